#pragma once

#include "base/map_grid.h"
#include "spread/fire_shape.h"

namespace pyroscene::spread {

/// Continuous column and row of a grid; cell centres at + 0.5.
struct Position {
    double col = 0.0, row = 0.0;
};

/// Time that a fire needs along a straight ray [s]: each cell that the ray crosses takes its part, exactly. Infinite when one carries no fire,
/// when the ray passes the corner between two that do not, and when it leaves the grid.
/// \param dx, dy  to the end of the ray, in columns and rows
double straight_ray_s(const MapGrid& grid, const FireShapes& shapes, Position start, double dx, double dy) noexcept;

}  // namespace pyroscene::spread
