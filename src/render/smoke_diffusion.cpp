#include "render/smoke_diffusion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"

namespace pyroscene::render {
namespace {

struct Optics {
    double ln_k, albedo, asymmetry;
};

/// Smoke's optics along wavelength as a curve, with the length of the way to each point of it.
struct Curve {
    std::vector<std::size_t> order;  ///< ascending wavelength
    std::vector<Optics> point;
    std::vector<double> way;

    [[nodiscard]] Optics at(double s) const {
        const auto high = static_cast<std::size_t>(std::upper_bound(way.begin(), way.end(), s) - way.begin());
        if (high == way.size()) return point.back();
        const Optics &a = point[high - 1], &b = point[high];
        const double f = (s - way[high - 1]) / (way[high] - way[high - 1]);
        return {std::lerp(a.ln_k, b.ln_k, f), std::lerp(a.albedo, b.albedo, f), std::lerp(a.asymmetry, b.asymmetry, f)};
    }
};

Curve curve_of(std::span<const double> lambda_um, std::span<const float> k, std::span<const float> albedo,
               std::span<const float> asymmetry) {
    constexpr double kLeast_per_m = 1e-12;
    Curve curve;
    curve.order.resize(lambda_um.size());
    std::iota(curve.order.begin(), curve.order.end(), std::size_t{0});
    std::stable_sort(curve.order.begin(), curve.order.end(),
                     [&](std::size_t a, std::size_t b) { return lambda_um[a] < lambda_um[b]; });
    for (const std::size_t l : curve.order) {
        const Optics now{std::log(std::max(static_cast<double>(k[l]), kLeast_per_m)), static_cast<double>(albedo[l]),
                         static_cast<double>(asymmetry[l])};
        const double step = curve.point.empty() ? 0.0
                                                : std::abs(now.ln_k - curve.point.back().ln_k) +
                                                      2.0 * std::abs(now.albedo - curve.point.back().albedo) +
                                                      2.0 * std::abs(now.asymmetry - curve.point.back().asymmetry);
        curve.way.push_back(curve.point.empty() ? 0.0 : curve.way.back() + step);
        curve.point.push_back(now);
    }
    return curve;
}

void set_node(DiffusionNodes& d, std::size_t j, const Optics& optics) {
    constexpr double kLeastBoundary = 1e-3;   // conservative scattering by its limit
    constexpr double kLeastResonance = 0.01;  // decay mu0 = 1, where two exponentials are one
    const double k = std::exp(optics.ln_k), w = optics.albedo, g = optics.asymmetry, forward = g * g;
    const double scale = 1.0 - w * forward, ws = (1.0 - forward) * w / scale, gs = g / (1.0 + g), rest = 1.0 - ws * gs;
    double q = std::max(2.0 / 3.0 * std::sqrt(3.0 * (1.0 - ws) / rest), kLeastBoundary);
    const double mu0 = static_cast<double>(d.sun_cosine);
    const double nearness = 1.0 - std::pow(1.5 * q * rest * mu0, 2.0);
    if (std::abs(nearness) < kLeastResonance)
        q = std::sqrt(1.0 - std::copysign(kLeastResonance, nearness)) / (1.5 * rest * mu0);
    const double decay = 1.5 * q * rest;
    d.extinction_per_m[j] = static_cast<float>(k);
    d.beam_per_m[j] = static_cast<float>(scale * k);
    d.decay_per_m[j] = static_cast<float>(decay * scale * k);
    d.boundary[j] = static_cast<float>(q);
    d.slope[j] = static_cast<float>(1.5 * g * q);
    if (!(mu0 > 0.0)) return;
    const double beam = 3.0 * ws * (1.0 + gs * (1.0 - ws)) / (4.0 * kPi) * mu0 * mu0 / (1.0 - decay * decay * mu0 * mu0);
    const double slope = (beam / mu0 - 3.0 * ws * gs * mu0 / (4.0 * kPi)) / rest;
    d.sun_top[j] = static_cast<float>(beam + 2.0 / 3.0 * slope);
    d.sun_bottom[j] = static_cast<float>(beam - 2.0 / 3.0 * slope);
    d.sun_beam[j] = static_cast<float>(beam);
    d.sun_beam_slope[j] = static_cast<float>(g * slope);
}

}  // namespace

SmokeDiffusion make_smoke_diffusion(std::span<const double> lambda_um, std::span<const float> extinction_per_m,
                                    std::span<const float> albedo, std::span<const float> asymmetry, double sun_cosine,
                                    int stride) {
    constexpr int kNodes = DiffusionNodes::kCount;
    constexpr double kLowestSun = 0.02;
    SmokeDiffusion d;
    d.nodes.sun_cosine = sun_cosine > 0.0 ? static_cast<float>(std::max(sun_cosine, kLowestSun)) : 0.0F;
    const Curve curve = curve_of(lambda_um, extinction_per_m, albedo, asymmetry);
    const double step = curve.way.back() / (kNodes - 1);
    for (int j = 0; j < kNodes; ++j) set_node(d.nodes, static_cast<std::size_t>(j), curve.at(j * step));
    d.weight.assign(static_cast<std::size_t>(kNodes) * static_cast<std::size_t>(stride), 0.0F);
    for (std::size_t i = 0; i < curve.order.size(); ++i) {
        const double x = step > 0.0 ? curve.way[i] / step : 0.0;
        const int first = std::clamp(static_cast<int>(x) - 1, 0, kNodes - 4);
        for (int j = first; j < first + 4; ++j) {  // Lagrange's cubic through four nodes
            double weight = 1.0;
            for (int other = first; other < first + 4; ++other)
                if (other != j) weight *= (x - other) / (j - other);
            d.weight[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) + curve.order[i]] =
                static_cast<float>(weight);
        }
    }
    return d;
}

}  // namespace pyroscene::render
