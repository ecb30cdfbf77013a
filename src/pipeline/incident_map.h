#pragma once

#include <filesystem>
#include <string>

#include "fire/state.h"

namespace pyroscene::pipeline {

/// What is written on a fire map besides the fire.
struct IncidentMapTitle {
    std::string incident, acquisition, datetime;  ///< datetime: ISO 8601 UTC
    double hot_K = 400.0;                         ///< ground at least this hot is heat
};

/// The fire of one moment as vectors for fire managers, from the state (the model's fire, not an image of it). Attributes have the
/// names of NWCG's event layers; every feature says MapMethod "Modeled" and synthetic 1.
///   perimeter<suffix>.geojson       burnt and burning ground
///   front<suffix>.geojson           active front line, one feature per connected front, with its length and intensity
///   heat<suffix>.geojson            areas of intense and scattered heat
///   isolated_heat<suffix>.geojson   points
///   incident_map<suffix>.gpkg, .kmz     all of them
/// \param fronts_csv  table of the frame's fronts (fronts_csv()), for their intensities; may be missing
void write_incident_map(const std::filesystem::path& folder, const std::string& suffix, const IncidentMapTitle& title,
                        const fire::FireState& state, const std::filesystem::path& fronts_csv);

}  // namespace pyroscene::pipeline
