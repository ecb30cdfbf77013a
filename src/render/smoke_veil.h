#pragma once

#include <array>
#include <vector>

#include "render/flame_columns.h"
#include "render/scene_tables.h"
#include "render/terrain_sight.h"

namespace pyroscene::render {

/// Smoke between the flames and the ground that they light. Sixteen bodies of flame stand for all: those at even shares of the
/// light that bodies without smoke would throw on the place, area T^4 cos / r^2; the smoke towards each is marched. Terrain
/// hides none of them. One per thread.
class SmokeVeil {
public:
    /// \param plume  columns of scene.plume; must outlive this, as must the others
    SmokeVeil(const RenderScene& scene, const SceneTables& tables, const FlameColumns& plume, double reach_m);

    /// Light of flames and the solid angle they fill, without smoke, become light through the smoke and the glow of what is in
    /// the way: t E + (1 - t) opacity B(T_smoke); t as for the light of flames in smoke (SmokeSpectra).
    /// \param opacity_sr [lambda]  \param smoke_K of the smoke  \param irradiance [lambda] in and out
    void dim(const Receiver& receiver, const float* opacity_sr, double smoke_K, float* irradiance);

private:
    static constexpr int kSamples = 16;
    struct Body {
        Vec3 middle_m;
        double weight, softening_m2;
    };
    /// Smoke towards the bodies that stand for all; false when there is none.
    bool find_smoke(const Receiver& receiver, std::array<double, kSamples>& fill_length_m);

    const RenderScene* scene_;
    const SceneTables* tables_;
    const FlameColumns* plume_;
    const SpectralKernels* kernels_;
    double reach_m_;
    std::vector<Body> bodies_;
    std::vector<double> light_;  ///< of the bodies, summed up
    std::vector<float> through_, one_;
};

}  // namespace pyroscene::render
