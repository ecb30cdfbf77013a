// Conservation of area integrals. Ground areas come from closed forms on the ellipsoid, not from the code under test.
#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

constexpr double kA_m = 6378137.0, kE2 = 6.69437999014e-3;

/// Area between the equator and a latitude per radian of longitude (Snyder 1987, eq. 3-12 times a^2 / 2).
double zone_area_m2(double lat_rad) {
    const double e = std::sqrt(kE2), s = std::sin(lat_rad);
    return 0.5 * kA_m * kA_m * (1 - kE2) * (s / (1 - kE2 * s * s) + std::atanh(e * s) / e);
}

double geographic_integral(const SourceRaster& source) {
    double sum = 0.0;
    const auto& gt = source.geotransform;
    for (int row = 0; row < source.rows; ++row) {
        const double north = (gt[3] + row * gt[5]) * kDegree_rad, south = (gt[3] + (row + 1) * gt[5]) * kDegree_rad;
        const double area = gt[1] * kDegree_rad * (zone_area_m2(north) - zone_area_m2(south));
        for (int col = 0; col < source.cols; ++col) {
            const double v = source.bands[0][static_cast<std::size_t>(row * source.cols + col)];
            if (v != -9999.0) sum += area * v;
        }
    }
    return sum;
}

/// Scale of UTM: k0 (1 + x^2 / (2 k0^2 R^2) + x^4 / (24 R^4)), with R^2 = rho nu at the latitude (Snyder 1987, section 8).
double utm_scale(double x_m, double lat_deg) {
    const double s = std::sin(lat_deg * kDegree_rad), w2 = 1 - kE2 * s * s;
    const double radius2 = kA_m * kA_m * (1 - kE2) / (w2 * w2), q = std::pow((x_m - 500000.0) / 0.9996, 2) / radius2;
    return 0.9996 * (1 + q / 2 + q * q / 24);
}

double utm_integral(const std::vector<double>& values, int cols, double west_m, double cell_m, double lat_deg) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i]) || values[i] == -9999.0) continue;
        const double x = west_m + (static_cast<double>(i % static_cast<std::size_t>(cols)) + 0.5) * cell_m;
        sum += values[i] * std::pow(cell_m / utm_scale(x, lat_deg), 2);
    }
    return sum;
}

double utm_integral(const Raster<float>& raster, double lat_deg) {
    return utm_integral({raster.values.begin(), raster.values.end()}, raster.grid.cols, raster.grid.west_m,
                        raster.grid.cell_m, lat_deg);
}

Raster<float> conserve(const std::filesystem::path& file, const MapGrid& grid) {
    return read_band({.file = file, .band = 1, .resampling = Resampling::Conserve, .name = "heat_flux", .unit = "W m-2"},
                     grid);
}

MapGrid grid_around(int epsg, double lat_deg, double lon_deg, double cell_m, double extent_m) {
    const auto [x, y] = MapProjection("EPSG:" + std::to_string(epsg)).to_map(lat_deg, lon_deg);
    const int cells = static_cast<int>(std::ceil(extent_m / cell_m));
    return {.cols = cells,
            .rows = cells,
            .west_m = x - 0.5 * cells * cell_m,
            .north_m = y + 0.5 * cells * cell_m,
            .cell_m = cell_m,
            .crs_wkt = wkt_of(epsg)};
}

struct Place {
    int epsg;
    double lat_deg, lon_deg;
};
const Place kPlaces[] = {{32611, 46.69, -114.14}, {32756, -33.8, 150.3}, {32611, 46.69, -117.0}};

// A burning patch of a few pixels, sharp-edged, from pixels of about 20 m x 14 m.
TEST(Conserve, KeepsTheIntegralOfACompactPatchFromGeographicToUtm) {
    for (const auto& place : kPlaces) {
        const TempFolder folder;
        const double pixel_deg = 1.8e-4;
        SourceRaster source{.cols = 120, .rows = 120};
        source.geotransform = {place.lon_deg - 60 * pixel_deg, pixel_deg, 0.0,
                               place.lat_deg + 60 * pixel_deg, 0.0,       -pixel_deg};
        source.crs = "EPSG:4326";
        source.band([](int c, int r) { return std::hypot(c - 55, r - 63) < 4.0 ? 1e5 + 2e4 * (c % 3) : 0.0; });
        source.write(folder / "a.tif");
        const double expected = geographic_integral(source);
        for (const double cell_m : {3.0, 17.0, 30.0, 100.0}) {  // finer and coarser than the source
            const auto raster =
                conserve(folder / "a.tif", grid_around(place.epsg, place.lat_deg, place.lon_deg, cell_m, 1200.0));
            EXPECT_NEAR(utm_integral(raster, place.lat_deg) / expected, 1.0, 1e-4) << place.epsg << ' ' << cell_m;
        }
    }
}

