#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {

TEST(Acquisitions, EveryKeyIsRead) {
    const ScenarioFolder folder;
    const auto list =
        folder
            .load(with_acquisitions(
                "  - id: first.1\n"
                "    sensor: wasp\n"
                "    time_s: 3600.5\n"
                "    platform: {over: fire, altitude_agl_m: 3000, heading_deg: 45, pitch_deg: 2, roll_deg: -5}\n"
                "    groups: [ir]\n"
                "    bands: [MWIR, LWIR]\n"
                "  - {id: second, sensor: camera.yaml, time_s: 0, platform: {altitude_m: 900}}\n"))
            .acquisitions;
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].id, "first.1");
    EXPECT_EQ(list[0].sensor, "wasp");
    EXPECT_EQ(list[0].time_s, 3600.5);
    EXPECT_TRUE(list[0].platform.over_fire);
    EXPECT_FALSE(list[0].platform.over_centre);
    EXPECT_EQ(list[0].platform.altitude_agl_m, 3000.0);
    EXPECT_FALSE(list[0].platform.altitude_m.has_value());
    EXPECT_EQ(list[0].platform.heading_deg, 45.0);
    EXPECT_EQ(list[0].platform.pitch_deg, 2.0);
    EXPECT_EQ(list[0].platform.roll_deg, -5.0);
    EXPECT_EQ(list[0].groups, std::vector<std::string>{"ir"});
    EXPECT_EQ(list[0].bands, (std::vector<std::string>{"MWIR", "LWIR"}));
    EXPECT_EQ(list[0].line, 7);
    EXPECT_EQ(list[1].sensor, (folder.path() / "camera.yaml").string());
    EXPECT_TRUE(list[1].platform.over_centre);
    EXPECT_EQ(list[1].platform.altitude_m, 900.0);
    EXPECT_TRUE(list[1].groups.empty() && list[1].bands.empty());
    EXPECT_EQ(list[1].line, 13);
}

TEST(Acquisitions, PlacesOnTheMapAndOnTheGlobe) {
    const ScenarioFolder folder;
    const auto place = [&](const std::string& over) {
        return folder.load(with_platform("{over: " + over + ", altitude_m: 3000}")).acquisitions[0].platform;
    };
    const auto map = place("{x_m: 718000, y_m: 5174000}");
    EXPECT_EQ(map.map_xy_m, (std::array<double, 2>{718000.0, 5174000.0}));
    EXPECT_FALSE(map.over_centre || map.over_fire || map.lat_lon_deg);
    const auto globe = place("{lat_deg: 46.69, lon_deg: -114.14}");
    EXPECT_EQ(globe.lat_lon_deg, (std::array<double, 2>{46.69, -114.14}));
    EXPECT_FALSE(globe.over_centre || globe.over_fire || globe.map_xy_m);
}

TEST(Acquisitions, PlatformIsChecked) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& platform) { return folder.problems(with_platform(platform)); };
    const std::string at = "7: acquisitions[0].platform";
    EXPECT_EQ(said("{}"), Lines{at + ": key 'altitude_agl_m' (above the terrain) or 'altitude_m' is missing"});
    EXPECT_EQ(said("{altitude_m: 1, altitude_agl_m: 1}"), Lines{at + ": give 'altitude_agl_m' or 'altitude_m', not both"});
    EXPECT_EQ(said("{altitude_agl_m: 0}"), Lines{at + ".altitude_agl_m: must be > 0 and <= 50000000, found 0"});
    EXPECT_EQ(said("{altitude_m: 1, pitch_deg: 181}"), Lines{at + ".pitch_deg: must be between -180 and 180, found 181"});
    EXPECT_EQ(said("{altitude_m: 1, heading: 9}"),
              Lines{at + ": unknown key 'heading'; known here: altitude_agl_m, altitude_m, "
                         "ground_speed_m_s, heading_deg, over, pass, pitch_deg, roll_deg, scan_angle_deg, trajectory"});
    EXPECT_EQ(said("3000"), Lines{at + ": expected a map of keys, found '3000'"});
    const std::string place = at + ".over: expected {x_m, y_m} or {lat_deg, lon_deg}";
    EXPECT_EQ(said("{altitude_m: 1, over: {x_m: 1}}"), Lines{place});
    EXPECT_EQ(said("{altitude_m: 1, over: {x_m: 1, lat_deg: 1}}"), Lines{place});
    EXPECT_EQ(said("{altitude_m: 1, over: {}}"), Lines{place});
    EXPECT_EQ(said("{altitude_m: 1, over: {x_m: 1, y_m: 1, lat_deg: 1, lon_deg: 1}}"), Lines{place});
    EXPECT_EQ(said("{altitude_m: 1, over: {lat_deg: 91, lon_deg: 1}}"),
              Lines{at + ".over.lat_deg: must be between -90 and 90, found 91"});
    EXPECT_EQ(said("{altitude_m: 1, over: [1, 2]}"), Lines{at + ".over: expected a text, found a list"});
    EXPECT_EQ(said("{altitude_m: 1, over: center}"),
              Lines{at + ".over: 'center' is none of centre, fire, {x_m, y_m} or {lat_deg, lon_deg}"});
}

