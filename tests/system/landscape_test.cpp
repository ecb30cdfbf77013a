// A landscape file as one input: the same scene as its bands named one by one.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/raster_input.h"
#include "inputs/load_scenario.h"
#include "inputs/scene_inputs.h"
#include "inputs/wind_inputs.h"
#include "pipeline/fingerprint.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

class LandscapeScenario : public testing::Test {
protected:
    scenario::Scenario load(const std::string& name, const std::string& inputs) {
        const auto file = scratch / (name + ".yaml");
        std::ofstream(file) << "pyroscene: 1\ninputs:\n  wind: {speed: 5, from_deg: 110}\n"
                            << inputs << R"(
start: 2017-07-15T22:00:00Z
acquisitions:
  - {id: a, sensor: wasp, time_s: 600, platform: {over: centre, altitude_agl_m: 3000}}
)";
        return inputs::load_scenario(file);
    }
    static std::string lolo(const std::string& name) {
        return (source_folder() / "scenarios" / "lolo_peak" / name).string();
    }
    ScratchFolder scratch;
};

const std::string kFire =
    "    ignition: [{line: [[720958, 5175500], [720958, 5174700]]}]\n"
    "    moisture: {m1h_pct: 3, m10h_pct: 4, m100h_pct: 5, mherb_pct: 30, mwoody_pct: 60}\n    frames_s: [300, 900]\n";

TEST_F(LandscapeScenario, IsItsBandsNamedOneByOne) {
    const auto file = lolo("landscape.tif");
    const auto whole = load("whole", "  landscape: {file: " + file + ", scheme: fbfm40}\n  spread:\n" + kFire);
    const auto parts = load("parts", "  terrain: {file: " + file + ", band: 1}\n  cover: {file: " + file +
                                         ", band: 4, table: fbfm40}\n  spread:\n    fuel: {file: " + file +
                                         ", band: 4, table: fbfm40}\n    canopy: {cover: {file: " + file +
                                         ", band: 5}, height_m: {file: " + file + ", band: 6, scale: 0.1}}\n" + kFire);
    EXPECT_TRUE(whole.notes.empty());
    const auto a = inputs::load_scene_inputs(whole), b = inputs::load_scene_inputs(parts);
    EXPECT_EQ(a.grid, b.grid);
    EXPECT_EQ(a.terrain_m.values, b.terrain_m.values);
    EXPECT_EQ(a.cover.values, b.cover.values);
    ASSERT_TRUE(a.modelled && b.modelled);
    EXPECT_EQ(a.modelled->fuel_load_kg_m2.values, b.modelled->fuel_load_kg_m2.values);
    int burnt = 0, apart = 0;
    for (std::size_t i = 0; i < a.grid.size(); ++i) {
        const float t = a.modelled->ground.arrival_time_s.values[i], u = b.modelled->ground.arrival_time_s.values[i];
        burnt += std::isnan(t) ? 0 : 1;
        apart += std::isnan(t) != std::isnan(u) || std::abs(t - u) > 0.01F ? 1 : 0;
    }
    EXPECT_GT(burnt, 100);
    EXPECT_EQ(apart, 0);
}

TEST_F(LandscapeScenario, GivesAFireOfAnotherModelItsFuel) {
    const auto s = load("fuel", "  landscape: {file: " + lolo("landscape.tif") +
                                    ", scheme: fbfm40}\n  heat_flux: {file: " + lolo("heat_flux.tif") + "}\n");
    ASSERT_TRUE(s.inputs.fuel_load);
    ASSERT_EQ(s.notes.size(), 1U);
    const auto grid = gis::make_map_grid(s.inputs.terrain.files.front(), {}, {});
    // fuel_load.tif was computed by another program from the published table and rounded to 0.001 kg/m2.
    const auto mine =
        gis::read_band({s.inputs.fuel_load->files.front(), 1, gis::Resampling::Nearest, "load", "kg m-2"}, grid);
    const auto other = gis::read_band({lolo("fuel_load.tif"), 1, gis::Resampling::Nearest, "load", "kg m-2"}, grid);
    for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_NEAR(mine.values[i], other.values[i], 1e-3) << i;
}

TEST_F(LandscapeScenario, FilesAreThoseOnDisk) {
    const auto s = load("files", "  landscape: {file: " + lolo("canyon.lcp") + ", scheme: fbfm40}\n  spread:\n" + kFire);
    const auto files = inputs::input_files(s);
    EXPECT_EQ(files, std::vector<std::filesystem::path>{lolo("canyon.lcp")});
}

TEST_F(LandscapeScenario, AnotherSchemeOrPlaceIsAnotherFire) {
    const auto state = [&](const std::string& name, const std::string& more) {
        const auto s = load(name, "  landscape: {file: " + lolo("landscape.tif") + ", " + more +
                                      "}\n  heat_flux: {file: " + lolo("heat_flux.tif") + "}\n");
        return pipeline::Fingerprints(s).state(0.0);
    };
    const auto first = state("a", "scheme: fbfm40");
    EXPECT_EQ(state("b", "scheme: fbfm40"), first);
    EXPECT_NE(state("c", "scheme: fbfm53"), first);
    EXPECT_NE(state("d", "scheme: fbfm40, crs: 'EPSG:32611'"), first);
}

TEST_F(LandscapeScenario, WindOfAStationChangesRowByRow) {
    std::ofstream(scratch / "station.csv") << "time_s,speed_m_s,from_deg\n600,3,270\n1800,4,180\n";
    auto s = load("station", "  landscape: {file: " + lolo("canyon.lcp") + ", scheme: fbfm40}\n  spread:\n" + kFire);
    s.inputs.wind = scenario::WindSource{};
    s.inputs.wind->table = scratch / "station.csv";
    EXPECT_EQ(inputs::wind_times_s(s), (std::vector{600.0, 1800.0}));
    const auto grid = gis::make_map_grid(lolo("dem.tif"), {}, {});
    // Map north lies 2.1 deg off true north here: convergence = (114.14 W - 117 W) sin 46.69 N.
    const double turn = (117.0 - 114.1426) * std::sin(46.6906 * kDegree_rad) * kDegree_rad;
    const auto blows = [&](double time_s, double east, double north) {
        const auto wind = inputs::wind_at(s, grid, 1, 0, time_s);
        EXPECT_NEAR(wind.east_m_s.values[0], east * std::cos(turn) - north * std::sin(turn), 2e-3) << time_s;
        EXPECT_NEAR(wind.north_m_s.values[0], east * std::sin(turn) + north * std::cos(turn), 2e-3) << time_s;
    };
    blows(0.0, 3.0, 0.0);
    blows(1799.0, 3.0, 0.0);
    blows(1800.0, 0.0, 4.0);
    blows(9000.0, 0.0, 4.0);
}

}  // namespace
}  // namespace pyroscene::test
