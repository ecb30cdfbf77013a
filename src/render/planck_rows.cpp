#include "render/planck_rows.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::render {
namespace {

constexpr double kColdest_K = 50.0;
constexpr double kResolution = 0.08;  // c2 d(1/T) / shortest wavelength between nodes; the error grows with its 4th power
constexpr double kLeastRadiance = 1e-20;       // keeps denormal numbers out of the loops
constexpr double kLargestRelativeStep = 0.03;  // of 1/T: bounds the error where B grows like T, at long wavelengths

float stored(double radiance) { return radiance < kLeastRadiance ? 0.0F : static_cast<float>(radiance); }

}  // namespace

PlanckRows::PlanckRows(std::span<const double> lambda_um, int stride, double lowest_K, double highest_K,
                       std::span<const double> exact_K)
    : stride_(static_cast<std::size_t>(stride)),
      lowest_K_(std::max(lowest_K, kColdest_K)),
      highest_K_(std::max(highest_K, lowest_K_)),
      exact_K_(exact_K.begin(), exact_K.end()) {
    if (highest_K_ > lowest_K_ && !lambda_um.empty()) {
        const double shortest_um = *std::min_element(lambda_um.begin(), lambda_um.end());
        const double step_per_K = std::min(kResolution * shortest_um / kC2_um_K, kLargestRelativeStep / highest_K_);
        const double range_per_K = 1.0 / lowest_K_ - 1.0 / highest_K_;
        nodes_ = static_cast<int>(std::ceil(range_per_K / step_per_K)) + 4;  // one beyond either end, for the cubic
        nodes_per_K_ = 1.0 / step_per_K;
        first_per_K_ = 1.0 / highest_K_ - step_per_K;
    }
    values_.reserve(stride_ * (static_cast<std::size_t>(nodes_) + exact_K_.size()));
    if (nodes_ > 0) add_nodes(lambda_um);
    for (const double T_K : exact_K_) {
        for (const double lambda : lambda_um) values_.push_back(stored(radiometry::planck_radiance(lambda, T_K)));
        values_.resize(values_.size() + stride_ - lambda_um.size(), 0.0F);
    }
    rows_ = nodes_ + static_cast<int>(exact_K_.size());
}

/// Nodes are even in 1/T, so exp(c2 / (lambda T)) grows from row to row by a constant factor per wavelength: one multiplication
/// instead of an exponential. Rounding adds up to 1e-13 over a thousand rows.
void PlanckRows::add_nodes(std::span<const double> lambda_um) {
    std::vector<double> exponential, factor, scale;
    for (const double lambda : lambda_um) {
        exponential.push_back(std::exp(kC2_um_K * first_per_K_ / lambda));
        factor.push_back(std::exp(kC2_um_K / (nodes_per_K_ * lambda)));
        scale.push_back(kC1L_W_um4_m2_sr / std::pow(lambda, 5));
    }
    for (int i = 0; i < nodes_; ++i) {
        for (std::size_t l = 0; l < lambda_um.size(); ++l) {
            values_.push_back(stored(scale[l] / (exponential[l] - 1.0)));
            exponential[l] *= factor[l];
        }
        values_.resize(values_.size() + stride_ - lambda_um.size(), 0.0F);
    }
}

PlanckRows::Lookup PlanckRows::at(double temperature_K) const noexcept {
    Lookup found;
    for (std::size_t i = 0; i < exact_K_.size(); ++i) {
        if (temperature_K == exact_K_[i]) {
            found.row = nodes_ + static_cast<int>(i);
            return found;
        }
    }
    if (nodes_ == 0) return found;
    const double T_K = std::clamp(temperature_K, lowest_K_, highest_K_);
    const double position = (1.0 / T_K - first_per_K_) * nodes_per_K_;  // >= 1
    const int i = std::clamp(static_cast<int>(position), 1, nodes_ - 3);
    const auto f = static_cast<float>(position - i), g = 1.0F - f;
    found.row = i - 1;
    found.count = 4;  // Lagrange's cubic through nodes -1, 0, 1, 2
    found.weight = {-f * g * (1.0F + g) / 6.0F, g * (1.0F + f) * (1.0F + g) / 2.0F, f * (1.0F + f) * (1.0F + g) / 2.0F,
                    -f * g * (1.0F + f) / 6.0F};
    return found;
}

}  // namespace pyroscene::render
