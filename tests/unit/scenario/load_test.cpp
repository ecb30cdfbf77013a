#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenario_folder.h"

namespace pyroscene::scenario {

TEST(Load, ShortestScenarioGetsTheDefaults) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(shortest());
    EXPECT_EQ(s.path, folder.path() / "scenario.yaml");
    EXPECT_EQ(s.name, "scenario");
    EXPECT_EQ(s.title, "scenario");
    EXPECT_FALSE(s.map_crs.has_value());
    EXPECT_FALSE(s.map_cell_m.has_value());
    EXPECT_EQ(s.geoid_undulation_m, 0.0);
    EXPECT_EQ(s.inputs.terrain.files, std::vector{folder.path() / "dem.tif"});
    EXPECT_EQ(s.inputs.heat_flux.files, std::vector{folder.path() / "heat.tif"});
    EXPECT_FALSE(s.inputs.fuel_load || s.inputs.arrival || s.inputs.wind || s.inputs.cover);
    EXPECT_EQ(s.start.iso8601(), "2017-07-15T22:00:00Z");
    EXPECT_EQ(s.physics, fire::Physics::Default);
    EXPECT_EQ(s.fire.physics, fire::Physics::Default);
    EXPECT_EQ(s.fire.front_threshold_W_m2, 1000.0);          // thesis 6.2
    EXPECT_DOUBLE_EQ(s.fire.front_temperature_K, 1073.15);   // 800 degC, thesis 6.2
    EXPECT_DOUBLE_EQ(s.fire.ambient_temperature_K, 307.15);  // 34 degC, thesis 6.2
    EXPECT_EQ(s.fire.scar.amplitude1_K, 578.97);             // eq 4.18
    EXPECT_EQ(s.fire.scar.time_constant2_s, 247.72);
    EXPECT_NEAR(s.fire.scar.amplitude1_K + s.fire.scar.amplitude2_K + s.fire.scar.floor_K - 273.15, 809.66, 1e-9);
    EXPECT_EQ(s.fire.seed, 1U);
    EXPECT_EQ(s.flame.parameters.temperature_K, 1100.0);
    EXPECT_EQ(s.flame.gas.soot_volume_fraction, 2e-7);
    EXPECT_FALSE(s.flame.grey_absorption_per_m.has_value());
    EXPECT_FALSE(s.flame.off);
    EXPECT_EQ(s.surface.unburned, "grass_dry");
    EXPECT_FALSE(s.surface.emissivity.has_value());
    EXPECT_EQ(s.atmosphere.model, "midlatitude_summer");
    EXPECT_EQ(s.atmosphere.visibility_km, 23.0);
    EXPECT_EQ(s.render.samples_per_axis, 3);
    EXPECT_TRUE(s.render.flame_light && s.render.sun);
    EXPECT_TRUE(s.products.radiance && s.products.brightness_temperature && s.products.ortho && s.products.truth &&
                s.products.fractions && s.products.frp && s.products.quicklook && s.products.report);
    EXPECT_EQ(s.seed, 1U);
    ASSERT_EQ(s.acquisitions.size(), 1U);
    EXPECT_EQ(s.acquisitions[0].line, 7);
}

TEST(Load, HeadOfTheFile) {
    const ScenarioFolder folder;
    const Scenario s =
        folder.load(shortest("name: lolo-peak_1.b\ntitle: 'Fire: a test'\nmap: {crs: EPSG:32611, cell_m: "
                             "30}\ngeoid_undulation_m: -17.5\nseed: 42\n"));
    EXPECT_EQ(s.name, "lolo-peak_1.b");
    EXPECT_EQ(s.title, "Fire: a test");
    EXPECT_EQ(s.map_crs, "EPSG:32611");
    EXPECT_EQ(s.map_cell_m, 30.0);
    EXPECT_EQ(s.geoid_undulation_m, -17.5);
    EXPECT_EQ(s.seed, 42U);
    EXPECT_EQ(s.fire.seed, 42U);
}

