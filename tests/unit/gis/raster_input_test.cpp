#include "gis/raster_input.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Raster<float> read(const std::filesystem::path& file, const MapGrid& grid, const std::string& unit = "W m-2", int band = 1,
                   Resampling rule = Resampling::Bilinear) {
    return read_band({.file = file, .band = band, .resampling = rule, .name = "heat_flux", .unit = unit}, grid);
}

TEST(ReadBand, OnItsOwnGridEveryRuleGivesTheSameBits) {
    const TempFolder folder;
    SourceRaster source;
    source.band([](int c, int r) { return 0.1f + 1e7 * c / 3.0 + 1e-3 * r; });
    source.write(folder / "a.tif");
    for (const auto rule : {Resampling::Bilinear, Resampling::Conserve, Resampling::Nearest}) {
        const auto raster = read(folder / "a.tif", grid_of(source), "W m-2", 1, rule);
        EXPECT_EQ(raster.name, "heat_flux");
        EXPECT_EQ(raster.unit, "W m-2");
        EXPECT_EQ(raster.grid, grid_of(source));
        for (std::size_t i = 0; i < raster.values.size(); ++i)
            EXPECT_EQ(raster.values[i], static_cast<float>(source.bands[0][i]));
    }
}

TEST(ReadBand, AppliesScaleAndOffsetThenTheUnit) {
    const TempFolder folder;
    SourceRaster source{.type = "Int16", .scale = 0.5, .offset = -10.0};
    source.band([](int c, int r) { return 10 * c + r; }, "kW/m2");
    source.write(folder / "a.tif");
    const auto raster = read(folder / "a.tif", grid_of(source));
    EXPECT_FLOAT_EQ(raster.at(2, 3), 1000.0f * (0.5f * 32.0f - 10.0f));
    EXPECT_FLOAT_EQ(raster.at(0, 0), -10000.0f);
}

TEST(ReadBand, ConvertsCelsius) {
    const TempFolder folder;
    SourceRaster source;
    source.band([](int c, int) { return 25.0 + c; }, "degC");
    source.write(folder / "a.tif");
    EXPECT_FLOAT_EQ(read(folder / "a.tif", grid_of(source), "K").at(0, 0), 298.15f);
}

TEST(ReadBand, NodataOfEveryKindBecomesNaN) {
    const TempFolder folder;
    SourceRaster declared{.nodata = -9999.0}, nan{.nodata = kNaN}, masked;
    const auto hole = [](double v) { return [v](int c, int r) { return c == 1 && r == 1 ? v : 5.0; }; };
    declared.band(hole(-9999.0)).write(folder / "declared.tif");
    nan.band(hole(kNaN)).write(folder / "nan.tif");
    masked.mask = std::vector<unsigned char>(12, 255);
    (*masked.mask)[5] = 0;
    masked.band(hole(5.0)).write(folder / "masked.tif");
    SourceRaster infinite;
    infinite.band(hole(std::numeric_limits<double>::infinity())).write(folder / "infinite.tif");
    SourceRaster lowest{.nodata = -3.4028234663852886e38};
    lowest.band(hole(-3.4028234663852886e38)).write(folder / "lowest.tif");
    for (const char* name : {"declared.tif", "nan.tif", "masked.tif", "infinite.tif", "lowest.tif"}) {
        const auto raster = read(folder / name, grid_of(declared));
        EXPECT_TRUE(std::isnan(raster.at(1, 1))) << name;
        EXPECT_EQ(raster.at(1, 2), 5.0f) << name;
    }
}

TEST(ReadBand, ScaledNodataIsRecognisedBeforeScaling) {
    const TempFolder folder;
    SourceRaster source{.type = "Int16", .nodata = -1.0, .scale = 0.1};
    source.band([](int c, int r) { return c == 0 && r == 0 ? -1 : 100; }).write(folder / "a.tif");
    const auto raster = read(folder / "a.tif", grid_of(source));
    EXPECT_TRUE(std::isnan(raster.at(0, 0)));
    EXPECT_FLOAT_EQ(raster.at(0, 1), 10.0f);
}

