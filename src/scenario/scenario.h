#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/flame_gas.h"
#include "base/time.h"
#include "fire/flame_field.h"
#include "fire/plume.h"
#include "fire/state.h"
#include "scenario/arrival_model_source.h"
#include "scenario/flux_model_source.h"
#include "scenario/landscape_source.h"
#include "scenario/raster_source.h"
#include "scenario/spread_source.h"
#include "scenario/wrf_source.h"
#include "spread/wind_profile.h"

namespace pyroscene::scenario {

/// Rasters of speed and direction, as WindNinja writes them.
struct WindNinjaSource {
    std::vector<std::filesystem::path> speed, angle;  ///< one each per moment
    std::string unit;                                 ///< of the speeds: m/s, mph, km/h, kt
    std::string crs;                                  ///< of files that do not say theirs
    bool grid_north = false;      ///< angles count from the y axis of the files' map, else from true north
    std::vector<double> times_s;  ///< one per moment; empty = one for all times
};

/// Wind as rasters (u, v bands) or as one vector for the whole map, constant or from a table of a weather station. With none of them
/// that of a coupled model's files, of which the rest then speaks.
struct WindSource {
    std::optional<WindNinjaSource> windninja;
    std::optional<spread::WindLevel> level;  ///< where it blows; absent = taken as it is by whatever asks for it
    std::optional<double> fuel_depth_m;      ///< everywhere, instead of that of the fuel models
    CanopySource canopy;                     ///< that shelters the flames; absent = that of `spread`
    bool speed_given = false;
    std::optional<RasterSource> raster;  ///< `bands` holds {u, v} of the first frame, or is empty: 1, 2 (or pairs per frame)
    double speed_m_s = 0.0, from_deg = 270.0;
    std::optional<std::filesystem::path> table;  ///< CSV: time_s, speed_m_s, from_deg; a row holds until the next

