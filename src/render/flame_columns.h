#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fire/flame_field.h"
#include "render/lattice_walk.h"

namespace pyroscene::render {

/// Index of a flame field by vertical columns of voxels: which of them hold flame, and from where to where. Every traversal
/// of the flame, by sight lines and by the light on the ground, goes through here, so that air costs next to nothing.
class FlameColumns {
public:
    /// One column of voxels that holds flame: voxels k_begin <= k < k_end, the first and last of them burning.
    struct Column {
        std::int32_t first_voxel = 0;  ///< of k = 0 (which may lie below the bricks): see `voxel`
        std::int32_t k_begin = 0, k_end = 0;
    };
    /// Horizontal box around columns with flame, scene frame.
    struct Box {
        double west_m = 0.0, south_m = 0.0, east_m = 0.0, north_m = 0.0;
        /// Squared gap between the box and a square of the given half width around a point; 0 where they overlap.
        [[nodiscard]] double squared_gap_m2(double x_m, double y_m, double half_m) const noexcept {
            const double dx = std::max({west_m - x_m - half_m, x_m - half_m - east_m, 0.0});
            const double dy = std::max({south_m - y_m - half_m, y_m - half_m - north_m, 0.0});
            return dx * dx + dy * dy;
        }
    };

    explicit FlameColumns(const fire::FlameField& field);

    [[nodiscard]] bool empty() const noexcept { return boxes_.empty(); }
    [[nodiscard]] const fire::VoxelGrid& grid() const noexcept { return field_->grid; }
    /// {lowest, highest} voxel face of all flame, in voxels above the grid's corner.
    [[nodiscard]] std::array<int, 2> height_range() const noexcept { return {lowest_, highest_}; }

    /// One box per brick column with flame, and its parts of 2 x 2 voxel columns: those of box b are parts()[first_part(b)] to
    /// parts()[first_part(b + 1) - 1].
    [[nodiscard]] const std::vector<Box>& boxes() const noexcept { return boxes_; }
    [[nodiscard]] const std::vector<Box>& parts() const noexcept { return parts_; }
    [[nodiscard]] std::size_t first_part(std::size_t box) const noexcept { return first_part_[box]; }

    /// Position of voxel k of a column in the field's bricks, counted through all bricks.
    static std::size_t voxel(const Column& column, int k) noexcept {
        return static_cast<std::size_t>(column.first_voxel + k * kEdge * kEdge);
    }
    [[nodiscard]] float fill(std::size_t voxel) const noexcept {
        return field_->bricks[voxel / kBrick].fill[voxel % kBrick];
    }
    [[nodiscard]] float temperature_K(std::size_t voxel) const noexcept {
        return field_->bricks[voxel / kBrick].temperature_K[voxel % kBrick];
    }

    /// Calls visit(column, from, to) for the columns with flame that the ray's footprint crosses between ray parameters
    /// `begin` and `end`, in order, until `visit` returns false. The walks are in voxels.
    template <class Visit>
    void cross(const AxisWalk& x, const AxisWalk& y, double begin, double end, Visit&& visit) const;

private:
    static constexpr int kEdge = fire::FlameField::kBrickEdge;
    static constexpr std::size_t kBrick = fire::FlameField::kBrickVoxels;
    using BrickColumns = std::array<Column, static_cast<std::size_t>(kEdge* kEdge)>;

    void add_brick_column(const fire::FlameField::BrickColumn& bricks, int brick_i, int brick_j);
    /// Box of the columns with flame among [i, i + size) x [j, j + size) of the brick column added last.
    [[nodiscard]] std::optional<Box> occupied_box(int brick_i, int brick_j, int i, int j, int size) const;

    const fire::FlameField* field_;
    CellBox bricks_{0, 0, 0, 0};  ///< brick columns that hold flame
    int lowest_ = 0, highest_ = 0;
    std::vector<std::int32_t> occupied_;  ///< [brick column] index into columns_, -1 = no flame
    std::vector<BrickColumns> columns_;   ///< k_end == 0: no flame
    std::vector<Box> boxes_, parts_;
    std::vector<std::size_t> first_part_;
};

template <class Visit>
void FlameColumns::cross(const AxisWalk& x, const AxisWalk& y, double begin, double end, Visit&& visit) const {
    if (empty()) return;
    x.clip(bricks_.first_i * kEdge, bricks_.end_i * kEdge, begin, end);
    y.clip(bricks_.first_j * kEdge, bricks_.end_j * kEdge, begin, end);
    if (!(begin < end)) return;
    walk_cells(x, y, begin, end, kEdge, bricks_, [&](int bi, int bj, double enter, double leave) {
        const std::int32_t found = occupied_[static_cast<std::size_t>(bj) * static_cast<std::size_t>(field_->brick_cols) +
                                             static_cast<std::size_t>(bi)];
        if (found < 0) return true;
        const BrickColumns& columns = columns_[static_cast<std::size_t>(found)];
        const int i0 = bi * kEdge, j0 = bj * kEdge;
        return walk_cells(x, y, enter, leave, 1.0, {i0, j0, i0 + kEdge, j0 + kEdge},
                          [&](int i, int j, double from, double to) {
                              const Column& column = columns[static_cast<std::size_t>((j - j0) * kEdge + (i - i0))];
                              return column.k_end == 0 || visit(column, from, to);
                          });
    });
}

}  // namespace pyroscene::render
