#pragma once

#include <string>
#include <vector>

#include "inputs/scene_inputs.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// What can be computed, but may not be what was meant: frames too far apart to date scars, images long after the last frame,
/// flames that lie flat, doubts about a modelled fire. `check` and `run` tell.
std::vector<std::string> scenario_warnings(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs);

}  // namespace pyroscene::pipeline
