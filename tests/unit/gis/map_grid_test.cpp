#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

SourceRaster utm_terrain() {
    SourceRaster terrain{.cols = 100, .rows = 80, .geotransform = {713982.992, 30.0, 0.0, 5179253.117, 0.0, -30.0}};
    terrain.band([](int c, int r) { return 1000.0 + c + r; }, "m");
    return terrain;
}

SourceRaster geographic_terrain(double west_deg, double north_deg, double pixel_deg, int cols, int rows) {
    SourceRaster terrain{.cols = cols,
                         .rows = rows,
                         .geotransform = {west_deg, pixel_deg, 0.0, north_deg, 0.0, -pixel_deg},
                         .crs = "EPSG:4326"};
    terrain.band([](int, int) { return 500.0; }, "m");
    return terrain;
}

std::filesystem::path written(const TempFolder& folder, const SourceRaster& terrain) {
    terrain.write(folder / "dem.tif");
    return folder / "dem.tif";
}

/// Every corner of the terrain lies within the grid, at most `slack_m` from its edge on the widest side.
void expect_covers(const MapGrid& grid, const SourceRaster& t, double slack_m) {
    const MapProjection map(grid.crs_wkt);
    double west = 1e12, east = -1e12, south = 1e12, north = -1e12;
    for (int i = 0; i <= 100; ++i)
        for (int j = 0; j <= 100; ++j) {
            const auto [x, y] = map.to_map(t.geotransform[3] + t.geotransform[5] * t.rows * j / 100.0,
                                           t.geotransform[0] + t.geotransform[1] * t.cols * i / 100.0);
            west = std::min(west, x), east = std::max(east, x), south = std::min(south, y), north = std::max(north, y);
        }
    EXPECT_LE(grid.west_m, west);
    EXPECT_GE(grid.east_m(), east);
    EXPECT_LE(grid.south_m(), south);
    EXPECT_GE(grid.north_m, north);
    EXPECT_LE(std::max({west - grid.west_m, grid.east_m() - east, south - grid.south_m(), grid.north_m - north}), slack_m);
}

TEST(MakeMapGrid, KeepsAProjectedSquareGridAsItIs) {
    const TempFolder folder;
    const auto file = written(folder, utm_terrain());
    for (const auto& crs : {std::optional<std::string>{}, std::optional<std::string>{"EPSG:32611"},
                            std::optional<std::string>{"+proj=utm +zone=11 +datum=WGS84"}})
        for (const auto& cell : {std::optional<double>{}, std::optional<double>{30.0}}) {
            const MapGrid grid = make_map_grid(file, crs, cell);
            EXPECT_EQ(grid.cols, 100);
            EXPECT_EQ(grid.rows, 80);
            EXPECT_EQ(grid.west_m, 713982.992);
            EXPECT_EQ(grid.north_m, 5179253.117);
            EXPECT_EQ(grid.cell_m, 30.0);
        }
}

TEST(MakeMapGrid, AnotherCellKeepsTheCornerAndTheFootprint) {
    const TempFolder folder;
    const auto file = written(folder, utm_terrain());
    const MapGrid coarse = make_map_grid(file, std::nullopt, 60.0), odd = make_map_grid(file, std::nullopt, 70.0);
    EXPECT_EQ(coarse.cols, 50);
    EXPECT_EQ(coarse.rows, 40);
    EXPECT_EQ(coarse.west_m, 713982.992);
    EXPECT_EQ(coarse.north_m, 5179253.117);
    // 3000 m / 70 m = 42.86, 2400 / 70 = 34.29: cells whose centre lies on the terrain.
    EXPECT_EQ(odd.cols, 43);
    EXPECT_EQ(odd.rows, 34);
}

TEST(MakeMapGrid, GeographicTerrainGoesToItsUtmZone) {
    struct Case {
        double west_deg, north_deg;
        const char* zone;
    };
    // Zone 11 near its eastern edge, zone 56 in the south, the widened zone 32 of Norway.
    for (const Case c :
         {Case{-114.2, 46.74, "UTM zone 11N"}, Case{150.3, -33.8, "UTM zone 56S"}, Case{5.3, 60.4, "UTM zone 32N"}}) {
        const TempFolder folder;
        const SourceRaster terrain = geographic_terrain(c.west_deg, c.north_deg, 1.0 / 3600.0, 300, 300);
        const MapGrid grid = make_map_grid(written(folder, terrain), std::nullopt, std::nullopt);
        EXPECT_NE(grid.crs_wkt.find(c.zone), std::string::npos) << c.zone;
        // The shorter edge of an arc second is its parallel: 30.92 m cos(lat), to three digits.
        const double edge = 1852.0 / 60.0 * std::cos((c.north_deg - 0.0417) * std::numbers::pi / 180.0);
        EXPECT_NEAR(grid.cell_m, edge, 0.01 * edge);
        EXPECT_NEAR(std::round(grid.cell_m * 10.0), grid.cell_m * 10.0, 1e-9);
        EXPECT_NEAR(std::round(grid.west_m / grid.cell_m), grid.west_m / grid.cell_m, 1e-6);
        expect_covers(grid, terrain, 1.01 * grid.cell_m);
    }
}

TEST(MakeMapGrid, PolarTerrainGoesToUps) {
    const TempFolder folder;
    const SourceRaster terrain = geographic_terrain(30.0, 85.1, 1e-3, 500, 100);
    const MapGrid grid = make_map_grid(written(folder, terrain), std::nullopt, 50.0);
    EXPECT_NE(grid.crs_wkt.find("UPS North"), std::string::npos);
    expect_covers(grid, terrain, 51.0);
}

