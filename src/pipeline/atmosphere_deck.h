#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// Conditions under which another code has to run for one acquisition.
struct DeckGeometry {
    std::string model;  ///< name of the model atmosphere
    double visibility_km = 23.0, ground_elevation_km = 0.0;
    double sensor_altitude_km = 0.0;      ///< above the ground
    std::vector<double> view_zenith_deg;  ///< nodes from nadir to the edge of the image
    double sun_zenith_deg = 90.0;         ///< 90 and more: night, no runs with a sun
    double lower_um = 0.4, upper_um = 15.0;
    int day_of_year = 1;
};

/// One run of a deck; its output file is what import-atmosphere reads.
struct DeckRun {
    std::string name;
    double view_zenith_deg = 0.0, relative_azimuth_deg = 0.0, albedo = 0.0;
    bool sun = true;
};

/// Geometry of an acquisition: sensor height, view angles that cover its image, sun, wavelengths of its bands. Opens the
/// terrain. Throws an input error: no such acquisition, problems of the scenario.
DeckGeometry deck_geometry(const scenario::Scenario& scenario, const std::string& acquisition_id);

/// Runs that a complete table needs: albedo 0 for every view angle and azimuth 0, 90, 180; albedo 0.5 for adjacency; albedos
/// 0.5 and 1 at nadir for irradiances and spherical albedo; albedo 1 without a sun for the thermal sky.
std::vector<DeckRun> deck_runs(const DeckGeometry& geometry);

/// Texts of input files, by file name. \param code modtran6 (JSON), modtran5 (tape5) or libradtran (uvspec inputs and a
/// script). A list runs.csv for import-atmosphere goes with modtran6 and libradtran; MODTRAN 5 echoes its cards. Throws an input error for an unknown code.
std::vector<std::pair<std::string, std::string>> deck_files(const DeckGeometry& geometry, const std::string& code);

/// Writes the deck of an acquisition into a folder and returns the names of its files.
std::vector<std::string> write_atmosphere_deck(const scenario::Scenario& scenario, const std::string& acquisition_id,
                                               const std::string& code, const std::filesystem::path& folder);

}  // namespace pyroscene::pipeline
