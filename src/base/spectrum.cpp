#include "base/spectrum.h"

#include <algorithm>
#include <cstddef>

namespace pyroscene {

double Spectrum::at(double wavelength_um, bool clamp) const noexcept {
    if (lambda_um.empty()) return 0.0;
    if (wavelength_um < lambda_um.front()) return clamp ? value.front() : 0.0;
    if (wavelength_um > lambda_um.back()) return clamp ? value.back() : 0.0;
    const auto upper = std::lower_bound(lambda_um.begin(), lambda_um.end(), wavelength_um);
    const auto i = static_cast<std::size_t>(upper - lambda_um.begin());
    if (i == 0 || *upper == wavelength_um) return value[i];
    const double f = (wavelength_um - lambda_um[i - 1]) / (lambda_um[i] - lambda_um[i - 1]);
    return value[i - 1] + f * (value[i] - value[i - 1]);
}

double mean_over(const Spectrum& s, double lower_um, double upper_um) noexcept {
    // Break the interval at the samples inside it; each piece is a straight line, so the trapezoid is exact.
    double sum = 0.0, x0 = lower_um, y0 = s.at(lower_um);
    auto next = std::upper_bound(s.lambda_um.begin(), s.lambda_um.end(), lower_um);
    for (; next != s.lambda_um.end() && *next < upper_um; ++next) {
        const double y1 = s.value[static_cast<std::size_t>(next - s.lambda_um.begin())];
        sum += 0.5 * (y0 + y1) * (*next - x0);
        x0 = *next;
        y0 = y1;
    }
    sum += 0.5 * (y0 + s.at(upper_um)) * (upper_um - x0);
    return sum / (upper_um - lower_um);
}

}  // namespace pyroscene