TEST(MakeMapGrid, ANamedCrsAndCellAreUsed) {
    const TempFolder folder;
    const SourceRaster terrain = geographic_terrain(-114.2, 46.74, 1.0 / 3600.0, 300, 300);
    const MapGrid grid = make_map_grid(written(folder, terrain), "EPSG:32612", 25.0);
    EXPECT_NE(grid.crs_wkt.find("UTM zone 12N"), std::string::npos);
    EXPECT_EQ(grid.cell_m, 25.0);
    expect_covers(grid, terrain, 25.01);
}

TEST(MakeMapGrid, NonSquareAndRotatedTerrainIsRegriddedInItsCrsToTheSmallerPixel) {
    const TempFolder folder;
    SourceRaster oblong{.cols = 50, .rows = 90, .geotransform = {500000.0, 40.0, 0.0, 5170000.0, 0.0, -25.0}};
    oblong.band([](int, int) { return 1.0; });
    const MapGrid grid = make_map_grid(written(folder, oblong), std::nullopt, std::nullopt);
    EXPECT_EQ(grid.cell_m, 25.0);
    EXPECT_EQ(grid.cols, 80);
    EXPECT_EQ(grid.rows, 90);
    EXPECT_NE(grid.crs_wkt.find("UTM zone 11N"), std::string::npos);

    // Turned by 30 degrees: 100 x 100 pixels of 10 m reach over 1000 (cos 30 + sin 30) = 1366 m.
    SourceRaster rotated{.cols = 100, .rows = 100};
    const double c = 10.0 * std::sqrt(0.75), s = 5.0;
    rotated.geotransform = {500000.0, c, s, 5170000.0, s, -c};
    rotated.band([](int, int) { return 1.0; });
    const MapGrid turned = make_map_grid(written(folder, rotated), std::nullopt, std::nullopt);
    EXPECT_NEAR(turned.cell_m, 10.0, 1e-9);
    EXPECT_EQ(turned.cols, 137);
    EXPECT_EQ(turned.rows, 137);
    EXPECT_NEAR(turned.north_m, 5170000.0 + 500.0, 1e-6);
}

TEST(MakeMapGrid, SouthUpTerrainIsTurnedNorthUp) {
    const TempFolder folder;
    SourceRaster terrain{.cols = 20, .rows = 10, .geotransform = {500000.0, 30.0, 0.0, 5170000.0, 0.0, 30.0}};
    terrain.band([](int, int r) { return r; }, "m");
    const auto file = written(folder, terrain);
    const MapGrid grid = make_map_grid(file, std::nullopt, std::nullopt);
    EXPECT_EQ(grid.north_m, 5170300.0);
    const auto raster =
        read_band({.file = file, .band = 1, .resampling = Resampling::Bilinear, .name = "terrain", .unit = "m"}, grid);
    EXPECT_FLOAT_EQ(raster.at(0, 3), 9.0f);
    EXPECT_FLOAT_EQ(raster.at(9, 3), 0.0f);
}

TEST(MakeMapGrid, TerrainInFeetGoesToMetres) {
    const TempFolder folder;
    // California zone 3, US survey feet; San Francisco lies near (6.0e6, 2.1e6) ft.
    SourceRaster terrain{
        .cols = 100, .rows = 100, .geotransform = {6000000.0, 100.0, 0.0, 2120000.0, 0.0, -100.0}, .crs = "EPSG:2227"};
    terrain.band([](int, int) { return 328.08333; }, "US survey foot");
    const auto file = written(folder, terrain);
    const MapGrid grid = make_map_grid(file, std::nullopt, std::nullopt);
    EXPECT_NE(grid.crs_wkt.find("UTM zone 10N"), std::string::npos);
    EXPECT_NEAR(grid.cell_m, 30.48, 0.05);
    const auto raster =
        read_band({.file = file, .band = 1, .resampling = Resampling::Bilinear, .name = "terrain", .unit = "m"}, grid);
    EXPECT_NEAR(raster.at(grid.rows / 2, grid.cols / 2), 100.0, 1e-3);
}

TEST(MakeMapGrid, SaysWhatIsWrong) {
    const TempFolder folder;
    const auto file = written(folder, utm_terrain());
    const auto message = [&](const std::optional<std::string>& crs, std::optional<double> cell) {
        return input_error_of([&] { (void)make_map_grid(file, crs, cell); });
    };
    EXPECT_NE(message("EPSG:2227", std::nullopt)
                  .find("map.crs: the coordinate reference system 'NAD83 / California zone 3 (ftUS)' has a "
                        "unit of 0.3048006096 m; expected metres"),
              std::string::npos);
    EXPECT_NE(message("EPSG:4326", std::nullopt).find("map.crs: the coordinate reference system 'WGS 84' is geographic"),
              std::string::npos);
    EXPECT_NE(message("UTM 11", std::nullopt).find("map.crs: 'UTM 11' is not a coordinate reference system"),
              std::string::npos);
    EXPECT_NE(message(std::nullopt, -5.0).find("map.cell_m: found -5, expected a length above 0"), std::string::npos);
    EXPECT_NE(message(std::nullopt, 1e6).find("expected 1 to 200000"), std::string::npos);

    SourceRaster no_crs = utm_terrain();
    no_crs.crs.clear();
    no_crs.write(folder / "no_crs.tif");
    EXPECT_NE(input_error_of([&] {
                  (void)make_map_grid(folder / "no_crs.tif", std::nullopt, std::nullopt);
              }).find("no_crs.tif: has no coordinate reference system"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
