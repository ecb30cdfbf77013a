#include "gis/vector_input.h"

#include <cmath>
#include <fstream>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gis/geodesy.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

MapGrid map() {
    return {.cols = 20, .rows = 10, .west_m = 500000.0, .north_m = 5170000.0, .cell_m = 30.0, .crs_wkt = wkt_of(32611)};
}

std::string feature(const std::string& geometry) {
    return R"({"type":"Feature","properties":{},"geometry":)" + geometry + "}";
}
std::string collection(const std::string& features, const std::string& crs = "") {
    return R"({"type":"FeatureCollection",)" + crs + R"("features":[)" + features + "]}";
}
const std::string kUtm = R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32611"}},)";

class ReadShapes : public testing::Test {
protected:
    std::filesystem::path write(const std::string& text, const std::string& name = "fire.geojson") {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    std::string problem(const ShapesRequest& request) {
        try {
            read_shapes(request, map());
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            return e.what();
        }
        return "";
    }

private:
    TempFolder folder_;
};

TEST_F(ReadShapes, TakesAllKindsOfFeatures) {
    const auto file = write(collection(
        feature(R"({"type":"Point","coordinates":[500015,5169985]})") + "," +
            feature(
                R"({"type":"MultiLineString","coordinates":[[[500000,5169900],[500100,5169900]],[[500000,5169800],[500100,5169800]]]})") +
            "," +
            feature(
                R"({"type":"GeometryCollection","geometries":[{"type":"Polygon","coordinates":[[[500200,5169900],[500300,5169900],[500300,5169800],[500200,5169900]]]}]})") +
            "," + R"({"type":"Feature","properties":{},"geometry":null})",
        kUtm));
    const auto shapes = read_shapes({file, "", ""}, map());
    ASSERT_EQ(shapes.points.size(), 1U);
    EXPECT_NEAR(shapes.points[0][0], 500015.0, 1e-6);
    ASSERT_EQ(shapes.lines.size(), 2U);
    EXPECT_NEAR(shapes.lines[1][1][0], 500100.0, 1e-6);
    ASSERT_EQ(shapes.polygons.size(), 1U);
    EXPECT_EQ(shapes.polygons[0].size(), 1U);
}

TEST_F(ReadShapes, DrawsLongitudeAndLatitudeOnTheMap) {
    const auto at = MapProjection("EPSG:32611").to_geodetic(500123.0, 5169876.0, 0.0);
    const auto file =
        write(feature(fmt::format(R"({{"type":"Point","coordinates":[{:.9f},{:.9f}]}})", at.lon_deg, at.lat_deg)));
    const auto shapes = read_shapes({file, "", ""}, map());
    EXPECT_NEAR(shapes.points.at(0)[0], 500123.0, 1e-3);
    EXPECT_NEAR(shapes.points.at(0)[1], 5169876.0, 1e-3);
}

TEST_F(ReadShapes, SaysWhatIsWrong) {
    EXPECT_NE(problem({"/nowhere/fire.shp", "", ""}).find("no such file"), std::string::npos);
    EXPECT_NE(problem({write("no geometry"), "", ""}).find("is not a vector file"), std::string::npos);
    EXPECT_NE(problem({write(collection("")), "", ""}).find("holds no point, line or polygon"), std::string::npos);
    const auto good = write(collection(feature(R"({"type":"Point","coordinates":[-117,46]})")));
    EXPECT_NE(problem({good, "roads", ""}).find("has no layer 'roads'; it has fire"), std::string::npos);
    EXPECT_NE(problem({good, "", "EPSG:32611"}).find("says its coordinate reference system"), std::string::npos);
    const auto far = write(collection(feature(R"({"type":"Point","coordinates":[-117,95]})")), "far.geojson");
    EXPECT_NE(problem({far, "", ""}).find("cannot be drawn on the map"), std::string::npos);
    const auto bare = write("x,y,WKT\n1,2,POINT (500015 5169985)\n", "bare.csv");
    EXPECT_NE(problem({bare, "", ""}).find("does not say its coordinate reference system; give 'crs'"), std::string::npos);
    EXPECT_EQ(read_shapes({bare, "", "EPSG:32611"}, map()).points.size(), 1U);
}

TEST(CellsOf, CountsCentresInAreasAndAllThatIsTouched) {
    Shapes shapes;
    // 4 x 3 cells of 30 m, a quarter of a cell off the lattice, with a hole over one centre.
    shapes.polygons.push_back(
        {{{500037.5, 5169962.5}, {500157.5, 5169962.5}, {500157.5, 5169872.5}, {500037.5, 5169872.5}, {500037.5, 5169962.5}},
         {{500070.0, 5169920.0},
          {500080.0, 5169920.0},
          {500080.0, 5169930.0},
          {500070.0, 5169930.0},
          {500070.0, 5169920.0}}});
    shapes.lines.push_back({{500001.0, 5169701.0}, {500299.0, 5169701.0}});
    shapes.points.push_back({500595.0, 5169995.0});
    const auto count = [](const Raster<std::uint8_t>& mask) {
        return std::accumulate(mask.values.begin(), mask.values.end(), 0);
    };
    const auto inside = cells_of(shapes, map(), false), touched = cells_of(shapes, map(), true);
    EXPECT_EQ(count(inside), 4 * 3 - 1);
    EXPECT_EQ(inside.at(2, 2), 0);  // the hole
    EXPECT_EQ(inside.at(1, 1), 1);
    EXPECT_EQ(count(touched), 5 * 4 + 10 + 1);
    EXPECT_EQ(touched.at(0, 19), 1);
    EXPECT_EQ(touched.at(9, 9), 1);
    EXPECT_EQ(count(cells_of({}, map(), true)), 0);
}

TEST(CloseLines, JoinsPiecesOfAPerimeterAndLeavesOpenLines) {
    Shapes shapes;
    // A square in two pieces of opposite directions, with gaps of 1 m; a closed triangle; a line of its own.
    shapes.lines = {{{0, 0}, {100, 0}, {100, 100}},
                    {{500, 0}, {600, 0}},
                    {{0, 1}, {0, 100}, {99, 100}},
                    {{200, 0}, {300, 0}, {250, 80}, {200, 0}}};
    EXPECT_EQ(close_lines(shapes, 5.0), 2);
    ASSERT_EQ(shapes.polygons.size(), 2U);
    ASSERT_EQ(shapes.lines.size(), 1U);
    EXPECT_EQ(shapes.lines[0].front(), (Position{500, 0}));
    EXPECT_EQ(shapes.polygons[0][0], (Path{{0, 0}, {100, 0}, {100, 100}, {99, 100}, {0, 100}, {0, 1}}));
    const MapGrid grid{.cols = 10, .rows = 10, .west_m = 0.0, .north_m = 100.0, .cell_m = 10.0, .crs_wkt = "map"};
    const auto inside = cells_of(shapes, grid, false);
    EXPECT_EQ(inside.at(5, 5), 1);
    Shapes wide;
    wide.lines = {{{0, 0}, {100, 0}, {100, 100}, {0, 100}, {0, 20}}};
    EXPECT_EQ(close_lines(wide, 5.0), 0);
    EXPECT_EQ(wide.lines.size(), 1U);
}

}  // namespace
}  // namespace pyroscene::gis
