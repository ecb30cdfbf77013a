#pragma once

#include "fire/flame_field.h"
#include "inputs/scene_inputs.h"
#include "radiometry/spectral_grid.h"
#include "render/scene.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// The plume at a moment: from the 3-D input, by the rise model, or none. Throws an input error for a field that does not fit.
fire::FlameField make_plume(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs, double time_s);

/// Fills what `optics` says about a plume voxel of fill 1 on the transport grid: smoke per g m-3, or the grey absorption of
/// the scenario, which scatters nothing.
void set_plume_optics(const scenario::Scenario& scenario, const radiometry::SpectralGrid& grid, render::SceneOptics& optics);

}  // namespace pyroscene::pipeline
