#include "render/absorption_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pyroscene::render {
namespace {

constexpr double kNodeRatio = 1.4, kNodeRatioOfMixtures = 1.55;
constexpr double kLeastShareOfMixtures = 1e-5, kMostOfMixtures_per_m = 100.0;  ///< opaque within a voxel
constexpr double kLeastShare = 1e-3;  ///< of the largest k: fainter flame than this gives no light worth tracing

}  // namespace

AbsorptionNodes::AbsorptionNodes(std::span<const float> absorption_per_m) : lambdas_(absorption_per_m.size()) {
    const double highest = std::max(*std::max_element(absorption_per_m.begin(), absorption_per_m.end()), 1e-12F);
    const double lowest = std::max(static_cast<double>(*std::min_element(absorption_per_m.begin(), absorption_per_m.end())),
                                   kLeastShare * highest);
    if (!make_nodes(lowest, highest, kNodeRatio)) return;
    for (const float k : absorption_per_m) places_.push_back(place(static_cast<double>(k)));
}

AbsorptionNodes::AbsorptionNodes(std::span<const std::vector<radiometry::AbsorptionPart>> mixes) : lambdas_(mixes.size()) {
    double highest = 1e-12, lowest = std::numeric_limits<double>::infinity();
    for (const auto& mix : mixes) {
        for (const auto& part : mix) {
            highest = std::max(highest, part.k_per_m);
            lowest = std::min(lowest, part.k_per_m);
        }
    }
    highest = std::min(highest, std::max(kMostOfMixtures_per_m, lowest));
    if (!make_nodes(std::max(lowest, kLeastShareOfMixtures * highest), highest, kNodeRatioOfMixtures)) return;
    mix_weight_.resize(mixes.size() * k_per_m_.size());
    for (std::size_t l = 0; l < mixes.size(); ++l) {
        for (const auto& part : mixes[l]) {
            const Place at = place(part.k_per_m);
            float* weight = mix_weight_.data() + l * k_per_m_.size() + at.first;
            for (std::size_t i = 0; i < 4; ++i) weight[i] += static_cast<float>(part.weight) * at.weight[i];
        }
    }
}

bool AbsorptionNodes::make_nodes(double lowest_per_m, double highest_per_m, double ratio) {
    if (highest_per_m / lowest_per_m < 1.0 + 1e-6) {
        k_per_m_.assign(1, static_cast<float>(highest_per_m));
        return false;
    }
    const int nodes = std::max(4, static_cast<int>(std::ceil(std::log(highest_per_m / lowest_per_m) / std::log(ratio))) + 1);
    lowest_per_m_ = lowest_per_m;
    step_ = std::log(highest_per_m / lowest_per_m) / (nodes - 1);
    highest_per_m_ = highest_per_m;
    for (int i = 0; i < nodes; ++i) k_per_m_.push_back(static_cast<float>(lowest_per_m * std::exp(step_ * i)));
    return true;
}

AbsorptionNodes::Place AbsorptionNodes::place(double k_per_m) const noexcept {
    const double position = std::log(std::clamp(k_per_m, lowest_per_m_, highest_per_m_) / lowest_per_m_) / step_;
    Place found;
    found.first = std::clamp(static_cast<int>(position) - 1, 0, count() - 4);
    const double x = position - found.first;  // Lagrange's cubic through 0, 1, 2, 3
    found.weight[0] = static_cast<float>(-(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0);
    found.weight[1] = static_cast<float>(x * (x - 2.0) * (x - 3.0) / 2.0);
    found.weight[2] = static_cast<float>(-x * (x - 1.0) * (x - 3.0) / 2.0);
    found.weight[3] = static_cast<float>(x * (x - 1.0) * (x - 2.0) / 6.0);
    // Fainter than the first node: light in proportion to k.
    for (float& w : found.weight) w *= static_cast<float>(std::min(1.0, k_per_m / lowest_per_m_));
    return found;
}

void AbsorptionNodes::interpolate(const float* at_nodes, int spacing, std::span<float> out) const noexcept {
    if (count() == 1) {
        std::fill(out.begin(), out.end(), at_nodes[0]);
        return;
    }
    if (!mix_weight_.empty()) {
        for (std::size_t l = 0; l < lambdas_; ++l) {
            const float* weight = mix_weight_.data() + l * k_per_m_.size();
            float sum = 0.0F;
            for (std::size_t i = 0; i < k_per_m_.size(); ++i)
                sum += weight[i] * at_nodes[static_cast<std::ptrdiff_t>(i) * spacing];
            out[l] = sum;
        }
        return;
    }
    for (std::size_t l = 0; l < places_.size(); ++l) {
        const Place& p = places_[l];
        const float* v = at_nodes + static_cast<std::ptrdiff_t>(p.first) * spacing;
        out[l] = p.weight[0] * v[0] + p.weight[1] * v[spacing] + p.weight[2] * v[2 * spacing] + p.weight[3] * v[3 * spacing];
    }
}

}  // namespace pyroscene::render
