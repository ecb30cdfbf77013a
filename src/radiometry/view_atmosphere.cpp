#include "radiometry/view_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

}  // namespace

void ViewAtmosphere::View::resize(int n) {
    const auto size = static_cast<std::size_t>(n);
    for (auto* array : {&transmittance, &path_thermal, &path_solar, &solar_correlation, &adjacency}) array->resize(size);
}

void ViewAtmosphere::at(double view_zenith_rad, double relative_azimuth_rad, View& out) const noexcept {
    const std::size_t count = static_cast<std::size_t>(lambda_count()), nodes = node_secant.size();
    const double cosine = std::cos(view_zenith_rad);
    const double secant =
        cosine > 1.0 / node_secant.back() ? 1.0 / cosine : node_secant.back();  // NaN and horizon: last node
    const auto above =
        static_cast<std::size_t>(std::upper_bound(node_secant.begin(), node_secant.end(), secant) - node_secant.begin());
    const std::size_t i1 = std::min(std::max<std::size_t>(above, 1), nodes - 1), i0 = i1 > 0 ? i1 - 1 : 0;
    const double span = node_secant[i1] - node_secant[i0];
    const auto f = static_cast<float>(span > 0.0 ? std::clamp((secant - node_secant[i0]) / span, 0.0, 1.0) : 0.0);
    const auto c1 = static_cast<float>(std::cos(relative_azimuth_rad)),
               c2 = static_cast<float>(std::cos(2.0 * relative_azimuth_rad));

    const auto lerp = [&](const std::vector<float>& table, std::vector<float>& to) {
        const float* low = table.data() + i0 * count;
        const float* high = table.data() + i1 * count;
        float* result = to.data();
        for (std::size_t l = 0; l < count; ++l) result[l] = low[l] + f * (high[l] - low[l]);
    };
    if (ln_transmittance_step.empty()) {
        lerp(transmittance, out.transmittance);
    } else {
        const float *low = transmittance.data() + i0 * count, *step = ln_transmittance_step.data() + i0 * count;
        for (std::size_t l = 0; l < count; ++l) out.transmittance[l] = low[l] * exp_of_step(f * step[l]);
    }
    lerp(path_thermal_W_m2_sr_um, out.path_thermal);
    lerp(solar_correlation, out.solar_correlation);
    lerp(adjacency_W_m2_sr_um, out.adjacency);

    const auto series = [&](std::size_t node, std::size_t l) {
        const std::size_t i = node * count + l;
        return path_solar_a0[i] + c1 * path_solar_a1[i] + c2 * path_solar_a2[i];
    };
    for (std::size_t l = 0; l < count; ++l) {
        const float low = series(i0, l), high = series(i1, l);
        out.path_solar[l] = std::max(0.0F, low + f * (high - low));  // a truncated series may undershoot
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
