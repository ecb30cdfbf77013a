// Sensor-geometry images: does GDAL itself put their pixels where the geolocation says?
#include <array>
#include <cmath>
#include <functional>

#include <gdal_utils.h>
#include <gtest/gtest.h>

#include "gis/geodesy.h"
#include "gis/raster_output.h"
#include "unit/gis/written_raster.h"

namespace pyroscene::gis {
namespace {

constexpr int kCols = 120, kRows = 90;

/// An oblique, turned view: longitude and latitude are linear in sample and line (pixel corner at integers).
struct View {
    static constexpr double lon0 = -114.2, lat0 = 46.7;
    static constexpr double lon_col = 4e-4, lon_row = 1.2e-4, lat_col = 0.8e-4, lat_row = -2.6e-4;
    static double lon_deg(double sample, double line) { return lon0 + lon_col * sample + lon_row * line; }
    static double lat_deg(double sample, double line) { return lat0 + lat_col * sample + lat_row * line; }
    static std::array<double, 2> sample_line(double lon, double lat) {
        const double det = lon_col * lat_row - lon_row * lat_col, a = lon - lon0, b = lat - lat0;
        return {(a * lat_row - b * lon_row) / det, (b * lon_col - a * lat_col) / det};
    }
};

bool is_sky(int col, int row) { return row < 6 || (col > 50 && col < 56 && row > 40 && row < 44); }

/// Ramp of sample number (band 1) and line number (band 2) of pixel centres, with its geolocation.
void write_view(const TempFolder& folder) {
    std::vector<double> where(2 * kCols * kRows);
    std::vector<float> ramp(2 * kCols * kRows);
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col) {
            const auto i = static_cast<std::size_t>(row * kCols + col), band2 = static_cast<std::size_t>(kCols * kRows);
            where[i] = is_sky(col, row) ? std::nan("") : View::lon_deg(col + 0.5, row + 0.5);
            where[band2 + i] = is_sky(col, row) ? std::nan("") : View::lat_deg(col + 0.5, row + 0.5);
            ramp[i] = static_cast<float>(col + 0.5);
            ramp[band2 + i] = static_cast<float>(row + 0.5);
        }
    OutputRaster geolocation;
    geolocation.cols = kCols, geolocation.rows = kRows;
    geolocation.bands = {{.description = "longitude", .unit = "degree"}, {.description = "latitude", .unit = "degree"}};
    write_geotiff(folder / "geolocation.tif", geolocation, std::span<const double>(where));

    OutputRaster image;
    image.cols = kCols, image.rows = kRows;
    image.bands = {{.description = "sample"}, {.description = "line"}};
    image.geolocation = folder / "../" / folder.path().filename() / "geolocation.tif";
    for (const double sample : {0.5, kCols - 0.5})
        for (const double line : {10.5, kRows - 0.5})
            image.control_points.push_back({.sample = sample,
                                            .line = line,
                                            .lon_deg = View::lon_deg(sample, line),
                                            .lat_deg = View::lat_deg(sample, line),
                                            .h_m = 1000.0});
    write_geotiff(folder / "radiance.tif", image, std::span<const float>(ramp));
}

TestDataset warp(const std::filesystem::path& file, std::initializer_list<const char*> extra) {
    const auto source = open_written(file);
    std::vector<const char*> words{"-of", "MEM", "-t_srs", "EPSG:32611", "-tr", "25", "25"};
    words.insert(words.end(), extra);
    words.push_back(nullptr);
    GDALWarpAppOptions* options = GDALWarpAppOptionsNew(const_cast<char**>(words.data()), nullptr);
    GDALDatasetH handle = source.get();
    TestDataset result(static_cast<GDALDataset*>(GDALWarp("", nullptr, 1, &handle, options, nullptr)));
    GDALWarpAppOptionsFree(options);
    return result;
}

/// Largest distance, in source pixels, between where a warped pixel came from and where it should; number compared.
struct Placement {
    double worst_px = 0.0;
    int compared = 0;
};
Placement placement(GDALDataset& warped) {
    const int cols = warped.GetRasterXSize(), rows = warped.GetRasterYSize();
    std::vector<float> values(2 * static_cast<std::size_t>(cols * rows));
    EXPECT_EQ(warped.RasterIO(GF_Read, 0, 0, cols, rows, values.data(), cols, rows, GDT_Float32, 2, nullptr, 0, 0, 0),
              CE_None);
    double gt[6];
    warped.GetGeoTransform(gt);
    const MapProjection map("EPSG:32611");
    Placement result;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const auto i = static_cast<std::size_t>(row * cols + col);
            const double sample = values[i], line = values[i + static_cast<std::size_t>(cols * rows)];
            if (std::isnan(sample) || sample == 0.0) continue;
            const Geodetic p = map.to_geodetic(gt[0] + (col + 0.5) * gt[1], gt[3] + (row + 0.5) * gt[5]);
            const auto [s, l] = View::sample_line(p.lon_deg, p.lat_deg);
            result.worst_px = std::max(result.worst_px, std::max(std::abs(s - sample), std::abs(l - line)));
            ++result.compared;
        }
    return result;
}

