#include "render/receiver_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace pyroscene::render {
namespace {

constexpr int kCoarsest = 16;           ///< cells between traced receivers far away from flames
constexpr float kLeastSpacings = 6.0F;  ///< from any flame

/// Cells from each cell to the nearest with flame over it, by steps along rows, columns and diagonals (up to 8 % too far).
Raster<float> cells_to_flame(const MapGrid& grid, const FlameColumns& flame, Vec3 scene_origin_m) {
    Raster<float> distance(grid, "distance to flame", "cells", std::numeric_limits<float>::infinity());
    const auto clamped = [](double at, int n) { return std::clamp(static_cast<int>(at), 0, n - 1); };
    for (const FlameColumns::Box& box : flame.parts()) {
        const int first_col = clamped(grid.col_at(box.west_m + scene_origin_m.x), grid.cols),
                  last_col = clamped(grid.col_at(box.east_m + scene_origin_m.x), grid.cols);
        const int first_row = clamped(grid.row_at(box.north_m + scene_origin_m.y), grid.rows),
                  last_row = clamped(grid.row_at(box.south_m + scene_origin_m.y), grid.rows);
        for (int r = first_row; r <= last_row; ++r)
            for (int c = first_col; c <= last_col; ++c) distance.at(r, c) = 0.0F;
    }
    // There and back, each cell from the four neighbours that were visited before it.
    const auto spread = [&](int r, int c, int back) {
        constexpr std::array<std::array<int, 2>, 4> kNeighbours{{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}}};
        for (const auto& [dr, dc] : kNeighbours) {
            const int rr = r + back * dr, cc = c + back * dc;
            if (rr < 0 || rr >= grid.rows || cc < 0 || cc >= grid.cols) continue;
            const float step = dr != 0 && dc != 0 ? std::numbers::sqrt2_v<float> : 1.0F;
            distance.at(r, c) = std::min(distance.at(r, c), distance.at(rr, cc) + step);
        }
    };
    for (int r = 0; r < grid.rows; ++r)
        for (int c = 0; c < grid.cols; ++c) spread(r, c, 1);
    for (int r = grid.rows - 1; r >= 0; --r)
        for (int c = grid.cols - 1; c >= 0; --c) spread(r, c, -1);
    return distance;
}

/// The four receivers around the middle of a gap of 2 `spacing` cells, and Lagrange's weights: two on each side, or one and
/// three at the rim of the map.
struct Cubic {
    std::array<int, 4> offset;
    std::array<float, 4> weight;
};
constexpr std::array<Cubic, 3> kCubics{{{{-3, -1, 1, 3}, {-0.0625F, 0.5625F, 0.5625F, -0.0625F}},
                                        {{-1, 1, 3, 5}, {0.3125F, 0.9375F, -0.3125F, 0.0625F}},
                                        {{-5, -3, -1, 1}, {0.0625F, -0.3125F, 0.9375F, 0.3125F}}}};

class Lattice {
public:
    Lattice(const GroundIrradiance& light, Raster<float> cells_to_flame)
        : light_(&light), cells_to_flame_(std::move(cells_to_flame)) {}

    /// Receivers at rows first_row, first_row + row_step, ... and the same of columns; interpolated along the columns of the map
    /// (`down`) or along its rows, between those `spacing` cells away.
    [[nodiscard]] std::vector<LatticeReceiver> wave(int first_row, int row_step, int first_col, int col_step, int spacing,
                                                    bool down) const {
        const MapGrid& grid = light_->grid;
        std::vector<LatticeReceiver> found;
        for (int r = first_row; r < grid.rows; r += row_step) {
            for (int c = first_col; c < grid.cols; c += col_step) {
                if (row_at(r, c) < 0) continue;
                found.push_back(between(r, c, spacing, down).value_or(LatticeReceiver{row_at(r, c)}));
            }
        }
        return found;
    }

private:
    [[nodiscard]] std::int32_t row_at(int r, int c) const {
        const MapGrid& grid = light_->grid;
        return r < 0 || r >= grid.rows || c < 0 || c >= grid.cols ? -1 : light_->row_of_cell[grid.index(r, c)];
    }
    [[nodiscard]] std::optional<LatticeReceiver> between(int r, int c, int spacing, bool down) const {
        if (spacing == 0 || cells_to_flame_.at(r, c) < kLeastSpacings * static_cast<float>(spacing)) return std::nullopt;
        for (const Cubic& cubic : kCubics) {
            LatticeReceiver receiver{row_at(r, c), false, {}, cubic.weight};
            for (std::size_t i = 0; i < cubic.offset.size(); ++i) {
                const int away = cubic.offset[i] * spacing;
                receiver.from[i] = row_at(r + (down ? away : 0), c + (down ? 0 : away));
            }
            if (std::all_of(receiver.from.begin(), receiver.from.end(), [](auto row) { return row >= 0; })) return receiver;
        }
        return std::nullopt;
    }

    const GroundIrradiance* light_;
    Raster<float> cells_to_flame_;
};

}  // namespace

std::vector<std::vector<LatticeReceiver>> receiver_waves(const GroundIrradiance& light, const FlameColumns& flame,
                                                         Vec3 scene_origin_m) {
    const Lattice lattice(light, cells_to_flame(light.grid, flame, scene_origin_m));
    std::vector<std::vector<LatticeReceiver>> waves;
    waves.push_back(lattice.wave(0, kCoarsest, 0, kCoarsest, 0, false));
    for (int s = kCoarsest / 2; s >= 1; s /= 2) {
        waves.push_back(lattice.wave(0, 2 * s, s, 2 * s, s, false));
        waves.push_back(lattice.wave(s, 2 * s, 0, s, s, true));
    }
    return waves;
}

}  // namespace pyroscene::render
