#pragma once

#include <optional>

#include "base/raster.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// How a wind that is given at some height changes with it, cell by cell (spread/wind_profile.h).
struct WindLevels {
    Raster<float> to_twenty_feet;  ///< wind 6.1 m (20 ft) above the vegetation / wind as given
    Raster<float> to_midflame;     ///< wind at flames / wind 6.1 m above the vegetation
};

/// Nothing when inputs.wind does not say its height. Depth of the fuel bed: inputs.wind.fuel_depth_m, else that of the fuel models of
/// `spread`, `arrival_model`, `landscape` or a cover of a shipped table, whichever is there first; cells without fuel count as 1 ft.
/// Trees: inputs.wind.canopy, else those of `spread`, else none. Throws an input error when the depth is nowhere to be had.
std::optional<WindLevels> wind_levels(const scenario::Scenario& scenario, const MapGrid& grid);

/// The scenario with WindNinja's rasters as components in memory.
scenario::Scenario with_windninja(scenario::Scenario scenario);

}  // namespace pyroscene::inputs
