#include "render/planck_rows.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::render {
namespace {

constexpr double kColdest_K = 50.0;
constexpr double kLeastRadiance = 1e-20;       // keeps denormal numbers out of the loops
constexpr double kLargestRelativeStep = 0.03;  // of 1/T: bounds the error where B grows like T, at long wavelengths

}  // namespace

PlanckRows::PlanckRows(std::span<const double> lambda_um, int stride, double lowest_K, double highest_K,
                       std::span<const double> exact_K, double resolution)
    : stride_(static_cast<std::size_t>(stride)),
      lowest_K_(std::max(lowest_K, kColdest_K)),
      highest_K_(std::max(highest_K, lowest_K_)),
      exact_K_(exact_K.begin(), exact_K.end()) {
    if (highest_K_ > lowest_K_ && !lambda_um.empty()) {
        const double shortest_um = *std::min_element(lambda_um.begin(), lambda_um.end());
        const double step_per_K = std::min(resolution * shortest_um / kC2_um_K, kLargestRelativeStep / highest_K_);
        const double range_per_K = 1.0 / lowest_K_ - 1.0 / highest_K_;
        nodes_ = static_cast<int>(std::ceil(range_per_K / step_per_K)) + 4;  // one beyond either end, for the cubic
        nodes_per_K_ = 1.0 / step_per_K;
        first_per_K_ = 1.0 / highest_K_ - step_per_K;
    }
    values_.reserve(stride_ * (static_cast<std::size_t>(nodes_) + exact_K_.size()));
    for (int i = 0; i < nodes_; ++i) add_row(lambda_um, 1.0 / (first_per_K_ + i / nodes_per_K_));
    for (const double T_K : exact_K_) add_row(lambda_um, T_K);
}

void PlanckRows::add_row(std::span<const double> lambda_um, double temperature_K) {
    for (const double lambda : lambda_um) {
        const double B = radiometry::planck_radiance(lambda, temperature_K);
        values_.push_back(B < kLeastRadiance ? 0.0F : static_cast<float>(B));
    }
    values_.resize(values_.size() + stride_ - lambda_um.size(), 0.0F);
    ++rows_;
}

PlanckRows::Lookup PlanckRows::at(double temperature_K) const noexcept {
    Lookup found;
    for (std::size_t i = 0; i < exact_K_.size(); ++i) {
        if (temperature_K == exact_K_[i]) {
            found.row = nodes_ + static_cast<int>(i);
            return found;
        }
    }
    return at_position(position_of(temperature_K));
}

double PlanckRows::position_of(double temperature_K) const noexcept {
    if (nodes_ == 0) return 0.0;
    return (1.0 / std::clamp(temperature_K, lowest_K_, highest_K_) - first_per_K_) * nodes_per_K_;  // >= 1
}

PlanckRows::Lookup PlanckRows::at_position(double position) const noexcept {
    Lookup found;
    if (nodes_ == 0) return found;
    const int i = std::clamp(static_cast<int>(position), 1, nodes_ - 3);
    const auto f = static_cast<float>(position - i), g = 1.0F - f;
    found.row = i - 1;
    found.count = 4;  // Lagrange's cubic through nodes -1, 0, 1, 2
    found.weight = {-f * g * (1.0F + g) / 6.0F, g * (1.0F + f) * (1.0F + g) / 2.0F, f * (1.0F + f) * (1.0F + g) / 2.0F,
                    -f * g * (1.0F + f) / 6.0F};
    return found;
}

}  // namespace pyroscene::render
