#include "drawing/qgis_style.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

TEST(QgisStyle, RangesAreThoseOfBlackBodiesAndOfSunlight) {
    const auto thermal = drawing::radiance_colours(4.0);
    EXPECT_DOUBLE_EQ(thermal.front().value, radiometry::planck_radiance(4.0, 280.0));
    EXPECT_DOUBLE_EQ(thermal.back().value, radiometry::planck_radiance(4.0, 700.0));
    // Half of the sun's 1550 W m-2 um-1 at 0.65 um: 250 W m-2 sr-1 um-1.
    EXPECT_NEAR(drawing::radiance_colours(0.65).back().value, 250.0, 20.0);
    const auto power = drawing::power_ladder(250.0);
    ASSERT_EQ(power.size(), 6u);
    for (std::size_t k = 0; k < power.size(); ++k) EXPECT_DOUBLE_EQ(power[k].value, 50.0 * static_cast<double>(k));
}

TEST(QgisStyle, StandsBesideTheRaster) {
    const auto folder = std::filesystem::temp_directory_path() / "pyroscene_qgis_style";
    std::filesystem::create_directories(folder);
    drawing::write_qgis_style(folder / "ortho_frp.tif", {2, "MW", drawing::power_ladder(250.0)});
    const auto text = read_text_file(folder / "ortho_frp.qml");
    EXPECT_NE(text.find("type=\"singlebandpseudocolor\" band=\"2\""), std::string::npos);
    EXPECT_NE(text.find("<item value=\"150\" color=\"#fd8d3c\" alpha=\"255\" label=\"150 MW\"/>"), std::string::npos);
    EXPECT_NE(text.find("minimumValue=\"0\" maximumValue=\"250\""), std::string::npos);
    drawing::write_qgis_style(folder / "fires.tif",
                              std::vector<drawing::ClassStyle>{{5, "#bfc8b4", "no fire"}, {9, "#d50000", "fire"}});
    const auto classes = read_text_file(folder / "fires.qml");
    EXPECT_NE(classes.find("type=\"paletted\" band=\"1\""), std::string::npos);
    EXPECT_NE(classes.find("<paletteEntry value=\"9\" color=\"#d50000\" alpha=\"255\" label=\"fire\"/>"), std::string::npos);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pyroscene::pipeline
