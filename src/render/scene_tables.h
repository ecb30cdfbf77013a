#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "radiometry/flame_table.h"
#include "render/planck_rows.h"
#include "render/scene.h"
#include "render/smoke_diffusion.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {

/// A diffuse sky or ground is dimmed as by a beam on this slant: the secant whose exp(-1.66 t) is nearest to the hemispherical
/// flux transmittance 2 E3(t) (Elsasser).
inline constexpr float kMeanSlant = 1.66F;

/// Smoke of fill 1 and the light that falls on it from outside the plume; rows of `stride`. Empty without a plume.
struct SmokeSpectra {
    bool scatters = false;
    std::vector<float> extinction_per_m, albedo, asymmetry;
    std::vector<float> sun;           ///< irradiance, direct normal
    std::vector<float> sky_radiance;  ///< mean over the open sky
    std::vector<float> ground_radiance,
        ground_lit;                 ///< of the scene's mean ambient ground: emitted and thermal sky; sunlight
    SmokeDiffusion diffusion;       ///< empty: light is scattered once
    std::vector<float> beam_per_m;  ///< what dims the sun inside smoke: extinction, or k' of the diffusion
    std::vector<float> flame_per_m, flame_spread_per_m;  ///< flames' light passes exp(-k c) / (1 + spread c) of a column c
};

/// The sky as rays see it that end in it, on nodes of the cosine of its zenith angle. Sunlit sky is the same all over; the thermal
/// sky is that of a grey layer at the temperature of the air, whose irradiance is the given one:
///   L(z) = B [1 - exp(-t sec z)],   1 - 2 E3(t) = E / (pi B)
/// One as bright as the air or brighter is the same all over.
struct OpenSky {
    static constexpr std::array<double, 13> kCosine{0.0,  0.02, 0.045, 0.07, 0.1,  0.14, 0.19,
                                                    0.25, 0.33, 0.43,  0.56, 0.75, 1.0};
    int stride = 0;
    std::vector<float> sunlit;   ///< [stride]
    std::vector<float> thermal;  ///< [node][stride]
};

/// Height of ground between two levels of its illumination: (1 - next) of level `first`, `next` of the one after it.
struct GroundLevel {
    int first = 0;
    float next = 0.0F;
};

/// Everything of a scene that depends on wavelength only, laid out for the kernels: rows of `stride` floats (the wavelengths,
/// padded with zeros). Built once per image.
struct SceneTables {
    explicit SceneTables(const RenderScene& scene);

    /// One row per material (and level, see below).
    struct Rows {
        std::vector<float> values;
        int stride = 0;
        [[nodiscard]] const float* operator[](int row) const noexcept {
            return values.data() + static_cast<std::ptrdiff_t>(row) * stride;
        }
    };

    int lambdas = 0, stride = 0, materials = 0, burnt_material = 0;
    PlanckRows planck;                    ///< all temperatures of flame and ground
    std::vector<float> absorption_per_m;  ///< of flame
    SmokeSpectra smoke;
    double truth_smoke_extinction_per_m = 0.0;
    /// Soot, gas and atoms over temperature; null when only the above absorbs.
    std::unique_ptr<const radiometry::FlameTable> mixture;
    /// Transmittance of flame over all wavelengths at 0, 0.25, ... in ln(1 + filled length / 1 cm), for the true exitance;
    /// empty for grey flame, whose transmittance is one.
    std::vector<double> total_transmittance;
    [[nodiscard]] double total_transmittance_at(double fill_length_m) const noexcept;
    bool grey = false;
    double least_absorption_per_m = 0.0;
    double truth_absorption_per_m = 0.0;  ///< at the node nearest 4.0 um

    Rows emissivity, reflectance_per_pi;
    /// Radiance reflected from the whole, open sky; sun: per cosine of incidence. Row `level * materials + material`.
    Rows sun, sky, thermal_sky;
    Rows sky_irradiance, thermal_sky_irradiance;  ///< [level] of level ground
    std::vector<double> level_m;                  ///< heights of the ground that these are for, scene frame, falling
    /// Where ground lies among the levels; beyond them as at the last.
    [[nodiscard]] GroundLevel level_at(double height_m) const noexcept;
    /// A row of the irradiances at any level; `between` may be used to hold it.
    [[nodiscard]] const float* at_level(const Rows& irradiance, GroundLevel level, std::vector<float>& between) const;
    Rows slopes_solar, slopes_thermal;  ///< radiance reflected from a hemisphere full of ambient terrain of the scene's mean
        ///< material: sun and sky that it reflects, what it emits and reflects of the thermal sky
    OpenSky open_sky;
    Vec3 to_sun;
    bool has_sun = false, has_sky = false, has_thermal_sky = false;
    double front_K = 0.0, ambient_K = 0.0;

private:
    void set_total_transmittance(const RenderScene& scene);
    void set_illumination(const RenderScene& scene);
    void set_slopes(const RenderScene& scene);
    void set_open_sky(const RenderScene& scene);
    void set_smoke(const RenderScene& scene, std::span<const double> reflected, std::span<const double> emitted);
    void set_smoke_scattering(const RenderScene& scene);
};

/// Checks that the parts of a scene fit together; throws an input error that names the part.
void check_scene(const RenderScene& scene);

}  // namespace pyroscene::render
