#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/yaml.h"
#include "scenario/scenario.h"

/// The sections of a scenario file, one function each. They report what is wrong in the document and go on, so that the user
/// sees all problems at once; what they return is used only when there are none.
namespace pyroscene::scenario {

inline const std::vector<std::string> kAtmosphereModels{"midlatitude_summer", "midlatitude_winter", "subarctic_summer",
                                                        "tropical",           "us_standard_1976",   "none"};
inline const std::vector<std::string> kProductNames{
    "radiance", "brightness_temperature", "ortho", "truth", "fractions", "frp", "quicklook", "report", "native"};

/// Temperatures that ground and flames of a scene can have [K].
inline constexpr config::Range kTemperature_K = config::Range::between(200.0, 3500.0);

/// \param folder  of the scenario file; relative paths start there
Inputs read_inputs(const config::Node& node, const std::filesystem::path& folder);
fire::FireParameters read_fire(const config::Node& node);
/// A raster that does not change with time; the caller calls finish().
RasterSource read_raster(const config::Node& node, const std::filesystem::path& folder);
/// Rasters that may change with time, so many bands for each moment; the caller calls finish().
RasterSource read_raster_series(const config::Node& node, const std::filesystem::path& folder, std::size_t bands_per_frame);
ArrivalModelSource read_arrival_model(const config::Node& node, const std::filesystem::path& folder, bool has_landscape);
/// The key `fuel` of a fire that the program computes.
FuelSource read_fuel(const config::Node& node, const std::filesystem::path& folder);
/// The frames of such a fire: frames_s, or duration_s and frame_step_s; mean_over_s; coarse_burn_time_s.
FireFrames read_fire_frames(const config::Node& node);
/// Heat flux as rasters or, with a key `model`, in a program's own files.
void read_heat_flux(const config::Node& node, const std::filesystem::path& folder, Inputs& inputs);
WrfSource read_wrf(const config::Node& node, const std::filesystem::path& folder);
/// The code scheme of fuel classes: fbfm13, fbfm40 or a CSV file. Reports anything else.
std::string read_fuel_table(const config::Node& node, const std::filesystem::path& folder);
/// \param has_landscape  which gives fuel (and canopy) where the node does not
SpreadSource read_spread(const config::Node& node, const std::filesystem::path& folder, bool has_landscape);
/// What heights of the wind are called, and which one a name is.
inline const std::vector<std::string> kWindHeights{"midflame", "20ft", "10m"};
spread::WindLevel::Kind wind_level_kind(const std::string& height);
/// Trees: cover, height_m, crown_ratio.
CanopySource read_canopy(const config::Node& node, const std::filesystem::path& folder);
/// \param beside_model  a coupled model brings a wind of its own
WindSource read_wind(const config::Node& node, const std::filesystem::path& folder, bool beside_model);
LandscapeSource read_landscape(const config::Node& node, const std::filesystem::path& folder);
/// Gives the inputs that are not there the landscape's bands.
void add_landscape(const LandscapeSource& landscape, Inputs& inputs);
/// What fuel codes mean: a shipped table or a CSV file under `table_key`, `custom`, `nonburnable`.
void read_fuel_models(const config::Node& node, const char* table_key, const std::filesystem::path& folder,
                      FuelSource& source);
/// Flame height, tilt, fireline intensity and front depth: the part of `fire` that read_flames.cpp reads.
void read_flame_relations(const config::Node& fire, fire::FireParameters& parameters);
/// Reports inputs that the chosen flame relations need and do not have, and the reverse.
void check_flame_inputs(const config::Node& root, const Scenario& scenario);
/// \param has_cover the inputs say the class of each cell, which `by_cover` needs
void read_scar(const config::Node& node, const std::filesystem::path& folder, bool has_cover,
               fire::FireParameters& parameters);
/// \param own_fuel  the heat flux is of a fuel whose heat of combustion the scenario gives in `fire`: the smoke's too
PlumeSettings read_plume(const config::Node& node, const Inputs& inputs, const fire::FireParameters& fire, bool own_fuel);
/// \param folder  of the scenario file
PlumeSource read_plume_source(const config::Node& node, const std::filesystem::path& folder);
SurfaceSettings read_surface(const config::Node& node, const std::filesystem::path& folder);
FlameSettings read_flame(const config::Node& node, fire::Physics physics);
AtmosphereSource read_atmosphere(const config::Node& node, const std::filesystem::path& folder);
/// \param surface  for the names of the user's spectra
RenderSettings read_render(const config::Node& node, const SurfaceSettings& surface);
std::vector<Acquisition> read_acquisitions(const config::Node& node, const std::filesystem::path& folder);
std::vector<Mosaic> read_mosaics(const config::Node& node, const std::vector<Acquisition>& acquisitions);
Products read_products(const config::Node& node);
/// Keys that are there and say nothing beside the others, each with the reason: one line of text.
std::vector<std::string> unused_keys(const config::Node& root, const Scenario& scenario);

/// The file a key names, absolute; reports a file that does not exist. Empty when the key is absent.
std::filesystem::path read_file_name(const config::Node& node, const std::filesystem::path& folder);
/// A list of words; a problem when it is no list or empty. Empty when the key is absent.
std::vector<std::string> read_words(const config::Node& node);
/// Names that become parts of paths and URLs: letters, digits, '.', '_' and '-', not starting with '.' or '-'.
bool is_safe_name(const std::string& name);

}  // namespace pyroscene::scenario