    [[nodiscard]] bool has_source() const noexcept { return raster || windninja || table || speed_given; }
};

struct CoverSource {
    RasterSource raster;
    std::string table;  ///< fbfm13, fbfm40, fbfm53 (both), or a CSV file: code,surface
};

/// A three-dimensional field above the fire: one band per level.
struct PlumeSource {
    enum class Quantity { Temperature, Excess, Buoyancy };
    std::vector<std::filesystem::path> files;  ///< one per moment
    std::vector<double> times_s;               ///< one per file; empty = one file for all times
    std::vector<double> levels_m;              ///< heights above the terrain, ascending, one per band
    Quantity quantity = Quantity::Temperature;
    bool of_wrf = false;   ///< the files are those of inputs.wrf_sfire, the excess follows from their heating
    std::string variable;  ///< of a netCDF file with several; empty = the file as it is
};

struct Inputs {
    RasterSource terrain,
        heat_flux;  ///< no heat flux with `spread`, `arrival_model` or, at first, `flux_model`; neither need be with `wrf_sfire`
    std::optional<WrfSource> wrf_sfire;
    std::optional<FluxModelSource> flux_model;  ///< whence heat_flux comes
    std::optional<LandscapeSource> landscape;
    std::optional<SpreadSource> spread;
    std::optional<ArrivalModelSource> arrival_model;
    std::optional<RasterSource> fuel_load, arrival;
    std::optional<RasterSource> fireline_intensity, flame_length, spread_rate;  ///< as the front passes; static
    std::optional<WindSource> wind;                                             ///< absent = calm
    std::optional<CoverSource> cover;                                           ///< absent = surface.unburned everywhere
    std::optional<PlumeSource> plume;
};

struct AtmosphereSource {
    std::string model = "midlatitude_summer";  ///< "none" = vacuum
    double visibility_km = 23.0;
    std::optional<std::filesystem::path> file;
    std::optional<double> ground_elevation_m;  ///< default: mean terrain height
};

struct SurfaceSettings {
    std::string unburned = "grass_dry";  ///< surface spectrum where no cover raster says otherwise
    std::string burned = "char_black";
    std::string ash = "ash_gray";                          ///< what burns white: mixed into burnt ground
    double burn_severity = 0.0;                            ///< share of ash in burnt ground, 0..1
    std::map<std::string, std::filesystem::path> spectra;  ///< of the user's, by name
    std::optional<double> emissivity;                      ///< one grey emissivity for everything (furnace, thesis)
};

struct FlameSettings {
    fire::FlameParameters parameters;
    FlameGas gas;
    std::optional<double> pressure_Pa;  ///< of the flame gas; else the standard atmosphere's at the ground's elevation
    bool hot_gas = true;                ///< gas and alkali lines absorb and emit beside the soot; thesis physics: soot alone
    std::optional<double> grey_absorption_per_m;  ///< wavelength-independent absorption instead of soot
    bool off = false;                             ///< no flames at all
    std::optional<double> radiant_fraction;       ///< (front + flame) / heat released, to be met by scaling the flame
    bool adjust_temperature = false;              ///< scale its temperature instead of its soot
};

struct RenderSettings {
    int samples_per_axis = 3;  ///< sub-rays per pixel = its square (1 when the PSF is none)
    int light_directions = 64;
    double light_reach_m = 500.0;
    bool flame_light = true;
    bool point_sources = false;  ///< flame light by point sources instead of the hemisphere
    double point_source_cut = 0.01;
    int light_bounces = 3, light_decay = 4;
    bool sun = true;  ///< false = solar terms off whatever the hour
    /// Surface (spectrum) at ambient temperature beyond the map: "cover" = what most of the map has, "none" = no data.
    std::string background = "cover";
    bool noise = true;  ///< false = a detector without noise; it still saturates and counts
};

/// A uniform layer of smoke: how much by concentration or by optical depth.
struct SmokeLayerSettings {
    double bottom_m = 0.0, top_m = 0.0;
    std::optional<double> concentration_g_m3;
    double optical_depth_550nm = 0.0;
    std::optional<double> temperature_K;  ///< the air's
};

/// Smoke and hot gas above the fire.
struct PlumeSettings {
    bool rise = false;  ///< plume rise model; a 3-D input is used when there is one
    fire::PlumeParameters parameters;
    std::string smoke = "savanna";                ///< kind of smoke (radiometry/smoke.h)
    std::optional<double> grey_absorption_per_m;  ///< of every plume voxel, instead of smoke
    bool multiple_scattering = true;              ///< of light by smoke; false: once only
    std::vector<SmokeLayerSettings> layers;
};

/// Pose of a frame: over a map place or at geographic coordinates.
struct Platform {
    std::optional<std::array<double, 2>> map_xy_m;     ///< over: {x_m, y_m}
    std::optional<std::array<double, 2>> lat_lon_deg;  ///< lat_deg, lon_deg
    bool over_centre = false;                          ///< over: centre
    bool over_fire = false;                            ///< over: fire - centroid of the burning cells at that time
    std::optional<double> altitude_agl_m, altitude_m;  ///< above the terrain below / above the ellipsoid
    double heading_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
    std::optional<double> ground_speed_m_s;  ///< of a flight line; default: the sensor file's
    enum class Pass { None, Ascending, Descending, Geostationary } pass = Pass::None;  ///< orbit of the sensor file
    double scan_angle_deg = 0.0;                      ///< pass: where in the scan `over` is seen, positive to the right
    std::optional<std::filesystem::path> trajectory;  ///< CSV of poses, instead of all else
};

struct Acquisition {
    std::string id, sensor;
    double time_s = 0.0;
    Platform platform;
    std::vector<std::string> groups;  ///< camera groups; empty = all
    std::vector<std::string> bands;   ///< empty = all
    std::string view;                 ///< of a conical scanner; empty = its first
    bool whole_lines = false;         ///< scanners: whole lines instead of the part that sees the map
    std::optional<int> lines;         ///< scanners: as many, around the place; default: those that see the map
    int line = 0;
};

struct Products {
    bool radiance = true, brightness_temperature = true, ortho = true, truth = true, fractions = true, frp = true,
         quicklook = true, report = true;
    bool native = false;  ///< files as the users of the instrument know them
};

/// Several images of one sensor, merged on the map.
struct Mosaic {
    enum class Rule { NearestNadir, Latest, Earliest } rule = Rule::NearestNadir;
    std::string id;
    std::vector<std::string> of;  ///< ids of acquisitions
};

/// All that the user asked for, fully checked by load(): files exist, sensors are known, numbers are in range.
struct Scenario {
    std::filesystem::path path;
    std::string name, title;
    std::optional<std::string> map_crs;
    std::optional<double> map_cell_m;
    double geoid_undulation_m = 0.0;
    Inputs inputs;
    UtcTime start;
    fire::Physics physics = fire::Physics::Default;
    fire::FireParameters fire;
    FlameSettings flame;
    PlumeSettings plume;
    SurfaceSettings surface;
    AtmosphereSource atmosphere;
    RenderSettings render;
    std::vector<Acquisition> acquisitions;
    std::vector<Mosaic> mosaics;
    Products products;
    std::uint64_t seed = 1;
    std::vector<std::string> notes;  ///< worth a warning: keys without effect, what whoever opened the inputs found
};

/// Reads and checks the file. All problems of the text are reported together in one input error (docs/scenario.md).
/// Things that need the rasters opened (CRS, overlap, units, bands) are checked by the pipeline.
Scenario load(const std::filesystem::path& path);

/// JSON Schema (draft 2020-12) of the scenario file.
std::string json_schema();

}  // namespace pyroscene::scenario