// The example of the interface page, with names of files that exist here.
TEST(Load, ReadsTheExampleOfTheInterface) {
    const ScenarioFolder folder;
    const Scenario s = folder.load(R"(
pyroscene: 1                       # format version
name: lolo_peak
map: {crs: EPSG:32611, cell_m: 30}
inputs:
  terrain:   {file: dem.tif}
  heat_flux: {file: heat.tif}
  fuel_load: {file: fuel.tif}
  wind:      {file: wind.tif, bands: [u, v]}
  arrival:   {file: arrival.tif, band: 1}
  cover:     {file: classes.tif, band: 4, table: fbfm40}
start: 2017-07-15T22:00:00Z
physics: default
fire:      {front_threshold_W_m2: 1000, flame_height: {method: heat_flux, alpha: 1}, tilt: {method: buoyant_velocity}}
flame:     {temperature_K: 1100, soot_volume_fraction: 2e-7, voxel_m: [5, 5, 1]}
scar:      {model: double_exponential}
atmosphere: {model: midlatitude_summer, visibility_km: 23}
acquisitions:
  - {id: wasp_1h, sensor: wasp, time_s: 3600, platform: {over: centre, altitude_agl_m: 3000, heading_deg: 0}}
products: [radiance, brightness_temperature, ortho, truth, fractions, frp, quicklook, report]
seed: 1
)");
    EXPECT_TRUE(s.inputs.wind->raster->bands.empty());
    EXPECT_EQ(s.inputs.arrival->bands, std::vector<int>{1});
    EXPECT_EQ(s.inputs.cover->raster.bands, std::vector<int>{4});
    EXPECT_EQ(s.inputs.cover->table, "fbfm40");
    EXPECT_EQ(s.acquisitions[0].platform.altitude_agl_m, 3000.0);
    EXPECT_TRUE(s.acquisitions[0].platform.over_centre);
}

TEST(Load, ReportsAllProblemsTogetherInTheOrderOfLines) {
    const ScenarioFolder folder;
    const std::string text =
        "pyroscene: 3\n"
        "name: two words\n"
        "inputs:\n"
        "  terrain: {file: nothing.tif, bnd: 1}\n"
        "start: 2017-07-15\n"
        "physics: tesis\n"
        "flame: {temperature_K: hot}\n"
        "acquisition:\n"
        "  - {id: a}\n"
        "products: [radiance, ortho, ortho]\n";
    EXPECT_EQ(
        folder.problems(text),
        (Lines{
            "1: pyroscene: format version 3 is unknown, this program reads version 1", "1: key 'acquisitions' is missing",
            "2: name: 'two words' is no plain name; use letters, digits, '.', '_', '-' (text goes to 'title')",
            "3: inputs: key 'heat_flux' is missing",
            "4: inputs.terrain.file: file 'nothing.tif' does not exist (" + (folder.path() / "nothing.tif").string() + ")",
            "4: inputs.terrain: unknown key 'bnd'; did you mean 'band'?",
            "5: start: expected UTC like 2017-07-15T22:00:00Z, found '2017-07-15'",
            "6: physics: 'tesis' is none of default, thesis; did you mean 'thesis'?",
            "7: flame.temperature_K: expected a number, found 'hot'",
            "8: unknown key 'acquisition'; did you mean 'acquisitions'?", "10: products: product 'ortho' is named twice"}));
}

TEST(Load, HeadIsChecked) {
    const ScenarioFolder folder;
    EXPECT_EQ(folder.problems(shortest("seed: -1\n")), Lines{"8: seed: must be >= 0, found -1"});
    EXPECT_EQ(folder.problems(shortest("seed: 1.5\n")), Lines{"8: seed: expected a whole number, found '1.5'"});
    EXPECT_EQ(folder.problems(shortest("map: {cell_m: 0}\n")),
              Lines{"8: map.cell_m: must be between 0.1 and 10000, found 0"});
    EXPECT_EQ(folder.problems(shortest("map: {epsg: 32611}\n")),
              Lines{"8: map: unknown key 'epsg'; known here: cell_m, crs"});
    EXPECT_EQ(folder.problems(shortest("geoid_undulation_m: 500\n")),
              Lines{"8: geoid_undulation_m: must be between -120 and 120, found 500"});
    EXPECT_EQ(folder.problems("start: 1800-01-01T00:00:00Z\n" + shortest()).back(),
              "6: key 'start' is given twice (first in line 1)");
    EXPECT_EQ(folder.problems("- a\n- b\n"), Lines{"1: expected a map of keys, found a list"});
}

