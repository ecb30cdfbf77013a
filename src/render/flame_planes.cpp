#include "render/flame_planes.h"

#include <algorithm>

#include "render/lattice_walk.h"

namespace pyroscene::render {

FlamePlanes::FlamePlanes(const fire::FlameField& field, const PlanckRows& planck) : field_(&field) {
    const std::size_t voxels = field.bricks.size() * fire::FlameField::kBrickVoxels;
    fill_.reserve(voxels);
    planck_position_.reserve(voxels);
    for (const auto& brick : field.bricks) {
        fill_.insert(fill_.end(), brick.fill.begin(), brick.fill.end());
        for (std::size_t v = 0; v < brick.fill.size(); ++v) {
            const bool burns = brick.fill[v] > 0.0F;
            planck_position_.push_back(burns ? static_cast<float>(planck.position_of(brick.temperature_K[v])) : 0.0F);
        }
    }
    occupied_.assign(field.columns.size(), -1);
    first_part_.push_back(0);
    for (int j = 0; j < field.brick_rows; ++j) {
        for (int i = 0; i < field.brick_cols; ++i) {
            const auto at =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(field.brick_cols) + static_cast<std::size_t>(i);
            if (field.columns[at].brick_count == 0) continue;
            occupied_[at] = static_cast<std::int32_t>(boxes_.size());
            add_brick_column(field.columns[at], i, j);
        }
    }
}

void FlamePlanes::add_brick_column(const fire::FlameField::BrickColumn& column, int brick_i, int brick_j) {
    auto& ranges = ranges_.emplace_back();
    const int bottom = column.z_begin * kEdge, top = bottom + column.brick_count * kEdge;
    for (int c = 0; c < kEdge * kEdge; ++c) {
        KRange& range = ranges[static_cast<std::size_t>(c)];
        const std::int32_t first_voxel = (column.first_brick - column.z_begin) * fire::FlameField::kBrickVoxels + c;
        for (int k = bottom; k < top; ++k) {
            if (!(fill_[voxel(first_voxel, k)] > 0.0F)) continue;
            if (range.end == 0) range.begin = k;
            range.end = k + 1;
        }
    }
    boxes_.push_back(occupied_box(brick_i, brick_j, 0, 0, kEdge).value_or(Box{}));
    constexpr int kPart = 2;
    for (int j = 0; j < kEdge; j += kPart) {
        for (int i = 0; i < kEdge; i += kPart) {
            if (const auto part = occupied_box(brick_i, brick_j, i, j, kPart)) parts_.push_back(*part);
        }
    }
    first_part_.push_back(parts_.size());
}

std::optional<FlamePlanes::Box> FlamePlanes::occupied_box(int brick_i, int brick_j, int i, int j, int size) const {
    int first_i = kEdge, end_i = 0, first_j = kEdge, end_j = 0;
    for (int v = j; v < j + size; ++v) {
        for (int u = i; u < i + size; ++u) {
            if (ranges_.back()[static_cast<std::size_t>(v * kEdge + u)].end == 0) continue;
            first_i = std::min(first_i, u), end_i = std::max(end_i, u + 1);
            first_j = std::min(first_j, v), end_j = std::max(end_j, v + 1);
        }
    }
    if (end_i == 0) return std::nullopt;
    const fire::VoxelGrid& g = field_->grid;
    const auto x_m = [&](int u) { return g.corner_m.x + (brick_i * kEdge + u) * g.dx_m; };
    const auto y_m = [&](int v) { return g.corner_m.y + (brick_j * kEdge + v) * g.dy_m; };
    return Box{x_m(first_i), y_m(first_j), x_m(end_i), y_m(end_j)};
}

void FlamePlanes::cross(double x_m, double y_m, double dx, double dy, double reach_m, std::vector<PlaneColumn>& out) const {
    const fire::VoxelGrid& g = field_->grid;
    const double from_x = (x_m - g.corner_m.x) / g.dx_m, from_y = (y_m - g.corner_m.y) / g.dy_m;
    const AxisWalk x(from_x, from_x + dx * reach_m / g.dx_m), y(from_y, from_y + dy * reach_m / g.dy_m);
    double begin = 0.0, end = 1.0;
    x.clip(0.0, field_->brick_cols * kEdge, begin, end);
    y.clip(0.0, field_->brick_rows * kEdge, begin, end);
    if (!(begin < end)) return;
    walk_cells(x, y, begin, end, kEdge, {0, 0, field_->brick_cols, field_->brick_rows},
               [&](int bi, int bj, double from, double to) {
                   const auto at = static_cast<std::size_t>(bj) * static_cast<std::size_t>(field_->brick_cols) +
                                   static_cast<std::size_t>(bi);
                   if (occupied_[at] < 0) return true;
                   const auto& ranges = ranges_[static_cast<std::size_t>(occupied_[at])];
                   const auto& column = field_->columns[at];
                   const int i0 = bi * kEdge, j0 = bj * kEdge;
                   const std::int32_t corner = (column.first_brick - column.z_begin) * fire::FlameField::kBrickVoxels;
                   return walk_cells(
                       x, y, from, to, 1.0, {i0, j0, i0 + kEdge, j0 + kEdge}, [&](int i, int j, double enter, double leave) {
                           const int local = (j - j0) * kEdge + (i - i0);
                           const KRange range = ranges[static_cast<std::size_t>(local)];
                           if (range.end > range.begin) {
                               out.push_back({static_cast<float>(enter * reach_m), static_cast<float>(leave * reach_m),
                                              range.begin, range.end, corner + local});
                           }
                           return true;
                       });
               });
}

}  // namespace pyroscene::render
