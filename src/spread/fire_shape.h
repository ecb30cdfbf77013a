#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "spread/rothermel.h"

namespace pyroscene::spread {

/// How a fire grows from a point of a cell: an ellipse on the ground with the point in its rear focus. What counts is the time that
/// the fire needs for a displacement v on the map, t(v) = sqrt(v M v) - w v: |v| (1 - e cos angle) / (R (1 - e)) for the rate R of the
/// head and the eccentricity e, lengths measured along the slope.
struct FireShape {
    float m_xx = 0.0F, m_xy = 0.0F, m_yy = 0.0F;  ///< M [s2 m-2], x east, y north; all 0 where nothing burns
    float w_x = 0.0F, w_y = 0.0F;                 ///< w [s m-1]

    [[nodiscard]] bool burns() const noexcept { return m_xx > 0.0F; }

    /// Length of v in the metric M [s].
    [[nodiscard]] double norm(double x_m, double y_m) const noexcept {
        return std::sqrt(m_xx * x_m * x_m + 2.0 * m_xy * x_m * y_m + m_yy * y_m * y_m);
    }
    /// Time for a displacement [s], infinite where nothing burns.
    [[nodiscard]] double time_s(double x_m, double y_m) const noexcept {
        return burns() ? norm(x_m, y_m) - w_x * x_m - w_y * y_m : std::numeric_limits<double>::infinity();
    }
};

/// Shapes of the fire in all cells that hold from one time to the next.
using FireShapes = std::vector<FireShape>;

/// \param head               of the fastest spread (rothermel.h)
/// \param length_to_width    of the ellipse, >= 1
/// \param slope_east, slope_north  of the ground, rise over run
FireShape fire_shape(const HeadFire& head, double length_to_width, double slope_east, double slope_north) noexcept;

/// Slowness of the front (gradient of the arrival time) [s m-1].
struct Slowness {
    float x = 0.0F, y = 0.0F;
};
/// Of a front that came by a displacement v. \pre the shape burns and v is not 0
Slowness slowness(const FireShape& shape, double x_m, double y_m) noexcept;

/// Where on a line the fire starts that reaches a place first: the share s of the line, between its ends, with the least
/// of step s + t(v + s d). NaN when an end is the best start.
/// \param x_m, y_m    displacement v from the first end to the place
/// \param dx_m, dy_m  how the displacement changes along the line, d
/// \param step_s      how much later the other end burns
double earliest_share(const FireShape& shape, double x_m, double y_m, double dx_m, double dy_m, double step_s) noexcept;

/// Rate of spread normal to the front, along the slope [m s-1].
double normal_rate_m_s(const Slowness& slowness, double slope_east, double slope_north) noexcept;

}  // namespace pyroscene::spread
