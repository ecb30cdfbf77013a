#include <cmath>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gis/landscape.h"
#include "gis/raster_input.h"
#include "source_folder.h"
#include "source_raster.h"

namespace pyroscene::gis {
namespace {

/// Eight bands in LANDFIRE's order, all different; a gentle wave makes slopes vary.
SourceRaster landfire(const std::string& slope_unit = "") {
    SourceRaster r{.cols = 12, .rows = 10};
    r.type = "Int16";
    const auto z = [](int col, int row) { return 1000.0 + 2.0 * (col * col + row * row); };
    r.band([=](int c, int y) { return z(c, y); });
    r.band([=](int c, int y) {
        const double zx = (z(c + 1, y) - z(c - 1, y)) / 60.0, zy = (z(c, y + 1) - z(c, y - 1)) / 60.0;
        const double tangent = std::hypot(zx, zy);
        return std::round(slope_unit == "percent" ? 100.0 * tangent : std::atan(tangent) * 180.0 / std::acos(-1.0));
    });
    r.band([](int, int) { return 45.0; });
    r.band([](int c, int) { return c < 6 ? 102.0 : 165.0; });
    r.band([](int c, int) { return 5.0 * c; });
    r.band([](int, int y) { return 30.0 * y; });
    r.band([](int, int) { return 12.0; });
    r.band([](int, int) { return 9.0; });
    return r;
}

/// The LCP that GDAL's own writer makes of a GeoTIFF; the options label the stored numbers.
void write_lcp(const std::filesystem::path& tif, const std::filesystem::path& lcp,
               std::initializer_list<const char*> options) {
    GDALAllRegister();
    CPLStringList list;
    for (const char* option : options) list.AddString(option);
    auto* source = static_cast<GDALDataset*>(GDALOpen(tif.c_str(), GA_ReadOnly));
    auto* driver = GetGDALDriverManager()->GetDriverByName("LCP");
    GDALClose(driver->CreateCopy(lcp.c_str(), source, FALSE, list.List(), nullptr, nullptr));
    GDALClose(source);
}

std::vector<float> band_values(const Landscape& land, int band, const std::string& unit, const MapGrid& grid) {
    return read_band({land.raster, band, Resampling::Nearest, "x", unit}, grid).values;
}

class LandscapeFile : public testing::Test {
protected:
    std::string refused(const SourceRaster& raster, const std::string& crs = "") {
        raster.write(folder / "bad.tif");
        return input_error_of([&] { open_landscape(folder / "bad.tif", crs); });
    }
    const TempFolder folder;
};

TEST_F(LandscapeFile, BareLandfireBandsHaveLandfireUnits) {
    const auto source = landfire();
    source.write(folder / "land.tif");
    const auto land = open_landscape(folder / "land.tif", "");
    const auto grid = grid_of(source);
    EXPECT_EQ(land.bands, 8);
    EXPECT_EQ(land.fuel_codes, (std::set{102, 165}));
    EXPECT_EQ(land.slope_note, "");
    const auto z = band_values(land, kElevation, "m", grid), cover = band_values(land, kCanopyCover, "1", grid),
               height = band_values(land, kCanopyHeight, "m", grid);
    EXPECT_FLOAT_EQ(z[3], 1018.0F);
    EXPECT_FLOAT_EQ(cover[3], 0.15F);
    EXPECT_FLOAT_EQ(height[5 * 12], 15.0F);
}

TEST_F(LandscapeFile, LcpAndGeoTiffOfOneAreaAreIdentical) {
    const auto tif = folder / "landscape.tif";  // GDAL's LCP writer leaves statistics beside its source
    std::filesystem::copy_file(source_folder() / "scenarios" / "lolo_peak" / "landscape.tif", tif);
    write_lcp(tif, folder / "same.lcp", {"LINEAR_UNIT=METER", "LATITUDE=47"});
    const auto a = open_landscape(tif, ""), b = open_landscape(folder / "same.lcp", "");
    EXPECT_EQ(a.fuel_codes, b.fuel_codes);
    EXPECT_EQ(a.slope_note, "");
    EXPECT_EQ(b.slope_note, "");
    const auto grid = make_map_grid(tif, {}, {});
    EXPECT_EQ(make_map_grid(b.raster, {}, {}).west_m, grid.west_m);
    EXPECT_EQ(make_map_grid(b.raster, {}, {}).north_m, grid.north_m);
    EXPECT_EQ(band_values(a, kElevation, "m", grid), band_values(b, kElevation, "m", grid));
    EXPECT_EQ(band_values(a, kFuelModel, "", grid), band_values(b, kFuelModel, "", grid));
    EXPECT_EQ(band_values(a, kCanopyCover, "1", grid), band_values(b, kCanopyCover, "1", grid));
    EXPECT_EQ(band_values(a, kCanopyHeight, "m", grid), band_values(b, kCanopyHeight, "m", grid));
}

TEST_F(LandscapeFile, UnitsOfAnLcpComeFromItsHeader) {
    const auto source = landfire();
    source.write(folder / "land.tif");
    write_lcp(folder / "land.tif", folder / "feet.lcp",
              {"LINEAR_UNIT=METER", "LATITUDE=47", "ELEVATION_UNIT=FEET", "CANOPY_HT_UNIT=FEET_X_10"});
    const auto land = open_landscape(folder / "feet.lcp", "");
    const auto grid = grid_of(source);
    EXPECT_NEAR(band_values(land, kElevation, "m", grid)[3], 1018.0 * 0.3048, 1e-3);
    EXPECT_NEAR(band_values(land, kCanopyHeight, "m", grid)[5 * 12], 15.0 * 0.3048, 1e-4);
}

TEST_F(LandscapeFile, NodataIsMinus9999WithoutATag) {
    auto source = landfire();
    source.bands[0][7] = -9999.0;
    source.write(folder / "hole.tif");
    const auto z = band_values(open_landscape(folder / "hole.tif", ""), kElevation, "m", grid_of(source));
    EXPECT_TRUE(std::isnan(z[7]));
    EXPECT_FALSE(std::isnan(z[8]));
}

TEST_F(LandscapeFile, FindsPercentThatCallsItselfDegrees) {
    landfire("percent").write(folder / "percent.tif");
    EXPECT_NE(open_landscape(folder / "percent.tif", "").slope_note.find("by the elevations it holds per cent"),
              std::string::npos);
    auto labelled = landfire("percent");
    labelled.units = {"m", "percent"};
    labelled.write(folder / "labelled.tif");
    EXPECT_EQ(open_landscape(folder / "labelled.tif", "").slope_note, "");
}

TEST_F(LandscapeFile, FindsASlopeOfAnotherPlace) {
    auto source = landfire();
    std::reverse(source.bands[1].begin(), source.bands[1].end());
    source.write(folder / "turned.tif");
    EXPECT_NE(open_landscape(folder / "turned.tif", "").slope_note.find("does not fit the elevations"), std::string::npos);
}

TEST_F(LandscapeFile, RefusesWhatWouldBeMisread) {
    auto few = landfire();
    few.bands.resize(4);
    EXPECT_NE(refused(few).find("has 4 band(s), expected at least 5"), std::string::npos);
    auto nowhere = landfire();
    nowhere.crs = "";
    EXPECT_NE(refused(nowhere).find("does not say its coordinate reference system"), std::string::npos);
    EXPECT_NO_THROW(open_landscape(folder / "bad.tif", "EPSG:32611"));
    EXPECT_NE(refused(landfire(), "EPSG:32612").find("but inputs.landscape.crs 'EPSG:32612'"), std::string::npos);
    auto other_nodata = landfire();
    other_nodata.bands[0][7] = 32767.0;
    EXPECT_NE(refused(other_nodata).find("elevation of 32767 m, expected -500 to 9000"), std::string::npos);
    auto crowns = landfire();
    crowns.units = {"m", "", "", "", "percent", "m"};
    EXPECT_NE(refused(crowns).find("canopy height of"), std::string::npos);
    auto classes = landfire();
    classes.units = {"m", "", "", "", "category"};
    EXPECT_NE(refused(classes).find("category"), std::string::npos);
}

TEST_F(LandscapeFile, RefusesAnLcpInFeetOnAMapInMetres) {
    landfire().write(folder / "land.tif");
    write_lcp(folder / "land.tif", folder / "land.lcp", {"LINEAR_UNIT=FOOT", "LATITUDE=47"});
    EXPECT_NE(input_error_of([&] { open_landscape(folder / "land.lcp", ""); }).find("its header counts in Feet"),
              std::string::npos);
}

TEST_F(LandscapeFile, GivesEachCodeItsValue) {
    const auto source = landfire();
    source.write(folder / "land.tif");
    const auto raster = raster_of_codes(open_landscape(folder / "land.tif", ""), {{102, 0.25}}, "kg m-2");
    EXPECT_TRUE(is_in_memory(raster));
    const auto load = read_band({raster, 1, Resampling::Nearest, "fuel load", "kg m-2"}, grid_of(source)).values;
    EXPECT_FLOAT_EQ(load[5], 0.25F);
    EXPECT_FLOAT_EQ(load[6], 0.0F);
}

}  // namespace
}  // namespace pyroscene::gis
