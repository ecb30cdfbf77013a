#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "radiometry/atmosphere_table.h"
#include "radiometry/spectral_grid.h"
#include "radiometry/view_atmosphere.h"

/// The atmosphere between a sensor and the ground, interpolated from look-up tables. The scheme and its sources:
/// data/atmosphere/README.md and docs/physics-radiometry.md.
namespace pyroscene::radiometry {

/// One file of the shipped tables (folder data/atmosphere).
struct AtmosphereFile {
    std::string file;
    double visibility_km = 23.0, ground_km = 0.0;
};

/// Names of the shipped model atmospheres.
std::vector<std::string> atmosphere_models();

/// All files of a model. Throws an input error that lists the models for an unknown one.
std::vector<AtmosphereFile> atmosphere_files(const std::string& model);

/// Elevations of the ground in a scene, m above sea level; one number stands for level ground.
struct ElevationRange {
    double lowest_m, highest_m;
    ElevationRange(double level_m) : lowest_m(level_m), highest_m(level_m) {}  // NOLINT(google-explicit-constructor)
    ElevationRange(double lowest, double highest) : lowest_m(lowest), highest_m(highest) {}
};

/// The files that AtmosphereSet needs for one visibility and range of ground elevations, in the order in which it expects them: the
/// model's own tables, then, where the model lacks a visibility or an elevation, tables of midlatitude_summer that give the
/// relative change. Values outside the tables are clamped (atmosphere_warnings tells).
std::vector<AtmosphereFile> needed_files(const std::string& model, double visibility_km, ElevationRange ground);

/// Tables that describe one atmosphere, in the order of needed_files. A (visibility, ground elevation) pair that occurs a
/// second time marks where the reference model's tables begin. A single table (a user's own) is used as it is, whatever
/// the visibility and elevation.
struct AtmosphereSet {
    std::vector<AtmosphereTable> tables;
};

/// Reads the tables of needed_files. \param read gives one variable of one of the files.
AtmosphereSet make_atmosphere_set(
    const std::string& model, double visibility_km, ElevationRange ground,
    const std::function<std::vector<double>(const std::string& file, const std::string& variable)>& read);

/// What surrounds an acquisition.
struct AtmosphereConditions {
    double sensor_altitude_agl_m = 0.0;  ///< above the ground; above the tables' 100 km the 100 km values hold
    double ground_elevation_m = 0.0;     ///< above sea level
    double visibility_km = 23.0;
    double sun_zenith_rad = 0.0;  ///< at the ground; pi/2 and more is night
    double sun_distance_AU = 1.0;
};

/// One line of sight.
struct AtmospherePoint {
    AtmosphereConditions conditions;
    double view_zenith_rad = 0.0;       ///< of the sensor, at the ground
    double relative_azimuth_rad = 0.0;  ///< sun azimuth minus azimuth of the line of sight (sensor to target)
};

/// The atmosphere's terms along one line of sight, per wavelength. Radiances W m-2 sr-1 um-1, irradiances W m-2 um-1; solar
/// terms are for the sun's actual distance, ground albedo 0, and zero at night.
struct AtmosphericTerms {
    std::vector<double> wavelength_um;
    std::vector<double> transmittance;                     ///< ground to sensor
    std::vector<double> path_thermal;                      ///< L_pt
    std::vector<double> path_solar;                        ///< L_ps at the point's relative azimuth
    std::array<std::vector<double>, 3> path_solar_series;  ///< a0, a1, a2:  L_ps = a0 + a1 cos(phi) + a2 cos(2 phi)
    std::vector<double> direct_normal;                     ///< E_dir, normal to the beam
    std::vector<double> diffuse;                           ///< E_dif, horizontal
    std::vector<double> thermal_sky;                       ///< E_sky, horizontal
    std::vector<double> spherical_albedo;                  ///< S
    std::vector<double> diffuse_transmittance;             ///< t_d, for adjacency
    std::vector<double> solar_correlation;                 ///< C of the directly reflected beam
};

/// Terms on the tables' own wavelengths. Angles, visibility and elevation outside the tables are clamped; beyond the largest
/// sun zenith angle the solar terms fall off with the cosine to zero at the horizon.
/// Throws an input error for numbers that are not finite and for a set without tables or with different wavelengths.
AtmosphericTerms evaluate(const AtmosphereSet& set, const AtmospherePoint& point);

/// Terms at one wavelength, linear between the tables' samples. Throws an input error outside the tables' range too.
AtmosphericTerms evaluate_at(const AtmosphereSet& set, const AtmospherePoint& point, double wavelength_um);

/// One line for each value that lies outside the tables and is clamped, for the run report.
std::vector<std::string> atmosphere_warnings(const AtmosphereSet& set, const AtmosphereConditions& conditions);
/// The same for a single line of sight (view zenith too).
std::vector<std::string> atmosphere_warnings(const AtmosphereSet& set, const AtmospherePoint& point);

/// Ground without relief (make_view_atmosphere).
inline constexpr std::array<double, 1> kLevelGround{0.0};

/// The atmosphere on a spectral grid, for all view directions of one acquisition. Every quantity is averaged over the
/// node's window; C becomes the factor that makes  E_dir C tau  of the averages equal to the average of the product.
/// Ground-sky bounces and adjacency use the albedo of the surroundings.
/// \param mean_albedo_per_node 0..1, one per grid node
/// \param ground_heights_m of the ground seen above that of the conditions, m, falling: the nodes between which the path up to
///        the sensor is interpolated (docs/physics-radiometry.md says how far apart). The illumination is that of the conditions.
/// Throws as evaluate(), and an input error when the numbers of albedos and nodes differ or the heights do not fall.
ViewAtmosphere make_view_atmosphere(const AtmosphereSet& set, const AtmosphereConditions& conditions,
                                    const SpectralGrid& grid, std::span<const double> mean_albedo_per_node,
                                    std::span<const double> ground_heights_m = kLevelGround);

}  // namespace pyroscene::radiometry
