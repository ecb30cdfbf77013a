#include "radiometry/atmosphere_table.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

void check_axis(const char* name, const std::vector<double>& axis, double minimum, double maximum, std::size_t fewest = 1) {
    if (axis.size() < fewest)
        throw input_error(name, fmt::format("atmosphere table: {} values, expected at least {}", axis.size(), fewest));
    for (std::size_t i = 0; i < axis.size(); ++i) {
        if (!(axis[i] >= minimum && axis[i] <= maximum))
            throw input_error(name, fmt::format("atmosphere table: value {}, expected {} to {}", axis[i], minimum, maximum));
        if (i > 0 && !(axis[i] > axis[i - 1]))
            throw input_error(name, fmt::format("atmosphere table: {} after {}, expected ascending", axis[i], axis[i - 1]));
    }
}

void check_array(const char* name, const std::vector<float>& values, std::size_t expected, float maximum) {
    if (values.size() != expected)
        throw input_error(name, fmt::format("atmosphere table: {} values, expected {}", values.size(), expected));
    for (const float value : values)
        if (!(value >= 0.0F && value <= maximum))
            throw input_error(name, fmt::format("atmosphere table: value {}, expected 0 to {}", value, maximum));
}

std::vector<float> narrow(const std::vector<double>& values) {
    std::vector<float> out;
    out.reserve(values.size());
    for (const double value : values) out.push_back(static_cast<float>(value));
    return out;
}

double scalar(const std::function<std::vector<double>(const std::string&)>& read, const std::string& variable) {
    const auto values = read(variable);
    if (values.size() != 1)
        throw input_error(variable, fmt::format("atmosphere table: {} values, expected one number", values.size()));
    return values.front();
}

}  // namespace

void check(const AtmosphereTable& t) {
    check_axis("sensor_altitude", t.sensor_altitude_km, 1e-3, 1e5);
    check_axis("view_zenith", t.view_zenith_deg, 0.0, 89.0);
    check_axis("solar_zenith", t.solar_zenith_deg, 0.0, 89.0);
    check_axis("relative_azimuth", t.relative_azimuth_deg, 0.0, 180.0);
    check_axis("wavelength", t.wavelength_um, 0.1, 1000.0, 2);
    const auto& azimuth = t.relative_azimuth_deg;
    if (azimuth.size() != 3 || azimuth[0] != 0.0 || azimuth[1] != 90.0 || azimuth[2] != 180.0)
        throw input_error("relative_azimuth", "atmosphere table: expected the three values 0, 90, 180 deg");
    if (!(t.visibility_km > 0.0)) throw input_error("visibility", "atmosphere table: expected a positive number of km");
    if (!std::isfinite(t.ground_elevation_km)) throw input_error("ground_elevation", "atmosphere table: expected a number");

    const std::size_t l = t.lambda_count(), view = t.sensor_altitude_km.size() * t.view_zenith_deg.size(),
                      sun = t.solar_zenith_deg.size();
    constexpr float kLargeRadiance = 1e6F, kLargeIrradiance = 1e5F, kLargeCorrelation = 1e6F;
    check_array("toa_solar_irradiance", t.toa_solar_irradiance, l, kLargeIrradiance);
    check_array("transmittance", t.transmittance, view * l, 1.0F);
    check_array("path_thermal_radiance", t.path_thermal_radiance, view * l, kLargeRadiance);
    check_array("path_solar_radiance", t.path_solar_radiance, view * sun * 3 * l, kLargeRadiance);
    check_array("direct_solar_irradiance", t.direct_solar_irradiance, sun * l, kLargeIrradiance);
    check_array("diffuse_solar_irradiance", t.diffuse_solar_irradiance, sun * l, kLargeIrradiance);
    check_array("thermal_sky_irradiance", t.thermal_sky_irradiance, l, kLargeIrradiance);
    check_array("spherical_albedo", t.spherical_albedo, l, 1.0F);
    check_array("diffuse_upward_transmittance", t.diffuse_upward_transmittance, view * l, 10.0F);
    check_array("solar_path_correlation", t.solar_path_correlation, view * sun * l, kLargeCorrelation);
}

AtmosphereTable make_atmosphere_table(const std::function<std::vector<double>(const std::string& variable)>& read) {
    AtmosphereTable t;
    t.visibility_km = scalar(read, "visibility");
    t.ground_elevation_km = scalar(read, "ground_elevation");
    t.sensor_altitude_km = read("sensor_altitude");
    t.view_zenith_deg = read("view_zenith");
    t.solar_zenith_deg = read("solar_zenith");
    t.relative_azimuth_deg = read("relative_azimuth");
    t.wavelength_um = read("wavelength");
    t.toa_solar_irradiance = narrow(read("toa_solar_irradiance"));
    t.transmittance = narrow(read("transmittance"));
    t.path_thermal_radiance = narrow(read("path_thermal_radiance"));
    t.path_solar_radiance = narrow(read("path_solar_radiance"));
    t.direct_solar_irradiance = narrow(read("direct_solar_irradiance"));
    t.diffuse_solar_irradiance = narrow(read("diffuse_solar_irradiance"));
    t.thermal_sky_irradiance = narrow(read("thermal_sky_irradiance"));
    t.spherical_albedo = narrow(read("spherical_albedo"));
    t.diffuse_upward_transmittance = narrow(read("diffuse_upward_transmittance"));
    t.solar_path_correlation = narrow(read("solar_path_correlation"));
    check(t);
    return t;
}

}  // namespace pyroscene::radiometry