TEST(ReadBandErrors, EachNamesFileBandFoundAndExpected) {
    const TempFolder folder;
    SourceRaster good;
    good.band([](int c, int) { return c; }, "W m-2");
    good.write(folder / "good.tif");
    const MapGrid grid = grid_of(good);

    SourceRaster no_crs = good, no_place = good, length = good, empty = good, elsewhere = good;
    no_crs.crs.clear();
    no_crs.write(folder / "no_crs.tif");
    no_place.georeferenced = false;
    no_place.write(folder / "no_place.tif");
    length.units = {"ft"};
    length.write(folder / "length.tif");
    empty.bands[0].assign(12, -9999.0);
    empty.nodata = -9999.0;
    empty.write(folder / "empty.tif");
    elsewhere.crs = "EPSG:32616";
    elsewhere.write(folder / "elsewhere.tif");
    std::ofstream(folder / "text.tif") << "no raster at all";

    const auto message = [&](const char* file, int band = 1) {
        return input_error_of([&] { (void)read(folder / file, grid, "W m-2", band); });
    };
    const auto expect = [&](const std::string& text, const char* file, const char* part) {
        EXPECT_NE(text.find((folder / file).string()), std::string::npos) << text;
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expect(message("missing.tif"), "missing.tif", "no such file");
    expect(message("text.tif"), "text.tif", "is not a raster");
    expect(message("no_crs.tif"), "no_crs.tif", "has no coordinate reference system");
    expect(message("no_place.tif"), "no_place.tif", "has no georeference");
    expect(message("good.tif", 2), "good.tif", "band 2 is asked for, found 1 band");
    expect(message("good.tif", 0), "good.tif", "band 0 is asked for");
    expect(message("length.tif"), "length.tif", "band 1: unit 'ft' belongs to another quantity; expected W m-2");
    expect(message("empty.tif"), "empty.tif", "band 1: holds only nodata");
    expect(message("elsewhere.tif"), "elsewhere.tif",
           "does not overlap the map; found longitude -87.0000 to -86.9984, latitude 46.68");
}

TEST(ReadBandErrors, NodataUnderTheMapIsSaidEvenWhenTheRestHasData) {
    const TempFolder folder;
    SourceRaster source{.cols = 20, .rows = 3, .nodata = -1.0};
    source.band([](int c, int) { return c < 10 ? -1.0 : 7.0; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    grid.cols = 5;
    EXPECT_NE(input_error_of([&] { (void)read(folder / "a.tif", grid); }).find("holds only nodata on the map"),
              std::string::npos);
}

TEST(ReadClasses, AreIntegersWithTheirOwnNodata) {
    const TempFolder folder;
    SourceRaster source{.type = "Int16", .nodata = -9999.0};
    source.band([](int c, int r) { return c == 0 ? -9999 : 100 * r + c; }).write(folder / "a.tif");
    MapGrid grid = grid_of(source);
    const auto classes = read_classes(folder / "a.tif", 1, grid, -7);
    EXPECT_EQ(classes.at(2, 3), 203);
    EXPECT_EQ(classes.at(2, 0), -7);

    // A finer grid that sticks out to the west: whole classes, never a mean of two, and the outside is nodata.
    grid = {.cols = 12,
            .rows = 9,
            .west_m = grid.west_m - 30.0,
            .north_m = grid.north_m,
            .cell_m = 10.0,
            .crs_wkt = grid.crs_wkt};
    const auto fine = read_classes(folder / "a.tif", 1, grid, -7);
    EXPECT_EQ(fine.at(0, 2), -7);
    EXPECT_EQ(fine.at(0, 5), -7);
    EXPECT_EQ(fine.at(5, 6), 101);
    EXPECT_EQ(fine.at(5, 8), 101);
    EXPECT_EQ(fine.at(5, 9), 102);
}

TEST(ReadClasses, RefusesFractions) {
    const TempFolder folder;
    SourceRaster source;
    source.band([](int c, int) { return 0.5 * c; }).write(folder / "a.tif");
    EXPECT_NE(input_error_of([&] {
                  (void)read_classes(folder / "a.tif", 1, grid_of(source), 0);
              }).find("expected integer classes"),
              std::string::npos);
}

TEST(ReadInfo, TellsWhatTheFileSays) {
    const TempFolder folder;
    SourceRaster source{.nodata = -9999.0, .scale = 2.0, .offset = 1.0};
    source.band([](int, int) { return 1.0; }, "W m-2").band([](int, int) { return 2.0; }).write(folder / "a.tif");
    const RasterInfo info = read_info(folder / "a.tif");
    EXPECT_EQ(info.cols, 4);
    EXPECT_EQ(info.rows, 3);
    EXPECT_EQ(info.geotransform, source.geotransform);
    EXPECT_FALSE(info.geographic);
    EXPECT_NE(info.crs_wkt.find("UTM zone 11N"), std::string::npos);
    ASSERT_EQ(info.bands.size(), 2u);
    EXPECT_EQ(info.bands[0].unit, "W m-2");
    EXPECT_EQ(info.bands[1].unit, "");
    EXPECT_EQ(info.bands[0].nodata, -9999.0);
    EXPECT_EQ(info.bands[0].scale, 2.0);
    EXPECT_EQ(info.bands[0].offset, 1.0);
    EXPECT_EQ(info.metadata.at("AREA_OR_POINT"), "Area");
    const auto bands = read_band_list(folder / "a.tif");
    ASSERT_EQ(bands.size(), 2u);
    EXPECT_EQ(bands[0].unit, "W m-2");
    EXPECT_EQ(bands[0].scale, 2.0);
}

TEST(ReadInfo, ACrsMayBeMissingButNotTheGeoreference) {
    const TempFolder folder;
    SourceRaster source{.crs = ""};
    source.band([](int, int) { return 1.0; }).write(folder / "a.tif");
    EXPECT_EQ(read_info(folder / "a.tif").crs_wkt, "");
    source.georeferenced = false;
    source.write(folder / "b.tif");
    EXPECT_NE(input_error_of([&] { (void)read_info(folder / "b.tif"); }).find("has no georeference"), std::string::npos);
    EXPECT_EQ(read_band_list(folder / "b.tif").size(), 1u);
}

}  // namespace
}  // namespace pyroscene::gis
