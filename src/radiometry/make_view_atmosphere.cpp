#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/atmosphere.h"
#include "radiometry/atmosphere_blend.h"

namespace pyroscene::radiometry {
namespace {

using Array = std::vector<double>;

/// Mean of a polyline over a window as a weighted sum of its samples; the ends of the polyline continue as constants.
struct Window {
    std::size_t first = 0;
    Array weights;

    [[nodiscard]] double mean(const Array& values) const noexcept {
        double sum = 0.0;
        for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * values[first + k];
        return sum;
    }
};

Window point_window(const Array& x, double at) {
    if (at <= x.front()) return {0, {1.0}};
    if (at >= x.back()) return {x.size() - 1, {1.0}};
    const auto high = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    const double f = (at - x[high - 1]) / (x[high] - x[high - 1]);
    return {high - 1, {1.0 - f, f}};
}

Window make_window(const Array& x, double lower, double upper) {
    if (!(upper > lower)) return point_window(x, lower);
    if (upper <= x.front() || lower >= x.back()) return point_window(x, lower);
    const auto above_lower = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), lower) - x.begin());
    const auto from_upper = static_cast<std::size_t>(std::lower_bound(x.begin(), x.end(), upper) - x.begin());
    const std::size_t first = above_lower > 0 ? above_lower - 1 : 0, last = std::min(from_upper, x.size() - 1);
    Window w{first, Array(last - first + 1, 0.0)};
    w.weights.front() += std::max(0.0, x.front() - lower);
    w.weights.back() += std::max(0.0, upper - x.back());
    for (std::size_t k = first; k < last; ++k) {
        const double width = x[k + 1] - x[k];
        const double a = (std::max(lower, x[k]) - x[k]) / width, b = (std::min(upper, x[k + 1]) - x[k]) / width;
        const double towards_high = 0.5 * (b * b - a * a);
        w.weights[k - first] += width * (b - a - towards_high);
        w.weights[k - first + 1] += width * towards_high;
    }
    for (double& weight : w.weights) weight /= upper - lower;
    return w;
}

/// Samples of the wavelength axis that the windows reach.
LambdaRange needed_range(const Array& lambda, const SpectralGrid& grid) {
    const double lower = *std::min_element(grid.cell_lower_um.begin(), grid.cell_lower_um.end());
    const double upper = *std::max_element(grid.cell_upper_um.begin(), grid.cell_upper_um.end());
    const auto above = static_cast<std::size_t>(std::upper_bound(lambda.begin(), lambda.end(), lower) - lambda.begin());
    const auto from = static_cast<std::size_t>(std::lower_bound(lambda.begin(), lambda.end(), upper) - lambda.begin());
    const std::size_t begin = std::min(above > 0 ? above - 1 : 0, lambda.size() - 2);
    return {begin, std::max(std::min(from + 1, lambda.size()), begin + 2)};
}

/// View nodes: the tables' own angles, each interval cut finely enough for linear interpolation of exponentials, and on to the
/// largest angle that is not clamped, where only the path grows.
Array view_secants(const Array& view_zenith_deg) {
    constexpr double kLongestStep = 0.07;
    constexpr int kFewestSteps = 4;
    Array nodes{1.0 / std::cos(view_zenith_deg.front() * kDegree_rad)};
    for (std::size_t v = 1; v < view_zenith_deg.size(); ++v) {
        const double start = nodes.back(), end = 1.0 / std::cos(view_zenith_deg[v] * kDegree_rad);
        const int steps = std::max(kFewestSteps, static_cast<int>(std::ceil((end - start) / kLongestStep)));
        for (int k = 1; k < steps; ++k) nodes.push_back(start + (end - start) * k / steps);
        nodes.push_back(end);
    }
    constexpr double kGrowth = 1.15;
    if (nodes.size() > 1 && nodes.back() < kLargestViewSecant) {
        for (double secant = kGrowth * nodes.back(); secant < kLargestViewSecant; secant *= kGrowth) nodes.push_back(secant);
        nodes.push_back(kLargestViewSecant);
    }
    return nodes;
}

/// Everything that stays the same for all view nodes.
struct Setting {
    std::vector<Window> windows;
    std::span<const double> albedo;
    double sun_factor, sun_cosine;
};

float to_float(double value) noexcept { return static_cast<float>(value); }

/// Ground-sky bounces: what the ground of mean albedo A receives from the sky beyond E_dif.
double diffuse_with_bounces(const PathTerms& path, std::size_t i, double albedo, double sun_cosine) noexcept {
    const double bounced = albedo * path.spherical_albedo[i];
    return path.diffuse[i] + (path.direct[i] * sun_cosine + path.diffuse[i]) * bounced / (1.0 - bounced);
}

void append_illumination(GroundIllumination& out, const PathTerms& path, const Setting& s) {
    Array diffuse(path.diffuse.size());
    for (std::size_t n = 0; n < s.windows.size(); ++n) {
        const auto& window = s.windows[n];
        for (std::size_t k = 0; k < window.weights.size(); ++k)
            diffuse[window.first + k] = diffuse_with_bounces(path, window.first + k, s.albedo[n], s.sun_cosine);
        out.direct_normal_irradiance_W_m2_um.push_back(to_float(s.sun_factor * window.mean(path.direct)));
        out.diffuse_irradiance_W_m2_um.push_back(to_float(s.sun_factor * window.mean(diffuse)));
        out.thermal_irradiance_W_m2_um.push_back(to_float(window.mean(path.thermal_sky)));
    }
}

