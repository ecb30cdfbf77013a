// `pyroscene plot` and `pyroscene picture`.
#include <gtest/gtest.h>

#include "base/files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

/// Width and height that a PNG's header tells.
std::pair<int, int> png_size(const std::filesystem::path& file) {
    const auto bytes = file_bytes(file);
    if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG") return {0, 0};
    const auto number = [&](std::size_t at) {
        int value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = 256 * value + static_cast<unsigned char>(bytes[at + k]);
        return value;
    };
    return {number(16), number(20)};
}

TEST(PlotCommand, DrawsAndRefuses) {
    const ScratchFolder scratch;
    write_text_file(scratch / "t.csv", "x,y,z,kind\n1,1,5,a\n2,4,6,a\n1,2,7,b\n2,3,8,b\n");
    const auto csv = (scratch / "t.csv").string(), png = (scratch / "t.png").string();
    const auto drawn = pyroscene_cli("plot " + csv + " --x x --y y,z --by kind --points z --log-y -o " + png);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    EXPECT_EQ(png_size(png), std::pair(900, 480));
    const auto wrong = pyroscene_cli("plot " + csv + " --x x --y q -o " + png);
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_NE(wrong.output.find("t.csv"), std::string::npos) << wrong.output;
    EXPECT_NE(pyroscene_cli("plot " + csv + " --x x --y y --points z -o " + png).output.find("'z' is not among"),
              std::string::npos);
    EXPECT_EQ(pyroscene_cli("plot " + csv + " --x x -o " + png).exit_code, 2);
}

TEST(PictureCommand, ShowsBandsAndWindows) {
    const ScratchFolder scratch;
    gis::OutputRaster out;
    out.cols = 40, out.rows = 30;
    out.bands = {{"one", "K", {}, {}, {}}, {"two", "K", {}, {}, {}}};
    std::vector<float> pixels(2400);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i);
    gis::write_geotiff(scratch / "r.tif", out, pixels);
    const auto raster = (scratch / "r.tif").string(), one = (scratch / "one.png").string(),
               two = (scratch / "two.png").string(), part = (scratch / "part.png").string();
    ASSERT_EQ(pyroscene_cli("picture " + raster + " -o " + one).exit_code, 0);
    ASSERT_EQ(pyroscene_cli("picture " + raster + " --bands 1,2 --range 0,100 -o " + two).exit_code, 0);
    ASSERT_EQ(pyroscene_cli("picture " + raster + " --window 0,0,40,10 -o " + part).exit_code, 0);
    EXPECT_GT(png_size(two).first, 1.8 * png_size(one).first - 100);
    EXPECT_EQ(png_size(two).second, png_size(one).second);
    EXPECT_LT(png_size(part).second, png_size(one).second);
    EXPECT_NE(pyroscene_cli("picture " + raster + " --bands 3 -o " + one).output.find("has no band 3, it has 2"),
              std::string::npos);
    EXPECT_EQ(pyroscene_cli("picture " + raster + " --window 10,0,40,10 -o " + one).exit_code, 3);
    EXPECT_EQ(pyroscene_cli("picture " + raster + " --range 5,1 -o " + one).exit_code, 3);
}

}  // namespace
}  // namespace pyroscene::test
