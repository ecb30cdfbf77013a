#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/flame_march.h"
#include "render/ground_mix.h"
#include "render/mixture_ray.h"
#include "render/scene.h"
#include "render/scene_tables.h"
#include "render/smoke_ray.h"

namespace pyroscene::render {

/// A scene and all that was prepared from it for one image; shared by all threads, constant.
struct PreparedScene {
    PreparedScene(const RenderScene& s, const GroundIrradiance* light)
        : scene(s), flame_light(light), tables(s), flame(*s.flame) {
        if (has_plume(s)) smoke.emplace(s, tables);
    }
    struct Smoke {
        Smoke(const RenderScene& s, const SceneTables& t)
            : columns(*s.plume),
              light(s, t, columns),
              nodes(t, light, s.optics->lambda_um, s.plume->temperature_range_K()[1]),
              shadow(s) {}
        FlameColumns columns;
        SmokeLight light;
        SmokeNodes nodes;
        SmokeShadow shadow;
    };
    const RenderScene& scene;
    const GroundIrradiance* flame_light;  ///< may be null
    SceneTables tables;
    FlameColumns flame;
    std::optional<Smoke> smoke;  ///< if any
};

/// What the rays of one pixel met, as sums of ray weights; opacities and transmittances of flame are those at 4.0 um.
struct PixelTruth {
    double coverage = 0.0;  ///< that met the scene
    double seen = 0.0;      ///< that met the scene or its surroundings, or ended in the sky
    double sky = 0.0;       ///< that ended in the sky
    Vec3 hit_m;             ///< weighted sum over those that met ground
    double flame = 0.0, smoke = 0.0, front = 0.0, scar = 0.0, background = 0.0;
    double flame_T4 = 0.0;   ///< sum of (tau_i - tau_{i+1}) T^4
    double ground_T4 = 0.0;  ///< sum of tau T^4
    double exitance_W_m2 = 0.0;
};

/// Gathers the rays of one pixel. One per thread.
class Pixel {
public:
    explicit Pixel(const PreparedScene& prepared);

    void begin();
    /// Ground, or sky, that a sub-ray ends on.
    struct Met {
        TerrainMesh::Hit hit;
        GroundCell ground;
        bool scene = true;  ///< false: the surroundings or the sky
    };
    /// nullopt where there is neither scene nor surroundings nor sky.
    [[nodiscard]] std::optional<Met> meet(const SceneRay& ray) const {
        return meet(ray, prepared_->scene.terrain->intersect(ray.start_m, ray.end_m));
    }
    /// The same for a ray of which it is known where it meets the terrain.
    [[nodiscard]] std::optional<Met> meet(const SceneRay& ray, const std::optional<TerrainMesh::Hit>& terrain) const;
    /// Adds one sub-ray: flame, and ground or sky behind it (eq 4.11 with the ground term).
    void add(const SceneRay& ray, const Met& met, double weight);
    /// Turns all gathered weights into the spectra `flame` and `ground`: sums over rays that saw something.
    void finish();

    [[nodiscard]] const PixelTruth& truth() const noexcept { return truth_; }
    [[nodiscard]] const float* flame() const noexcept { return flame_.data(); }
    /// Emission of the plume; zeros in scenes without one.
    [[nodiscard]] const float* smoke() const noexcept { return smoke_.data(); }
    /// What the plume scatters.
    [[nodiscard]] const float* scattered() const noexcept { return scattered_.data(); }
    [[nodiscard]] const GroundSpectra& ground() const noexcept { return ground_; }

private:
    struct FlamePiece {
        float temperature_K;
        double fill_length_m;  ///< length x filled fraction
        double emitted = 0.0;  ///< what it emits of its black body through the pieces before it, at 4.0 um
    };
    [[nodiscard]] GroundLight light_at(const Met& met) const;
    void march(Vec3 start_m, Vec3 end_m);
    /// What flames and smoke on a ray let through.
    struct Through {
        double at_4um = 1.0;  ///< flame and smoke, for fractions
        double total = 1.0;   ///< flame over all wavelengths, for exitance
    };
    Through flame_truth(double weight);
    void add_grey_flame(double weight);
    void emit_soot(double weight);
    void add_flame_spectrally(double weight, const GroundCell& ground, const GroundLight& light);
    Through mixed_truth(double weight);
    void add_mixed(double weight, const GroundCell& ground, const GroundLight& light);
    void add_ground_behind(double weight, const GroundCell& ground, const GroundLight& light, const float* tau);
    void add_ground_truth(const GroundCell& ground, double weight, const Through& through);

    const PreparedScene* prepared_;
    const SpectralKernels* kernels_;
    PixelTruth truth_;
    std::vector<FlamePiece> pieces_;    ///< of the current ray, neighbours of one temperature merged
    std::vector<double> flame_weight_;  ///< [Planck row] of grey flame
    int first_flame_row_ = 0, end_flame_row_ = 0;
    GroundMix mix_, mix_of_ray_;
    GroundSpectra ground_, ground_of_ray_;
    std::optional<MixtureRay> mixture_;
    std::vector<float> flame_, smoke_, scattered_, tau_;
    std::optional<SmokeRay> smoke_ray_;
    bool flame_used_ = false, ground_used_ = false;
};

}  // namespace pyroscene::render
