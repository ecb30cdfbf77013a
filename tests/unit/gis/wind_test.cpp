#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

constexpr double kE2 = 6.69437999014e-3;

/// Grid convergence of UTM from closed forms (see geodesy_test.cpp), positive where grid north lies east of true north.
double utm_convergence_rad(double lat_deg, double from_central_meridian_deg) {
    const double lat = lat_deg * kDegree_rad, dlon = from_central_meridian_deg * kDegree_rad;
    const double eta2 = kE2 / (1.0 - kE2) * std::pow(std::cos(lat), 2);
    return std::atan(std::tan(dlon) * std::sin(lat)) + std::pow(dlon, 3) * std::sin(lat) * std::pow(std::cos(lat), 2) * eta2;
}

MapGrid grid_around(int epsg, double lat_deg, double lon_deg, double cell_m, int cells) {
    const auto [x, y] = MapProjection("EPSG:" + std::to_string(epsg)).to_map(lat_deg, lon_deg);
    return {.cols = cells,
            .rows = cells,
            .west_m = x - 0.5 * cells * cell_m,
            .north_m = y + 0.5 * cells * cell_m,
            .cell_m = cell_m,
            .crs_wkt = wkt_of(epsg)};
}

SourceRaster geographic_wind(double lat_deg, double lon_deg, double u_m_s, double v_m_s) {
    SourceRaster wind{
        .cols = 60, .rows = 60, .geotransform = {lon_deg - 0.3, 0.01, 0.0, lat_deg + 0.3, 0.0, -0.01}, .crs = "EPSG:4326"};
    wind.band([=](int, int) { return u_m_s; }, "m/s").band([=](int, int) { return v_m_s; }, "m/s");
    return wind;
}

struct Place {
    int epsg;
    double lat_deg, lon_deg, central_meridian_deg;
};
const Place kPlaces[] = {{32611, 46.69, -114.14, -117.0}, {32611, 46.69, -119.9, -117.0}, {32756, -33.8, 150.3, 153.0}};

// A vector (east E, north N) has the components  E cos g - N sin g  and  E sin g + N cos g  on axes whose north lies g clockwise.
TEST(Wind, EastWindOnUtmIsTurnedByTheConvergence) {
    for (const auto& p : kPlaces) {
        const TempFolder folder;
        geographic_wind(p.lat_deg, p.lon_deg, 10.0, 0.0).write(folder / "wind.tif");
        const MapGrid grid = grid_around(p.epsg, p.lat_deg, p.lon_deg, 200.0, 50);
        const Wind wind = read_wind(folder / "wind.tif", 1, 2, grid);
        EXPECT_EQ(wind.east_m_s.unit, "m s-1");
        const MapProjection map(grid.crs_wkt);
        double largest = 0.0;
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col) {
                const Geodetic at = map.to_geodetic(grid.x_centre_m(col), grid.y_centre_m(row));
                const double g = utm_convergence_rad(at.lat_deg, at.lon_deg - p.central_meridian_deg);
                ASSERT_NEAR(wind.east_m_s.at(row, col), 10.0 * std::cos(g), 2e-6);
                ASSERT_NEAR(wind.north_m_s.at(row, col), 10.0 * std::sin(g), 2e-6);
                largest = std::max(largest, std::abs(g));
            }
        EXPECT_GT(largest, 0.025);  // the rotation matters: 25 mrad are 0.25 m/s of cross wind
    }
}

TEST(Wind, BetweenNeighbouringZonesTurnsByTheDifference) {
    const TempFolder folder;
    const double lat = 46.69, lon = -114.0;
    const MapGrid from = grid_around(32611, lat, lon, 100.0, 80);
    SourceRaster source{
        .cols = 80, .rows = 80, .geotransform = {from.west_m, 100.0, 0.0, from.north_m, 0.0, -100.0}, .crs = "EPSG:32611"};
    source.band([](int, int) { return 3.0; }, "m s-1")
        .band([](int, int) { return 4.0; }, "m s-1")
        .write(folder / "wind.tif");
    const MapGrid grid = grid_around(32612, lat, lon, 100.0, 20);
    const Wind wind = read_wind(folder / "wind.tif", 1, 2, grid);
    const Geodetic at = MapProjection(grid.crs_wkt).to_geodetic(grid.x_centre_m(10), grid.y_centre_m(10));
    const double from_g = utm_convergence_rad(at.lat_deg, at.lon_deg + 117.0),
                 to_g = utm_convergence_rad(at.lat_deg, at.lon_deg + 111.0);
    const double east = 3.0 * std::cos(from_g) + 4.0 * std::sin(from_g),
                 north = -3.0 * std::sin(from_g) + 4.0 * std::cos(from_g);
    EXPECT_NEAR(wind.east_m_s.at(10, 10), east * std::cos(to_g) - north * std::sin(to_g), 2e-6);
    EXPECT_NEAR(wind.north_m_s.at(10, 10), east * std::sin(to_g) + north * std::cos(to_g), 2e-6);
    EXPECT_NEAR(std::hypot(wind.east_m_s.at(3, 4), wind.north_m_s.at(3, 4)), 5.0, 2e-6);
}

TEST(Wind, OnUpsFollowsTheLongitude) {
    const TempFolder folder;
    geographic_wind(86.0, 40.0, 0.0, 5.0).write(folder / "wind.tif");
    const MapGrid grid = grid_around(32661, 86.0, 40.0, 100.0, 10);
    const Wind wind = read_wind(folder / "wind.tif", 1, 2, grid);
    const Geodetic at = MapProjection(grid.crs_wkt).to_geodetic(grid.x_centre_m(2), grid.y_centre_m(7));
    EXPECT_NEAR(wind.east_m_s.at(7, 2), -5.0 * std::sin(at.lon_deg * kDegree_rad), 1e-5);
    EXPECT_NEAR(wind.north_m_s.at(7, 2), 5.0 * std::cos(at.lon_deg * kDegree_rad), 1e-5);
}

TEST(Wind, OnTheGridItselfIsUntouchedAndUnitsAreConverted) {
    const TempFolder folder;
    SourceRaster source;
    source.band([](int c, int) { return 10.0 * c; }, "km/h")
        .band([](int, int r) { return 36.0 + r; }, "km/h")
        .write(folder / "wind.tif");
    const Wind wind = read_wind(folder / "wind.tif", 1, 2, grid_of(source));
    EXPECT_FLOAT_EQ(wind.east_m_s.at(1, 3), 30.0f / 3.6f);
    EXPECT_FLOAT_EQ(wind.north_m_s.at(0, 0), 10.0f);
}

TEST(Wind, WithoutOneComponentThereIsNone) {
    const TempFolder folder;
    SourceRaster source{.nodata = -99.0};
    source.band([](int c, int) { return c == 2 ? -99.0 : 1.0; }).band([](int, int r) { return r == 1 ? -99.0 : 1.0; });
    source.write(folder / "wind.tif");
    const Wind wind = read_wind(folder / "wind.tif", 1, 2, grid_of(source));
    EXPECT_TRUE(std::isnan(wind.north_m_s.at(0, 2)));
    EXPECT_TRUE(std::isnan(wind.east_m_s.at(1, 0)));
    EXPECT_EQ(wind.east_m_s.at(0, 0), 1.0f);
}

TEST(Wind, NeedsBothBands) {
    const TempFolder folder;
    SourceRaster source;
    source.band([](int, int) { return 1.0; }, "m/s").write(folder / "wind.tif");
    EXPECT_NE(
        input_error_of([&] { (void)read_wind(folder / "wind.tif", 1, 2, grid_of(source)); }).find("band 2 is asked for"),
        std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
