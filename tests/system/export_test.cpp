// `pyroscene export` as a user types it: the thesis's lattice, conserved volume, exit codes.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <numeric>
#include <sstream>

#include "base/csv.h"
#include "base/files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

std::string thesis_scene() { return (source_folder() / "scenarios/thesis_grassfire/scenario.yaml").string(); }

// Frame 666 of 6 s in the thesis's text format and lattice: 142 x 142 x 64 voxels of 20 x 20 x 5 m, material 206.
TEST(Export, WritesFrame666LikeTheThesis) {
    const ScratchFolder scratch;
    const auto file = scratch / "666.grid";
    const auto result = pyroscene_cli(
        fmt::format("export {} --time_s 3996 --format dirsig-grid --voxel_m 20,20,5 --layers 64 --above-ground -o {}",
                    thesis_scene(), file.string()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    std::istringstream in(read_text_file(file));
    int nx = 0, ny = 0, nz = 0, rows = 0;
    in >> nx >> ny >> nz;
    EXPECT_EQ(nx, 142);
    EXPECT_EQ(ny, 142);
    EXPECT_EQ(nz, 64);
    int i = 0, j = 0, k = 0, material = 0;
    double T_K = 0.0, ppm = 0.0;
    while (in >> i >> j >> k >> material >> T_K >> ppm) {
        ++rows;
        ASSERT_TRUE(i >= 0 && i < nx && j >= 0 && j < ny && k >= 0 && k < nz);
        ASSERT_EQ(material, 206);
        ASSERT_TRUE(T_K > 300.0 && T_K < 1500.0);
        ASSERT_GE(ppm, 0.0);
    }
    EXPECT_TRUE(in.eof());
    EXPECT_GT(rows, 500);
    EXPECT_NE(read_text_file(file.string() + ".odb").find("DELTA_Z = 5"), std::string::npos);
}

TEST(Export, VoxelSizeDoesNotChangeTheVolume) {
    const ScratchFolder scratch;
    double volume_m3[2] = {};
    for (int n = 0; n < 2; ++n) {
        const auto file = scratch / fmt::format("{}.csv", n);
        const auto result = pyroscene_cli(fmt::format("export {} --acquisition wasp_3714s --format csv --voxel_m {} -o {}",
                                                      thesis_scene(), n == 0 ? "20,20,5" : "10,10,2", file.string()));
        ASSERT_EQ(result.exit_code, 0) << result.output;
        const auto volumes = read_csv(file).numbers("volume_m3");
        volume_m3[n] = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    }
    EXPECT_GT(volume_m3[0], 1000.0);
    EXPECT_NEAR(volume_m3[1] / volume_m3[0], 1.0, 2e-5);  // six printed digits per voxel
}

TEST(Export, ExitCodes) {
    const ScratchFolder scratch;
    const auto code = [&](const std::string& words) {
        return pyroscene_cli("export " + thesis_scene() + " -o " + (scratch / "x.csv").string() + " " + words).exit_code;
    };
    EXPECT_EQ(code("--format csv"), 2);
    EXPECT_EQ(code("--format csv --acquisition wasp_3714s --time_s 3000"), 2);
    EXPECT_EQ(code("--format obj --time_s 3000"), 2);
    EXPECT_EQ(code("--format csv --time_s 3000 --voxel_m 20,20"), 2);
    EXPECT_EQ(code("--format csv --acquisition nobody"), 3);
    EXPECT_EQ(code("--format csv --time_s -5"), 3);
    EXPECT_EQ(code("--format csv --time_s 3714 --layers 1"), 3);
    EXPECT_FALSE(std::filesystem::exists(scratch / "x.csv"));
    EXPECT_EQ(code("--format side-view --time_s 3714 --layers 1 --above-ground"), 1);  // no picture has this ending
    const auto picture = pyroscene_cli("export " + thesis_scene() + " -o " + (scratch / "x.png").string() +
                                       " --format side-view --time_s 3714 --layers 1 --above-ground");
    EXPECT_EQ(picture.exit_code, 0) << picture.output;
}

// 3714 s: cells above 1000 W m-2 as README.md of the scenario counts them (1453), in connected pieces.
TEST(Fronts, AreListedBesideTheStateAndInTheReport) {
    const ScratchFolder scratch;
    const auto result = pyroscene_cli(fmt::format("prepare {} -o {}", thesis_scene(), (scratch / "out").string()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto table = read_csv(scratch / "out/state/t000003714_fronts.csv");
    const auto cells = table.numbers("cells"), length_m = table.numbers("length_m");
    EXPECT_EQ(std::accumulate(cells.begin(), cells.end(), 0.0), 1453.0);
    EXPECT_GT(length_m[0], 2000.0);
    const auto report = read_text_file(scratch / "out/run.json");
    EXPECT_NE(report.find("\"fronts\""), std::string::npos);
    EXPECT_NE(report.find("\"largest_intensity_kW_m\""), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::test
