#pragma once

#include <vector>

#include "render/absorption_nodes.h"
#include "render/flame_columns.h"
#include "render/planck_series.h"
#include "render/plane_trace.h"
#include "render/scene.h"
#include "render/spectral_kernels.h"
#include "render/terrain_sight.h"

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

/// Light of the flames on receivers. The hemisphere is cut into vertical planes that are spent only on azimuths where flame
/// stands; within a plane the elevations between the lowest and highest flame are cut into strata, each traced once through
/// its columns; the weight of a stratum is exact. Cells next to flame are sampled at many points with two planes each,
/// so that the result is the mean over the cell where it varies within the cell. One per thread.
class ReceiverLight {
public:
    explicit ReceiverLight(const LightScene& shared);

    /// Fills `emitted`: [absorption node][moment of the Planck series] cosine-weighted solid angle [sr] times T_moment; moment
    /// 0 is pi minus what the flames let through.
    void compute(const Receiver& receiver);
    [[nodiscard]] const std::vector<float>& emitted() const noexcept { return emitted_; }

private:
    /// Part of the circle of azimuths, in diamond angle (0 to 4 and beyond), that flames stand in.
    struct Arc {
        double begin, end;
        const FlameColumns::Box *first, *last;  ///< whose edges begin and end are; null: flame stands on the receiver

        void reach(double other_end, const FlameColumns::Box* box) noexcept {
            if (other_end > end) end = other_end, last = box;
        }
    };
    static constexpr Arc kCircle{0.0, 4.0, nullptr, nullptr};

    [[nodiscard]] bool is_near_flame(const Receiver& receiver) const;
    void compute_cell(const Receiver& receiver);
    void compute_centre(const Receiver& receiver);
    void find_arcs(double x_m, double y_m);
    bool add_arc(const FlameColumns::Box& box, double x_m, double y_m);
    void merge_arcs();
    void trace_planes(Vec3 from_m, const Receiver& receiver, double begin, double end, int count);
    /// One plane; rays are sent `in_stratum` (0 to 1) of the way up through each stratum.
    void trace_plane(Vec3 from_m, const Receiver& receiver, double azimuth, double weight, double in_stratum);
    void cross_columns(Vec3 from_m, double dx, double dy);
    void find_horizons(Vec3 from_m, double dx, double dy);
    [[nodiscard]] bool slopes_of_flame(Vec3 from_m, double& low, double& high) const;

    const LightScene* shared_;
    const SpectralKernels* kernels_;
    std::vector<Arc> arcs_;
    std::vector<PlaneColumn> columns_;
    std::vector<float> sums_;     ///< [node][moment][stratum]
    std::vector<float> hottest_;  ///< [node][stratum], see PlaneTrace
    std::vector<float> emitted_;
};

}  // namespace pyroscene::render
