#pragma once

#include <cstdint>
#include <vector>

#include "render/scene_tables.h"
#include "render/smoke_shadow.h"

namespace pyroscene::render {

/// Spectra of the ground-leaving radiance, its parts kept apart: arrays of `stride` floats.
struct GroundSpectra {
    enum Part { Emission, Sun, Sky, ThermalSky, FlameLight, kParts };

    explicit GroundSpectra(int stride_floats)
        : stride(stride_floats), values(static_cast<std::size_t>(kParts) * static_cast<std::size_t>(stride_floats), 0.0F) {}
    [[nodiscard]] float* part(int p) noexcept { return values.data() + static_cast<std::ptrdiff_t>(p) * stride; }
    [[nodiscard]] const float* part(int p) const noexcept { return values.data() + static_cast<std::ptrdiff_t>(p) * stride; }
    void clear() noexcept { std::fill(values.begin(), values.end(), 0.0F); }

    int stride;
    std::vector<float> values;
};

/// Light on a piece of ground: the cosine of the sun (0 in shadow) and up to four rows of GroundIrradiance around it;
/// `open` is the rest of the weight, ground without a row, as far as it sees the sky; `hidden` as far as it sees terrain.
struct GroundLight {
    GroundLevel level;  ///< of the ground, for sun and open sky
    double sun_cosine = 0.0;
    int row_count = 0;
    std::array<std::int32_t, 4> row{};
    std::array<double, 4> weight{};
    double open = 1.0, hidden = 0.0;
    SmokeShade smoke;  ///< between the place and the sun, and above it; the rows above know of it already
};

/// Ground as plain weights per material, temperature and light, gathered over rays before any wavelength is touched: what
/// many rays through the same air see costs the arithmetic over wavelengths only once.
class GroundMix {
public:
    explicit GroundMix(const SceneTables& tables);

    /// Ground of one material and temperature that fills `weight` of the view: what it emits and what it reflects.
    void add(int material, double temperature_K, double weight, const GroundLight& light) {
        add_emission(material, temperature_K, weight);
        add_reflection(material, weight, light);
    }
    void add_emission(int material, double temperature_K, double weight);
    void add_reflection(int material, double weight, const GroundLight& light);
    /// The open sky itself, at a zenith angle of this cosine.
    void add_sky(double zenith_cosine, double weight) noexcept;
    /// Adds the spectra of all that was gathered to `out` and forgets it.
    void resolve(const GroundIrradiance* flame_light, GroundSpectra& out);
    [[nodiscard]] bool empty() const noexcept { return touched_.empty() && sky_weight_ == 0.0F; }

private:
    struct Reflection {
        double sun = 0.0, open = 0.0, hidden = 0.0;
    };
    struct LitPart {
        std::int32_t row;
        int material;
        double weight;
    };

    /// Ground in the shade of smoke, each ray by itself.
    struct ShadedPart {
        int material;
        GroundLevel level;
        double sun, open;
        SmokeShade smoke;
    };

    void resolve_reflection(GroundSpectra& out);
    void resolve_shaded(const ShadedPart& part, GroundSpectra& out);
    void resolve_lit(const LitPart& part, const GroundIrradiance& flame_light, GroundSpectra& out) const;

    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    std::vector<float> emission_;  ///< [material][Planck row] weight
    std::vector<std::uint8_t> is_touched_;
    std::vector<std::int32_t> touched_;    ///< indices into emission_, in order of arrival
    std::vector<Reflection> reflection_;   ///< [level][material]
    int first_level_ = 0, end_level_ = 0;  ///< those that hold anything
    std::vector<LitPart> lit_;
    std::vector<ShadedPart> shaded_;
    std::vector<float> through_, sky_, between_;
    SmokySky smoky_sky_;
    float sky_weight_ = 0.0F;
    std::array<float, OpenSky::kCosine.size()> sky_node_weight_{};
};

/// What a ray ends on: the ground at one place, what burns, what has burned, which material; or the sky.
struct GroundCell {
    int base_material = 0;
    double base_K = 0.0;          ///< NaN or 0 where there is no data
    double front_fraction = 0.0;  ///< part that flames
    bool burned = false;
    bool sky = false;          ///< no ground at all
    double zenith_cosine = 0;  ///< of the sky seen
};

/// The ground under a point of the scene frame.
GroundCell ground_cell(const RenderScene& scene, const SceneTables& tables, Vec3 point_m) noexcept;

/// Adds the ground of a cell, front and rest, to a mix.
void add_ground(const SceneTables& tables, const GroundCell& ground, double weight, const GroundLight& light,
                GroundMix& mix);

}  // namespace pyroscene::render
