#pragma once

#include <string>

#include "base/report.h"
#include "pipeline/acquisition.h"

namespace pyroscene::pipeline {

/// Compares what the inputs release with what the scene radiates and records it as energy/<acquisition>/...:
/// heat_release_W (cell-mean heat flux x area of the frame), front_W and scar_W (ground; the scar above ambient),
/// flame_W, flame_gas_W and smoke_W (flame_power.h), radiant_fraction = (front (1 - e) + flame + gas) / release,
/// where e is the emissivity of the flame that stands over the front.
/// Warns when the radiant fraction of front and flame exceeds 0.35 (published for wildland fire: 0.10-0.25) under default physics.
void record_energy(RunReport& report, const scenario::Scenario& scenario, const fire::FireState& state,
                   const FireScene& scene, const std::string& acquisition_id);

/// Scales soot, or temperature, of the flame so that front and flame radiate flame.radiant_fraction of the heat that the frame
/// releases, gas included; does nothing without that key. By bisection to 1e-7 of soot or temperature.
/// Records energy/<acquisition>/soot_volume_fraction or flame_temperature_factor; warns when the target cannot be met (the
/// front alone radiates more, or soot or temperature would leave their range).
void meet_radiant_fraction(RunReport& report, const scenario::Scenario& scenario, const fire::FireState& state,
                           FireScene& scene, const std::string& acquisition_id);

/// Heat of all frames (trapezoid over time of the release that the state files hold) as energy/inputs/heat_released_J and,
/// with a fuel load, fuel_heat_J: fuel consumed (first minus last band; of a single band all fuel where the last frame's
/// state is burning or burnt) x fire.heat_of_combustion_J_kg. Warns when more than 1.1 times the fuel's heat is released (E = int H <= w h).
void record_inputs_energy(RunReport& report, const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                          const std::filesystem::path& output);

}  // namespace pyroscene::pipeline
