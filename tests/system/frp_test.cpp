// `pyroscene frp` on planted fires of known area and temperature: 1 km pixels, background 300 K, two bands.
#include <gtest/gtest.h>

#include <cmath>

#include "base/csv.h"
#include "base/files.h"
#include "gis/crs.h"
#include "radiometry/planck.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr int kCols = 60, kRows = 40;

struct Planted {
    int col, row;
    double temperature_K, area_m2, power_MW, mir_MW;  ///< last two: true and by the MIR method with a = 3.0e-9
};
// Analytic pixels, computed with an independent program.
const std::vector<Planted> kPlanted{{10, 10, 1000.0, 1000.0, 56.2, 62.7},
                                    {40, 8, 1000.0, 10000.0, 562.0, 627.0},
                                    {25, 30, 800.0, 1000.0, 22.8, 24.9},
                                    {50, 31, 600.0, 10000.0, 68.9, 54.2},
                                    {5, 33, 1100.0, 1000.0, 82.6, 88.2}};

double band(double T_K, double lower_um, double upper_um) {
    return radiometry::band_radiance(T_K, lower_um, upper_um) / (upper_um - lower_um);
}

void write_image(const std::filesystem::path& file, const std::string& crs, double west, double north, double cell) {
    gis::OutputRaster out;
    out.cols = kCols, out.rows = kRows;
    MapGrid grid;
    grid.cols = kCols, grid.rows = kRows, grid.cell_m = cell, grid.west_m = west, grid.north_m = north;
    grid.crs_wkt = gis::parse_crs(crs, "test").wkt;
    out.grid = grid;
    out.acquisition_time = "2019-08-01T19:05:00Z";
    std::vector<float> pixels;
    for (const auto& [lower, upper] : {std::pair{3.929, 3.989}, {10.78, 11.28}}) {
        out.bands.push_back({"", "W m-2 sr-1 um-1", 0.5 * (lower + upper), upper - lower, {}});
        for (int row = 0; row < kRows; ++row)
            for (int col = 0; col < kCols; ++col) {
                double L = band(300.0, lower, upper);
                for (const auto& fire : kPlanted)
                    if (fire.col == col && fire.row == row)
                        L += fire.area_m2 * 1e-6 * (band(fire.temperature_K, lower, upper) - L);
                pixels.push_back(static_cast<float>(L));
            }
    }
    gis::write_cog(file, out, pixels);
}

TEST(FrpCommand, FindsThePowerOfPlantedFires) {
    const ScratchFolder scratch;
    // UTM: the scale of the map at 3 degrees from the central meridian leaves areas within 0.2 %.
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    for (const std::string method : {"mir", "bispectral"}) {
        const auto out = scratch / (method + ".tif");
        const auto result = pyroscene_cli("frp " + (scratch / "modis.tif").string() + " --coefficient modis --method " +
                                          method + " -o " + out.string());
        ASSERT_EQ(result.exit_code, 0) << result.output;
        EXPECT_NE(result.output.find("5 fire pixels, 0 without"), std::string::npos) << result.output;
        const auto image = gis::read_image(out);
        const auto power = plane(image, 1), mask = plane(image, 2);
        for (const auto& fire : kPlanted) {
            const auto i = static_cast<std::size_t>(fire.row * kCols + fire.col);
            EXPECT_EQ(mask[i], 1.0);
            EXPECT_NEAR(power[i] / (method == "mir" ? fire.mir_MW : fire.power_MW), 1.0, 0.006)
                << fire.temperature_K << ' ' << method;
            if (method == "bispectral") {
                EXPECT_NEAR(plane(image, 3)[i] * 1e6, fire.area_m2, 2e-3 * fire.area_m2);
                EXPECT_NEAR(plane(image, 4)[i], fire.temperature_K, 1.0);
            }
        }
        EXPECT_TRUE(std::isnan(power[0]));
        const auto pixels = read_csv(scratch / (method + "_pixels.csv")),
                   fires = read_csv(scratch / (method + "_fires.csv"));
        ASSERT_EQ(pixels.rows.size(), kPlanted.size());
        EXPECT_EQ(pixels.columns.front(), "latitude");
        EXPECT_EQ(pixels.rows[0][pixels.column("acq_time")], "1905");
        EXPECT_NEAR(pixels.numbers("scan")[0], 1.0, 0.002);
        EXPECT_NEAR(fires.numbers("frp_MW")[0], method == "mir" ? 627.0 : 562.0, 4.0);
        EXPECT_NEAR(fires.numbers("longitude")[0], -117.0 + 0.2684, 0.002);  // 520.5 km east: 20.5 km from the meridian
    }
}

TEST(FrpCommand, FitsTheCoefficientAndCorrectsForTheAir) {
    const ScratchFolder scratch;
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    const auto total = [&](const std::string& options) {
        const auto result = pyroscene_cli("frp " + (scratch / "modis.tif").string() + " " + options + " -o " +
                                          (scratch / "out.tif").string());
        EXPECT_EQ(result.exit_code, 0) << result.output;
        double sum = 0.0;
        for (const double MW : read_csv(scratch / "out_fires.csv").numbers("frp_MW")) sum += MW;
        return sum;
    };
    const double fitted = total(""), half = total("--mir-transmittance 0.5"), given = total("--coefficient 2.9193e-9");
    EXPECT_NEAR(fitted / given, 1.0, 1e-3);
    EXPECT_NEAR(half / fitted, 2.0, 1e-4);
    EXPECT_GT(total("--no-background"), fitted);
}

TEST(FrpCommand, RefusesWhatItCannotUse) {
    const ScratchFolder scratch;
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    const auto expect = [&](const std::string& arguments, int code, const std::string& text) {
        const auto result = pyroscene_cli("frp " + arguments);
        EXPECT_EQ(result.exit_code, code) << result.output;
        EXPECT_NE(result.output.find(text), std::string::npos) << result.output;
    };
    const auto image = (scratch / "modis.tif").string();
    expect(image + " --coefficient best", 2, "'best' is neither a number");
    expect(image + " --mir-band 3", 3, "no band 3; it has 2");
    expect((scratch / "none.tif").string(), 3, "none.tif");
    const auto dem = (source_folder() / "scenarios/minimal/dem.tif").string();
    expect(dem, 3, "no band between 3 and 5 um");
    EXPECT_FALSE(std::filesystem::exists(scratch / "modis_frp.tif"));
}

}  // namespace
}  // namespace pyroscene::test
