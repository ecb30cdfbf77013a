#pragma once

#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The scenario with the bands of its landscape file (`inputs.landscape`) as rasters in memory that say their units, and, for a fire that
/// is given by its heat flux without a fuel load, with the load of the cells' fuel models. What looks wrong is added to Scenario::notes.
/// Input errors: those of gis::open_landscape, fuel codes that the scheme does not have.
scenario::Scenario with_landscape(scenario::Scenario scenario);

}  // namespace pyroscene::inputs