TEST(Load, StartMustLieWhereTheSunIsKnown) {
    const ScenarioFolder folder;
    std::string text = shortest();
    text.replace(text.find("2017-07-15"), 10, "1850-07-15");
    EXPECT_EQ(folder.problems(text), Lines{"5: start: must lie in the years 1901 to 2099, found 1850-07-15T22:00:00Z"});
}

TEST(Load, ProductsAreThoseNamed) {
    const ScenarioFolder folder;
    const Products p = folder.load(shortest("products: [frp, radiance]\n")).products;
    EXPECT_TRUE(p.frp && p.radiance);
    EXPECT_FALSE(p.brightness_temperature || p.ortho || p.truth || p.fractions || p.quicklook || p.report || p.native);
    EXPECT_EQ(folder.problems(shortest("products: []\n")),
              Lines{"8: products: expected a list of names; leave the key out for all"});
    EXPECT_EQ(folder.problems(shortest("products: all\n")),
              Lines{"8: products: expected a list of names; leave the key out for all"});
    EXPECT_EQ(folder.problems(shortest("products: [xyzxyzxyz]\n")),
              Lines{"8: products: 'xyzxyzxyz' is none of radiance, brightness_temperature, ortho, truth, fractions, frp, "
                    "quicklook, report, native"});
}

TEST(Load, KeysWithoutEffectAreNoted) {
    const ScenarioFolder folder;
    EXPECT_TRUE(folder.load(shortest()).notes.empty());
    EXPECT_EQ(folder
                  .load(shortest(R"(fire:
  flame_height: {method: byram, alpha: 2}
  front_depth: {residence_time_s: 10}
flame: {enabled: false, temperature_K: 900}
atmosphere: {model: none, visibility_km: 5}
surface: {emissivity: 0.9, burned: ash_gray}
render: {flame_light: false, light_bounces: 1}
plume: {top_m: 500, heat_of_combustion_J_kg: 1.8e7}
)"))
                  .notes,
              (Lines{"scenario.yaml:9: fire.flame_height.alpha has no effect: the method is 'byram'",
                     "scenario.yaml:10: fire.front_depth.residence_time_s has no effect: the depth follows the heat flux",
                     "scenario.yaml:11: flame.temperature_K has no effect: there are no flames",
                     "scenario.yaml:15: plume.top_m has no effect: there is no plume",
                     "scenario.yaml:15: plume.heat_of_combustion_J_kg has no effect: there is no plume",
                     "scenario.yaml:13: surface.burned has no effect: one emissivity stands for all ground",
                     "scenario.yaml:12: atmosphere.visibility_km has no effect: there is no air",
                     "scenario.yaml:14: render.light_bounces has no effect: flames throw no light on the ground"}));
    EXPECT_TRUE(
        folder
            .load(shortest("fire: {flame_height: {method: butler, stand_height_m: 20}}\nplume: {model: rise, merge_m: 9}\n"
                           "flame: {profile: linear, tip_temperature_K: 800}\n"))
            .notes.empty());
    EXPECT_EQ(
        folder.load(shortest("flame: {hot_gas: false, composition: {x_H2O: 0.1, soot_volume_fraction: 1e-7}}\n")).notes,
        Lines{"scenario.yaml:8: flame.composition.x_H2O has no effect: there is no hot gas"});
}

TEST(Load, MissingScenarioIsAnInputError) {
    try {
        (void)load("/nowhere/scenario.yaml");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_EQ(std::string(error.what()), "/nowhere/scenario.yaml: does not exist");
    }
}

}  // namespace pyroscene::scenario
