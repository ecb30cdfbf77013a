#pragma once

#include <vector>

#include "bench/w0_scene.h"

namespace pyroscene::bench {

/// The comparison peer: what one writes down first, kept simple and honest. A dense voxel array, one three-dimensional
/// traversal per ray, one exp per step, a table of Planck spectra with one row per kelvin and linear interpolation, flat
/// ground by a division, the result as [band][line][sample]. With light: every ground cell gathers a fixed set of
/// cosine-weighted directions once (cached per cell). One thread, no terrain mesh, no bricks.
struct BaselineResult {
    int samples = 0, lines = 0, bands = 0;
    std::vector<float> radiance_W_m2_sr_um;  ///< [band][line][sample]
};

class Baseline {
public:
    explicit Baseline(const W0Scene& scene, double reflectance);
    /// \param directions  of each ground cell in which the light of flames is gathered that it reflects once, the square of a
    ///        whole number; 0 = without that light
    [[nodiscard]] BaselineResult render(const W0Camera& camera, int directions) const;

private:
    /// Radiance of the flame along a ray and its transmittance; stops at the ground (z = 0) or the end of the grid.
    float march(Vec3 from_m, Vec3 direction, float* radiance) const;
    void add_planck(float temperature_K, float weight, float* radiance) const;
    [[nodiscard]] std::vector<float> cell_irradiance(int count) const;

    int nx_, ny_, nz_, bands_;
    double dx_m_, dz_m_;
    Vec3 corner_m_;
    std::vector<float> voxel_K_;   ///< dense, x fastest, 0 = empty
    std::vector<float> ground_K_;  ///< [row][col], row 0 = north
    MapGrid ground_grid_;
    Vec3 origin_m_;
    double absorption_per_m_, reflectance_;
    double lowest_K_;
    std::vector<float> planck_;  ///< [kelvin][band]
};

/// Single rays voxel by voxel in double precision with Planck's law itself: what both must agree with. Needs the scene.
class ExactMarch {
public:
    ExactMarch(const W0Scene& scene, double reflectance);
    [[nodiscard]] double radiance(const render::SceneRay& ray, double lambda_um) const;

private:
    const W0Scene* scene_;
    double reflectance_;
    std::vector<float> voxel_K_;
};

}  // namespace pyroscene::bench
