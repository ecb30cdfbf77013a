#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace pyroscene::radiometry {

/// One look-up table of the atmosphere as data/atmosphere/README.md describes it. Arrays are row-major with the wavelength
/// innermost; a = altitude, v = view zenith, s = sun zenith, r = relative azimuth, l = wavelength. Solar terms are for 1 AU,
/// radiances W m-2 sr-1 um-1, irradiances W m-2 um-1.
struct AtmosphereTable {
    double visibility_km = 23.0;
    double ground_elevation_km = 0.0;
    std::vector<double> sensor_altitude_km;    ///< above ground, ascending, > 0
    std::vector<double> view_zenith_deg;       ///< at the ground, ascending from 0
    std::vector<double> solar_zenith_deg;      ///< at the ground, ascending from 0
    std::vector<double> relative_azimuth_deg;  ///< 0, 90, 180
    std::vector<double> wavelength_um;         ///< ascending

    std::vector<float> toa_solar_irradiance;          ///< [l]
    std::vector<float> transmittance;                 ///< [a][v][l]
    std::vector<float> path_thermal_radiance;         ///< [a][v][l]
    std::vector<float> path_solar_radiance;           ///< [a][v][s][r][l], ground albedo 0
    std::vector<float> direct_solar_irradiance;       ///< [s][l], normal to the beam
    std::vector<float> diffuse_solar_irradiance;      ///< [s][l], horizontal, ground albedo 0
    std::vector<float> thermal_sky_irradiance;        ///< [l], horizontal
    std::vector<float> spherical_albedo;              ///< [l]
    std::vector<float> diffuse_upward_transmittance;  ///< [a][v][l]
    std::vector<float> solar_path_correlation;        ///< [a][v][s][l]

    [[nodiscard]] std::size_t lambda_count() const noexcept { return wavelength_um.size(); }
};

/// Fills a table from a source of named variables (the names of the netCDF files: the axes sensor_altitude, view_zenith,
/// solar_zenith, relative_azimuth, wavelength, the scalars visibility and ground_elevation, and the arrays above), then
/// checks it. Throws what `read` throws and the errors of check().
AtmosphereTable make_atmosphere_table(const std::function<std::vector<double>(const std::string& variable)>& read);

/// Throws an input error naming the variable unless all shapes agree, axes ascend, azimuths are 0, 90, 180 deg,
/// 0 <= transmittance and spherical albedo <= 1, and no value is negative or NaN.
void check(const AtmosphereTable& table);

}  // namespace pyroscene::radiometry
