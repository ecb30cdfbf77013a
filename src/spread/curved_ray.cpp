#include "spread/curved_ray.h"

#include <algorithm>
#include <limits>

namespace pyroscene::spread {

Position CurvedRay::at(double share) const noexcept {
    const double aside = 0.5 * bend * length() * share * (1.0 - share);
    return {start.col + share * dx - aside * dy, start.row + share * dy + aside * dx};
}

CurvedRay CurvedRay::first_half() const noexcept {
    const auto middle = at(0.5);
    CurvedRay half{start, middle.col - start.col, middle.row - start.row, 0.0};
    // A quarter of the sagitta, which is bend length2 / 8.
    half.bend = 0.25 * bend * (dx * dx + dy * dy) / (half.dx * half.dx + half.dy * half.dy);
    return half;
}

Position CurvedRay::direction_at_end() const noexcept {
    const double turn = 0.5 * bend * length();
    return {dx + turn * dy, dy - turn * dx};
}

double curved_ray_s(const MapGrid& grid, const FireShapes& shapes, const CurvedRay& ray) noexcept {
    if (ray.bend == 0.0) return straight_ray_s(grid, shapes, ray.start, ray.dx, ray.dy);
    const int pieces = std::clamp(static_cast<int>(ray.length() / 4.0), 2, 8);
    double sum_s = 0.0;
    Position from = ray.start;
    for (int i = 1; i <= pieces && sum_s < std::numeric_limits<double>::infinity(); ++i) {
        const auto to = ray.at(static_cast<double>(i) / pieces);
        sum_s += straight_ray_s(grid, shapes, from, to.col - from.col, to.row - from.row);
        from = to;
    }
    return sum_s;
}

}  // namespace pyroscene::spread
