#pragma once

#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {

/// What flames and smoke of a scene radiate into all directions [W].
struct FlamePower {
    double soot_W =
        0.0;  ///< thin: 4 k_P sigma T^4 V, k_P = 1340 fv T per metre (or grey); an upper bound, free of the voxels
    double gas_W =
        0.0;  ///< what gas and alkali lines add, absorbing themselves: sigma T^4 A (eps - eps_soot) per body of flame
    double smoke_W = 0.0;     ///< thin, above the air's temperature
    double emissivity = 0.0;  ///< of the flame: soot and gas over sigma T^4 A of the bodies, at most 1
    [[nodiscard]] double flame_W() const noexcept { return soot_W + gas_W; }
};
FlamePower flame_power(const scenario::Scenario& scenario, const FireScene& scene);

}  // namespace pyroscene::pipeline
