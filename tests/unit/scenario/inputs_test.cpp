#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {

using Bands = std::vector<int>;
using Times = std::vector<double>;

TEST(Inputs, OneFileOfATimeSeries) {
    const ScenarioFolder folder;
    const auto source = folder.load(with_heat_flux("{file: heat.tif, bands: [3, 5], times_s: [0, 60.5]}")).inputs.heat_flux;
    EXPECT_EQ(source.files, std::vector{folder.path() / "heat.tif"});
    EXPECT_EQ(source.bands, (Bands{3, 5}));
    EXPECT_EQ(source.times_s, (Times{0.0, 60.5}));
    EXPECT_EQ(source.line, 4);
}

TEST(Inputs, OneFilePerFrame) {
    const ScenarioFolder folder;
    const auto source =
        folder.load(with_heat_flux("{files: [heat.tif, heat2.tif], band: 2, times_s: [0, 60]}")).inputs.heat_flux;
    EXPECT_EQ(source.files, (std::vector{folder.path() / "heat.tif", folder.path() / "heat2.tif"}));
    EXPECT_EQ(source.bands, Bands{2});
    EXPECT_EQ(source.times_s, (Times{0.0, 60.0}));
}

TEST(Inputs, TimesOfAFileWithUnknownBandsAreNotCounted) {
    const ScenarioFolder folder;
    EXPECT_EQ(folder.problems(with_heat_flux("{file: heat.tif, times_s: [0, 60, 120]}")), Lines{});
}

TEST(Inputs, RasterSourcesAreChecked) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& value) { return folder.problems(with_heat_flux(value)); };
    EXPECT_EQ(said("heat.tif"), Lines{"4: inputs.heat_flux: expected a map of keys, found 'heat.tif'"});
    EXPECT_EQ(said("{}"), Lines{"4: inputs.heat_flux: key 'file' (or 'files') is missing"});
    EXPECT_EQ(said("{files: []}"), Lines{"4: inputs.heat_flux.files: expected a list of files"});
    EXPECT_EQ(said("{files: heat.tif}"), Lines{"4: inputs.heat_flux.files: expected a list of files"});
    EXPECT_EQ(said("{file: [heat.tif]}"), Lines{"4: inputs.heat_flux.file: expected a text, found a list"});
    EXPECT_EQ(said("{file: heat.tif, files: [heat.tif]}"), Lines{"4: inputs.heat_flux: give 'file' or 'files', not both"});
    EXPECT_EQ(said("{file: heat.tif, band: 1, bands: [1]}"), Lines{"4: inputs.heat_flux: give 'band' or 'bands', not both"});
    EXPECT_EQ(said("{file: heat.tif, band: 0}"), Lines{"4: inputs.heat_flux.band: must be between 1 and 65535, found 0"});
    EXPECT_EQ(said("{file: heat.tif, bands: [1, x]}"),
              Lines{"4: inputs.heat_flux.bands[1]: expected a whole number, found 'x'"});
    EXPECT_EQ(said("{file: heat.tif, bands: 2}"), Lines{"4: inputs.heat_flux.bands: expected a list of band numbers"});
    EXPECT_EQ(said("{file: heat.tif, times_s: [-1, 5]}"), Lines{"4: inputs.heat_flux.times_s: must be >= 0, found -1"});
    EXPECT_EQ(said("{file: heat.tif, times_s: [5, 5]}"),
              Lines{"4: inputs.heat_flux.times_s: times must ascend, but 5 follows 5"});
    EXPECT_EQ(said("{files: [heat.tif, heat2.tif], times_s: [0]}"),
              Lines{"4: inputs.heat_flux.times_s: expected one time for each of 2 frames (files x bands), found 1"});
    EXPECT_EQ(said("{file: heat.tif, bands: [1, 2], times_s: [0]}"),
              Lines{"4: inputs.heat_flux.times_s: expected one time for each of 2 frames (files x bands), found 1"});
    EXPECT_EQ(said("{file: ''}"), Lines{"4: inputs.heat_flux.file: '' is a folder, expected a file"});
}

TEST(Inputs, StaticRastersHaveNoTimes) {
    const ScenarioFolder folder;
    EXPECT_EQ(folder.problems(with_inputs("  arrival: {file: arrival.tif, times_s: [0]}\n")),
              Lines{"5: inputs.arrival: unknown key 'times_s'; known here: band, file"});
    EXPECT_EQ(folder.load(with_inputs("  arrival: {file: arrival.tif, band: 2}\n")).inputs.arrival->bands, Bands{2});
}

TEST(Inputs, WindAsOneVector) {
    const ScenarioFolder folder;
    for (const char* text : {"  wind: {speed: 3, from_deg: 225}\n", "  wind: {speed_m_s: 3, from_deg: 225}\n"}) {
        const auto wind = folder.load(with_inputs(text)).inputs.wind.value();
        EXPECT_FALSE(wind.raster.has_value());
        EXPECT_EQ(wind.speed_m_s, 3.0);
        EXPECT_EQ(wind.from_deg, 225.0);
    }
}

