// Speed and direction in two rasters, as WindNinja writes them.
#include "gis/polar_wind.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

/// As programs of ESRI's kind write it.
constexpr const char* kPrj =
    "PROJCS[\"WGS_1984_UTM_Zone_11N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298."
    "257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
    "PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",-117.0],"
    "PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";

class PolarWindFiles : public ::testing::Test {
protected:
    /// ESRI ASCII grids of 2 x 2 cells of 100 m; -9999 = no data.
    void write(const std::string& name, const std::string& rows, bool with_prj = true) const {
        std::ofstream(folder_ / (name + ".asc"))
            << "ncols 2\nnrows 2\nxllcorner 700000\nyllcorner 5100000\ncellsize 100\nNODATA_value -9999\n"
            << rows;
        if (with_prj) std::ofstream(folder_ / (name + ".prj")) << kPrj;
    }
    [[nodiscard]] PolarWind pair() const { return {folder_ / "hill_vel.asc", folder_ / "hill_ang.asc", "mph", ""}; }
    [[nodiscard]] static Wind read(const std::filesystem::path& file) {
        return read_wind(file, 1, 2, make_map_grid(file, {}, {}));
    }
    TempFolder folder_;
};

TEST_F(PolarWindFiles, DirectionsSayWhereTheWindComesFrom) {
    write("hill_vel", "10 10\n0 -9999\n");
    write("hill_ang", "270 0\n-9999 90\n");
    auto wind = pair();
    wind.grid_north = true;
    const auto w = read(wind_components(wind));
    constexpr double kTenMph_m_s = 4.4704;
    EXPECT_NEAR(w.east_m_s.at(0, 0), kTenMph_m_s, 1e-6);
    EXPECT_NEAR(w.north_m_s.at(0, 0), 0.0, 1e-6);
    EXPECT_NEAR(w.east_m_s.at(0, 1), 0.0, 1e-6);
    EXPECT_NEAR(w.north_m_s.at(0, 1), -kTenMph_m_s, 1e-6);
    EXPECT_EQ(w.east_m_s.at(1, 0), 0.0F);  // calm air needs no direction
    EXPECT_TRUE(std::isnan(w.east_m_s.at(1, 1)));
}

TEST_F(PolarWindFiles, GeoTiffsReadTheSame) {
    SourceRaster{.cols = 3, .rows = 2, .nodata = -9999.0}
        .band([](int col, int) { return col == 0 ? -9999.0 : 36.0; })
        .write(folder_ / "a_vel.tif");
    SourceRaster{.cols = 3, .rows = 2}.band([](int, int) { return 180.0; }).write(folder_ / "a_ang.tif");
    const auto w = read(wind_components({folder_ / "a_vel.tif", folder_ / "a_ang.tif", "km/h", "", true}));
    EXPECT_TRUE(std::isnan(w.north_m_s.at(0, 0)));
    EXPECT_NEAR(w.north_m_s.at(0, 2), 10.0, 1e-5);  // from the south
    EXPECT_NEAR(w.east_m_s.at(1, 1), 0.0, 1e-5);
}

TEST_F(PolarWindFiles, TrueNorthIsTurnedToTheMap) {
    write("hill_vel", "10 10\n10 10\n");
    write("hill_ang", "360 360\n360 360\n");
    const auto w = read(wind_components(pair()));
    // East of the central meridian the y axis points east of north: a wind from true north comes from the west of it.
    const double convergence = MapProjection("EPSG:32611").convergence_rad(700100.0, 5100100.0);
    EXPECT_GT(convergence, 0.02);
    EXPECT_NEAR(std::atan2(w.east_m_s.at(0, 0), -w.north_m_s.at(0, 0)), convergence, 1e-4);
}

TEST_F(PolarWindFiles, InterpolatesComponentsNotAngles) {
    write("hill_vel", "10 10\n10 10\n");
    write("hill_ang", "350 10\n350 10\n");
    auto wind = pair();
    wind.grid_north = true;
    const auto file = wind_components(wind);
    MapGrid fine = make_map_grid(file, {}, {});
    fine.cols *= 4, fine.rows *= 4, fine.cell_m /= 4.0;
    const auto w = read_wind(file, 1, 2, fine);
    for (int col = 0; col < 8; ++col) EXPECT_LT(w.north_m_s.at(3, col), -4.4) << col;  // from the north everywhere
    EXPECT_NEAR(w.east_m_s.at(3, 3) + w.east_m_s.at(3, 4), 0.0, 1e-6);
}

TEST_F(PolarWindFiles, JunkIsRefusedByName) {
    write("hill_vel", "10 10\n0 -9999\n");
    write("hill_ang", "270 0\n-9999 90\n");
    write("hill_cld", "0.1 0.2\n0.1 0.2\n");
    write("strong_vel", "10 400\n1 1\n");
    write("strong_ang", "270 0\n1 1\n");
    write("wide_ang", "270 1000\n1 1\n");
    write("bare_vel", "1 1\n1 1\n", false);
    SourceRaster{.cols = 2, .rows = 2}.band([](int, int) { return 90.0; }).write(folder_ / "other.tif");
    const auto says = [&](const std::string& speed, const std::string& angle, const std::string& crs = "") {
        return input_error_of([&] { (void)wind_components({folder_ / speed, folder_ / angle, "mph", crs}); });
    };
    EXPECT_NE(says("hill_vel.asc", "hill_cld.asc").find("cloud cover"), std::string::npos);
    EXPECT_NE(says("strong_vel.asc", "strong_ang.asc").find("178.816 m/s, expected 0 to 150; is its unit wrong?"),
              std::string::npos);
    EXPECT_NE(says("hill_vel.asc", "wide_ang.asc").find("angle of 1000 degrees"), std::string::npos);
    EXPECT_NE(says("hill_vel.asc", "other.tif").find("has not the pixels of"), std::string::npos);
    EXPECT_NE(says("bare_vel.asc", "hill_ang.asc").find("no coordinate reference system"), std::string::npos);
    EXPECT_NE(says("hill_vel.asc", "hill_ang.asc", "EPSG:32612").find("inputs.wind.windninja.crs"), std::string::npos);
    EXPECT_NO_THROW((void)wind_components({folder_ / "bare_vel.asc", folder_ / "hill_ang.asc", "mph", "EPSG:32611"}));
}

}  // namespace
}  // namespace pyroscene::gis
