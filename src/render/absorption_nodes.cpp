#include "render/absorption_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pyroscene::render {
namespace {

constexpr double kNodeRatio = 1.4;
constexpr double kLeastShare = 1e-3;  ///< of the largest k: fainter flame than this gives no light worth tracing

}  // namespace

AbsorptionNodes::AbsorptionNodes(std::span<const float> absorption_per_m) : places_(absorption_per_m.size()) {
    const double highest = std::max(*std::max_element(absorption_per_m.begin(), absorption_per_m.end()), 1e-12F);
    const double lowest = std::max(static_cast<double>(*std::min_element(absorption_per_m.begin(), absorption_per_m.end())),
                                   kLeastShare * highest);
    if (highest / lowest < 1.0 + 1e-6) {
        k_per_m_.assign(1, static_cast<float>(highest));
        return;
    }
    const int nodes = std::max(4, static_cast<int>(std::ceil(std::log(highest / lowest) / std::log(kNodeRatio))) + 1);
    const double step = std::log(highest / lowest) / (nodes - 1);
    for (int i = 0; i < nodes; ++i) k_per_m_.push_back(static_cast<float>(lowest * std::exp(step * i)));
    for (std::size_t l = 0; l < places_.size(); ++l) {
        const double k = std::clamp(static_cast<double>(absorption_per_m[l]), lowest, highest);
        const double position = std::log(k / lowest) / step;
        const int first = std::clamp(static_cast<int>(position) - 1, 0, nodes - 4);
        const double x = position - first;  // Lagrange's cubic through 0, 1, 2, 3
        Place& place = places_[l];
        place.first = first;
        place.weight[0] = static_cast<float>(-(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0);
        place.weight[1] = static_cast<float>(x * (x - 2.0) * (x - 3.0) / 2.0);
        place.weight[2] = static_cast<float>(-x * (x - 1.0) * (x - 3.0) / 2.0);
        place.weight[3] = static_cast<float>(x * (x - 1.0) * (x - 2.0) / 6.0);
        // Fainter than the first node: light in proportion to k.
        for (float& w : place.weight) w *= static_cast<float>(std::min(1.0, absorption_per_m[l] / lowest));
    }
}

void AbsorptionNodes::interpolate(const float* at_nodes, int spacing, std::span<float> out) const noexcept {
    if (count() == 1) {
        std::fill(out.begin(), out.end(), at_nodes[0]);
        return;
    }
    for (std::size_t l = 0; l < places_.size(); ++l) {
        const Place& p = places_[l];
        const float* v = at_nodes + static_cast<std::ptrdiff_t>(p.first) * spacing;
        out[l] = p.weight[0] * v[0] + p.weight[1] * v[spacing] + p.weight[2] * v[2 * spacing] + p.weight[3] * v[3 * spacing];
    }
}

}  // namespace pyroscene::render
