#include "spread/fire_shape.h"

#include <algorithm>

namespace pyroscene::spread {

FireShape fire_shape(const HeadFire& head, double length_to_width, double slope_east, double slope_north) noexcept {
    if (!(head.rate_m_s > 0.0)) return {};
    const double e = std::sqrt(length_to_width * length_to_width - 1.0) / length_to_width;
    const double s = 1.0 / (head.rate_m_s * (1.0 - e));
    // Straight up the slope on the map; lengths that way are longer on the ground.
    const double tangent = std::hypot(slope_east, slope_north), stretch = std::sqrt(1.0 + tangent * tangent);
    const double up_x = tangent > 0.0 ? slope_east / tangent : 0.0, up_y = tangent > 0.0 ? slope_north / tangent : 1.0;
    const double along = stretch * std::cos(head.from_upslope_rad), across = std::sin(head.from_upslope_rad);
    return {.m_xx = static_cast<float>(s * s * (1.0 + slope_east * slope_east)),
            .m_xy = static_cast<float>(s * s * slope_east * slope_north),
            .m_yy = static_cast<float>(s * s * (1.0 + slope_north * slope_north)),
            .w_x = static_cast<float>(s * e * (along * up_x + across * up_y)),
            .w_y = static_cast<float>(s * e * (along * up_y - across * up_x))};
}

Slowness slowness(const FireShape& shape, double x_m, double y_m) noexcept {
    const double norm = shape.norm(x_m, y_m);
    return {static_cast<float>((shape.m_xx * x_m + shape.m_xy * y_m) / norm - shape.w_x),
            static_cast<float>((shape.m_xy * x_m + shape.m_yy * y_m) / norm - shape.w_y)};
}

double earliest_share(const FireShape& shape, double x, double y, double dx, double dy, double step_s) noexcept {
    // The least of sqrt(a s2 + 2 b s + c) + d s.
    const double a = shape.m_xx * dx * dx + 2.0 * shape.m_xy * dx * dy + shape.m_yy * dy * dy;
    const double b = (shape.m_xx * dx + shape.m_xy * dy) * x + (shape.m_xy * dx + shape.m_yy * dy) * y;
    const double c = shape.m_xx * x * x + 2.0 * shape.m_xy * x * y + shape.m_yy * y * y;
    const double d = step_s - shape.w_x * dx - shape.w_y * dy;
    // The derivative is negative at one end and positive at the other, or the least is an end.
    if (!(d * std::sqrt(c) + b < 0.0) || !(d * std::sqrt(a + 2.0 * b + c) + a + b > 0.0) || !(d * d < a))
        return std::numeric_limits<double>::quiet_NaN();
    return -d * std::sqrt(std::max(0.0, a * c - b * b)) / (a * std::sqrt(a - d * d)) - b / a;
}

double normal_rate_m_s(const Slowness& p, double slope_east, double slope_north) noexcept {
    const double up = p.x * slope_east + p.y * slope_north;
    const double squared = p.x * p.x + p.y * p.y - up * up / (1.0 + slope_east * slope_east + slope_north * slope_north);
    return squared > 0.0 ? 1.0 / std::sqrt(squared) : 0.0;
}

}  // namespace pyroscene::spread
