// The sample files of every fire model and wind source that a recipe names: accepted, run to images, and the fire where and when the
// reference has it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gis/raster_input.h"
#include "inputs/load_scenario.h"
#include "inputs/scene_inputs.h"
#include "pipeline/run.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

struct Source {
    const char* scenario;
    double typical_s, wrong_share;  ///< median |difference| of arrival; share of cells burnt in one but not in the other
};

std::filesystem::path sample(const std::string& file) { return source_folder() / "scenarios" / "fire_models" / file; }

std::vector<float> reference_arrival_s() {
    const auto grid = gis::make_map_grid(sample("dem.tif"), {}, {});
    auto minutes = gis::read_band(
        {.file = sample("pyretechnics.tif"), .resampling = gis::Resampling::Nearest, .name = "arrival", .unit = "s"}, grid);
    for (float& t : minutes.values) t *= 60.0F;
    return minutes.values;
}

class FireModelSample : public ::testing::TestWithParam<Source> {};

TEST_P(FireModelSample, BurnsWhereAndWhenTheReferenceDoes) {
    const ScratchFolder scratch;
    pipeline::RunOptions options;
    options.output = scratch / "out";
    options.threads = 2;
    RunReport report;
    pipeline::run(inputs::load_scenario(sample(std::string(GetParam().scenario) + ".yaml")), options, report);

    const auto found = gis::read_image(scratch / "out" / "spread" / "arrival.tif");
    const auto expected_s = reference_arrival_s();
    ASSERT_EQ(found.pixels.size(), expected_s.size());
    std::vector<double> off_s;
    std::size_t wrong = 0, burnt = 0;
    constexpr float kEnd_s = 1200.0F;  // of the scenarios; cells that burn within a minute of it may fall on either side
    for (std::size_t i = 0; i < expected_s.size(); ++i) {
        const bool a = found.pixels[i] <= kEnd_s, b = expected_s[i] <= kEnd_s;
        burnt += b ? 1 : 0;
        wrong += a != b && !(std::abs(expected_s[i] - kEnd_s) < 60.0F) ? 1 : 0;
        if (a && b) off_s.push_back(std::abs(static_cast<double>(found.pixels[i]) - static_cast<double>(expected_s[i])));
    }
    ASSERT_GT(off_s.size(), burnt / 2);
    std::nth_element(off_s.begin(), off_s.begin() + static_cast<std::ptrdiff_t>(off_s.size() / 2), off_s.end());
    EXPECT_LE(off_s[off_s.size() / 2], GetParam().typical_s);
    EXPECT_LE(static_cast<double>(wrong), GetParam().wrong_share * static_cast<double>(burnt));

    const auto image = gis::read_image(scratch / "out" / "camera" / "radiance.tif");
    const auto mwir = plane(image, 1);
    EXPECT_GT(*std::max_element(mwir.begin(), mwir.end()), 20.0 * *std::min_element(mwir.begin(), mwir.end()));
}

INSTANTIATE_TEST_SUITE_P(All, FireModelSample,
                         ::testing::Values(Source{"farsite", 0.02, 0.0}, Source{"flammap", 0.02, 0.0},
                                           Source{"pyretechnics", 0.001, 0.0}, Source{"forefire", 0.001, 0.0},
                                           Source{"cell2fire", 0.04, 0.0}, Source{"fds", 0.001, 0.0},
                                           Source{"quic_fire", 100.0, 0.12},  // known every 200 s on cells of 40 m
                                           Source{"elmfire", 60.0, 0.12},
                                           Source{"windninja", 120.0, 0.20} /* a wind of its own */,
                                           Source{"station_wind", 60.0, 0.12}),
                         [](const auto& parameter) { return std::string(parameter.param.scenario); });

/// A scenario whose files hold the heat flux 400 kW m-2 exp(-age / 60 s) of the reference fire at 600, 900 and 1200 s.
class FluxSample : public ::testing::TestWithParam<const char*> {};

TEST_P(FluxSample, HasTheHeatOfTheReferenceWhereItBurns) {
    const auto scenario = inputs::load_scenario(sample(std::string(GetParam()) + ".yaml"));
    const auto scene = inputs::load_scene_inputs(scenario);
    ASSERT_EQ(scene.frames.size(), 3U);
    const auto arrival_s = reference_arrival_s();
    for (std::size_t f = 0; f < 3; ++f) {
        const double time_s = 600.0 + 300.0 * static_cast<double>(f);
        EXPECT_EQ(scene.frames[f].time_s, time_s);
        const auto flux = inputs::load_frame(scenario, scene, f).heat_flux_W_m2;
        struct Sum {
            double heat = 0.0, east = 0.0, south = 0.0;
            void add(double value, double col, double row) { heat += value, east += value * col, south += value * row; }
        } found, expected;
        for (int row = 0; row < flux.grid.rows; ++row)
            for (int col = 0; col < flux.grid.cols; ++col) {
                const double age_s = time_s - arrival_s[flux.grid.index(row, col)];
                if (age_s >= 0.0) expected.add(4e5 * std::exp(-age_s / 60.0), col, row);
                if (const double v = flux.at(row, col); v > 0.0) found.add(v, col, row);
            }
        EXPECT_NEAR(found.heat / expected.heat, 1.0, 1e-4) << time_s;
        // Cells of 40 m spread their heat over those of 20 m, which leaves its centre where it is.
        EXPECT_NEAR(found.east / found.heat, expected.east / expected.heat, 0.3) << time_s;
        EXPECT_NEAR(found.south / found.heat, expected.south / expected.heat, 0.3) << time_s;
    }
}

TEST_P(FluxSample, BecomesAnImage) {
    const ScratchFolder scratch;
    pipeline::RunOptions options;
    options.output = scratch / "out";
    options.threads = 2;
    RunReport report;
    pipeline::run(inputs::load_scenario(sample(std::string(GetParam()) + ".yaml")), options, report);
    const auto mwir = plane(gis::read_image(scratch / "out" / "camera" / "radiance.tif"), 1);
    EXPECT_GT(*std::max_element(mwir.begin(), mwir.end()), 20.0 * *std::min_element(mwir.begin(), mwir.end()));
}

INSTANTIATE_TEST_SUITE_P(All, FluxSample, ::testing::Values("fds_heat_release", "quic_fire_surface", "quic_fire_energy"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace pyroscene::test
