#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "inputs/modelled_fire.h"
#include "inputs/wind_inputs.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The fire of inputs.spread on the grid of the terrain: reads fuel, weather, barriers and ignition, follows the front to the last
/// frame, and says what burns when. Throws an input error: fuel codes of no table, an ignition that lights nothing, unreadable or
/// misplaced rasters and shapes.
/// \param levels  see spread_weather
/// \param on_progress  called with the time of the front; may throw to cancel
ModelledFire spread_own_fire(const scenario::Scenario& scenario, const Raster<float>& terrain_m, const WindLevels* levels,
                             const std::function<void(double time_s)>& on_progress = {});

/// Files that inputs.spread names.
std::vector<std::filesystem::path> spread_files(const scenario::SpreadSource& source);

}  // namespace pyroscene::inputs
