#pragma once

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "render/absorption_nodes.h"
#include "render/flame_columns.h"
#include "render/planck_series.h"
#include "render/plane_trace.h"
#include "render/scene.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {

/// What all receivers of a scene share.
struct LightScene {
    LightScene(const RenderScene& s, const GroundLightSettings& g);

    const RenderScene& scene;
    GroundLightSettings settings;
    PlanckSeries planck;
    AbsorptionNodes nodes;
    FlameColumns flame;
    std::vector<float> voxels;  ///< of all bricks: {fill, reduced inverse temperature}
    bool rough = false;         ///< terrain is no horizontal plane
};

/// A piece of ground that receives light: a map cell with its mean slope.
struct Receiver {
    double x_m = 0.0, y_m = 0.0;  ///< centre, scene frame
    Vec3 normal{0.0, 0.0, 1.0};
};

/// Weight of the elevations below a line of sight, in one vertical plane per radian of azimuth:
///   F(t) = int (n . omega) cos(e) de up to e = atan t  =  n_h (e + sin e cos e) / 2 + n_z sin^2(e) / 2
/// with n_h the component of the receiver's normal along the plane.
struct PlaneWeight {
    double along = 0.0, up = 1.0;
    [[nodiscard]] double below(double slope) const noexcept;
    /// Slope of the receiver's own surface: nothing below it is seen.
    [[nodiscard]] double lowest_slope() const noexcept { return -along / up; }
};

/// Light of the flames on receivers. The hemisphere is cut into vertical planes that are spent only on azimuths where flame
/// stands; within a plane the elevations between the lowest and highest flame are cut into strata, each traced once through
/// its columns; the weight of a stratum is exact. Cells next to flame are sampled at several points with fewer planes each,
/// so that the result is the mean over the cell where it varies within the cell. One per thread.
class ReceiverLight {
public:
    explicit ReceiverLight(const LightScene& shared);

    /// Fills `emitted`: [absorption node][moment of the Planck series] cosine-weighted solid angle [sr] times T_moment; moment
    /// 0 is pi minus what the flames let through.
    void compute(const Receiver& receiver);
    [[nodiscard]] const std::vector<float>& emitted() const noexcept { return emitted_; }

    /// Directions of the receiver's hemisphere that meet terrain instead of sky, in `planes` azimuths: calls
    /// visit(direction, weight_sr), and returns the sum of the weights.
    template <class Visit>
    double hidden_by_terrain(const Receiver& receiver, int planes, Visit&& visit) const;

private:
    /// Part of the circle of azimuths, in diamond angle (0 to 4 and beyond), that flames stand in.
    struct Arc {
        double begin, end;
    };

    [[nodiscard]] bool is_near_flame(const Receiver& receiver) const;
    void compute_point(double x_m, double y_m, const Receiver& receiver, int planes_around, double weight);
    void find_arcs(double x_m, double y_m);
    bool add_arc(const FlameColumns::Box& box, double x_m, double y_m);
    void merge_arcs();
    void trace_plane(Vec3 from_m, const Receiver& receiver, double azimuth, double weight);
    void cross_columns(Vec3 from_m, double dx, double dy);
    void find_horizons(Vec3 from_m, double dx, double dy);
    [[nodiscard]] bool slopes_of_flame(Vec3 from_m, double& low, double& high) const;

    const LightScene* shared_;
    const SpectralKernels* kernels_;
    std::vector<Arc> arcs_;
    std::vector<PlaneColumn> columns_;
    std::vector<float> sums_;  ///< [node][moment][stratum]
    std::vector<float> emitted_;
};

/// Slope of the terrain's skyline from a point into a horizontal direction, scanned cell by cell up to `reach_m`.
double skyline_slope(const TerrainMesh& terrain, Vec3 from_m, double dx, double dy, double reach_m) noexcept;

template <class Visit>
double ReceiverLight::hidden_by_terrain(const Receiver& receiver, int planes, Visit&& visit) const {
    const TerrainMesh& terrain = *shared_->scene.terrain;
    const Vec3 from{receiver.x_m, receiver.y_m, terrain.height_at(receiver.x_m, receiver.y_m)};
    double sum_sr = 0.0;
    for (int p = 0; p < planes; ++p) {
        const double azimuth = 2.0 * kPi * (p + 0.5) / planes, dx = std::cos(azimuth), dy = std::sin(azimuth);
        const PlaneWeight weight{receiver.normal.x * dx + receiver.normal.y * dy, receiver.normal.z};
        const double lowest = weight.lowest_slope(),
                     skyline = skyline_slope(terrain, from, dx, dy, shared_->settings.reach_m);
        if (!(skyline > lowest)) continue;
        const double weight_sr = 2.0 * kPi / planes * (weight.below(skyline) - weight.below(lowest));
        sum_sr += weight_sr;
        visit(normalized(Vec3{dx, dy, 0.5 * (lowest + skyline)}), weight_sr);
    }
    return sum_sr;
}

}  // namespace pyroscene::render
