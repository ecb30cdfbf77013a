#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

/// Walking straight lines through regular lattices (Amanatides & Woo 1987), shared by the march and the ground light.
namespace pyroscene::render {

/// Marching along one axis of a lattice: which cell the ray is in and where it leaves it. Positions are ray parameters in
/// [0, 1]; every crossing is computed from the cell's index, never summed up, so that lengths telescope exactly.
struct AxisWalk {
    double origin, rate, inverse;  ///< in cells; rate per whole ray
    int cell = 0, step = 0;

    AxisWalk(double from, double to) noexcept
        : origin(from),
          rate(to - from),
          inverse(rate != 0.0 ? 1.0 / rate : 0.0),
          step(rate > 0.0   ? 1
               : rate < 0.0 ? -1
                            : 0) {}

    /// Cuts [begin, end] to where lower <= position <= upper.
    void clip(double lower, double upper, double& begin, double& end) const noexcept {
        if (step == 0) {
            if (origin < lower || origin >= upper) end = -1.0;
            return;
        }
        const double a = (lower - origin) * inverse, b = (upper - origin) * inverse;
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    void enter(double at, double cell_size, int lowest, int highest) noexcept {
        cell = std::clamp(static_cast<int>(std::floor((origin + rate * at) / cell_size)), lowest, highest);
    }
    [[nodiscard]] double leaves(double cell_size) const noexcept {
        if (step == 0) return std::numeric_limits<double>::infinity();
        return ((cell + (step > 0 ? 1 : 0)) * cell_size - origin) * inverse;
    }
};

/// Cells [first, end) of a lattice in the plane.
struct CellBox {
    int first_i, first_j, end_i, end_j;
};

/// Calls visit(i, j, from, to) for the cells of edge `cell_size` (in the units of the walks) that the ray crosses between ray
/// parameters `begin` and `end`, in order, until `visit` returns false or the ray leaves the box. Returns false if asked to stop.
template <class Visit>
bool walk_cells(AxisWalk x, AxisWalk y, double begin, double end, double cell_size, CellBox box, Visit&& visit) {
    x.enter(begin, cell_size, box.first_i, box.end_i - 1);
    y.enter(begin, cell_size, box.first_j, box.end_j - 1);
    double next_x = x.leaves(cell_size), next_y = y.leaves(cell_size);
    for (double at = begin; at < end;) {
        const double next = std::min(next_x, next_y), until = std::min(next, end);
        if (until > at && !visit(x.cell, y.cell, at, until)) return false;
        if (next == next_x) {
            x.cell += x.step;
            if (x.cell < box.first_i || x.cell >= box.end_i) return true;
            next_x = x.leaves(cell_size);
        } else {
            y.cell += y.step;
            if (y.cell < box.first_j || y.cell >= box.end_j) return true;
            next_y = y.leaves(cell_size);
        }
        at = std::max(at, until);
    }
    return true;
}

}  // namespace pyroscene::render
