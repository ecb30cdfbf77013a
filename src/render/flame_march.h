#pragma once

#include "base/vec3.h"
#include "render/flame_columns.h"

namespace pyroscene::render {

/// Calls visit(temperature_K, fill, from, to) for every filled voxel on the segment, from `start_m` on; `from` and `to` are ray
/// parameters in [0, 1], and one voxel begins where its neighbour ends. `visit` returns false to stop.
template <class Visit>
void march_pieces(const FlameColumns& flame, Vec3 start_m, Vec3 end_m, Visit&& visit) {
    if (flame.empty()) return;
    const fire::VoxelGrid& g = flame.grid();
    const Vec3 from = start_m - g.corner_m, to = end_m - g.corner_m;
    const AxisWalk x(from.x / g.dx_m, to.x / g.dx_m), y(from.y / g.dy_m, to.y / g.dy_m), z(from.z / g.dz_m, to.z / g.dz_m);
    double begin = 0.0, end = 1.0;
    const auto [lowest, highest] = flame.height_range();
    z.clip(lowest, highest, begin, end);
    if (!(begin < end)) return;

    flame.cross(x, y, begin, end, [&](const FlameColumns::Column& column, double enter, double leave) {
        z.clip(column.k_begin, column.k_end, enter, leave);
        if (!(enter < leave)) return true;
        AxisWalk walk = z;
        walk.enter(enter, 1.0, column.k_begin, column.k_end - 1);
        for (double at = enter; at < leave;) {
            const double until = std::min(walk.leaves(1.0), leave);
            const std::size_t voxel = FlameColumns::voxel(column, walk.cell);
            const float fill = flame.fill(voxel);
            if (fill > 0.0F && until > at && !visit(flame.temperature_K(voxel), fill, at, until)) return false;
            walk.cell += walk.step;
            if (walk.cell < column.k_begin || walk.cell >= column.k_end) break;
            at = std::max(at, until);
        }
        return true;
    });
}

/// Calls visit(temperature_K, fill, length_m) for every burning voxel on the segment, from `start_m` on; temperature and fill
/// are constant within a voxel. `visit` returns false to stop. Lengths add up to the geometric length within 1e-12 relative
/// (eq 4.8 with the slant path, per voxel).
template <class Visit>
void march_flame(const FlameColumns& flame, Vec3 start_m, Vec3 end_m, Visit&& visit) {
    if (flame.empty()) return;
    const double ray_m = length(end_m - start_m);
    march_pieces(flame, start_m, end_m,
                 [&](float T_K, float fill, double from, double to) { return visit(T_K, fill, (to - from) * ray_m); });
}

}  // namespace pyroscene::render
