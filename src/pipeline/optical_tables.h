#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "inputs/scene_inputs.h"
#include "radiometry/atmosphere.h"
#include "radiometry/flame_optics.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// Optical tables from files, the same for all acquisitions of a scenario.
struct OpticalTables {
    double ground_elevation_m = 0.0;       ///< that the air stands on
    std::vector<double> ground_heights_m;  ///< above it, for which the path to a sensor is made; from the highest down
    std::optional<radiometry::AtmosphereSet> air;          ///< none: no air
    std::shared_ptr<const radiometry::FlameOptics> flame;  ///< beside soot; null where the scenario leaves it out
    radiometry::SootOptics soot;
};

/// Throws an input error for a file that cannot be read or is no such table.
OpticalTables load_optical_tables(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs);

/// Shipped tables of soot, hot gas and alkali lines, read when they are first asked for.
std::shared_ptr<const radiometry::FlameOptics> shipped_flame_optics();

}  // namespace pyroscene::pipeline
