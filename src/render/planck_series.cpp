#include "render/planck_series.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "radiometry/planck.h"
#include "render/plane_trace.h"

namespace pyroscene::render {
namespace {

constexpr int kSamples = 64;
constexpr double kTolerance = 1e-4;

/// Chebyshev coefficients of one wavelength by the discrete cosine transform.
std::vector<double> coefficients(double lambda_um, double middle_per_K, double half_range_per_K) {
    std::vector<double> c(PlaneTrace::kMaximumMoments + 1, 0.0);
    for (int j = 0; j < kSamples; ++j) {
        const double angle = kPi * (j + 0.5) / kSamples;
        const double B = radiometry::planck_radiance(lambda_um, 1.0 / (middle_per_K + half_range_per_K * std::cos(angle)));
        for (std::size_t m = 0; m < c.size(); ++m)
            c[m] += (m == 0 ? 1.0 : 2.0) / kSamples * B * std::cos(static_cast<double>(m) * angle);
    }
    return c;
}

}  // namespace

PlanckSeries::PlanckSeries(std::span<const double> lambda_um, int stride, double lowest_K, double highest_K)
    : stride_(static_cast<std::size_t>(stride)),
      middle_per_K_(0.5 * (1.0 / lowest_K + 1.0 / highest_K)),
      half_range_per_K_(0.5 * (1.0 / lowest_K - 1.0 / highest_K)) {
    std::vector<std::vector<double>> all;
    for (const double lambda : lambda_um) {
        all.push_back(coefficients(lambda, middle_per_K_, half_range_per_K_));
        if (half_range_per_K_ == 0.0) continue;
        const auto& c = all.back();
        const double hottest = radiometry::planck_radiance(lambda, highest_K);
        double rest = 0.0;
        for (int m = PlaneTrace::kMaximumMoments; m >= moments_; --m) {
            rest += std::abs(c[static_cast<std::size_t>(m)]);
            if (rest > kTolerance * hottest) moments_ = std::max(moments_, std::min(m + 1, PlaneTrace::kMaximumMoments));
        }
    }
    if (half_range_per_K_ > 0.0) moments_ = std::max(moments_, 2);
    values_.assign(static_cast<std::size_t>(moments_) * stride_, 0.0F);
    for (std::size_t l = 0; l < all.size(); ++l) {
        for (int m = 0; m < moments_; ++m) {
            values_[static_cast<std::size_t>(m) * stride_ + l] = static_cast<float>(all[l][static_cast<std::size_t>(m)]);
        }
    }
}

double PlanckSeries::reduced(double temperature_K) const noexcept {
    if (half_range_per_K_ == 0.0) return 0.0;
    return std::clamp((1.0 / temperature_K - middle_per_K_) / half_range_per_K_, -1.0, 1.0);
}

}  // namespace pyroscene::render