TEST(Inputs, WindAsRasters) {
    const ScenarioFolder folder;
    const auto bands = [&](const std::string& text) {
        return folder.load(with_inputs("  wind: {file: wind.tif" + text + "}\n")).inputs.wind.value().raster.value().bands;
    };
    EXPECT_EQ(bands(""), Bands{});
    EXPECT_EQ(bands(", bands: [u, v]"), Bands{});
    EXPECT_EQ(bands(", bands: [3, 4]"), (Bands{3, 4}));
    const auto series = folder.load(with_inputs("  wind: {file: wind.tif, bands: [1, 2, 5, 6], times_s: [0, 60]}\n"))
                            .inputs.wind->raster.value();
    EXPECT_EQ(series.bands, (Bands{1, 2, 5, 6}));
    EXPECT_EQ(series.times_s, (Times{0.0, 60.0}));
}

TEST(Inputs, WindIsChecked) {
    const ScenarioFolder folder;
    const auto said = [&](const std::string& value) { return folder.problems(with_inputs("  wind: " + value + "\n")); };
    EXPECT_EQ(
        said("{}"),
        Lines{"5: inputs.wind: expected 'file' or 'files' with u and v, 'table', 'windninja', or 'speed' and 'from_deg'"});
    EXPECT_EQ(said("3"), Lines{"5: inputs.wind: expected a map of keys, found '3'"});
    EXPECT_EQ(said("{speed: 3}"), Lines{"5: inputs.wind: key 'from_deg' is missing (where the wind comes from)"});
    EXPECT_EQ(said("{from_deg: 3}"), Lines{"5: inputs.wind: key 'speed' is missing"});
    EXPECT_EQ(said("{speed: -3, from_deg: 0}"), Lines{"5: inputs.wind.speed: must be between 0 and 100, found -3"});
    EXPECT_EQ(said("{speed: 3, speed_m_s: 3, from_deg: 0}"), Lines{"5: inputs.wind: give 'speed' or 'speed_m_s', not both"});
    EXPECT_EQ(said("{file: wind.tif, speed: 3, from_deg: 0}"),
              Lines{"5: inputs.wind: give rasters or 'speed' and 'from_deg', not both"});
    EXPECT_EQ(said("{file: wind.tif, bands: [1]}"),
              Lines{"5: inputs.wind.bands: expected pairs of band numbers (u, v of each frame), found 1 numbers"});
    EXPECT_EQ(said("{file: wind.tif, bands: [v, u]}"),
              (Lines{"5: inputs.wind.bands[0]: expected a whole number, found 'v'",
                     "5: inputs.wind.bands[1]: expected a whole number, found 'u'"}));
    EXPECT_EQ(said("{file: wind.tif, band: 1}"), Lines{"5: inputs.wind: unknown key 'band'; did you mean 'bands'?"});
}

TEST(Inputs, CoverNamesAShippedTableOrAFile) {
    const ScenarioFolder folder;
    const auto table = [&](const std::string& name) {
        return folder.load(with_inputs("  cover: {file: classes.tif, table: " + name + "}\n")).inputs.cover.value().table;
    };
    EXPECT_EQ(table("fbfm13"), "fbfm13");
    EXPECT_EQ(table("fbfm40"), "fbfm40");
    EXPECT_EQ(table("classes.csv"), (folder.path() / "classes.csv").string());
    const auto said = [&](const std::string& value) { return folder.problems(with_inputs("  cover: " + value + "\n")); };
    EXPECT_EQ(said("{file: classes.tif}"), Lines{"5: inputs.cover: key 'table' is missing"});
    EXPECT_EQ(said("{file: classes.tif, table: landfire}"),
              Lines{"5: inputs.cover.table: 'landfire' is none of fbfm13, fbfm40, fbfm53 or a CSV file"});
    EXPECT_EQ(said("{file: classes.tif, table: no.csv}"),
              Lines{"5: inputs.cover.table: file 'no.csv' does not exist (" + (folder.path() / "no.csv").string() + ")"});
}

TEST(Inputs, PathsStartAtTheScenario) {
    const ScenarioFolder folder;
    const std::string inside = "../" + folder.path().filename().string() + "/heat.tif";
    EXPECT_EQ(folder.load(with_heat_flux("{file: " + inside + "}")).inputs.heat_flux.files,
              std::vector{folder.path() / "heat.tif"});
    const std::string absolute = (folder.path() / "heat.tif").string();
    EXPECT_EQ(folder.load(with_heat_flux("{file: " + absolute + "}")).inputs.heat_flux.files,
              std::vector{folder.path() / "heat.tif"});
}

}  // namespace pyroscene::scenario
