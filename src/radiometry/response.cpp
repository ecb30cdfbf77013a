#include "radiometry/response.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::radiometry {

void check_response(const Spectrum& response, std::string_view subject) {
    const auto& x = response.lambda_um;
    const auto& y = response.value;
    if (x.size() != y.size())
        throw input_error(subject, fmt::format("{} wavelengths but {} response values", x.size(), y.size()));
    if (x.size() < 2) throw input_error(subject, fmt::format("the response has {} points, expected at least 2", x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(x[i]) || x[i] <= 0.0)
            throw input_error(subject, fmt::format("wavelength {} um of point {}, expected a positive number", x[i], i + 1));
        if (i > 0 && x[i] < x[i - 1])
            throw input_error(subject,
                              fmt::format("wavelengths descend from {} to {} um, expected ascending", x[i - 1], x[i]));
        if (!std::isfinite(y[i]) || y[i] < 0.0)
            throw input_error(subject, fmt::format("response {} at {} um, expected 0 or more", y[i], x[i]));
    }
    if (!(response_area_um(response) > 0.0)) throw input_error(subject, "the response is zero everywhere");
}

double response_area_um(const Spectrum& response) noexcept {
    double area = 0.0;
    for (std::size_t i = 1; i < response.lambda_um.size(); ++i)
        area += 0.5 * (response.value[i - 1] + response.value[i]) * (response.lambda_um[i] - response.lambda_um[i - 1]);
    return area;
}

std::array<double, 4> response_moments(const Spectrum& response, double lower_um, double upper_um) noexcept {
    const double centre = 0.5 * (lower_um + upper_um), half = 0.5 * (upper_um - lower_um);
    std::array<double, 4> m{};
    const auto& x = response.lambda_um;
    const auto first = std::upper_bound(x.begin(), x.end(), lower_um);
    for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first - x.begin(), 1)); i < x.size(); ++i) {
        if (x[i - 1] >= upper_um) break;
        if (x[i] <= x[i - 1]) continue;  // vertical edge
        const double slope = (response.value[i] - response.value[i - 1]) / (x[i] - x[i - 1]);
        const double l0 = std::max(x[i - 1], lower_um), l1 = std::min(x[i], upper_um);
        const double r0 = response.value[i - 1] + slope * (l0 - x[i - 1]),
                     r1 = response.value[i - 1] + slope * (l1 - x[i - 1]);
        const double u0 = (l0 - centre) / half, u1 = (l1 - centre) / half, mid = 0.5 * (u0 + u1), h = 0.5 * (u1 - u0);
        // R(v) u^k with u = mid + h v, v in [-1, 1], R = mean + tilt v; odd powers of v integrate to zero.
        const double mean = 0.5 * (r0 + r1), tilt = 0.5 * (r1 - r0), v2 = 1.0 / 3.0, v4 = 0.2, width = l1 - l0;
        m[0] += width * mean;
        m[1] += width * (mean * mid + tilt * h * v2);
        m[2] += width * (mean * (mid * mid + h * h * v2) + 2.0 * tilt * mid * h * v2);
        m[3] += width * (mean * mid * (mid * mid + 3.0 * h * h * v2) + tilt * h * (3.0 * mid * mid * v2 + h * h * v4));
    }
    return m;
}

Spectrum clip_response(const Spectrum& response, double lower_um, double upper_um) {
    const auto& x = response.lambda_um;
    const auto& y = response.value;
    const auto interpolate = [&](std::size_t i, double at_um) {
        return y[i] + (y[i + 1] - y[i]) * (at_um - x[i]) / (x[i + 1] - x[i]);
    };
    const auto index = [&](auto iterator) { return static_cast<std::size_t>(iterator - x.begin()); };
    const std::size_t after_lower = index(std::upper_bound(x.begin(), x.end(), lower_um));
    const std::size_t not_below_upper = index(std::lower_bound(x.begin(), x.end(), upper_um));
    Spectrum part{response.kind, {lower_um}, {}};
    part.value.push_back(x[after_lower - 1] == lower_um ? y[after_lower - 1] : interpolate(after_lower - 1, lower_um));
    for (std::size_t i = after_lower; i < not_below_upper; ++i) {
        part.lambda_um.push_back(x[i]);
        part.value.push_back(y[i]);
    }
    part.lambda_um.push_back(upper_um);
    part.value.push_back(x[not_below_upper] == upper_um ? y[not_below_upper] : interpolate(not_below_upper - 1, upper_um));
    return part;
}

}  // namespace pyroscene::radiometry
