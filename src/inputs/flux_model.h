#pragma once

#include <filesystem>
#include <vector>

#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The scenario with the heat flux that inputs.heat_flux.model names as a raster in memory, a band for each moment from `start` on.
/// Throws an input error: unreadable files, no moment after the start.
scenario::Scenario with_flux_model(scenario::Scenario scenario);

/// Files that it is read from.
std::vector<std::filesystem::path> flux_model_files(const scenario::FluxModelSource& source);

}  // namespace pyroscene::inputs
