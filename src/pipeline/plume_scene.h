#pragma once

#include <vector>

#include "fire/flame_field.h"
#include "pipeline/scene_inputs.h"
#include "radiometry/spectral_grid.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// The plume at a moment: from the 3-D input, by the rise model, or none. Throws an input error for a field that does not fit.
fire::FlameField make_plume(const scenario::Scenario& scenario, const SceneInputs& inputs, double time_s);

/// Absorption of a plume voxel of fill 1 on the transport grid: smoke per g m-3, or the grey value of the scenario.
std::vector<float> plume_absorption_per_m(const scenario::Scenario& scenario, const radiometry::SpectralGrid& grid);

}  // namespace pyroscene::pipeline
