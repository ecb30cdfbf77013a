#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

Raster<float> read(const std::filesystem::path& file, const MapGrid& grid, Resampling rule) {
    return read_band({.file = file, .band = 1, .resampling = rule, .name = "quantity", .unit = "1"}, grid);
}

/// Grid of square cells around a place.
MapGrid grid_around(int epsg, double lat_deg, double lon_deg, double cell_m, int cells) {
    const MapProjection map("EPSG:" + std::to_string(epsg));
    const auto [x, y] = map.to_map(lat_deg, lon_deg);
    return {.cols = cells,
            .rows = cells,
            .west_m = x - 0.5 * cells * cell_m,
            .north_m = y + 0.5 * cells * cell_m,
            .cell_m = cell_m,
            .crs_wkt = wkt_of(epsg)};
}

/// Geographic raster around a place, with pixels about as wide as high on the ground.
SourceRaster geographic_around(double lat_deg, double lon_deg, double pixel_deg, int pixels) {
    const double wide_deg = pixel_deg / std::cos(lat_deg * kDegree_rad);
    return {.cols = pixels,
            .rows = pixels,
            .geotransform = {lon_deg - 0.5 * pixels * wide_deg, wide_deg, 0.0, lat_deg + 0.5 * pixels * pixel_deg, 0.0,
                             -pixel_deg},
            .crs = "EPSG:4326",
            .type = "Float64"};
}

struct Place {
    int epsg;
    double lat_deg, lon_deg;
};
// UTM north, south and at the edge of its zone, UPS.
const Place kPlaces[] = {{32611, 46.69, -114.14}, {32756, -33.8, 150.3}, {32611, 46.69, -119.9}, {32661, 86.0, 40.0}};

// A field linear in longitude and latitude is reproduced by bilinear interpolation at the true position of each cell's centre.
TEST(Bilinear, ReproducesALinearFieldAtTheRightPlace) {
    for (const auto& place : kPlaces) {
        SCOPED_TRACE(place.epsg + place.lon_deg);
        const TempFolder folder;
        SourceRaster source = geographic_around(place.lat_deg, place.lon_deg, 5e-4, 300);
        const auto field = [&](double lon, double lat) {
            return 3000.0 * (lon - place.lon_deg) - 7000.0 * (lat - place.lat_deg);
        };
        source.band_at(field).write(folder / "a.tif");
        const MapGrid grid = grid_around(place.epsg, place.lat_deg, place.lon_deg, 40.0, 50);
        const auto raster = read(folder / "a.tif", grid, Resampling::Bilinear);
        const MapProjection map(grid.crs_wkt);
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col) {
                const Geodetic p = map.to_geodetic(grid.x_centre_m(col), grid.y_centre_m(row));
                // 0.01 pixel on each axis.
                ASSERT_NEAR(raster.at(row, col), field(p.lon_deg, p.lat_deg),
                            0.01 * (3000.0 * source.geotransform[1] + 7000.0 * 5e-4));
            }
    }
}

TEST(Bilinear, ReachesTheEdgeOfTheSource) {
    const TempFolder folder;
    SourceRaster source{.cols = 40, .rows = 40};
    source.band_at([](double x, double y) { return (x - 500000.0) + 2.0 * (y - 5170000.0); }).write(folder / "a.tif");
    for (const double cell_m : {7.0, 30.0, 45.0})
        for (const double shift_m : {0.0, 3.3}) {
            SCOPED_TRACE(cell_m + shift_m);
            MapGrid grid = grid_of(source);
            grid = {.cols = static_cast<int>(1400 / cell_m),
                    .rows = static_cast<int>(1400 / cell_m),
                    .west_m = grid.west_m - 100.0 + shift_m,
                    .north_m = grid.north_m + 100.0 + shift_m,
                    .cell_m = cell_m,
                    .crs_wkt = grid.crs_wkt};
            const auto raster = read(folder / "a.tif", grid, Resampling::Bilinear);
            for (int row = 0; row < grid.rows; ++row)
                for (int col = 0; col < grid.cols; ++col) {
                    const double x = grid.x_centre_m(col) - 500000.0, y = 5170000.0 - grid.y_centre_m(row);
                    const bool inside = x > 0.0 && x < 1200.0 && y > 0.0 && y < 1200.0;
                    ASSERT_EQ(std::isnan(raster.at(row, col)), !inside) << x << ' ' << y;
                    // Beyond the outermost pixel centres there is nothing to interpolate with.
                    if (x > 60.0 && x < 1140.0 && y > 60.0 && y < 1140.0) {
                        ASSERT_NEAR(raster.at(row, col), x - 2.0 * y, 1e-3);
                    }
                }
        }
}

