#include "radiometry/view_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace pyroscene::radiometry {

namespace {

/// exp(x) for x in [-6, 0] within 5e-4 (2e-6 above -3) as (Taylor's series of x / 8 to the sixth power)^8: compilers vectorise it.
float exp_of_step(float x) noexcept {
    const float y = 0.125F * x;
    const float root =
        1.0F +
        y * (1.0F + y * (0.5F + y * (1.66666667e-1F + y * (4.16666667e-2F + y * (8.33333333e-3F + y * 1.38888889e-3F)))));
    const float square = root * root, fourth = square * square;
    return fourth * fourth;
}

/// Where a value lies on a sorted axis: between `first` and the node `step` (0 or 1) after it.
struct Between {
    std::size_t first = 0, step = 0;
    double fraction = 0.0;
};
template <class Before>
Between between(const std::vector<double>& axis, double value, Before before) {
    if (axis.size() < 2) return {};
    const auto after = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), value, before) - axis.begin());
    const std::size_t first = std::clamp<std::size_t>(after, 1, axis.size() - 1) - 1;
    const double fraction = (value - axis[first]) / (axis[first + 1] - axis[first]);
    return {first, 1, fraction > 0.0 ? std::min(fraction, 1.0) : 0.0};
}

}  // namespace

void ViewAtmosphere::View::resize(int n) {
    const auto size = static_cast<std::size_t>(n);
    for (auto* array : {&transmittance, &path_thermal, &path_solar, &solar_correlation, &adjacency}) array->resize(size);
}

void ViewAtmosphere::at(double view_zenith_rad, double relative_azimuth_rad, double ground_m, View& out) const noexcept {
    const std::size_t count = static_cast<std::size_t>(lambda_count());
    const double cosine = std::cos(view_zenith_rad);
    const double secant =
        cosine > 1.0 / node_secant.back() ? 1.0 / cosine : node_secant.back();  // NaN and horizon: last node
    const Between view = between(node_secant, secant, std::less<>()), ground = between(height_m, ground_m, std::greater<>());
    const auto f = static_cast<float>(view.fraction), g = static_cast<float>(ground.fraction);
    const std::size_t corner = (ground.first * node_secant.size() + view.first) * count, aside = view.step * count,
                      below = ground.step * node_secant.size() * count;
    const auto c1 = static_cast<float>(std::cos(relative_azimuth_rad)),
               c2 = static_cast<float>(std::cos(2.0 * relative_azimuth_rad));

    /// value(i) of the corners of the cell, linear in both directions.
    const auto blend = [&](const auto& value, float* to) {
        const auto along_view = [&](std::size_t i) {
            const float low = value(i);
            return low + f * (value(i + aside) - low);
        };
        if (below == 0) {
            for (std::size_t l = 0; l < count; ++l) to[l] = along_view(corner + l);
        } else {
            for (std::size_t l = 0; l < count; ++l) {
                const float high = along_view(corner + l);
                to[l] = high + g * (along_view(corner + below + l) - high);
            }
        }
    };
    const auto of = [](const std::vector<float>& table) { return [t = table.data()](std::size_t i) { return t[i]; }; };
    blend(of(path_thermal_W_m2_sr_um), out.path_thermal.data());
    blend(of(solar_correlation), out.solar_correlation.data());
    blend(of(adjacency_W_m2_sr_um), out.adjacency.data());
    blend([&](std::size_t i) { return path_solar_a0[i] + c1 * path_solar_a1[i] + c2 * path_solar_a2[i]; },
          out.path_solar.data());
    for (std::size_t l = 0; l < count; ++l) out.path_solar[l] = std::max(0.0F, out.path_solar[l]);  // the series is cut off

    const float *tau = transmittance.data() + corner, *step = ln_transmittance_step.data() + corner,
                *drop = ln_transmittance_drop.data() + corner;
    if (ln_transmittance_step.empty()) {
        std::copy_n(tau, count, out.transmittance.begin());
    } else if (below == 0) {
        for (std::size_t l = 0; l < count; ++l) out.transmittance[l] = tau[l] * exp_of_step(f * step[l]);
    } else {
        for (std::size_t l = 0; l < count; ++l)
            out.transmittance[l] = tau[l] * exp_of_step(f * step[l] + g * (drop[l] + f * (drop[l + aside] - drop[l])));
    }
}

ViewAtmosphere vacuum(int lambda_count) {
    const auto n = static_cast<std::size_t>(lambda_count);
    const std::vector<float> zero(n, 0.0F), one(n, 1.0F);
    ViewAtmosphere v;
    v.direct_normal_irradiance_W_m2_um = v.diffuse_irradiance_W_m2_um = v.thermal_irradiance_W_m2_um = zero;
    v.node_secant = {1.0};
    v.transmittance = v.solar_correlation = one;
    v.path_thermal_W_m2_sr_um = v.path_solar_a0 = v.path_solar_a1 = v.path_solar_a2 = v.adjacency_W_m2_sr_um = zero;
    return v;
}

}  // namespace pyroscene::radiometry
