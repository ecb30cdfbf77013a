#include "radiometry/atmosphere_slice.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::radiometry {
namespace {

/// Where a value lies between two nodes of an axis.
struct AxisPosition {
    std::size_t low = 0, high = 0;
    double fraction = 0.0;  ///< of the way from low to high
};

// Values below these are zero in the tables (cut off when they were written) or too small to matter; logarithms stop there.
constexpr double kSmallestTau = 1e-12, kSmallestAbsorptance = 1e-6, kSmallestSource = 1e-7;

/// Position of x on an ascending axis whose coordinates are transformed before; clamped to the ends.
template <class Transform>
AxisPosition locate(const std::vector<double>& axis, double x, const Transform& transform) {
    if (x <= axis.front()) return {0, 0, 0.0};
    if (x >= axis.back()) return {axis.size() - 1, axis.size() - 1, 0.0};
    const auto high = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), x) - axis.begin());
    const double a = transform(axis[high - 1]), b = transform(axis[high]);
    return {high - 1, high, (transform(x) - a) / (b - a)};
}

double mix(double low, double high, double fraction) noexcept { return low + fraction * (high - low); }

double absorptance(double tau) noexcept { return std::max(1.0 - tau, kSmallestAbsorptance); }

double scale_height_coordinate(double altitude_km) noexcept { return -std::expm1(-altitude_km / 4.0); }

double secant_of_degrees(double angle_deg) noexcept { return 1.0 / std::cos(angle_deg * kDegree_rad); }

/// Between two sources of thermal radiation by their temperatures: what an opaque path sends is B of the air before the
/// sensor, whose temperature is far nearer to linear than its radiance. Nearly dark ones linearly.
double mix_thermal(double lambda_um, double low, double high, double fraction) noexcept {
    constexpr double kDark = 1e-9;
    if (fraction == 0.0 || !(low > kDark && high > kDark)) return mix(low, high, fraction);
    return planck_radiance(lambda_um,
                           mix(brightness_temperature(lambda_um, low), brightness_temperature(lambda_um, high), fraction));
}

double exp_or_zero(double ln_value, double smallest) noexcept {
    const double value = std::exp(ln_value);
    return value > smallest * 1.000001 ? value : 0.0;
}

}  // namespace

/// Where the slice cuts the table's axes.
struct TableSlice::SlicePosition {
    AxisPosition height, height_u;  ///< in ln h and in u
    double above_ground;            ///< share of the lowest node for quantities that start from a known value at the ground
    AxisPosition sun, sun_cosine;   ///< in the secant and the cosine of the sun zenith
};

void PathTerms::resize(std::size_t n) {
    for (auto* array : {&ln_tau, &thermal_source, &solar_source[0], &solar_source[1], &solar_source[2], &correlation,
                        &diffuse_transmittance, &direct, &diffuse, &thermal_sky, &spherical_albedo})
        array->resize(n);
}

TableSlice::TableSlice(const AtmosphereTable& t, LambdaRange range, double altitude_km, double sun_zenith_rad) {
    const double lowest_km = t.sensor_altitude_km.front(), sun_deg = sun_zenith_rad / kDegree_rad;
    const SlicePosition at{
        locate(t.sensor_altitude_km, altitude_km, [](double h) { return std::log(h); }),
        locate(t.sensor_altitude_km, altitude_km, scale_height_coordinate),
        altitude_km < lowest_km ? scale_height_coordinate(altitude_km) / scale_height_coordinate(lowest_km) : 1.0,
        locate(t.solar_zenith_deg, sun_deg, secant_of_degrees),
        locate(t.solar_zenith_deg, sun_deg, [](double a) { return std::cos(a * kDegree_rad); })};
    for (std::size_t v = 0; v < t.view_zenith_deg.size(); ++v) {
        secant_.push_back(secant_of_degrees(t.view_zenith_deg[v]));
        nodes_.emplace_back();
        fill_view_node(t, v, range, at, nodes_.back());
    }
    fill_ground(t, range, at);
}