TEST(Acquisitions, IdsBecomeFoldersAndAreUnique) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& id) {
        return folder.problems(
            with_acquisitions("  - {id: " + id + ", sensor: wasp, time_s: 0, platform: {altitude_m: 1}}\n"));
    };
    for (const char* good : {"a", "wasp_1h", "A-1.b", "2017"}) EXPECT_EQ(said(good), Lines{}) << good;
    for (const char* bad : {"a/b", "'..'", "'.hidden'", "'-x'", "'a b'", "''", "caf\xC3\xA9"}) {
        const auto lines = said(bad);
        ASSERT_EQ(lines.size(), 1U) << bad;
        EXPECT_NE(lines[0].find("cannot be a folder name"), std::string::npos) << lines[0];
    }
    EXPECT_EQ(said("state"), Lines{"7: acquisitions[0].id: 'state' is the folder of the fire states; choose another id"});
    EXPECT_EQ(folder.problems(with_acquisitions("  - {id: a, sensor: wasp, time_s: 0, platform: {altitude_m: 1}}\n"
                                                "  - {id: b, sensor: wasp, time_s: 0, platform: {altitude_m: 1}}\n"
                                                "  - {id: a, sensor: wasp, time_s: 0, platform: {altitude_m: 1}}\n")),
              Lines{"9: acquisitions[2].id: 'a' is used twice (first in line 7)"});
}

TEST(Acquisitions, SensorsMustExist) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& sensor) {
        return folder.problems(
            with_acquisitions("  - {id: a, sensor: " + sensor + ", time_s: 0, platform: {altitude_m: 1}}\n"));
    };
    for (const char* shipped : {"wasp", "wasp-thesis", "generic-framing", "camera.yaml", "./camera.yaml"})
        EXPECT_EQ(said(shipped), Lines{}) << shipped;
    EXPECT_EQ(said("wsap"), Lines{"7: acquisitions[0].sensor: unknown sensor 'wsap'; did you mean 'wasp'?"});
    EXPECT_EQ(
        said("telescope-of-galileo"),
        Lines{
            "7: acquisitions[0].sensor: unknown sensor 'telescope-of-galileo'; 'pyroscene sensors' lists those there are"});
    EXPECT_EQ(said("other.yaml"), Lines{"7: acquisitions[0].sensor: file 'other.yaml' does not exist (" +
                                        (folder.path() / "other.yaml").string() + ")"});
}

TEST(Acquisitions, MissingKeysAndWrongKinds) {
    const ScenarioFolder folder;
    EXPECT_EQ(folder.problems(with_acquisitions("  - {}\n")),
              (Lines{"7: acquisitions[0]: key 'id' is missing", "7: acquisitions[0]: key 'sensor' is missing",
                     "7: acquisitions[0]: key 'time_s' is missing", "7: acquisitions[0]: key 'platform' is missing"}));
    EXPECT_EQ(folder.problems(with_acquisitions("  - wasp\n")),
              Lines{"7: acquisitions[0]: expected a map of keys, found 'wasp'"});
    const std::string list =
        "6: acquisitions: expected a list with at least one acquisition ('- {id: ..., sensor: ..., time_s: ..., "
        "platform: ...}')";
    EXPECT_EQ(folder.problems(with_acquisitions("  []\n")), Lines{list});
    EXPECT_EQ(folder.problems(with_acquisitions("  {id: a}\n")), Lines{list});
    EXPECT_EQ(folder.problems(
                  with_acquisitions("  - {id: a, sensor: wasp, time_s: -5, platform: {altitude_m: 1}, bands: MWIR}\n")),
              (Lines{"7: acquisitions[0].time_s: must be between 0 and 100000000, found -5",
                     "7: acquisitions[0].bands: expected a list of names; leave the key out for all"}));
}

}  // namespace pyroscene::scenario
