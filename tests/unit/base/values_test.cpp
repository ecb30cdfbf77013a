// Constants, vectors, map grids and errors: small values everything else rests on.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/map_grid.h"
#include "base/raster.h"
#include "base/vec3.h"

namespace pyroscene {
namespace {

// CODATA 2018: first radiation constant for spectral radiance 1.191042972e-16 W m2 sr-1, second 1.438776877e-2 m K,
// Stefan-Boltzmann 5.670374419e-8 W m-2 K-4 = 2 pi^5 k^4 / (15 h^3 c^2).
TEST(Constants, AgreeWithCodata2018) {
    EXPECT_NEAR(kC1L_W_um4_m2_sr / 1.191042972e8, 1.0, 1e-9);
    EXPECT_NEAR(kC2_um_K / 14387.76877, 1.0, 1e-9);
    const double sigma = 2.0 * std::pow(kPi, 5) * std::pow(kBoltzmann_J_K, 4) /
                         (15.0 * std::pow(kPlanck_J_s, 3) * kLightSpeed_m_s * kLightSpeed_m_s);
    EXPECT_NEAR(kStefanBoltzmann_W_m2_K4 / sigma, 1.0, 1e-9);
}

TEST(Vec3, ProductsOfTheAxes) {
    constexpr Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    EXPECT_EQ(cross(x, y), z);
    EXPECT_EQ(cross(y, z), x);
    EXPECT_EQ(cross(z, x), y);
    EXPECT_EQ(dot(x + 2.0 * y, y), 2.0);
    EXPECT_EQ(lerp(x, y, 0.25), (Vec3{0.75, 0.25, 0.0}));
    EXPECT_DOUBLE_EQ(length(Vec3{2.0, 3.0, 6.0}), 7.0);
    EXPECT_DOUBLE_EQ(length(normalized(Vec3{-5.0, 1.0, 2.0})), 1.0);
}

TEST(MapGrid, CountsCornersAtIntegersFromTheNorthWest) {
    const MapGrid grid{.cols = 4, .rows = 3, .west_m = 100.0, .north_m = 1000.0, .cell_m = 20.0, .crs_wkt = ""};
    EXPECT_EQ(grid.size(), 12u);
    EXPECT_EQ(grid.index(2, 3), 11u);
    EXPECT_EQ(grid.east_m(), 180.0);
    EXPECT_EQ(grid.south_m(), 940.0);
    EXPECT_EQ(grid.x_centre_m(0), 110.0);
    EXPECT_EQ(grid.y_centre_m(0), 990.0);
    EXPECT_EQ(grid.col_at(110.0), 0.5);
    EXPECT_EQ(grid.row_at(945.0), 2.75);
    EXPECT_TRUE(grid.contains(2, 3));
    EXPECT_FALSE(grid.contains(3, 0));
    EXPECT_FALSE(grid.contains(0, -1));
}

TEST(Raster, IsRowMajor) {
    Raster<float> r({.cols = 3, .rows = 2, .cell_m = 1.0, .crs_wkt = ""}, "heat_flux", "W m-2", -1.0f);
    r.at(1, 2) = 5.0f;
    EXPECT_EQ(r.values, (std::vector<float>{-1, -1, -1, -1, -1, 5}));
}

TEST(Error, SaysWhereAndWhoHasToAct) {
    EXPECT_STREQ(input_error("dem.tif", "has no CRS").what(), "dem.tif: has no CRS");
    EXPECT_STREQ(runtime_error("", "disk full").what(), "disk full");
    EXPECT_EQ(input_error("a", "b").kind(), ErrorKind::Input);
    EXPECT_EQ(runtime_error("a", "b").kind(), ErrorKind::Runtime);
}

}  // namespace
}  // namespace pyroscene