TEST(Conserve, KeepsTheIntegralBetweenNeighbouringUtmZones) {
    const TempFolder folder;
    const MapGrid from = grid_around(32612, 46.69, -114.14, 30.0, 3000.0);
    SourceRaster source{.cols = from.cols, .rows = from.rows, .type = "Float64"};
    source.geotransform = {from.west_m, 30.0, 0.0, from.north_m, 0.0, -30.0};
    source.crs = "EPSG:32612";
    source.band([](int c, int r) { return c > 40 && c < 47 && r > 45 && r < 60 ? 5e4 : 0.0; }).write(folder / "a.tif");
    const double expected = utm_integral(source.bands[0], source.cols, from.west_m, 30.0, 46.69);
    for (const double cell_m : {7.0, 20.0, 30.0, 90.0, 250.0}) {
        const auto raster = conserve(folder / "a.tif", grid_around(32611, 46.69, -114.14, cell_m, 2500.0));
        EXPECT_NEAR(utm_integral(raster, 46.69) / expected, 1.0, 1e-4) << cell_m;
    }
}

TEST(Conserve, AUniformFieldStaysUniform) {
    const TempFolder folder;
    const double pixel_deg = 1e-3;
    SourceRaster source{.cols = 100, .rows = 100};
    source.geotransform = {-114.14 - 50 * pixel_deg, pixel_deg, 0.0, 46.69 + 50 * pixel_deg, 0.0, -pixel_deg};
    source.crs = "EPSG:4326";
    source.band([](int, int) { return 1234.5; }).write(folder / "a.tif");
    for (const double cell_m : {10.0, 300.0})
        for (const float v : conserve(folder / "a.tif", grid_around(32611, 46.69, -114.14, cell_m, 2000.0)).values)
            EXPECT_NEAR(v, 1234.5, 2e-4);
}

// By hand: source pixels of 30 m, target cells of 20 m that start with the source. Cell 1 covers 10 m of pixel 0, 10 m of pixel 1.
TEST(Conserve, MixesByOverlapOnTheSameCrs) {
    const TempFolder folder;
    SourceRaster source{.cols = 2, .rows = 2};
    source.band([](int c, int r) { return r == 0 ? (c == 0 ? 600.0 : 1200.0) : 0.0; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    grid.cell_m = 20.0, grid.cols = grid.rows = 3;
    const auto raster = conserve(folder / "a.tif", grid);
    EXPECT_FLOAT_EQ(raster.at(0, 0), 600.0f);
    EXPECT_FLOAT_EQ(raster.at(0, 1), 900.0f);
    EXPECT_FLOAT_EQ(raster.at(0, 2), 1200.0f);
    EXPECT_FLOAT_EQ(raster.at(1, 1), 450.0f);
    EXPECT_FLOAT_EQ(raster.at(2, 1), 0.0f);
}

// Nodata and the outside give nothing to a partly covered cell, so that the integral holds; wholly without data is no data.
TEST(Conserve, APartlyCoveredCellKeepsTheIntegralOfItsCoveredPart) {
    const TempFolder folder;
    SourceRaster source{.cols = 4, .rows = 2, .nodata = -9999.0};
    source.band([](int c, int) { return c == 1 ? 800.0 : -9999.0; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    grid.west_m -= 45.0, grid.cell_m = 60.0, grid.cols = 4, grid.rows = 1;
    const auto raster = conserve(folder / "a.tif", grid);
    // Pixel 1 spans 30...60 m east of the source's edge; the cells end at 15, 75, 135 m.
    EXPECT_TRUE(std::isnan(raster.at(0, 0)));
    EXPECT_FLOAT_EQ(raster.at(0, 1), 400.0f);
    EXPECT_TRUE(std::isnan(raster.at(0, 2)));
    EXPECT_TRUE(std::isnan(raster.at(0, 3)));
}

// A patch of fire in a sea of nodata: the usual output of a model that masks what does not burn.
TEST(Conserve, KeepsTheIntegralOfAPatchInNodata) {
    const TempFolder folder;
    SourceRaster source{.cols = 60, .rows = 60, .nodata = -9999.0};
    source.geotransform = {-114.15, 3e-4, 0.0, 46.70, 0.0, -3e-4};
    source.crs = "EPSG:4326";
    source.band([](int c, int r) { return std::abs(c - 30) + std::abs(r - 30) < 6 ? 2e5 : -9999.0; })
        .write(folder / "a.tif");
    const auto raster = conserve(folder / "a.tif", grid_around(32611, 46.691, -114.141, 25.0, 1500.0));
    EXPECT_NEAR(utm_integral(raster, 46.691) / geographic_integral(source), 1.0, 1e-4);
}

}  // namespace
}  // namespace pyroscene::gis
