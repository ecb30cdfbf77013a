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

/// The ring as a layer in its own CRS.
VectorLayer ring_layer() {
    VectorLayer layer;
    layer.name = "perimeter";
    layer.crs = ring().grid.crs_wkt;
    layer.kind = GeometryKind::Polygon;
    layer.fields = {
        {"label", VectorField::Type::Text}, {"area_ha", VectorField::Type::Real}, {"count", VectorField::Type::Integer}};
    for (auto& outline : outlines(ring()))
        layer.features.push_back(
            {std::move(outline.rings), {std::string("burnt"), outline.area_m2 * 1e-4, std::int64_t{7}}});
    layer.style = "PEN(c:#FF0000,w:3px)";
    return layer;
}

std::unique_ptr<GDALDataset> open_vector(const std::filesystem::path& path) {
    GDALAllRegister();
    return std::unique_ptr<GDALDataset>(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
}

TEST(WriteVector, OutlinesConnectedCellsInLongitudeAndLatitude) {
    const TempFolder folder;
    const auto layer_out = ring_layer();
    write_vector(folder / "perimeter.geojson", {&layer_out, 1});
    EXPECT_EQ(folder.entries(), 1);
    const auto file = open_vector(folder / "perimeter.geojson");
    ASSERT_TRUE(file);
    OGRLayer* layer = file->GetLayer(0);
    ASSERT_EQ(layer->GetFeatureCount(), 2);
    const MapProjection map("EPSG:32611");
    double areas_ha = 0.0;
    int holes = 0;
    for (const auto& feature : *layer) {
        EXPECT_STREQ(feature->GetFieldAsString("label"), "burnt");
        EXPECT_EQ(feature->GetFieldAsInteger("count"), 7);
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

TEST(WriteVector, GeoPackageKeepsTheMapAndKmzHoldsEveryLayer) {
    const TempFolder folder;
    VectorLayer points;
    points.name = "spots";
    points.crs = ring().grid.crs_wkt;
    const std::string time = "2017-07-15T23:00:00Z";
    points.fields = {{"ground_K", VectorField::Type::Real}, {"seen", VectorField::Type::Time}};
    points.features = {{{{{500045.0, 5169955.0}}}, {512.5, time}}, {{{{500105.0, 5169955.0}}}, {std::monostate{}, time}}};
    points.style = "SYMBOL(id:\"http://example.org/circle.png\",c:#FFD000)";
    VectorLayer lines = points;
    lines.style = "PEN(c:#FF0000,w:3px)";
    lines.name = "front";
    lines.kind = GeometryKind::Line;
    lines.features = {
        {{{{500000.0, 5170000.0}, {500030.0, 5169960.0}}, {{500090.0, 5170000.0}, {500090.0, 5169900.0}}}, {1.0, time}}};
    const std::vector<VectorLayer> layers{ring_layer(), lines, points};
    write_vector(folder / "map.gpkg", layers);
    write_vector(folder / "map.kmz", layers);
    EXPECT_EQ(folder.entries(), 2);
    for (const char* name : {"map.gpkg", "map.kmz"}) {
        const auto file = open_vector(folder / name);
        ASSERT_TRUE(file) << name;
        ASSERT_EQ(file->GetLayerCount(), 3) << name;
        EXPECT_EQ(file->GetLayerByName("perimeter")->GetFeatureCount(), 2) << name;
        EXPECT_EQ(file->GetLayerByName("spots")->GetFeatureCount(), 2) << name;
    }
    const auto package = open_vector(folder / "map.gpkg");
    OGRLayer* front = package->GetLayerByName("front");
    EXPECT_TRUE(front->GetSpatialRef()->IsProjected());
    const std::unique_ptr<OGRFeature> feature(front->GetNextFeature());
    EXPECT_NEAR(feature->GetGeometryRef()->toMultiLineString()->get_Length(), 50.0 + 100.0, 1e-9);
    OGRLayer* spots = package->GetLayerByName("spots");
    const std::unique_ptr<OGRFeature> hot(spots->GetNextFeature()), unknown(spots->GetNextFeature());
    EXPECT_DOUBLE_EQ(hot->GetFieldAsDouble("ground_K"), 512.5);
    EXPECT_STREQ(hot->GetFieldAsString("seen"), "2017/07/15 23:00:00+00");  // GDAL's way to show a time
    write_vector(folder / "spots.geojson", {&points, 1});
    EXPECT_NE(read_text_file(folder / "spots.geojson").find("\"seen\": \"2017-07-15T23:00:00Z\""), std::string::npos);
    EXPECT_FALSE(unknown->IsFieldSetAndNotNull(unknown->GetFieldIndex("ground_K")));
    const auto google = open_vector(folder / "map.kmz");
    const std::unique_ptr<OGRFeature> spot(google->GetLayerByName("spots")->GetNextFeature());
    const auto [x, y] = MapProjection("EPSG:32611")
                            .to_map(spot->GetGeometryRef()->toPoint()->getY(), spot->GetGeometryRef()->toPoint()->getX());
    EXPECT_STREQ(spot->GetFieldAsString("timestamp"), "2017/07/15 23:00:00+00");
    EXPECT_NEAR(x, 500045.0, 0.05);
    EXPECT_NEAR(y, 5169955.0, 0.05);
}

TEST(WriteVector, NothingBurnedIsAnEmptyCollection) {
    const TempFolder folder;
    auto layer = ring_layer();
    layer.features.clear();
    write_vector(folder / "perimeter.geojson", {&layer, 1});
    EXPECT_NE(read_text_file(folder / "perimeter.geojson").find("FeatureCollection"), std::string::npos);
    Raster<std::uint8_t> mask = ring();
    mask.values.assign(mask.values.size(), 0);
    EXPECT_TRUE(outlines(mask).empty());
}

TEST(WriteVector, NamesTheFileThatFailed) {
    const TempFolder folder;
    write_text_file(folder / "file", "in the way");
    const auto layer = ring_layer();
    for (const char* name : {"file/perimeter.geojson", "perimeter.shp"}) {
        try {
            write_vector(folder / name, {&layer, 1});
            FAIL();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Runtime);
            EXPECT_NE(std::string(e.what()).find("perimeter."), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace pyroscene::gis
