#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/spectrum.h"

/// Output of other radiative-transfer codes, as the building blocks of a look-up table (assemble_atmosphere.h).
namespace pyroscene::radiometry {

/// Where a run looked from, and under which sun. What the file does not say stays empty.
struct RunGeometry {
    std::optional<double> sensor_altitude_km;    ///< above the ground
    std::optional<double> view_zenith_deg;       ///< at the ground
    std::optional<double> sun_zenith_deg;        ///< at the ground
    std::optional<double> relative_azimuth_deg;  ///< 0 = looking towards the sun, 180 = sun behind the sensor
    std::optional<double> albedo;                ///< of the ground
    std::optional<double> ground_elevation_km, visibility_km;
    std::optional<double> surface_temperature_K;  ///< of the black part of the ground; libRadtran thermal runs
    std::optional<double> day_of_year;            ///< of the sun's distance in the run; 0 or empty: 1 AU

    /// Fills what is empty here from the other.
    void complete_with(const RunGeometry& other);
};

/// One run in the units of this program: radiances W m-2 sr-1 um-1, irradiances W m-2 um-1. Arrays are as long as the
/// wavelengths or empty.
struct AtmosphereRun {
    std::string source;  ///< file (and place in it), for messages
    RunGeometry geometry;
    bool looks_up = false;              ///< from the ground into the sky
    bool includes_thermal = true;       ///< false: terms of the sun only
    bool includes_sun = true;           ///< false: thermal terms only
    std::vector<double> wavelength_um;  ///< ascending
    std::vector<double> transmittance;
    std::vector<double> path_thermal, path_solar;            ///< of the path; looking up: radiance of the sky
    std::vector<double> ground_reflected, direct_reflected;  ///< what the sensor sees of the ground's reflection
    std::vector<double> total_radiance;                      ///< everything, emission of the ground included
    std::vector<double> toa_irradiance;                      ///< sun at the top, normal to the beam
    std::vector<double> two_way_irradiance;                  ///< sun x transmittance of the path sun - ground - sensor
    std::vector<double> direct_normal;                       ///< sun at the ground
    std::vector<double> diffuse, thermal_sky;                ///< horizontal, at the ground, for the run's albedo
    std::vector<double> spherical_albedo, diffuse_transmittance, correlation;
};

/// Unit of spectral radiances and irradiances in a file.
enum class SpectralUnit {
    PerWavenumber,
    PerMicrometre,
    PerNanometre,
    MicrowattPerNanometre,
    MilliwattPerNanometreM2,
    WattPerNanometreM2,
    Product
};

/// W cm-2 cm, W cm-2 um-1, W cm-2 nm-1, uW cm-2 nm-1, mW m-2 nm-1, W m-2 nm-1, W m-2 um-1: factor to W m-2 um-1 at a wavelength
/// (per wavenumber: 1e8 / lambda^2 = wavenumber squared).
double to_product_unit(SpectralUnit unit, double wavelength_um) noexcept;
/// Name as users write it (W_cm2_cm-1, W_cm2_um, W_cm2_nm, uW_cm2_nm, mW_m2_nm, W_m2_nm, W_m2_um); throws an input error about
/// `subject` that lists them.
SpectralUnit spectral_unit(std::string_view name, const std::string& subject = "unit");
std::string spectral_unit_name(SpectralUnit unit);

/// What the user says about a file that it does not say itself.
struct RunHints {
    RunGeometry geometry;              ///< wins over the file
    std::optional<SpectralUnit> unit;  ///< wins over the file
};

/// All runs of a MODTRAN tape7, .tp7 or .7sc file (IEMSCT 0 to 3). \param sun irradiance at 1 AU, which the file's own
/// TOA_SUN must resemble: a wrong unit is off by more than a factor of ten. Throws an input error naming file and line.
std::vector<AtmosphereRun> read_modtran_table(const std::string& path, const std::string& text, const RunHints& hints,
                                              const Spectrum& sun);

/// A MODTRAN6 csv: names, units, numbers. Same columns and checks as the table.
std::vector<AtmosphereRun> read_modtran_csv(const std::string& path, const std::string& text, const RunHints& hints,
                                            const Spectrum& sun);

/// All blocks of a MODTRAN channel file (.chn): band means, with direct and diffuse transmittances and spherical albedo.
std::vector<AtmosphereRun> read_modtran_channels(const std::string& path, const std::string& text, const RunHints& hints,
                                                 const Spectrum& sun);

/// Columns of a libRadtran uvspec table, which has no header. \param columns names in file order: lambda (nm), zout, sza,
/// edir, edn, eup, uu; others are skipped.
AtmosphereRun read_uvspec(const std::string& path, const std::string& text, const std::vector<std::string>& columns,
                          bool thermal, const RunHints& hints);

/// The exchange table of this program (columns wavelength_um, transmittance, path_thermal, ...: docs/recipes).
AtmosphereRun read_exchange_csv(const std::string& path, const RunHints& hints);

}  // namespace pyroscene::radiometry
