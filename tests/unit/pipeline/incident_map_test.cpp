#include "pipeline/incident_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "gis/crs.h"
#include "pipeline/fronts.h"

namespace pyroscene::pipeline {
namespace {

using fire::CellClass;
using Json = nlohmann::json;

/// A strip of front, 20 cells of 30 m long, behind it hot and then cold scar; far away one burning cell alone.
fire::FireState state() {
    MapGrid grid{.cols = 40, .rows = 30, .west_m = 500000.0, .north_m = 5170000.0, .cell_m = 30.0, .crs_wkt = {}};
    grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
    fire::FireState s;
    s.cell_class = Raster<std::uint8_t>(grid, "class", "1");
    for (auto* raster : {&s.surface_temperature_K, &s.front_fraction, &s.flame_height_m})
        *raster = SparseRaster<float>(grid, "value", "1");
    const auto set = [&](int row, int col, CellClass c, float T_K) {
        s.cell_class.at(row, col) = static_cast<std::uint8_t>(c);
        s.surface_temperature_K.set(grid.index(row, col), T_K);
        s.front_fraction.set(grid.index(row, col), c == CellClass::Front ? 0.5F : 0.0F);
    };
    for (int col = 10; col < 30; ++col) {
        set(10, col, CellClass::Front, 1073.0F);
        set(11, col, CellClass::Scar, 600.0F);
        set(12, col, CellClass::Scar, 320.0F);
    }
    set(25, 3, CellClass::Front, 1073.0F);
    return s;
}

Json read(const std::filesystem::path& file) { return Json::parse(read_text_file(file)); }

TEST(IncidentMap, ShowsPerimeterFrontAndHeatMarkedSynthetic) {
    const auto folder = std::filesystem::temp_directory_path() / "pyroscene_incident_map";
    std::filesystem::create_directories(folder);
    const auto fire = state();
    Raster<float> flux(fire.cell_class.grid, "heat flux", "W m-2");
    for (std::size_t i = 0; i < flux.values.size(); ++i) flux.values[i] = fire.front_fraction[i] > 0.0F ? 2e5F : 0.0F;
    write_text_file(folder / "fronts.csv", fronts_csv(find_fronts(fire, flux)));
    write_incident_map(folder, "", {"test_fire", "wasp", "2017-07-15T23:00:00Z", 400.0}, fire, folder / "fronts.csv");

    const auto perimeter = read(folder / "perimeter.geojson")["features"];
    ASSERT_EQ(perimeter.size(), 2u);
    double area_ha = 0.0;
    for (const auto& feature : perimeter) {
        const auto& p = feature["properties"];
        EXPECT_EQ(p["MapMethod"], "Modeled");
        EXPECT_EQ(p["synthetic"], 1);
        EXPECT_EQ(p["IncidentName"], "test_fire");
        area_ha += p["area_ha"].get<double>();
        EXPECT_NEAR(p["GISAcres"].get<double>() / p["area_ha"].get<double>(), 2.4710538, 1e-6);
    }
    EXPECT_NEAR(area_ha, 61 * 0.09, 1e-9);

    // The edge to unburned ground: north side and both ends, corners cut. 22 edges of 30 m less two corners of 30 m - 21.2 m.
    const auto front = read(folder / "front.geojson")["features"];
    ASSERT_EQ(front.size(), 2u);
    const double expected_m = 22 * 30.0 - 2 * (30.0 - 30.0 * std::sqrt(0.5));
    EXPECT_NEAR(front[0]["properties"]["length_m"].get<double>(), expected_m, 1e-6);
    EXPECT_NEAR(front[1]["properties"]["length_m"].get<double>(), 4 * 30.0 * std::sqrt(0.5), 1e-6);
    // 20 cells of 900 m2 with 200 kW m-2 over 600 m
    EXPECT_NEAR(front[0]["properties"]["intensity_kW_m"].get<double>(), 20 * 900.0 * 200.0 / 600.0, 0.05 * 6000.0);

    const auto heat = read(folder / "heat.geojson")["features"];
    ASSERT_EQ(heat.size(), 2u);
    for (const auto& feature : heat) EXPECT_NEAR(feature["properties"]["area_ha"].get<double>(), 20 * 0.09, 1e-9);
    EXPECT_EQ(heat[0]["properties"]["FeatureCategory"], "Intense Heat");
    EXPECT_EQ(heat[1]["properties"]["FeatureCategory"], "Scattered Heat");
    const auto isolated = read(folder / "isolated_heat.geojson")["features"];
    ASSERT_EQ(isolated.size(), 1u);
    EXPECT_EQ(isolated[0]["properties"]["FeatureCategory"], "Isolated Heat");
    EXPECT_NEAR(isolated[0]["geometry"]["coordinates"][0].get<double>(), -117.0 + 105.0 / 76200.0, 1e-4);
    EXPECT_GT(std::filesystem::file_size(folder / "incident_map.gpkg"), 0u);
    EXPECT_EQ(read_text_file(folder / "incident_map.kmz").substr(0, 2), "PK");  // a zip archive
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pyroscene::pipeline
