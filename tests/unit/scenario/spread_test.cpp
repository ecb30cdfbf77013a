#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {
namespace {

const std::string kFuel = "fuel: {file: fuel.tif, table: fbfm40}";
const std::string kIgnition = "ignition: [{point: [10, 20]}]";
const std::string kMoisture = "moisture: {m1h_pct: 6, m10h_pct: 7, m100h_pct: 8, mherb_pct: 60, mwoody_pct: 90}";

std::string with_spread(const std::string& keys, const std::string& more_inputs = "") {
    return "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n  spread: {" + keys + "}\n" + more_inputs +
           "start: 2017-07-15T22:00:00Z\nacquisitions:\n  - {id: a, sensor: wasp, time_s: 300, platform: {altitude_m: "
           "3000}}\n";
}
std::string complete(const std::string& more) {
    return with_spread(kFuel + ", " + kIgnition + ", " + kMoisture + ", " + more);
}

TEST(Spread, ReadsTheShortestFire) {
    const ScenarioFolder folder;
    const auto inputs = folder.load(complete("duration_s: 900")).inputs;
    EXPECT_TRUE(inputs.heat_flux.files.empty());
    ASSERT_TRUE(inputs.spread);
    const auto& s = *inputs.spread;
    EXPECT_EQ(s.fuel.raster.files, std::vector{folder.path() / "fuel.tif"});
    EXPECT_EQ(s.fuel.table, "fbfm40");
    ASSERT_EQ(s.ignition.size(), 1U);
    EXPECT_EQ(s.ignition[0].points, (std::vector<std::array<double, 2>>{{10.0, 20.0}}));
    EXPECT_EQ(s.moisture_pct[spread::kHerb], 60.0);
    EXPECT_EQ(s.frames.times_s, (std::vector{300.0, 600.0, 900.0}));
    EXPECT_EQ(s.frames.mean_over_s, 6.0);
    EXPECT_EQ(s.rules.curing, spread::Curing::BehavePlus);
    EXPECT_FALSE(s.rules.wind_limit);
    EXPECT_EQ(s.canopy.crown_ratio, 0.5);
    EXPECT_EQ(s.frames.coarse_burn_time_s, 300.0);
}

TEST(Spread, SaysWhereTheWindBlowsThatDoesNotSayIt) {
    const ScenarioFolder folder;
    using Kind = spread::WindLevel::Kind;
    const auto kind = [&](const std::string& height, const std::string& wind) {
        const auto inputs = folder
                                .load(with_spread(kFuel + ", " + kIgnition + ", " + kMoisture + ", duration_s: 900" + height,
                                                  "  wind: {speed: 3, from_deg: 270" + wind + "}\n"))
                                .inputs;
        return inputs.wind->level->kind;
    };
    EXPECT_EQ(kind("", ""), Kind::TwentyFeet);
    EXPECT_EQ(kind(", wind_height: 10m", ""), Kind::TenMetres);
    EXPECT_EQ(kind(", wind_height: midflame", ""), Kind::Midflame);
    EXPECT_EQ(kind("", ", height: 10m"), Kind::TenMetres);
}

TEST(Spread, ReadsAllItsKeys) {
    const ScenarioFolder folder;
    const auto s =
        *folder
             .load(with_spread(
                 "fuel: {file: fuel.tif, band: 4, table: classes.csv, custom: classes.csv, nonburnable: [0, 7]}, "
                 "ignition: [{line: [[1, 2], [3, 4]], time_s: 60, crs: 'EPSG:4326'}, {file: arrival.tif, layer: x}, "
                 "{polygon: [[0, 0], [1, 0], [0, 1]]}, {points: [[5, 6], [7, 8]]}], "
                 "barriers: [{line: [[0, 0], [9, 9]]}], "
                 "moisture: {table: classes.csv, mherb_pct: 50}, "
                 "canopy: {cover: {file: classes.tif, band: 5}, height_m: {file: classes.tif, scale: 0.1}, crown_ratio: "
                 "0.3}, "
                 "wind_height: 10m, wind_limit: true, curing: linear, frames_s: [10, 25], coarse_burn_time_s: 60"))
             .inputs.spread;
    EXPECT_EQ(s.fuel.nonburnable, (std::vector{0, 7}));
    EXPECT_EQ(s.fuel.table, folder.path() / "classes.csv");
    ASSERT_EQ(s.ignition.size(), 4U);
    EXPECT_EQ(s.ignition[0].line.size(), 2U);
    EXPECT_EQ(s.ignition[0].time_s, 60.0);
    EXPECT_EQ(s.ignition[0].crs, "EPSG:4326");
    EXPECT_EQ(s.ignition[1].layer, "x");
    EXPECT_EQ(s.ignition[2].polygon.size(), 3U);
    EXPECT_EQ(s.ignition[3].points.size(), 2U);
    EXPECT_EQ(s.barriers.size(), 1U);
    EXPECT_EQ(s.moisture_pct[spread::kHerb], 50.0);
    EXPECT_FALSE(s.moisture_pct[spread::kOneHour]);
    EXPECT_EQ(s.canopy.cover.raster->bands, std::vector{5});
    EXPECT_EQ(s.canopy.height_m.scale, 0.1);
    EXPECT_EQ(s.wind_level.kind, spread::WindLevel::Kind::TenMetres);
    EXPECT_TRUE(s.rules.wind_limit);
    EXPECT_EQ(s.rules.curing, spread::Curing::Linear);
    EXPECT_EQ(s.frames.times_s, (std::vector{10.0, 25.0}));
    EXPECT_EQ(s.frames.mean_over_s, 6.0);
}

TEST(Spread, SaysWhatIsWrong) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& more) { return folder.problems(complete(more)); };
    EXPECT_EQ(folder.problems(with_spread("duration_s: 600")),
              (Lines{"4: inputs.spread: key 'fuel' is missing", "4: inputs.spread: key 'ignition' is missing",
                     "4: inputs.spread: key 'moisture' is missing"}));
    EXPECT_EQ(said("frame_step_s: 60"), Lines{"4: inputs.spread: key 'duration_s' is missing"});
    EXPECT_EQ(said("duration_s: 60"),
              Lines{"4: inputs.spread.duration_s: 60 s in steps of 300 s are 0 frames, expected 1 to 100000"});
    EXPECT_EQ(said("frames_s: [60, 30]"), Lines{"4: inputs.spread.frames_s: times must ascend from above 0, found 30"});
    EXPECT_EQ(said("frames_s: [60], duration_s: 60"), Lines{"4: inputs.spread.duration_s: does not go with 'frames_s'"});
    EXPECT_EQ(said("frames_s: [60], mean_over_s: 100"),
              Lines{"4: inputs.spread.mean_over_s: must not exceed the 60 s between two frames, found 100"});
    EXPECT_EQ(said("frames_s: [60], barriers: [{point: [1, 2], line: [[1, 2], [3, 4]]}]"),
              Lines{"4: inputs.spread.barriers[0]: expected one of 'file', 'point', 'points', 'line', 'polygon', found 2"});
    EXPECT_EQ(said("frames_s: [60], barriers: [{line: [[1, 2]]}]"),
              Lines{"4: inputs.spread.barriers[0].line: expected a list of at least 2 positions [[x, y], ...]"});
    EXPECT_EQ(said("frames_s: [60], barriers: [{point: [1, 2, 3]}]"),
              Lines{"4: inputs.spread.barriers[0].point: expected a position [x, y]"});
    EXPECT_EQ(said("frames_s: [60], barriers: [{point: [1, 2], layer: x}]"),
              Lines{"4: inputs.spread.barriers[0].layer: belongs to 'file'"});
    EXPECT_EQ(folder.problems(
                  with_spread("fuel: {file: fuel.tif, table: kitral}, frames_s: [60], " + kIgnition + ", " + kMoisture)),
              Lines{"4: inputs.spread.fuel.table: 'kitral' is none of fbfm13, fbfm40, fbfm53 or a CSV file"});
    EXPECT_EQ(
        folder.problems(with_spread(
            kFuel + ", frames_s: [60], moisture: {m1h_pct: 5, m10h_pct: 6, m100h_pct: 7, mherb_pct: 8}, " + kIgnition)),
        Lines{"4: inputs.spread.moisture: key 'mwoody_pct' is missing"});
    EXPECT_EQ(folder.problems(
                  with_spread(kFuel + ", frames_s: [60], moisture: {file: fuel.tif, bands: [1, 2, 3, 4]}, " + kIgnition)),
              Lines{"4: inputs.spread.moisture.bands: expected 5 band numbers for each frame, found 4 numbers"});
}

TEST(Spread, StandsInsteadOfWhatAFireModelGives) {
    const ScenarioFolder folder;
    const auto keys = kFuel + ", " + kIgnition + ", " + kMoisture + ", duration_s: 600";
    EXPECT_EQ(folder.problems(with_spread(keys, "  heat_flux: {file: heat.tif}\n  arrival: {file: arrival.tif}\n")),
              (Lines{"5: inputs.heat_flux: comes from 'spread'; give one of the two",
                     "6: inputs.arrival: comes from 'spread'; give one of the two"}));
    // Relations that need arrival times, fuel or flame length have them.
    EXPECT_EQ(
        folder.problems(with_spread(keys) + "fire: {flame_height: {method: raster}, fireline_intensity: {method: fuel}}\n"),
        Lines{});
}

}  // namespace
}  // namespace pyroscene::scenario
