#pragma once

#include <cmath>

#include "spread/straight_ray.h"

namespace pyroscene::spread {

/// A way of the fire over many cells: a parabola over the chord from a start to an end.
struct CurvedRay {
    Position start;
    double dx = 0.0, dy = 0.0;  ///< chord, in columns and rows
    double bend =
        0.0;  ///< curvature in the middle [1 / cell], > 0 when it lies to the right of the chord (rows count southwards); 0 = straight

    [[nodiscard]] double length() const noexcept { return std::hypot(dx, dy); }
    /// Place at a share of the chord.
    [[nodiscard]] Position at(double share) const noexcept;
    /// The part from the start to the middle, which is a parabola too.
    [[nodiscard]] CurvedRay first_half() const noexcept;
    /// Direction at the end, in columns and rows; of the chord's length and more.
    [[nodiscard]] Position direction_at_end() const noexcept;
};

/// Time that a fire needs along it [s], by straight pieces of at least 4 cells, at most 8 (see straight_ray_s).
double curved_ray_s(const MapGrid& grid, const FireShapes& shapes, const CurvedRay& ray) noexcept;

}  // namespace pyroscene::spread
