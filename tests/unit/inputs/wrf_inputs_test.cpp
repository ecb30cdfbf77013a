// A scenario on a history file of WRF-SFIRE: what it takes from there, what it says of it, what it refuses.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "inputs/load_scenario.h"
#include "inputs/scene_inputs.h"
#include "unit/base/temp_folder.h"
#include "unit/gis/wrf_file.h"

namespace pyroscene::inputs {
namespace {

class WrfInputs : public ::testing::Test {
protected:
    scenario::Scenario load(const gis::WrfTestFile& file, const std::string& more = "",
                            const std::string& beside = "") const {
        file.write(folder_ / "wrfout_d01");
        std::ofstream(folder_ / "scenario.yaml") << "pyroscene: 1\ninputs:\n  wrf_sfire: {file: wrfout_d01" << more << "}\n"
                                                 << beside
                                                 << "start: 2020-07-01T17:59:30Z\nacquisitions:\n  - {id: a, sensor: wasp, "
                                                    "time_s: 40, platform: {over: centre, altitude_agl_m: 3000}}\n";
        return load_scenario(folder_ / "scenario.yaml");
    }
    [[nodiscard]] std::string refusal(const gis::WrfTestFile& file, const std::string& more = "") const {
        try {
            (void)load(file, more);
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    }
    static std::string notes(const scenario::Scenario& s) { return fmt::format("{}", fmt::join(s.notes, "\n")); }
    TempFolder folder_;
};

TEST_F(WrfInputs, HeatOfBothGridsIsCompared) {
    EXPECT_EQ(notes(load({})).find("GRNHFX"), std::string::npos) << notes(load({}));
    gis::WrfTestFile file;
    file.coarse_heat = 1.01;
    EXPECT_NE(notes(load(file)).find("GRNHFX of the atmosphere's grid"), std::string::npos);
    file = {};
    file.latent_heat = 0.5;
    EXPECT_NE(notes(load(file)).find("FGRNQFX is 0.5 of FGRNHFX, but fuel of moisture 0.08 gives 0.0918"), std::string::npos)
        << notes(load(file));
}

TEST_F(WrfInputs, MissingFieldsAreNamed) {
    EXPECT_NE(refusal({.left_out = {"FGRNHFX"}}).find("has no FGRNHFX"), std::string::npos);
    EXPECT_NE(refusal({.left_out = {"ZSF"}}).find("neither ZSF nor HGT"), std::string::npos);
    EXPECT_NE(notes(load({.left_out = {"TIGN_G"}})).find("no TIGN_G"), std::string::npos);
    EXPECT_NE(notes(load({.left_out = {"FGIP"}})).find("no FUEL_FRAC and FGIP"), std::string::npos);
    EXPECT_NE(notes(load({.left_out = {"UF"}})).find("calm air"), std::string::npos);
}

TEST_F(WrfInputs, WindOfTheFileMayHaveAHeight) {
    const auto s = load({}, "", "  wind: {height: 10m, fuel_depth_m: 0.762}\n");
    const auto in = load_scene_inputs(s);
    const auto frame = load_frame(s, in, 0);
    // UF = 3 m/s in the whole file; on its own map nothing is turned. 2.5 ft of fuel: midflame 0.439515 of the wind at 20 ft.
    EXPECT_NEAR(frame.wind_east_m_s.at(2, 2), 3.0 / 1.15, 1e-5);
    ASSERT_TRUE(in.front.midflame_wind);
    EXPECT_NEAR(in.front.midflame_wind->at(2, 2), 0.439515, 1e-6);
}

TEST_F(WrfInputs, PlumeIsThatOfTheRecordBefore) {
    const auto s = load({}, ", plume: true");
    ASSERT_TRUE(s.inputs.plume);
    // The first record, 30 s after the start, has no heating; the second, 10 s later, has.
    const auto band = [&](double time_s) {
        const auto file = wrf_plume_levels(s, time_s);
        return gis::read_band({.file = file, .band = 3, .name = "excess", .unit = "K"}, gis::make_map_grid(file, {}, {}));
    };
    for (const float v : band(35.0).values) EXPECT_EQ(v, 0.0F);
    for (const float v : band(40.0).values) EXPECT_GT(v, 0.0F);
    EXPECT_THROW((void)wrf_plume_levels(s, 20.0), Error);
    // The file's heating has nothing to do with its flux.
    EXPECT_NE(notes(s).find("RTHFRTEN heats the air with"), std::string::npos);
    EXPECT_NE(refusal({.left_out = {"RTHFRTEN", "PHB", "MU"}}, ", plume: true")
                  .find("has no RTHFRTEN, PHB, MU, which inputs.wrf_sfire.plume needs"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::inputs
