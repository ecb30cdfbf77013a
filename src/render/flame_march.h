#pragma once

#include "base/vec3.h"
#include "fire/flame_field.h"
#include "render/lattice_walk.h"

namespace pyroscene::render {

namespace detail {

/// Voxels of one brick column between ray parameters [begin, end]. Returns false when `visit` asked to stop.
template <class Visit>
bool march_column(const fire::FlameField& field, const fire::FlameField::BrickColumn& column, int brick_i, int brick_j,
                  AxisWalk x, AxisWalk y, AxisWalk z, double begin, double end, double ray_m, Visit& visit) {
    constexpr int kEdge = fire::FlameField::kBrickEdge;
    const int bottom = column.z_begin * kEdge, top = bottom + column.brick_count * kEdge;
    z.clip(bottom, top, begin, end);
    if (!(begin < end)) return true;
    const int i0 = brick_i * kEdge, j0 = brick_j * kEdge;
    x.enter(begin, 1.0, i0, i0 + kEdge - 1);
    y.enter(begin, 1.0, j0, j0 + kEdge - 1);
    z.enter(begin, 1.0, bottom, top - 1);
    double next_x = x.leaves(1.0), next_y = y.leaves(1.0), next_z = z.leaves(1.0);
    for (double at = begin; at < end;) {
        const double next = std::min(std::min(next_x, next_y), next_z);
        const double until = std::min(next, end);
        const int k = z.cell - bottom;
        const auto& brick = field.bricks[static_cast<std::size_t>(column.first_brick + k / kEdge)];
        const auto voxel = static_cast<std::size_t>(((k % kEdge) * kEdge + (y.cell - j0)) * kEdge + (x.cell - i0));
        const float fill = brick.fill[voxel];
        if (fill > 0.0F && until > at && !visit(brick.temperature_K[voxel], fill, (until - at) * ray_m)) return false;
        if (next == next_z) {
            z.cell += z.step;
            if (z.cell < bottom || z.cell >= top) break;
            next_z = z.leaves(1.0);
        } else if (next == next_x) {
            x.cell += x.step;
            if (x.cell < i0 || x.cell >= i0 + kEdge) break;
            next_x = x.leaves(1.0);
        } else {
            y.cell += y.step;
            if (y.cell < j0 || y.cell >= j0 + kEdge) break;
            next_y = y.leaves(1.0);
        }
        at = std::max(at, until);
    }
    return true;
}

}  // namespace detail

/// A flame field ready for marching: the field and the box of its occupied brick columns.
class FlameMarcher {
public:
    FlameMarcher() = default;
    explicit FlameMarcher(const fire::FlameField& field) noexcept;

    /// Calls visit(temperature_K, fill, length_m) for every occupied voxel on the segment, from `start_m` on; temperature
    /// and fill are constant within a voxel. `visit` returns false to stop. Brick columns without flame cost one step.
    /// Lengths add up to the geometric length within 1e-12 relative (eq 4.8 with the slant path, per voxel).
    template <class Visit>
    void march(Vec3 start_m, Vec3 end_m, Visit&& visit) const;

private:
    const fire::FlameField* field_ = nullptr;
    int first_i_ = 0, first_j_ = 0, end_i_ = 0, end_j_ = 0;  ///< brick columns that hold flame
    double bottom_ = 0.0, top_ = 0.0;                        ///< in voxels above the grid's corner
};

template <class Visit>
void FlameMarcher::march(Vec3 start_m, Vec3 end_m, Visit&& visit) const {
    constexpr int kEdge = fire::FlameField::kBrickEdge;
    if (end_i_ == first_i_) return;
    const fire::VoxelGrid& g = field_->grid;
    const Vec3 from = start_m - g.corner_m, to = end_m - g.corner_m;
    AxisWalk x(from.x / g.dx_m, to.x / g.dx_m), y(from.y / g.dy_m, to.y / g.dy_m), z(from.z / g.dz_m, to.z / g.dz_m);

    double begin = 0.0, end = 1.0;
    x.clip(first_i_ * kEdge, end_i_ * kEdge, begin, end);
    y.clip(first_j_ * kEdge, end_j_ * kEdge, begin, end);
    z.clip(bottom_, top_, begin, end);
    if (!(begin < end)) return;

    const double ray_m = length(end_m - start_m);
    walk_cells(
        x, y, begin, end, kEdge, {first_i_, first_j_, end_i_, end_j_}, [&](int i, int j, double from_at, double to_at) {
            const auto& column = field_->columns[static_cast<std::size_t>(j) * static_cast<std::size_t>(field_->brick_cols) +
                                                 static_cast<std::size_t>(i)];
            return column.brick_count == 0 ||
                   detail::march_column(*field_, column, i, j, x, y, z, from_at, to_at, ray_m, visit);
        });
}

}  // namespace pyroscene::render
