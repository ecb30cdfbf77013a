#include "render/absorption_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "render/plane_trace.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {
namespace {

constexpr double kNodeRatio = 1.4, kNodeRatioOfMixtures = 1.55;
constexpr double kLeastShareOfMixtures = 1e-5, kMostOfMixtures_per_m = 100.0;  ///< opaque within a voxel
constexpr double kLeastShare = 1e-3;  ///< of the largest k: fainter flame than this gives no light worth tracing

}  // namespace

AbsorptionNodes::AbsorptionNodes(std::span<const float> absorption_per_m)
    : stride_(padded(static_cast<int>(absorption_per_m.size()))) {
    const double highest = std::max(*std::max_element(absorption_per_m.begin(), absorption_per_m.end()), 1e-12F);
    const double lowest = std::max(static_cast<double>(*std::min_element(absorption_per_m.begin(), absorption_per_m.end())),
                                   kLeastShare * highest);
    make_nodes(lowest, highest, kNodeRatio);
    for (std::size_t l = 0; l < absorption_per_m.size(); ++l) add(l, static_cast<double>(absorption_per_m[l]), 1.0);
}

AbsorptionNodes::AbsorptionNodes(std::span<const std::vector<radiometry::AbsorptionPart>> mixes)
    : stride_(padded(static_cast<int>(mixes.size()))) {
    double highest = 1e-12, lowest = std::numeric_limits<double>::infinity();
    for (const auto& mix : mixes) {
        for (const auto& part : mix) {
            highest = std::max(highest, part.k_per_m);
            lowest = std::min(lowest, part.k_per_m);
        }
    }
    highest = std::min(highest, std::max(kMostOfMixtures_per_m, lowest));
    make_nodes(std::max(lowest, kLeastShareOfMixtures * highest), highest, kNodeRatioOfMixtures);
    for (std::size_t l = 0; l < mixes.size(); ++l)
        for (const auto& part : mixes[l]) add(l, part.k_per_m, part.weight);
}

void AbsorptionNodes::make_nodes(double lowest_per_m, double highest_per_m, double ratio) {
    if (highest_per_m / lowest_per_m < 1.0 + 1e-6) {
        k_per_m_.assign(1, static_cast<float>(highest_per_m));
    } else {
        const int nodes =
            std::max(4, static_cast<int>(std::ceil(std::log(highest_per_m / lowest_per_m) / std::log(ratio))) + 1);
        lowest_per_m_ = lowest_per_m;
        step_ = std::log(highest_per_m / lowest_per_m) / (nodes - 1);
        highest_per_m_ = highest_per_m;
        for (int i = 0; i < nodes; ++i) k_per_m_.push_back(static_cast<float>(lowest_per_m * std::exp(step_ * i)));
    }
    weight_.assign(k_per_m_.size() * static_cast<std::size_t>(stride_), 0.0F);
}

void AbsorptionNodes::add(std::size_t l, double k_per_m, double share) {
    const auto stride = static_cast<std::size_t>(stride_);
    if (count() == 1) {
        weight_[l] = 1.0F;
        return;
    }
    const Place at = place(k_per_m);
    for (std::size_t i = 0; i < 4; ++i)
        weight_[(static_cast<std::size_t>(at.first) + i) * stride + l] += static_cast<float>(share) * at.weight[i];
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

void AbsorptionNodes::interpolate(const float* at_nodes, int spacing, float* out) const noexcept {
    std::array<float, PlaneTrace::kMaximumNodes> value{};
    for (std::size_t i = 0; i < k_per_m_.size(); ++i) value[i] = at_nodes[static_cast<std::ptrdiff_t>(i) * spacing];
    std::fill(out, out + stride_, 0.0F);
    spectral_kernels().add_rows(stride_, weight_.data(), stride_, count(), value.data(), out);
}

}  // namespace pyroscene::render
