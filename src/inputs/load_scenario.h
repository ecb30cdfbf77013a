#pragma once

#include "inputs/flux_model.h"
#include "inputs/landscape_inputs.h"
#include "inputs/wind_levels.h"
#include "inputs/wrf_inputs.h"

namespace pyroscene::inputs {

/// scenario::load(), and the inputs that come out of files with many fields.
inline scenario::Scenario load_scenario(const std::filesystem::path& file) {
    return with_windninja(with_landscape(with_wrf_inputs(with_flux_model(scenario::load(file)))));
}

}  // namespace pyroscene::inputs
