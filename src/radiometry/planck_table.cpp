#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/constants.h"
#include "radiometry/planck.h"
#include "radiometry/response.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kColdest_K = 140.0, kHottest_K = 3200.0;  // a little more than the promised 150 to 3000 K
constexpr int kThermometerNodes = 256;
constexpr double kSmallestRadiance = 1e-30;
constexpr double kInterpolationError = 1.85e-6;  // leaves the rest of 2e-6 to the rounding of the rows

double centroid_um(const Spectrum& response) {
    const double lower = response.lambda_um.front(), upper = response.lambda_um.back();
    const auto m = response_moments(response, lower, upper);
    return 0.5 * (lower + upper) + 0.5 * (upper - lower) * m[1] / m[0];
}

}  // namespace

BandThermometer::BandThermometer(Spectrum response) : response_(std::move(response)) {
    check_response(response_, "band response");
    lambda_um_ = centroid_um(response_);
    const auto mono_K = [&](double T_K) { return brightness_temperature(lambda_um_, band_mean_radiance(T_K, response_)); };
    const double last = std::log(mono_K(kHottest_K));
    first_ = std::log(mono_K(kColdest_K));
    step_ = (last - first_) / (kThermometerNodes - 1);
    for (int i = 0; i < kThermometerNodes; ++i) {
        const double T_mono = std::exp(first_ + i * step_);
        const auto before = [&](int k) { return band_ratio_[static_cast<std::size_t>(i - k)]; };
        const double near = i > 1 ? 2.0 * before(1) - before(2) : 1.0;
        band_ratio_.push_back(band_brightness_temperature(planck_radiance(lambda_um_, T_mono), response_, near * T_mono) /
                              T_mono);
    }
    // Four-point differences: the Hermite curve through them keeps the fourth order of the nodes.
    const int n = kThermometerNodes;
    const auto at = [&](int i) { return band_ratio_[static_cast<std::size_t>(i)]; };
    for (int i = 0; i < n; ++i) {
        if (i >= 2 && i < n - 2)
            slope_.push_back((at(i - 2) - 8.0 * at(i - 1) + 8.0 * at(i + 1) - at(i + 2)) / 12.0);
        else if (i < 2)
            slope_.push_back((-3.0 * at(i) + 4.0 * at(i + 1) - at(i + 2)) / 2.0);
        else
            slope_.push_back((3.0 * at(i) - 4.0 * at(i - 1) + at(i - 2)) / 2.0);
    }
}

double BandThermometer::temperature_K(double radiance_mean) const {
    const double T_mono = brightness_temperature(lambda_um_, radiance_mean);
    const double position = (std::log(T_mono) - first_) / step_;
    if (std::isnan(position)) return std::numeric_limits<double>::quiet_NaN();
    // The outermost intervals have less accurate slopes; they lie outside the promised range.
    if (position < 2.0 || position > kThermometerNodes - 3.0) return band_brightness_temperature(radiance_mean, response_);
    const auto i = static_cast<std::size_t>(position);
    const double f = position - static_cast<double>(i), g = 1.0 - f;
    const double ratio = g * g * ((1.0 + 2.0 * f) * band_ratio_[i] + f * slope_[i]) +
                         f * f * ((1.0 + 2.0 * g) * band_ratio_[i + 1] - g * slope_[i + 1]);
    return T_mono * ratio;
}

PlanckTable::PlanckTable(std::span<const double> lambda_um, double T_min_K, double T_max_K, double step_K)
    : columns_(lambda_um.size()) {
    const double coldest_per_K = 1.0 / T_min_K, hottest_per_K = 1.0 / T_max_K, range = coldest_per_K - hottest_per_K;
    const double shortest_um = lambda_um.empty() ? 1.0 : *std::min_element(lambda_um.begin(), lambda_um.end());
    // Linear interpolation in u errs by du^2 / 8 B''/B = (c2 du / lambda)^2 / 8 (1 + e^-x) / (1 - e^-x)^2, most where it is
    // hot.
    const double e = std::exp(-kC2_um_K / (shortest_um * T_max_K)), curvature = (1.0 + e) / ((1.0 - e) * (1.0 - e));
    const double wanted = step_K > 0.0 ? 1.0 / (T_max_K - step_K) - hottest_per_K
                                       : std::sqrt(8.0 * kInterpolationError / curvature) * shortest_um / kC2_um_K;
    const double intervals = wanted > 0.0 ? std::ceil(range / wanted) : 1.0;
    rows_ = static_cast<int>(std::clamp(intervals, 1.0, kMaximumRows - 1.0)) + 1;
    first_per_K_ = coldest_per_K;
    step_per_K_ = range / (rows_ - 1);
    values_.reserve(static_cast<std::size_t>(rows_) * columns_);
    for (int i = 0; i < rows_; ++i) {
        const double T_K = 1.0 / (first_per_K_ - i * step_per_K_);
        for (const double lambda : lambda_um) {
            const double B = planck_radiance(lambda, T_K);
            values_.push_back(B < kSmallestRadiance ? 0.0F : static_cast<float>(B));
        }
    }
}

void PlanckTable::locate(double T_K, int& i, float& f) const noexcept {
    const double position = (first_per_K_ - 1.0 / T_K) / step_per_K_;
    if (!(T_K > 0.0) || position <= 0.0) {
        i = 0;
        f = 0.0F;
        return;
    }
    i = static_cast<int>(std::min(position, static_cast<double>(rows_ - 2)));
    f = static_cast<float>(std::min(position - i, 1.0));
}

void PlanckTable::evaluate(double T_K, std::span<float> out) const noexcept {
    int i = 0;
    float f = 0.0F;
    locate(T_K, i, f);
    const float* below = row(i);
    const float* above = row(i + 1);
    for (std::size_t l = 0; l < columns_; ++l) out[l] = below[l] + f * (above[l] - below[l]);
}

}  // namespace pyroscene::radiometry
