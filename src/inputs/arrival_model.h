#pragma once

#include <filesystem>
#include <vector>

#include "inputs/modelled_fire.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The fire of inputs.arrival_model on the map grid. Cells with negative, infinite or no arrival time (in FlamMap's rasters also 0) were
/// not reached. Where fireline intensity I and spread rate R are both given, the heat per area is I / R, else load x heat of the fuel
/// model. Throws an input error: unreadable rasters, a unit tag that contradicts the scenario, fuel codes of no table, no cell that
/// burns. Warns of arrival times whose gradient is no plausible spread rate.
ModelledFire read_arrival_model(const scenario::Scenario& scenario, const MapGrid& grid);

/// Files that inputs.arrival_model names.
std::vector<std::filesystem::path> arrival_model_files(const scenario::ArrivalModelSource& source);

}  // namespace pyroscene::inputs
