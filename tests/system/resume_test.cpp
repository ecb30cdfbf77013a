// A run that stops and resumes from its saved states must leave the same files, to the byte, as one that went straight through.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "base/csv.h"
#include "gis/crs.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr int kFrames = 5;

/// A fire whose hottest cell flares up more in every frame, so that its history sheds embers; frames are 3 s apart.
void write_fire(const ScratchFolder& folder) {
    MapGrid grid{.cols = 12, .rows = 10, .west_m = 500000.0, .north_m = 4600000.0, .cell_m = 20.0, .crs_wkt = ""};
    grid.crs_wkt = gis::parse_map_crs("EPSG:32611", "test").wkt;
    write_band(folder / "dem.tif", grid, "m", [](double x, double y) { return 100.0 + 0.01 * (x - y + 4100000.0); });
    std::string files;
    for (int frame = 0; frame < kFrames; ++frame) {
        write_band(folder / fmt::format("flux{}.tif", frame), grid, "W m-2", [&](double x, double) {
            const double from_front = std::abs(x - 500070.0 - 20.0 * frame) / 20.0;
            return from_front > 1.6 ? 0.0 : 4e5 * (1.0 + frame * frame) / (1.0 + from_front);
        });
        files += fmt::format("{}flux{}.tif", frame > 0 ? ", " : "", frame);
    }
    std::ofstream(folder / "scenario.yaml") << fmt::format(R"(pyroscene: 1
name: resume
inputs:
  terrain: {{file: dem.tif}}
  heat_flux: {{files: [{}], times_s: [0, 3, 6, 9, 12]}}
  wind: {{speed: 4, from_deg: 250}}
start: 2020-06-01T20:00:00Z
atmosphere: {{model: none}}
acquisitions:
  - {{id: shot, sensor: generic-framing, time_s: 13, platform: {{over: centre, altitude_agl_m: 1800}}}}
)",
                                                           files);
}

std::string state_name(int frame) { return fmt::format("state/t{:09}.tif", 3 * frame); }
std::string ember_name(int frame) { return fmt::format("state/t{:09}_embers.csv", 3 * frame); }

TEST(Resume, LeavesTheSameBytesAsAStraightRun) {
    const ScratchFolder folder;
    write_fire(folder);
    const auto prepare = [&](const std::string& output) {
        const auto result =
            pyroscene_cli(fmt::format("prepare {} -o {}", (folder / "scenario.yaml").string(), (folder / output).string()));
        ASSERT_EQ(result.exit_code, 0) << result.output;
    };
    prepare("straight");
    // The history is worth the test: pockets of several frames are alive in the last one.
    const auto releases = read_csv(folder / "straight" / ember_name(kFrames - 1)).numbers("release_s");
    ASSERT_GT(releases.size(), 8U);
    EXPECT_LT(*std::min_element(releases.begin(), releases.end()), 9.5);

    std::filesystem::copy(folder / "straight", folder / "stopped", std::filesystem::copy_options::recursive);
    for (const int frame : {2, 3, 4}) {
        std::filesystem::remove(folder / "stopped" / state_name(frame));
        std::filesystem::remove(folder / "stopped" / ember_name(frame));
    }
    prepare("stopped");
    for (int frame = 0; frame < kFrames; ++frame) {
        EXPECT_EQ(file_bytes(folder / "stopped" / state_name(frame)), file_bytes(folder / "straight" / state_name(frame)));
        if (!std::filesystem::exists(folder / "straight" / ember_name(frame))) continue;
        EXPECT_EQ(file_bytes(folder / "stopped" / ember_name(frame)), file_bytes(folder / "straight" / ember_name(frame)));
    }
}

}  // namespace
}  // namespace pyroscene::test
