#pragma once

#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The scenario with the rasters of its WRF-SFIRE files (`inputs.wrf_sfire`) in place of inputs that it does not give itself:
/// terrain, heat flux of surface and crown fire, fuel load, arrival, wind, cover. They are read from the files when they are
/// read, moment by moment. What was missing or looks wrong is added to Scenario::notes. Without such files the scenario as it
/// is. Input errors: those of gis::open_wrf_sfire, no heat flux or terrain, no record after the scenario's start.
scenario::Scenario with_wrf_inputs(scenario::Scenario scenario);

/// Excess temperatures over the fire at the last record at or before a time, a band for each of inputs.plume's levels (gis/wrf_plume.h).
/// Throws an input error without such a record.
/// \pre inputs.wrf_sfire with a plume
std::filesystem::path wrf_plume_levels(const scenario::Scenario& scenario, double time_s);

}  // namespace pyroscene::inputs
