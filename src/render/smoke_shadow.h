#pragma once

#include <vector>

#include "render/flame_columns.h"
#include "render/scene.h"
#include "render/scene_tables.h"

namespace pyroscene::render {

/// Fill x length of smoke between two points, and from a point towards the sun (0 at night).
double smoke_between(const FlameColumns& plume, Vec3 from_m, Vec3 to_m);
double smoke_to_sun(const FlameColumns& plume, Vec3 from_m, Vec3 to_sun);

/// Smoke between a place on the ground and the sun, and straight above it: fill x length, and the mean temperature above.
struct SmokeShade {
    float to_sun = 0.0F, above = 0.0F, temperature_K = 0.0F;
};

/// Smoke over the ground, per cell of the terrain's map.
class SmokeShadow {
public:
    explicit SmokeShadow(const RenderScene& scene);

    /// Bilinear between the centres of cells.  \param ground_m scene frame
    [[nodiscard]] SmokeShade at(Vec3 ground_m) const noexcept;

private:
    MapGrid grid_;
    Vec3 origin_m_;
    std::vector<SmokeShade> cells_;
};

/// Irradiance of a sky through smoke:  t E + (1 - t) pi B(T_smoke),  t = exp(-1.66 k column). Of light scattered more than once
/// t E + r M + (1 - t - r) pi B  with the layer's own t and r and the ambient ground's exitance M; what smoke scatters down of the
/// sun belongs to the sunlit sky. One per thread.
class SmokySky {
public:
    explicit SmokySky(const SceneTables& tables);

    void look_from(const SmokeShade& shade);
    /// Of a sky's irradiance without smoke, after look_from().
    /// \param thermal  the thermal sky: smoke has its B and ground its own; false: the sunlit sky, with what smoke scatters down
    void dim(const float* sky, bool thermal, float* out) const;

private:
    [[nodiscard]] bool diffuse() const noexcept { return !tables_->smoke.diffusion.empty(); }

    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    SmokeShade shade_;
    std::vector<float> through_, back_, sun_;  ///< [lambda] t, r, and sunlight on level ground per irradiance
};

}  // namespace pyroscene::render