TEST(Bilinear, LeavesNodataOut) {
    const TempFolder folder;
    SourceRaster source{.cols = 40, .rows = 40, .nodata = -9999.0};
    source.band([](int c, int) { return c < 20 ? 100.0 : -9999.0; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    grid.west_m += 11.0, grid.cell_m = 13.0, grid.cols = 80;
    const auto raster = read(folder / "a.tif", grid, Resampling::Bilinear);
    for (const float v : raster.values)
        EXPECT_TRUE(std::isnan(v) || std::abs(v - 100.0f) < 1e-4f) << v;  // never mixed with -9999
    EXPECT_FALSE(std::isnan(raster.at(5, 43)));                           // centre 576.5 m: in the last valid pixel
    EXPECT_TRUE(std::isnan(raster.at(5, 46)));                            // centre 615.5 m
}

TEST(Bilinear, AveragesAFinerSource) {
    // One metre stripes of 0 and 1 on a grid of 10 m: every cell must see both.
    const TempFolder folder;
    SourceRaster source{.cols = 200, .rows = 200, .geotransform = {500000.0, 1.0, 0.0, 5170000.0, 0.0, -1.0}};
    source.band([](int c, int) { return c % 2; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    grid.cell_m = 10.0, grid.cols = grid.rows = 20;
    for (const float v : read(folder / "a.tif", grid, Resampling::Bilinear).values) EXPECT_NEAR(v, 0.5, 0.06);
}

TEST(Nearest, TakesThePixelThatHoldsTheCentre) {
    for (const auto& place : kPlaces) {
        SCOPED_TRACE(place.epsg + place.lon_deg);
        const TempFolder folder;
        SourceRaster source = geographic_around(place.lat_deg, place.lon_deg, 1e-3, 150);
        source.band([](int c, int r) { return 1000 * r + c; }).write(folder / "a.tif");
        const MapGrid grid = grid_around(place.epsg, place.lat_deg, place.lon_deg, 40.0, 50);
        const auto raster = read(folder / "a.tif", grid, Resampling::Nearest);
        const MapProjection map(grid.crs_wkt);
        int different = 0;
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col) {
                const Geodetic p = map.to_geodetic(grid.x_centre_m(col), grid.y_centre_m(row));
                const double c = (p.lon_deg - source.geotransform[0]) / source.geotransform[1],
                             r = (source.geotransform[3] - p.lat_deg) / 1e-3;
                different += raster.at(row, col) != static_cast<float>(1000.0 * std::floor(r) + std::floor(c)) ? 1 : 0;
            }
        EXPECT_LE(different, 50);  // centres within 0.01 pixel of a border may fall on either side: 2 % of 2500
    }
}

TEST(AnyRule, LongitudesFrom0To360MeetAGridInTheWest) {
    const TempFolder folder;
    SourceRaster source{.cols = 360, .rows = 180, .geotransform = {0.0, 1.0, 0.0, 90.0, 0.0, -1.0}, .crs = "EPSG:4326"};
    source.band_at([](double lon, double) { return lon; }).write(folder / "a.tif");
    const MapGrid grid = grid_around(32611, 46.69, -114.14, 1000.0, 4);
    for (const auto rule : {Resampling::Bilinear, Resampling::Conserve, Resampling::Nearest})
        for (const float v : read(folder / "a.tif", grid, rule).values) EXPECT_NEAR(v, 360.0 - 114.14, 0.7);
}

TEST(AnyRule, SouthUpAndRotatedSourcesLieWhereTheyAre) {
    const TempFolder folder;
    const auto plane = [](double x, double y) { return (x - 500000.0) - 3.0 * (y - 5170000.0); };
    SourceRaster south_up{.cols = 60, .rows = 60, .geotransform = {499000.0, 30.0, 0.0, 5169000.0, 0.0, 30.0}};
    south_up.band_at(plane).write(folder / "south_up.tif");
    const double c = 25.0 * std::cos(0.5), s = 25.0 * std::sin(0.5);
    SourceRaster rotated{.cols = 90, .rows = 90, .geotransform = {498800.0, c, s, 5170300.0, s, -c}};
    rotated.band_at(plane).write(folder / "rotated.tif");
    const MapGrid grid{
        .cols = 10, .rows = 10, .west_m = 500000.0, .north_m = 5170300.0, .cell_m = 30.0, .crs_wkt = wkt_of(32611)};
    for (const char* file : {"south_up.tif", "rotated.tif"}) {
        const auto bilinear = read(folder / file, grid, Resampling::Bilinear),
                   conserved = read(folder / file, grid, Resampling::Conserve);
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col) {
                const double expected = plane(grid.x_centre_m(col), grid.y_centre_m(row));
                EXPECT_NEAR(bilinear.at(row, col), expected, 1e-2) << file;
                // Pixels are flat there: the plane of slope 3.2 becomes steps of 25 m, mixed by area.
                EXPECT_NEAR(conserved.at(row, col), expected, 0.25 * 25.0 * 3.2) << file;
            }
    }
}

// Arrival times without a nodata tag: -9999 must not bleed into the burnt cells beside it, nor move the edge of the burn.
TEST(Bilinear, KeepsSentinelsOutAndTheEdgeInPlace) {
    const TempFolder folder;
    constexpr int kBurnt = 12;
    SourceRaster source{.cols = 20, .rows = 10};
    source.band([](int col, int row) { return col < kBurnt ? 60.0 * col + 7.0 * row : -9999.0; }).write(folder / "a.tif");
    MapGrid fine = grid_of(source);
    fine.cols *= 3, fine.rows *= 3, fine.cell_m /= 3.0;
    const BandRequest request{
        .file = folder / "a.tif", .resampling = Resampling::Bilinear, .name = "arrival", .unit = "s", .least = 0.0};
    const auto time = read_band(request, fine);
    for (int row = 0; row < fine.rows; ++row)
        for (int col = 0; col < fine.cols; ++col) {
            const float value = time.at(row, col);
            ASSERT_EQ(std::isnan(value), col >= 3 * kBurnt) << row << ' ' << col;
            // Centres of source pixels lie at 1, 4, 7, ... of the fine grid; beyond the outermost the plane is not continued.
            const double x = (col - 1) / 3.0, y = std::clamp((row - 1) / 3.0, 0.0, source.rows - 1.0);
            if (col < 3 * kBurnt) {
                EXPECT_NEAR(value, 60.0 * std::clamp(x, 0.0, kBurnt - 1.0) + 7.0 * y, 1e-3) << row << ' ' << col;
            }
        }
    // On its own grid the values are the file's.
    const auto same = read_band(request, grid_of(source));
    EXPECT_EQ(same.at(3, 5), 321.0F);
    EXPECT_TRUE(std::isnan(same.at(3, kBurnt)));
}

}  // namespace
}  // namespace pyroscene::gis