TEST(Geolocation, IsWrittenWithAbsolutePathAndPixelCentres) {
    const TempFolder folder;
    write_view(folder);
    const auto ds = open_written(folder / "radiance.tif");
    const std::string expected = std::filesystem::weakly_canonical(folder / "geolocation.tif").string();
    EXPECT_EQ(item(ds.get(), "X_DATASET", "GEOLOCATION"), expected);
    EXPECT_EQ(item(ds.get(), "Y_DATASET", "GEOLOCATION"), expected);
    EXPECT_EQ(item(ds.get(), "X_BAND", "GEOLOCATION"), "1");
    EXPECT_EQ(item(ds.get(), "Y_BAND", "GEOLOCATION"), "2");
    EXPECT_EQ(item(ds.get(), "PIXEL_STEP", "GEOLOCATION"), "1");
    EXPECT_EQ(item(ds.get(), "LINE_OFFSET", "GEOLOCATION"), "0");
    EXPECT_EQ(item(ds.get(), "GEOREFERENCING_CONVENTION", "GEOLOCATION"), "PIXEL_CENTER");
    EXPECT_NE(item(ds.get(), "SRS", "GEOLOCATION").find("WGS 84"), std::string::npos);
    EXPECT_EQ(folder.entries(), 2);
}

// gdalwarp -geoloc: nearest neighbour is at most half a pixel away; a tenth is left for the inversion of the arrays.
TEST(Geolocation, GdalwarpPutsEveryPixelInItsPlace) {
    const TempFolder folder;
    write_view(folder);
    const auto warped = warp(folder / "radiance.tif", {"-geoloc", "-r", "near"});
    ASSERT_TRUE(warped);
    const Placement p = placement(*warped);
    EXPECT_GT(p.compared, 8000);
    EXPECT_LE(p.worst_px, 0.6);
}

TEST(Geolocation, BilinearWarpIsWithinATenthOfAPixel) {
    const TempFolder folder;
    write_view(folder);
    const auto warped = warp(folder / "radiance.tif", {"-geoloc", "-r", "bilinear", "-wo", "XSCALE=1", "-wo", "YSCALE=1"});
    ASSERT_TRUE(warped);
    const int cols = warped->GetRasterXSize(), rows = warped->GetRasterYSize();
    std::vector<float> samples(static_cast<std::size_t>(cols * rows));
    ASSERT_EQ(warped->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float32, 0, 0,
                                                 nullptr),
              CE_None);
    double gt[6];
    warped->GetGeoTransform(gt);
    const MapProjection map("EPSG:32611");
    int compared = 0;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const Geodetic p = map.to_geodetic(gt[0] + (col + 0.5) * gt[1], gt[3] + (row + 0.5) * gt[5]);
            const auto [s, l] = View::sample_line(p.lon_deg, p.lat_deg);
            const bool inner = s > 2 && s < kCols - 2 && l > 10 && l < kRows - 2 && !(s > 48 && s < 59 && l > 38 && l < 47);
            if (!inner) continue;
            ASSERT_NEAR(samples[static_cast<std::size_t>(row * cols + col)], s, 0.1);
            ++compared;
        }
    EXPECT_GT(compared, 6000);
}

TEST(ControlPoints, AreTheFallBack) {
    const TempFolder folder;
    write_view(folder);
    const auto ds = open_written(folder / "radiance.tif");
    ASSERT_EQ(ds->GetGCPCount(), 4);
    EXPECT_NEAR(ds->GetGCPs()[0].dfGCPX, View::lon_deg(0.5, 10.5), 1e-12);
    EXPECT_EQ(ds->GetGCPs()[0].dfGCPZ, 1000.0);
    const auto warped = warp(folder / "radiance.tif", {"-order", "1", "-r", "near"});
    ASSERT_TRUE(warped);
    const Placement p = placement(*warped);
    EXPECT_GT(p.compared, 8000);
    EXPECT_LE(p.worst_px, 0.6);
}

}  // namespace
}  // namespace pyroscene::gis