void TableSlice::fill_view_node(const AtmosphereTable& t, std::size_t v, LambdaRange range, const SlicePosition& at,
                                Node& node) {
    const std::size_t nl = t.lambda_count(), nv = t.view_zenith_deg.size(), ns = t.solar_zenith_deg.size();
    for (std::size_t l = range.begin; l < range.end; ++l) {
        const auto path = [&](std::size_t a) { return (a * nv + v) * nl + l; };
        const auto with_sun = [&](std::size_t a, std::size_t s) { return ((a * nv + v) * ns + s) * nl + l; };
        const auto tau = [&](std::size_t a) { return static_cast<double>(t.transmittance[path(a)]); };
        const auto ln_tau = [&](std::size_t a) { return std::log(std::max(tau(a), kSmallestTau)); };
        const auto diffuse_up = [&](std::size_t a) { return static_cast<double>(t.diffuse_upward_transmittance[path(a)]); };
        const auto thermal = [&](std::size_t a) {
            return static_cast<double>(t.path_thermal_radiance[path(a)]) / absorptance(tau(a));
        };
        const auto over_sun = [&](const auto& f, std::size_t a) {
            return mix(f(a, at.sun.low), f(a, at.sun.high), at.sun.fraction);
        };
        const auto correlation = [&](std::size_t a) {
            const auto ln_C = [&](std::size_t b, std::size_t s) {
                return std::log(std::max(static_cast<double>(t.solar_path_correlation[with_sun(b, s)]), 1e-3));
            };
            return over_sun(ln_C, a);
        };
        node.ln_tau.push_back(at.above_ground *
                              mix(ln_tau(at.height_u.low), ln_tau(at.height_u.high), at.height_u.fraction));
        node.diffuse_transmittance.push_back(
            at.above_ground * mix(diffuse_up(at.height_u.low), diffuse_up(at.height_u.high), at.height_u.fraction));
        node.thermal_source.push_back(
            mix_thermal(t.wavelength_um[l], thermal(at.height.low), thermal(at.height.high), at.height.fraction));
        node.ln_correlation.push_back(at.above_ground *
                                      mix(correlation(at.height.low), correlation(at.height.high), at.height.fraction));
        for (std::size_t r = 0; r < 3; ++r) {
            const auto ln_source = [&](std::size_t a, std::size_t s) {
                const auto L = static_cast<double>(t.path_solar_radiance[(((a * nv + v) * ns + s) * 3 + r) * nl + l]);
                return std::log(std::max(L / absorptance(tau(a)), kSmallestSource));
            };
            node.ln_solar_source[r].push_back(
                mix(over_sun(ln_source, at.height.low), over_sun(ln_source, at.height.high), at.height.fraction));
        }
    }
}

void TableSlice::fill_ground(const AtmosphereTable& t, LambdaRange range, const SlicePosition& at) {
    const std::size_t nl = t.lambda_count();
    for (std::size_t l = range.begin; l < range.end; ++l) {
        const auto top = static_cast<double>(t.toa_solar_irradiance[l]);
        const auto ln_direct = [&](std::size_t s) {
            return std::log(std::max(static_cast<double>(t.direct_solar_irradiance[s * nl + l]) / top, kSmallestTau));
        };
        const auto diffuse = [&](std::size_t s) { return static_cast<double>(t.diffuse_solar_irradiance[s * nl + l]); };
        const double share = top > 0.0 ? mix(ln_direct(at.sun.low), ln_direct(at.sun.high), at.sun.fraction) : -1e3;
        direct_.push_back(top * exp_or_zero(share, kSmallestTau));
        diffuse_.push_back(mix(diffuse(at.sun_cosine.low), diffuse(at.sun_cosine.high), at.sun_cosine.fraction));
        thermal_sky_.push_back(static_cast<double>(t.thermal_sky_irradiance[l]));
        spherical_albedo_.push_back(static_cast<double>(t.spherical_albedo[l]));
    }
}

void TableSlice::at(double view_secant, PathTerms& out) const {
    const auto view = locate(secant_, view_secant, [](double x) { return x; });
    const Node &low = nodes_[view.low], &high = nodes_[view.high];
    const std::size_t n = direct_.size();
    out.resize(n);
    out.direct = direct_;
    out.diffuse = diffuse_;
    out.thermal_sky = thermal_sky_;
    out.spherical_albedo = spherical_albedo_;
    for (std::size_t i = 0; i < n; ++i) {
        out.ln_tau[i] = mix(low.ln_tau[i], high.ln_tau[i], view.fraction);
        out.thermal_source[i] = mix(low.thermal_source[i], high.thermal_source[i], view.fraction);
        out.correlation[i] = std::exp(mix(low.ln_correlation[i], high.ln_correlation[i], view.fraction));
        out.diffuse_transmittance[i] = mix(low.diffuse_transmittance[i], high.diffuse_transmittance[i], view.fraction);
        for (std::size_t r = 0; r < 3; ++r)
            out.solar_source[r][i] =
                exp_or_zero(mix(low.ln_solar_source[r][i], high.ln_solar_source[r][i], view.fraction), kSmallestSource);
    }
    const double beyond = std::min(view_secant, kLargestViewSecant) - secant_.back();
    if (beyond > 0.0 && secant_.size() > 1) follow_beers_law(beyond, out.ln_tau);
}

/// From the last view angle on to a larger secant.
void TableSlice::follow_beers_law(double beyond_secant, std::vector<double>& ln_tau) const {
    const std::vector<double>&last = nodes_.back().ln_tau, &before = nodes_[nodes_.size() - 2].ln_tau;
    const double steps = beyond_secant / (secant_.back() - secant_[secant_.size() - 2]);
    for (std::size_t i = 0; i < ln_tau.size(); ++i)
        ln_tau[i] = std::max(last[i] + steps * std::min(last[i] - before[i], 0.0), std::log(kSmallestTau));
}

}  // namespace pyroscene::radiometry
