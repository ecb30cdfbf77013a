// The sample files of every fire model and wind source that a recipe names: accepted, run to images, and the fire where and when the
// reference has it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gis/raster_input.h"
#include "inputs/load_scenario.h"
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

}  // namespace
}  // namespace pyroscene::test
