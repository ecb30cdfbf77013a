#include <gtest/gtest.h>

#include "base/constants.h"
#include "scenario_folder.h"

namespace pyroscene::scenario {

TEST(Physics, EveryKeyOfFireFlameAndScarIsRead) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(shortest(R"(
physics: thesis
fire:
  front_threshold_W_m2: 900
  front_temperature_K: 1100
  ambient_temperature_K: 300
  flaming_heat_flux_W_m2: 2.5e5
  one_sigma_rule: false
  jitter_m: 2
  flame_height: {method: heat_flux, alpha: 0.676, volumetric_heat_release_W_m3: 1.2e6}
  tilt: {method: buoyant_velocity, maximum_deg: 60}
  air: {density_kg_m3: 1.1, heat_capacity_J_kg_K: 1010, temperature_K: 310}
flame: {enabled: false, temperature_K: 1200, absorption_per_m: 3, voxel_m: [20, 20, 5], ember_gap_m: 1}
scar: {model: double_exponential, amplitude1_K: 500, time_constant1_s: 70, amplitude2_K: 200, time_constant2_s: 250, floor_K: 300}
)"));
    EXPECT_EQ(s.physics, fire::Physics::Thesis);
    EXPECT_EQ(s.fire.physics, fire::Physics::Thesis);
    EXPECT_EQ(s.fire.front_threshold_W_m2, 900.0);
    EXPECT_EQ(s.fire.front_temperature_K, 1100.0);
    EXPECT_EQ(s.fire.ambient_temperature_K, 300.0);
    EXPECT_EQ(s.fire.flaming_heat_flux_W_m2, 2.5e5);
    EXPECT_FALSE(s.fire.one_sigma_rule);
    EXPECT_EQ(s.fire.jitter_m, 2.0);
    EXPECT_EQ(s.fire.height_alpha, 0.676);
    EXPECT_EQ(s.fire.volumetric_heat_release_W_m3, 1.2e6);
    EXPECT_DOUBLE_EQ(s.fire.maximum_tilt_rad, kPi / 3.0);
    EXPECT_EQ(s.fire.air_density_kg_m3, 1.1);
    EXPECT_EQ(s.fire.air_heat_capacity_J_kg_K, 1010.0);
    EXPECT_EQ(s.fire.air_temperature_K, 310.0);
    EXPECT_TRUE(s.flame.off);
    EXPECT_EQ(s.flame.parameters.temperature_K, 1200.0);
    EXPECT_EQ(s.flame.grey_absorption_per_m, 3.0);
    EXPECT_EQ(s.flame.parameters.voxel_m, (std::array<double, 3>{20.0, 20.0, 5.0}));
    EXPECT_EQ(s.flame.parameters.ember_gap_m, 1.0);
    EXPECT_EQ(s.fire.scar.amplitude1_K, 500.0);
    EXPECT_EQ(s.fire.scar.time_constant1_s, 70.0);
    EXPECT_EQ(s.fire.scar.amplitude2_K, 200.0);
    EXPECT_EQ(s.fire.scar.time_constant2_s, 250.0);
    EXPECT_EQ(s.fire.scar.floor_K, 300.0);
}

TEST(Physics, SingleExponentialHasItsOwnDefaults) {
    const ScenarioFolder folder;
    const auto scar = folder.load(shortest("scar: {model: single_exponential, time_constant1_s: 120}\n")).fire.scar;
    EXPECT_EQ(scar.amplitude1_K, 766.0);
    EXPECT_EQ(scar.time_constant1_s, 120.0);
    EXPECT_EQ(scar.amplitude2_K, 0.0);
    EXPECT_EQ(scar.floor_K, 307.15);
}

// `physics: thesis` chooses formulas; numbers stay what the scenario or the defaults say (table in docs/scenario.md).
TEST(Physics, ThesisChangesNoNumber) {
    const ScenarioFolder folder;
    const Scenario a = folder.load(shortest()), b = folder.load(shortest("physics: thesis\n"));
    EXPECT_EQ(b.fire.physics, fire::Physics::Thesis);
    EXPECT_EQ(a.fire.front_temperature_K, b.fire.front_temperature_K);
    EXPECT_EQ(a.fire.volumetric_heat_release_W_m3, b.fire.volumetric_heat_release_W_m3);
    EXPECT_EQ(a.flame.parameters.temperature_K, b.flame.parameters.temperature_K);
    EXPECT_EQ(a.flame.parameters.voxel_m, b.flame.parameters.voxel_m);
    EXPECT_EQ(b.surface.emissivity, a.surface.emissivity);
}

TEST(Physics, SurfaceAtmosphereAndRenderAreRead) {
    const ScenarioFolder folder;
    const Scenario s =
        folder.load(shortest("surface: {unburned: conifer, burned: ash_gray, emissivity: 0.9}\n"
                             "atmosphere: {model: tropical, visibility_km: 5, ground_elevation_m: 1200}\n"
                             "render: {samples_per_axis: 5, light_directions: 128, light_reach_m: 250, "
                             "flame_light: false, sun: false, background: water, noise: false}\n"));
    EXPECT_EQ(s.surface.unburned, "conifer");
    EXPECT_EQ(s.surface.burned, "ash_gray");
    EXPECT_EQ(s.surface.emissivity, 0.9);
    EXPECT_EQ(s.atmosphere.model, "tropical");
    EXPECT_EQ(s.atmosphere.visibility_km, 5.0);
    EXPECT_EQ(s.atmosphere.ground_elevation_m, 1200.0);
    EXPECT_EQ(s.render.samples_per_axis, 5);
    EXPECT_EQ(s.render.light_directions, 128);
    EXPECT_EQ(s.render.light_reach_m, 250.0);
    EXPECT_FALSE(s.render.flame_light || s.render.sun);
    EXPECT_EQ(s.render.background, "water");
    EXPECT_FALSE(s.render.noise);
    EXPECT_EQ(folder.load(shortest("atmosphere: {model: none}\n")).atmosphere.model, "none");
    EXPECT_EQ(folder.load(shortest("atmosphere: {file: lut.nc}\n")).atmosphere.file, folder.path() / "lut.nc");
}

TEST(Physics, NumbersAreChecked) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& text) { return folder.problems(shortest(text + "\n")); };
    EXPECT_EQ(said("fire: {front_temperature_K: 800 C}"), Lines{"8: fire.front_temperature_K: expected a number, found '800 "
                                                                "C' (a value carries no unit; the unit is in the key)"});
    EXPECT_EQ(said("fire: {ambient_temperature_K: 34}"),
              Lines{"8: fire.ambient_temperature_K: must be between 200 and 3500, found 34"});
    EXPECT_EQ(said("fire: {front_threshold_W_m2: 0}"),
              Lines{"8: fire.front_threshold_W_m2: must be > 0 and <= 100000000, found 0"});
    EXPECT_EQ(said("fire: {tilt: {maximum_deg: 90}}"),
              Lines{"8: fire.tilt.maximum_deg: must be between 0 and 89, found 90"});
    EXPECT_EQ(said("fire: {tilt: {method: sails}}"),
              Lines{"8: fire.tilt.method: 'sails' is none of buoyant_velocity, aga, thomas, albini, putnam, rule, butler, "
                    "thesis"});
    EXPECT_EQ(said("fire: {flame_height: {method: heatflux}}"),
              Lines{"8: fire.flame_height.method: 'heatflux' is none of heat_flux, heskestad, byram, weise_biging, thomas, "
                    "nelson_adkins, nelson_lab, nelson_field, butler, clark, fernandes, finney_grumstrup, constant, raster; "
                    "did you mean 'heat_flux'?"});
    EXPECT_EQ(said("flame: {voxel_m: [0.01, 5, 300]}"),
              (Lines{"8: flame.voxel_m[0]: must be between 0.05 and 200, found 0.01",
                     "8: flame.voxel_m[2]: must be between 0.05 and 200, found 300"}));
    EXPECT_EQ(said("flame: {absorption_per_m: -1}"),
              Lines{"8: flame.absorption_per_m: must be between 0 and 10000, found -1"});
    EXPECT_EQ(said("scar: {time_constant1_s: 0}"), Lines{"8: scar.time_constant1_s: must be > 0 and <= 10000000, found 0"});
    EXPECT_EQ(said("surface: {emissivity: 0}"), Lines{"8: surface.emissivity: must be > 0 and <= 1, found 0"});
    EXPECT_EQ(said("render: {samples_per_axis: 17}"),
              Lines{"8: render.samples_per_axis: must be between 1 and 16, found 17"});
    EXPECT_EQ(said("atmosphere: {visibility_km: 0.5}"),
              Lines{"8: atmosphere.visibility_km: must be between 1 and 300, found 0.5"});
}

TEST(Physics, ExclusiveKeysAreNotBothAccepted) {
    const ScenarioFolder folder;
    EXPECT_EQ(
        folder.problems(shortest("flame: {soot_volume_fraction: 1e-7, absorption_per_m: 1}\n")),
        Lines{"8: flame.absorption_per_m: replaces soot; give 'soot_volume_fraction' or 'absorption_per_m', not both"});
    EXPECT_EQ(folder.problems(shortest("atmosphere: {file: lut.nc, visibility_km: 5}\n")),
              Lines{"8: atmosphere: give 'model' and 'visibility_km', or 'file', not both"});
}

TEST(Flame, SodiumAndPressureAreRead) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(shortest("flame: {composition: {sodium_ppm: 0.4}, pressure_Pa: 80000}\n"));
    EXPECT_EQ(s.flame.gas.sodium_ppm, 0.4);
    EXPECT_EQ(s.flame.pressure_Pa, 80000.0);
    EXPECT_FALSE(folder.load(shortest("")).flame.pressure_Pa.has_value());
}

}  // namespace pyroscene::scenario
