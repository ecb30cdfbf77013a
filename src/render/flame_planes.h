#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fire/flame_field.h"
#include "render/planck_rows.h"

namespace pyroscene::render {

/// Part of a vertical plane through a receiver that lies in one column of voxels with flame.
struct PlaneColumn {
    float enter_m, leave_m;    ///< horizontal distances from the receiver
    int k_begin, k_end;        ///< occupied voxels
    std::int32_t first_voxel;  ///< place of the column in the flame's arrays, see FlamePlanes::voxel
    float horizon = -std::numeric_limits<float>::infinity();  ///< slope below which terrain hides the column
};

/// The flame as places on the ground see it: columns of voxels crossed by vertical planes.
class FlamePlanes {
public:
    /// Horizontal box around occupied voxels, scene frame.
    struct Box {
        double west_m, south_m, east_m, north_m;
        /// Gap between the box and a square of the given half width around a point, along x and y; 0 where they overlap.
        [[nodiscard]] double squared_gap_m2(double x_m, double y_m, double half_m) const noexcept {
            const double dx = std::max({west_m - x_m - half_m, x_m - half_m - east_m, 0.0});
            const double dy = std::max({south_m - y_m - half_m, y_m - half_m - north_m, 0.0});
            return dx * dx + dy * dy;
        }
    };

    /// \param planck  rows that the emission is expressed in
    FlamePlanes(const fire::FlameField& field, const PlanckRows& planck);

    /// One per brick column with flame, and their parts of 2 x 2 voxel columns: those of box b are parts()[first_part(b)] to
    /// parts()[first_part(b + 1) - 1].
    [[nodiscard]] const std::vector<Box>& boxes() const noexcept { return boxes_; }
    [[nodiscard]] const std::vector<Box>& parts() const noexcept { return parts_; }
    [[nodiscard]] std::size_t first_part(std::size_t box) const noexcept { return first_part_[box]; }
    /// Appends the columns with flame on the horizontal ray from (x, y) into (dx, dy), a unit vector, up to `reach_m`, in
    /// order of distance.
    void cross(double x_m, double y_m, double dx, double dy, double reach_m, std::vector<PlaneColumn>& out) const;

    [[nodiscard]] double bottom_m() const noexcept { return field_->grid.corner_m.z; }
    [[nodiscard]] double dz_m() const noexcept { return field_->grid.dz_m; }
    /// Index of voxel k of a column into `fill` and `planck_position`.
    static std::size_t voxel(std::int32_t first_voxel, int k) noexcept {
        return static_cast<std::size_t>(first_voxel + k * kEdge * kEdge);
    }
    [[nodiscard]] float fill(std::size_t v) const noexcept { return fill_[v]; }
    [[nodiscard]] float planck_position(std::size_t v) const noexcept { return planck_position_[v]; }

private:
    static constexpr int kEdge = fire::FlameField::kBrickEdge;
    struct KRange {
        int begin = 0, end = 0;
    };

    void add_brick_column(const fire::FlameField::BrickColumn& column, int brick_i, int brick_j);
    /// Box of the occupied columns among [i, i + size) x [j, j + size) of the brick column added last.
    [[nodiscard]] std::optional<Box> occupied_box(int brick_i, int brick_j, int i, int j, int size) const;

    const fire::FlameField* field_;
    std::vector<std::int32_t> occupied_;  ///< per brick column: index into ranges_ and boxes_, -1 = no flame
    std::vector<std::array<KRange, static_cast<std::size_t>(kEdge* kEdge)>> ranges_;
    std::vector<Box> boxes_, parts_;
    std::vector<std::size_t> first_part_;
    std::vector<float> fill_, planck_position_;
};

}  // namespace pyroscene::render
