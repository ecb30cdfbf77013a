#include "gis/vector_output.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/geodesy.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

Raster<std::uint8_t> ring() {
    // 3 x 3 cells with a hole in the middle, and one cell apart.
    Raster<std::uint8_t> mask(
        {.cols = 8, .rows = 6, .west_m = 500000.0, .north_m = 5170000.0, .cell_m = 30.0, .crs_wkt = wkt_of(32611)}, "burned",
        "1");
    for (int row = 1; row < 4; ++row)
        for (int col = 1; col < 4; ++col) mask.at(row, col) = row == 2 && col == 2 ? 0 : 1;
    mask.at(4, 6) = 1;
    return mask;
}

TEST(WritePolygons, OutlinesConnectedCellsInLongitudeAndLatitude) {
    const TempFolder folder;
    write_polygons(folder / "perimeter.geojson", ring(), {{"synthetic", "true"}});
    EXPECT_EQ(folder.entries(), 1);
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open((folder / "perimeter.geojson").c_str(), GDAL_OF_VECTOR));
    ASSERT_TRUE(file);
    OGRLayer* layer = file->GetLayer(0);
    ASSERT_EQ(layer->GetFeatureCount(), 2);
    const MapProjection map("EPSG:32611");
    double areas_ha = 0.0;
    int holes = 0;
    for (const auto& feature : *layer) {
        EXPECT_STREQ(feature->GetFieldAsString("synthetic"), "true");
        areas_ha += feature->GetFieldAsDouble("area_ha");
        const OGRPolygon* polygon = feature->GetGeometryRef()->toPolygon();
        holes += polygon->getNumInteriorRings();
        EXPECT_FALSE(polygon->getExteriorRing()->isClockwise());  // RFC 7946: counter-clockwise outside
        for (const auto& point : *polygon->getExteriorRing()) {
            const auto [x, y] = map.to_map(point.getY(), point.getX());
            EXPECT_NEAR(std::round((x - 500000.0) / 30.0) * 30.0, x - 500000.0, 0.02);  // 7 decimals are 1 cm
            EXPECT_NEAR(std::round((y - 5170000.0) / 30.0) * 30.0, y - 5170000.0, 0.02);
        }
    }
    EXPECT_EQ(holes, 1);
    EXPECT_NEAR(areas_ha, 9 * 0.09, 1e-9);
}

TEST(WritePolygons, NothingBurnedIsAnEmptyCollection) {
    const TempFolder folder;
    Raster<std::uint8_t> mask = ring();
    mask.values.assign(mask.values.size(), 0);
    write_polygons(folder / "perimeter.geojson", mask, {});
    EXPECT_NE(read_text_file(folder / "perimeter.geojson").find("FeatureCollection"), std::string::npos);
}

TEST(WritePolygons, NamesTheFileThatFailed) {
    const TempFolder folder;
    write_text_file(folder / "file", "in the way");
    try {
        write_polygons(folder / "file/perimeter.geojson", ring(), {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Runtime);
        EXPECT_NE(std::string(e.what()).find("perimeter.geojson"), std::string::npos);
    }
}

}  // namespace
}  // namespace pyroscene::gis
