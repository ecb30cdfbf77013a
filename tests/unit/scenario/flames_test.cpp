// Keys of the flame relations: height, tilt, fireline intensity, front depth, and the rasters they need.
#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {

TEST(FlameRelations, EveryKeyIsRead) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(with_inputs("  arrival: {file: arrival.tif}\n"
                                               "  fuel_load: {file: fuel.tif}\n"
                                               "  spread_rate: {file: heat.tif, band: 2}\n"
                                               "  fireline_intensity: {file: heat2.tif}\n") +
                                   R"(
fire:
  flame_height: {method: heskestad, constant_m: 3, air_fuel_ratio: 6, plume_coefficient_m_kW: 0.235,
                 burning_area_fraction: 0.025, stand_height_m: 12}
  tilt: {method: buoyant_velocity, slope: true}
  heat_of_combustion_J_kg: 1.8e7
  maximum_spread_rate_m_s: 6
  fireline_intensity: {method: fuel, consumed_fraction: 0.6}
  front_depth: {method: residence_time, residence_time_s: 15}
  air: {fuel_vapour_density_kg_m3: 0.4}
)");
    const auto& f = s.fire.flames;
    EXPECT_EQ(f.height.method, "heskestad");
    EXPECT_EQ(f.height.constant_m, 3.0);
    EXPECT_EQ(f.height.air_fuel_ratio, 6.0);
    EXPECT_EQ(f.height.plume_coefficient_m_kW, 0.235);
    EXPECT_EQ(f.height.burning_area_fraction, 0.025);
    EXPECT_EQ(f.height.stand_height_m, 12.0);
    EXPECT_EQ(f.tilt.method, "buoyant_velocity");
    EXPECT_TRUE(f.tilt.slope);
    EXPECT_EQ(f.tilt.fuel_vapour_density_kg_m3, 0.4);
    EXPECT_EQ(f.heat_of_combustion_J_kg, 1.8e7);
    EXPECT_EQ(f.maximum_spread_rate_m_s, 6.0);
    EXPECT_EQ(f.intensity, fire::IntensityRule::Fuel);
    EXPECT_EQ(f.consumed_fraction, 0.6);
    EXPECT_EQ(f.depth, fire::DepthRule::ResidenceTime);
    EXPECT_EQ(f.residence_time_s, 15.0);
    EXPECT_EQ(s.inputs.spread_rate->bands, std::vector<int>{2});
    EXPECT_EQ(s.inputs.fireline_intensity->files.front(), folder.path() / "heat2.tif");
    EXPECT_FALSE(s.inputs.flame_length.has_value());
}

TEST(FlameRelations, ResidenceTimeFollowsFromFuelModels) {
    const ScenarioFolder folder;
    const std::string inputs = "  arrival: {file: arrival.tif}\n", depth = "fire: {front_depth: {method: residence_time}}\n";
    EXPECT_EQ(folder.problems(with_inputs(inputs + "  cover: {file: classes.tif, table: fbfm40}\n") + depth), Lines{});
    EXPECT_EQ(folder.problems(with_inputs(inputs + "  cover: {file: classes.tif, table: classes.csv}\n") + depth).size(),
              1U);
}

TEST(FlameRelations, FlameLengthGoesWithItsMethod) {
    const ScenarioFolder folder;
    const std::string raster = "  flame_length: {file: heat2.tif}\n", method = "fire: {flame_height: {method: raster}}\n";
    EXPECT_EQ(folder.problems(with_inputs(raster) + method), Lines{});
    EXPECT_EQ(folder.problems(with_inputs(raster)).size(), 1U);
    EXPECT_EQ(folder.problems(shortest(method)).size(), 1U);
}

TEST(Plume, LayersOfSmokeAreRead) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(shortest(R"(plume:
  layers:
    - {bottom_m: 500, top_m: 900, optical_depth_550nm: 0.3}
    - {bottom_m: 1200, top_m: 1250, concentration_g_m3: 2e-4, temperature_K: 280}
)"));
    ASSERT_EQ(s.plume.layers.size(), 2U);
    EXPECT_EQ(s.plume.layers[0].top_m, 900.0);
    EXPECT_EQ(s.plume.layers[0].optical_depth_550nm, 0.3);
    EXPECT_FALSE(s.plume.layers[0].concentration_g_m3.has_value());
    EXPECT_EQ(s.plume.layers[1].concentration_g_m3, 2e-4);
    EXPECT_EQ(s.plume.layers[1].temperature_K, 280.0);
    EXPECT_TRUE(s.plume.multiple_scattering);
    EXPECT_FALSE(folder.load(shortest("plume: {model: rise, multiple_scattering: false}\n")).plume.multiple_scattering);
}

// The smoke of a fuel whose heat is given for the fire comes from that fuel, unless the plume names another, or the heat flux
// was made with a value of its own.
TEST(Plume, TakesTheHeatOfTheFiresFuel) {
    const ScenarioFolder folder;
    const auto heat_J_kg = [&](const std::string& keys) {
        return folder.load(shortest(keys)).plume.parameters.heat_of_combustion_J_kg;
    };
    EXPECT_EQ(heat_J_kg("plume: {model: rise}\n"), 17.433e6);
    EXPECT_EQ(heat_J_kg("fire: {heat_of_combustion_J_kg: 1.8e7}\nplume: {model: rise}\n"), 1.8e7);
    EXPECT_EQ(heat_J_kg("fire: {heat_of_combustion_J_kg: 1.8e7}\nplume: {model: rise, heat_of_combustion_J_kg: 2e7}\n"),
              2e7);
    EXPECT_EQ(folder
                  .load("pyroscene: 1\ninputs: {wrf_sfire: heat.tif}\nstart: 2021-08-12T20:00:00Z\n"
                        "acquisitions: [{id: a, sensor: wasp, time_s: 0, platform: {altitude_m: 3000}}]\n"
                        "fire: {heat_of_combustion_J_kg: 1.8e7}\nplume: {model: rise}\n")
                  .plume.parameters.heat_of_combustion_J_kg,
              17.433e6);
}

}  // namespace pyroscene::scenario
