#include "spread/straight_ray.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace pyroscene::spread {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

bool burns(const MapGrid& grid, const FireShapes& shapes, int row, int col) noexcept {
    return grid.contains(row, col) && shapes[grid.index(row, col)].burns();
}

}  // namespace

double straight_ray_s(const MapGrid& grid, const FireShapes& shapes, Position start, double dx, double dy) noexcept {
    const double x_m = dx * grid.cell_m, y_m = -dy * grid.cell_m;
    int col = static_cast<int>(std::floor(start.col)), row = static_cast<int>(std::floor(start.row));
    const int step_col = dx < 0.0 ? -1 : 1, step_row = dy < 0.0 ? -1 : 1;
    const int last_col = static_cast<int>(std::floor(start.col + dx)),
              last_row = static_cast<int>(std::floor(start.row + dy));
    int cols = std::abs(last_col - col), rows = std::abs(last_row - row);
    // Share of the ray at the next border of columns and of rows, and from one to the next.
    const double per_col = cols > 0 ? 1.0 / std::abs(dx) : kNever, per_row = rows > 0 ? 1.0 / std::abs(dy) : kNever;
    double next_col = cols > 0 ? per_col * std::abs(col + (dx < 0.0 ? 0 : 1) - start.col) : kNever,
           next_row = rows > 0 ? per_row * std::abs(row + (dy < 0.0 ? 0 : 1) - start.row) : kNever;
    double sum_s = 0.0, at = 0.0;
    for (;;) {
        const double next = std::min({next_col, next_row, 1.0});
        if (next > at) {
            if (!grid.contains(row, col)) return kNever;
            sum_s += (next - at) * shapes[grid.index(row, col)].time_s(x_m, y_m);
            if (!(sum_s < kNever)) return kNever;
            at = next;
        }
        if (cols == 0 && rows == 0) return sum_s;
        constexpr double kCorner = 1e-9;
        const bool across = cols > 0 && next_col <= next_row,
                   corner = std::abs(next_col - next_row) < kCorner && cols > 0 && rows > 0;
        if (corner && !burns(grid, shapes, row, col + step_col) && !burns(grid, shapes, row + step_row, col)) return kNever;
        if (across || corner) {
            col += step_col;
            next_col = --cols > 0 ? next_col + per_col : kNever;
        }
        if (!across || corner) {
            row += step_row;
            next_row = --rows > 0 ? next_row + per_row : kNever;
        }
    }
}

}  // namespace pyroscene::spread
