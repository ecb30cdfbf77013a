#include "radiometry/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/atmosphere_blend.h"

namespace pyroscene::radiometry {
namespace {

/// Secant of an angle below the horizon; at() clamps it.
double secant(double zenith_rad) noexcept { return 1.0 / std::max(std::cos(zenith_rad), 1e-3); }

AtmosphericTerms evaluate_range(const AtmosphereSet& set, const AtmospherePoint& p, LambdaRange range) {
    PathTerms path;
    BlendedAtmosphere(set, p.conditions, range).at(secant(p.view_zenith_rad), path);
    const double sun = solar_factor(set, p.conditions);
    const double c1 = std::cos(p.relative_azimuth_rad), c2 = std::cos(2.0 * p.relative_azimuth_rad);
    AtmosphericTerms out;
    const auto& lambda = set.tables.front().wavelength_um;
    for (std::size_t i = 0; i < range.size(); ++i) {
        const double absorbed = -std::expm1(path.ln_tau[i]);
        const auto series = solar_series(path, i);
        out.wavelength_um.push_back(lambda[range.begin + i]);
        out.transmittance.push_back(1.0 - absorbed);
        out.path_thermal.push_back(path.thermal_source[i] * absorbed);
        for (std::size_t k = 0; k < 3; ++k) out.path_solar_series[k].push_back(sun * series[k]);
        out.path_solar.push_back(std::max(0.0, sun * (series[0] + c1 * series[1] + c2 * series[2])));
        out.direct_normal.push_back(sun * path.direct[i]);
        out.diffuse.push_back(sun * path.diffuse[i]);
        out.thermal_sky.push_back(path.thermal_sky[i]);
        out.spherical_albedo.push_back(path.spherical_albedo[i]);
        out.diffuse_transmittance.push_back(path.diffuse_transmittance[i]);
        out.solar_correlation.push_back(path.correlation[i]);
    }
    return out;
}

}  // namespace

void check_numbers(const AtmospherePoint& p) {
    const auto& c = p.conditions;
    for (const auto& [name, value] :
         std::initializer_list<std::pair<const char*, double>>{{"sensor altitude", c.sensor_altitude_agl_m},
                                                               {"ground elevation", c.ground_elevation_m},
                                                               {"sun zenith", c.sun_zenith_rad},
                                                               {"view zenith", p.view_zenith_rad},
                                                               {"relative azimuth", p.relative_azimuth_rad}})
        if (!std::isfinite(value)) throw input_error("atmosphere", fmt::format("{} is {}, expected a number", name, value));
    for (const auto& [name, value] :
         {std::pair{"visibility", c.visibility_km}, std::pair{"sun distance", c.sun_distance_AU}})
        if (!(value > 0.0) || !std::isfinite(value))
            throw input_error("atmosphere", fmt::format("{} is {}, expected a positive number", name, value));
}

double solar_factor(const AtmosphereSet& set, const AtmosphereConditions& conditions) {
    const double cosine = std::cos(conditions.sun_zenith_rad);
    if (cosine <= 1e-9) return 0.0;
    const double lowest = std::cos(set.tables.front().solar_zenith_deg.back() * kDegree_rad);
    return std::min(1.0, cosine / lowest) / (conditions.sun_distance_AU * conditions.sun_distance_AU);
}

std::array<double, 3> solar_series(const PathTerms& path, std::size_t i) noexcept {
    const double absorbed = -std::expm1(path.ln_tau[i]);
    const double towards = path.solar_source[0][i] * absorbed, across = path.solar_source[1][i] * absorbed,
                 away = path.solar_source[2][i] * absorbed;
    return {(towards + 2.0 * across + away) / 4.0, (towards - away) / 2.0, (towards - 2.0 * across + away) / 4.0};
}

AtmosphericTerms evaluate(const AtmosphereSet& set, const AtmospherePoint& point) {
    check_numbers(point);
    (void)sort_tables(set);
    return evaluate_range(set, point, {0, set.tables.front().lambda_count()});
}

AtmosphericTerms evaluate_at(const AtmosphereSet& set, const AtmospherePoint& point, double wavelength_um) {
    check_numbers(point);
    (void)sort_tables(set);
    const auto& lambda = set.tables.front().wavelength_um;
    if (!(wavelength_um >= lambda.front() && wavelength_um <= lambda.back()))
        throw input_error("atmosphere", fmt::format("wavelength {} um is outside the tables ({} to {} um)", wavelength_um,
                                                    lambda.front(), lambda.back()));
    const auto next = std::upper_bound(lambda.begin() + 1, lambda.end() - 1, wavelength_um);
    const auto high = static_cast<std::size_t>(next - lambda.begin());
    auto terms = evaluate_range(set, point, {high - 1, high + 1});
    const double f = (wavelength_um - lambda[high - 1]) / (lambda[high] - lambda[high - 1]);
    for (auto* array : {&terms.transmittance, &terms.path_thermal, &terms.path_solar, &terms.path_solar_series[0],
                        &terms.path_solar_series[1], &terms.path_solar_series[2], &terms.direct_normal, &terms.diffuse,
                        &terms.thermal_sky, &terms.spherical_albedo, &terms.diffuse_transmittance, &terms.solar_correlation})
        *array = {(*array)[0] + f * ((*array)[1] - (*array)[0])};
    terms.wavelength_um = {wavelength_um};
    return terms;
}

std::vector<std::string> atmosphere_warnings(const AtmosphereSet& set, const AtmosphereConditions& conditions) {
    return atmosphere_warnings(set, AtmospherePoint{conditions, 0.0, 0.0});
}

std::vector<std::string> atmosphere_warnings(const AtmosphereSet& set, const AtmospherePoint& point) {
    const auto limits = table_limits(sort_tables(set));
    const auto& c = point.conditions;
    std::vector<std::string> out;
    const auto clamped = [&](const char* name, double value, double used, const char* unit) {
        out.push_back(fmt::format("{} {:.6g} {} is outside the tables; {:.6g} {} is used", name, value, unit, used, unit));
    };
    constexpr double kSlack = 1e-9, kElevationSlack_m = 200.0;  // changes tau by 0.03 at most
    const double steepest_rad = std::max(std::acos(1.0 / kLargestViewSecant), limits.view_zenith_rad);
    if (point.view_zenith_rad > steepest_rad + kSlack)
        clamped("view zenith", point.view_zenith_rad / kDegree_rad, steepest_rad / kDegree_rad, "deg");
    else if (point.view_zenith_rad > limits.view_zenith_rad + kSlack)
        out.push_back(fmt::format("view zenith {:.6g} deg is beyond the tables; Beer's law goes on from {:.6g} deg",
                                  point.view_zenith_rad / kDegree_rad, limits.view_zenith_rad / kDegree_rad));
    const auto& direct = set.tables.front().direct_solar_irradiance;
    const bool has_sun = std::any_of(direct.begin(), direct.end(), [](float E) { return E > 0.0F; });
    if (has_sun && c.sun_zenith_rad > limits.sun_zenith_rad + kSlack && c.sun_zenith_rad < 0.5 * kPi)
        out.push_back(
            fmt::format("sun zenith {:.2f} deg is beyond the tables; {:.0f} deg is used, its light scaled "
                        "with the cosine",
                        c.sun_zenith_rad / kDegree_rad, limits.sun_zenith_rad / kDegree_rad));
    constexpr double kTop_m = 80e3;  // above it nothing is left that matters
    const double highest_m = std::min(limits.altitude_m, kTop_m);
    if (limits.altitude_m < kTop_m && c.sensor_altitude_agl_m > 1.02 * highest_m)
        clamped("sensor altitude", c.sensor_altitude_agl_m, highest_m, "m");
    const double first_sun_rad = set.tables.front().solar_zenith_deg.front() * kDegree_rad;
    if (c.sun_zenith_rad < first_sun_rad - 1.0 * kDegree_rad && has_sun)
        clamped("sun zenith", c.sun_zenith_rad / kDegree_rad, first_sun_rad / kDegree_rad, "deg");
    if (c.sensor_altitude_agl_m < 0.0) clamped("sensor altitude", c.sensor_altitude_agl_m, 0.0, "m");
    const double visibility = std::clamp(c.visibility_km, limits.visibility_km[0], limits.visibility_km[1]);
    if (set.tables.size() > 1 && visibility != c.visibility_km) clamped("visibility", c.visibility_km, visibility, "km");
    const double elevation = std::clamp(c.ground_elevation_m, limits.ground_elevation_m[0], limits.ground_elevation_m[1]);
    if (std::abs(elevation - c.ground_elevation_m) > kElevationSlack_m)
        clamped("ground elevation", c.ground_elevation_m, elevation, "m");
    return out;
}

}  // namespace pyroscene::radiometry
