// `pyroscene compare` on an image and its own copy, moved and altered by known amounts.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "base/files.h"
#include "base/random.h"
#include "gis/crs.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

/// 300 x 221 pixels of 5 m: ground with texture and a ring of fire; the picture moved by (east, north) metres.
void write_fire(const std::filesystem::path& file, double east_m, double north_m, double offset, double noise) {
    gis::OutputRaster out;
    out.cols = 300, out.rows = 221;
    MapGrid grid;
    grid.cols = 300, grid.rows = 221, grid.cell_m = 5.0, grid.west_m = 500000.0, grid.north_m = 4000000.0;
    grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
    out.grid = grid;
    out.bands.push_back({"brightness temperature", "K", 3.9, 0.4, {}});
    std::vector<float> pixels;
    for (int row = 0; row < 221; ++row)
        for (int col = 0; col < 300; ++col) {
            const double x = (col + 0.5) * 5.0 - east_m, y = (row + 0.5) * 5.0 + north_m;
            const double ground =
                300.0 + 3.0 * std::sin(x / 31.0) * std::cos(y / 23.0) + 2.0 * std::sin(x / 11.0 + y / 17.0);
            const double ring = std::hypot(x - 700.0, 1.4 * (y - 520.0)) - 260.0;
            const double random = noise * standard_normal({7, 0, 0}, static_cast<std::uint64_t>(row * 300 + col));
            pixels.push_back(static_cast<float>(ground + 300.0 * std::exp(-ring * ring / 400.0) + offset + random));
        }
    gis::write_cog(file, out, pixels);
}

TEST(CompareCommand, FindsAKnownShiftAndOffset) {
    const ScratchFolder scratch;
    write_fire(scratch / "synthetic.tif", 0.0, 0.0, 0.0, 0.0);
    write_fire(scratch / "real.tif", 23.0, -11.0, 1.5, 0.3);
    const auto out = (scratch / "out").string();
    const auto result = pyroscene_cli("compare " + (scratch / "synthetic.tif").string() + " " +
                                      (scratch / "real.tif").string() + " -o " + out);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto scores = nlohmann::json::parse(read_text_file(out + "/scores.json"));
    EXPECT_NEAR(scores.at("shift_east_m").get<double>(), -23.0, 1.0);  // a fifth of a pixel
    EXPECT_NEAR(scores.at("shift_north_m").get<double>(), 11.0, 1.0);
    const auto& band = scores.at("bands").at(0);
    EXPECT_NEAR(band.at("bias").get<double>(), -1.5, 0.1);
    EXPECT_GT(band.at("correlation").get<double>(), 0.99);
    EXPECT_GT(band.at("fire_dice").get<double>(), 0.95);
    EXPECT_LT(band.at("front_distance_mean_m").get<double>(), 2.0);
    const auto html = read_text_file(out + "/report.html");
    EXPECT_NE(html.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(html.find("</html>"), std::string::npos);
    const auto difference = gis::read_image(out + "/difference.tif");
    EXPECT_EQ(difference.bands[0].unit, "K");
    EXPECT_FALSE(difference.metadata.contains("synthetic"));

    const auto as_they_lie = pyroscene_cli("compare " + (scratch / "synthetic.tif").string() + " " +
                                           (scratch / "real.tif").string() + " --no-registration --threshold 450 -o " + out);
    ASSERT_EQ(as_they_lie.exit_code, 0) << as_they_lie.output;
    const auto apart = nlohmann::json::parse(read_text_file(out + "/scores.json")).at("bands").at(0);
    EXPECT_LT(apart.at("fire_dice").get<double>(), 0.8);
    EXPECT_NEAR(apart.at("fire_threshold").get<double>(), 450.0, 1e-9);
    EXPECT_GT(apart.at("front_distance_mean_m").get<double>(), 8.0);
}

TEST(CompareCommand, AnImageEqualsItself) {
    const ScratchFolder scratch;
    write_fire(scratch / "a.tif", 0.0, 0.0, 0.0, 0.0);
    const auto a = (scratch / "a.tif").string(), out = (scratch / "out").string();
    ASSERT_EQ(pyroscene_cli("compare " + a + " " + a + " -o " + out).exit_code, 0);
    const auto scores = nlohmann::json::parse(read_text_file(out + "/scores.json"));
    EXPECT_NEAR(scores.at("shift_east_m").get<double>(), 0.0, 1e-6);
    EXPECT_EQ(scores.at("bands").at(0).at("fire_dice").get<double>(), 1.0);
    EXPECT_NEAR(scores.at("bands").at(0).at("ssim").get<double>(), 1.0, 1e-6);
}

TEST(CompareCommand, RefusesWhatCannotBeCompared) {
    const ScratchFolder scratch;
    write_fire(scratch / "a.tif", 0.0, 0.0, 0.0, 0.0);
    const auto a = (scratch / "a.tif").string();
    const auto dem = (source_folder() / "scenarios/minimal/dem.tif").string();
    const auto none = pyroscene_cli("compare " + a + " " + (scratch / "none.tif").string());
    EXPECT_EQ(none.exit_code, 3);
    EXPECT_NE(none.output.find("none.tif"), std::string::npos) << none.output;
    EXPECT_EQ(pyroscene_cli("compare " + a + " " + dem + " -o " + (scratch / "out").string()).exit_code,
              3);  // other unit, other place
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

}  // namespace
}  // namespace pyroscene::test
