#pragma once

#include <string>

#include "base/report.h"
#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {

/// Compares what the inputs release with what the scene radiates and records it as energy/<acquisition>/...:
/// heat_release_W (cell-mean heat flux x area of the frame), front_W and scar_W (ground, emissivity 1; the scar above ambient),
/// flame_W (optically thin upper bound 4 k_P sigma T^4 V with the Planck-mean absorption of soot, 1340 fv T), radiant_fraction.
/// Warns when the radiant fraction of front and flame exceeds 0.35 (published for wildland fire: 0.10-0.25) under default physics.
void record_energy(RunReport& report, const scenario::Scenario& scenario, const SceneInputs& inputs,
                   const fire::FireState& state, const FireScene& scene, const std::string& acquisition_id);

}  // namespace pyroscene::pipeline
