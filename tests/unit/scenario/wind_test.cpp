#include <fstream>

#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {
namespace {

std::string with_wind(const std::string& keys) { return with_inputs("  wind: {" + keys + "}\n"); }

WindSource wind_of(const ScenarioFolder& folder, const std::string& keys) {
    return *folder.load(with_wind(keys)).inputs.wind;
}

TEST(Wind, SaysAtWhatHeightItBlows) {
    using Kind = spread::WindLevel::Kind;
    const ScenarioFolder folder;
    EXPECT_FALSE(wind_of(folder, "speed: 3, from_deg: 270").level);
    EXPECT_EQ(wind_of(folder, "speed: 3, from_deg: 270, height: 20ft").level->kind, Kind::TwentyFeet);
    EXPECT_EQ(wind_of(folder, "file: wind.tif, height: 10m").level->kind, Kind::TenMetres);
    EXPECT_EQ(wind_of(folder, "file: wind.tif, height: midflame").level->kind, Kind::Midflame);
    const auto mast = wind_of(
        folder,
        "speed: 3, from_deg: 270, height_m: 40, roughness_m: 0.1, fuel_depth_m: 0.5, canopy: {cover: 0.4, height_m: 12}");
    EXPECT_EQ(mast.level->kind, Kind::Metres);
    EXPECT_EQ(mast.level->height_m, 40.0);
    EXPECT_EQ(*mast.level->roughness_m, 0.1);
    EXPECT_EQ(*mast.fuel_depth_m, 0.5);
    EXPECT_EQ(mast.canopy.height_m.value, 12.0);
    const auto said = [&](const std::string& keys) {
        return folder.problems(with_wind("speed: 3, from_deg: 270, " + keys));
    };
    EXPECT_EQ(said("height: 10m, height_m: 10"), Lines{"5: inputs.wind.height_m: 'height' says it; give one of the two"});
    EXPECT_EQ(said("height: 10m, roughness_m: 0.1"), Lines{"5: inputs.wind.roughness_m: belongs to 'height_m'"});
    EXPECT_EQ(said("height_m: 1, roughness_m: 0.8"),
              Lines{"5: inputs.wind.roughness_m: of 0.8 m, expected less than half of the height of 1 m"});
    EXPECT_EQ(said("fuel_depth_m: 1"), Lines{"5: inputs.wind.fuel_depth_m: is about the wind at a 'height'; give that too"});
}

TEST(Wind, FindsTheAnglesOfWindNinjaBesideItsSpeeds) {
    const ScenarioFolder folder;
    for (const char* name :
         {"hill_255_9_100m_vel.asc", "hill_255_9_100m_ang.asc", "noon_vel.asc", "noon_ang.asc", "alone_vel.asc"})
        std::ofstream(folder.path() / name) << "x";
    const auto one = *wind_of(folder, "windninja: {speed: hill_255_9_100m_vel.asc, unit: mph}").windninja;
    EXPECT_EQ(one.angle.front().filename(), "hill_255_9_100m_ang.asc");
    EXPECT_EQ(one.unit, "mph");
    EXPECT_FALSE(one.grid_north);
    const auto two =
        *wind_of(folder,
                 "windninja: {speed: [hill_255_9_100m_vel.asc, noon_vel.asc], unit: km/h, times_s: [0, 3600], north: grid}")
             .windninja;
    EXPECT_EQ(two.angle.back().filename(), "noon_ang.asc");
    EXPECT_EQ(two.times_s.back(), 3600.0);
    EXPECT_TRUE(two.grid_north);
    EXPECT_EQ(
        wind_of(folder, "windninja: {speed: heat.tif, angle: wind.tif, unit: m/s}").windninja->angle.front().filename(),
        "wind.tif");

    const auto said = [&](const std::string& keys) { return folder.problems(with_wind("windninja: {" + keys + "}")); };
    EXPECT_EQ(said("speed: noon_vel.asc"), Lines{"5: inputs.wind.windninja: key 'unit' is missing"});
    EXPECT_EQ(said("speed: alone_vel.asc, unit: mph"),
              Lines{"5: inputs.wind.windninja.speed: there is no 'alone_ang.asc' beside 'alone_vel.asc'"});
    EXPECT_EQ(said("speed: noon_ang.asc, unit: mph").size(), 1U);
    EXPECT_EQ(said("speed: [noon_vel.asc, hill_255_9_100m_vel.asc], unit: mph"),
              Lines{"5: inputs.wind.windninja: expected one of 'times_s' for each of 2 files of speed, found 0"});
    EXPECT_EQ(folder.problems(with_wind("windninja: {speed: noon_vel.asc, unit: mph}, speed: 3, from_deg: 270")),
              Lines{"5: inputs.wind.windninja: stands alone; give one source of the wind"});
}

}  // namespace
}  // namespace pyroscene::scenario
