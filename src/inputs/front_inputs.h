#pragma once

#include <map>
#include <optional>
#include <string>

#include "fire/state.h"
#include "inputs/modelled_fire.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// The static rasters that the scenario's flame relations read, on the map grid; those that nothing asks for stay absent.
/// Spread rate: inputs.spread_rate, and 1 / |grad arrival| where it has no value. Fuel load: the first frame, before the fire.
/// Residence time: of the fuel models of inputs.cover. Slope: of the terrain. Throws an input error for an unreadable raster
/// or one in a unit of another quantity.
/// \param modelled  a fire that knows intensity, flame length, spread rate and fuel by itself; else null
fire::FrontInputs load_front_inputs(const scenario::Scenario& scenario, const Raster<float>& terrain_m,
                                    const SharedRaster<float>& arrival_time_s, const ModelledFire* modelled = nullptr);

/// Flame residence time [s] per code of a shipped fuel table, fbfm13 or fbfm40 (data/fuel; Anderson 1969 by the characteristic
/// surface-to-volume ratio). Codes that carry no fire are left out.
std::map<int, double> fuel_residence_times_s(const std::string& table);

}  // namespace pyroscene::inputs
