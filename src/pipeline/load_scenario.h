#pragma once

#include "pipeline/landscape_inputs.h"
#include "pipeline/wrf_inputs.h"

namespace pyroscene::pipeline {

/// scenario::load(), and the inputs that come out of files with many fields.
inline scenario::Scenario load_scenario(const std::filesystem::path& file) {
    return with_landscape(with_wrf_inputs(scenario::load(file)));
}

}  // namespace pyroscene::pipeline
