#pragma once

#include <vector>

#include "render/scene_tables.h"
#include "render/terrain_sight.h"

namespace pyroscene::render {

/// The flame as isotropic point sources, one per vertical column of voxels at its centre of emission (thesis 4.4 and 6.4):
///   E = sum I cos(theta) / r^2,   I = sum over the column of k fill V B(T)
/// Meant for comparison with the hemisphere quadrature: no terrain and no other flame stands in the way, and flame that is
/// not thin emits too much.
class PointSources {
public:
    /// \param cut  a source is ignored where its irradiance is below this fraction of that in 1 m distance: reaches
    ///        1 / sqrt(cut) metres (thesis: 1 % and 10 m); 0 = up to reach_m
    PointSources(const RenderScene& scene, const SceneTables& tables, double cut, double reach_m);

    /// Adds the irradiance on a receiver, the mean over 3 x 3 points of a cell.
    void add(const RenderScene& scene, const Receiver& receiver, float* irradiance) const;

private:
    struct Source {
        Vec3 at_m;
        std::size_t row;  ///< of intensity_
    };
    double reach_m_;
    int stride_;
    std::vector<Source> sources_;
    std::vector<float> intensity_W_sr_um_;  ///< [source][lambda]
};

}  // namespace pyroscene::render