void append_view(ViewAtmosphere& out, const PathTerms& path, const Setting& s) {
    const std::size_t count = path.ln_tau.size();
    Array tau(count), thermal(count), reflected(count), adjacency(count);
    std::array<Array, 3> series{Array(count), Array(count), Array(count)};
    for (std::size_t i = 0; i < count; ++i) {
        tau[i] = std::exp(path.ln_tau[i]);
        thermal[i] = -std::expm1(path.ln_tau[i]) * path.thermal_source[i];
        reflected[i] = path.direct[i] * path.correlation[i] * tau[i];
        const auto a = solar_series(path, i);
        for (std::size_t k = 0; k < 3; ++k) series[k][i] = s.sun_factor * a[k];
    }
    for (std::size_t n = 0; n < s.windows.size(); ++n) {
        const auto& window = s.windows[n];
        const double A = s.albedo[n];
        for (std::size_t k = 0; k < window.weights.size(); ++k) {
            const std::size_t i = window.first + k;
            const double ground =
                path.direct[i] * s.sun_cosine * path.correlation[i] + diffuse_with_bounces(path, i, A, s.sun_cosine);
            adjacency[i] = s.sun_factor * A * ground / kPi * path.diffuse_transmittance[i];
        }
        const double mean_tau = window.mean(tau), product = window.mean(path.direct) * mean_tau;
        out.transmittance.push_back(to_float(std::min(mean_tau, 1.0)));
        out.path_thermal_W_m2_sr_um.push_back(to_float(window.mean(thermal)));
        out.path_solar_a0.push_back(to_float(window.mean(series[0])));
        out.path_solar_a1.push_back(to_float(window.mean(series[1])));
        out.path_solar_a2.push_back(to_float(window.mean(series[2])));
        out.solar_correlation.push_back(product > 1e-9 ? to_float(window.mean(reflected) / product) : 1.0F);
        out.adjacency_W_m2_sr_um.push_back(to_float(window.mean(adjacency)));
    }
}

/// Beer's law between nodes `apart` from each other: air that hardly lets through anything is no straight line in the secant,
/// nor in the height of the ground.
std::vector<float> transmittance_steps(const std::vector<float>& transmittance, std::size_t apart) {
    constexpr float kLeast = -6.0F;
    std::vector<float> step(transmittance.size(), 0.0F);
    for (std::size_t i = 0; i + apart < step.size(); ++i) {
        const float here = transmittance[i], next = transmittance[i + apart];
        if (here > 0.0F && next > 0.0F) step[i] = std::clamp(std::log(next / here), kLeast, 0.0F);
    }
    return step;
}

/// The same conditions over ground of another height, under the same sensor.
AtmosphereConditions over_ground(AtmosphereConditions conditions, double height_m) {
    conditions.ground_elevation_m += height_m;
    conditions.sensor_altitude_agl_m = std::max(conditions.sensor_altitude_agl_m - height_m, 0.0);
    return conditions;
}

void check_heights(std::span<const double> heights_m) {
    const bool falling = std::adjacent_find(heights_m.begin(), heights_m.end(), std::less_equal<>()) == heights_m.end();
    const bool finite = std::all_of(heights_m.begin(), heights_m.end(), [](double h) { return std::isfinite(h); });
    if (heights_m.empty() || !falling || !finite)
        throw input_error("atmosphere",
                          fmt::format("heights of the ground {} m, expected falling numbers", fmt::join(heights_m, ", ")));
}

}  // namespace

ViewAtmosphere make_view_atmosphere(const AtmosphereSet& set, const AtmosphereConditions& conditions,
                                    const SpectralGrid& grid, std::span<const double> mean_albedo_per_node,
                                    std::span<const double> ground_heights_m) {
    check_numbers(AtmospherePoint{conditions, 0.0, 0.0});
    check_heights(ground_heights_m);
    (void)sort_tables(set);
    const auto nodes = static_cast<std::size_t>(grid.size());
    if (mean_albedo_per_node.size() != nodes)
        throw input_error("atmosphere", fmt::format("{} albedos for {} wavelengths", mean_albedo_per_node.size(), nodes));
    ViewAtmosphere out;
    if (nodes == 0) return out;

    const auto& lambda = set.tables.front().wavelength_um;
    const auto range = needed_range(lambda, grid);
    const Array axis(lambda.begin() + static_cast<std::ptrdiff_t>(range.begin),
                     lambda.begin() + static_cast<std::ptrdiff_t>(range.end));
    Setting setting{
        {}, mean_albedo_per_node, solar_factor(set, conditions), std::max(std::cos(conditions.sun_zenith_rad), 0.0)};
    for (std::size_t n = 0; n < nodes; ++n)
        setting.windows.push_back(make_window(axis, grid.cell_lower_um[n], grid.cell_upper_um[n]));

    PathTerms path;
    out.node_secant = view_secants(set.tables.front().view_zenith_deg);
    out.height_m.assign(ground_heights_m.begin(), ground_heights_m.end());
    BlendedAtmosphere(set, conditions, range).at(out.node_secant.front(), path);
    append_illumination(out, path, setting);
    const bool several = out.height_m.size() > 1;
    for (const double height_m : out.height_m) {
        const BlendedAtmosphere atmosphere(set, over_ground(conditions, height_m), range);
        for (const double secant : out.node_secant) {
            atmosphere.at(secant, path);
            if (several && secant == out.node_secant.front())
                append_illumination(out.illumination.emplace_back(), path, setting);
            append_view(out, path, setting);
        }
    }
    out.ln_transmittance_step = transmittance_steps(out.transmittance, nodes);
    out.ln_transmittance_drop = transmittance_steps(out.transmittance, nodes * out.node_secant.size());
    return out;
}

}  // namespace pyroscene::radiometry
