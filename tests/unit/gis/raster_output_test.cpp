#include "gis/raster_output.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "gis/image_stream.h"
#include "gis/tiff_writer.h"
#include "unit/gis/written_raster.h"

namespace pyroscene::gis {
namespace {

std::vector<float> pixels_of(GDALDataset& dataset, int band) {
    std::vector<float> pixels(static_cast<std::size_t>(dataset.GetRasterXSize()) *
                              static_cast<std::size_t>(dataset.GetRasterYSize()));
    EXPECT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Read, 0, 0, dataset.GetRasterXSize(), dataset.GetRasterYSize(),
                                                    pixels.data(), dataset.GetRasterXSize(), dataset.GetRasterYSize(),
                                                    GDT_Float32, 0, 0, nullptr),
              CE_None);
    return pixels;
}

void expect_same_pixels(GDALDataset& dataset, const std::vector<float>& expected) {
    const auto first = pixels_of(dataset, 1), second = pixels_of(dataset, 2);
    for (std::size_t i = 0; i < first.size(); ++i) {
        ASSERT_TRUE(first[i] == expected[i] || (std::isnan(first[i]) && std::isnan(expected[i]))) << i;
        const float other = expected[first.size() + i];
        ASSERT_TRUE(second[i] == other || (std::isnan(second[i]) && std::isnan(other))) << i;
    }
}

/// Everything the raster has to say of itself, whatever its format.
void expect_described(GDALDataset& ds) {
    EXPECT_EQ(item(&ds, "synthetic"), "true");
    EXPECT_EQ(item(&ds, "run"), "abc <&> \"quoted\"");
    EXPECT_EQ(item(&ds, "TIFFTAG_DATETIME"), "2017:07:15 23:00:01");
    EXPECT_EQ(item(&ds, "ACQUISITION_DATE"), "2017-07-15T23:00:01.250Z");
    EXPECT_EQ(item(&ds, "ACQUISITIONDATETIME", "IMAGERY"), "2017-07-15 23:00:01");
    EXPECT_EQ(item(&ds, "wavelength", "ENVI"), "{3.95, 9.5}");
    EXPECT_EQ(item(&ds, "wavelength_units", "ENVI"), "Micrometers");
    EXPECT_EQ(item(&ds, "fwhm", "ENVI"), "{1.5, 2.5}");
    EXPECT_EQ(item(&ds, "band_names", "ENVI"), "{MWIR 3.0-5.0 um radiance, LWIR; wide}");
    EXPECT_EQ(item(&ds, "data_ignore_value", "ENVI"), "nan");

    GDALRasterBand* band = ds.GetRasterBand(2);
    EXPECT_STREQ(band->GetDescription(), "LWIR, wide");
    EXPECT_STREQ(band->GetUnitType(), "W m-2 sr-1 um-1");
    EXPECT_TRUE(std::isnan(band->GetNoDataValue()));
    EXPECT_EQ(item(band, "wavelength"), "9.5");
    EXPECT_EQ(item(band, "wavelength_units"), "Micrometers");
    EXPECT_EQ(item(band, "fwhm"), "2.5");
    EXPECT_EQ(item(band, "bbl"), "1");
    EXPECT_EQ(item(band, "CENTRAL_WAVELENGTH_UM", "IMAGERY"), "9.5");
    EXPECT_EQ(item(band, "FWHM_UM", "IMAGERY"), "2.5");
    EXPECT_EQ(item(ds.GetRasterBand(1), "band_id"), "MWIR");
    EXPECT_EQ(item(ds.GetRasterBand(1), "CENTRAL_WAVELENGTH_UM", "IMAGERY"), "3.95");

    EXPECT_NE(std::string(ds.GetProjectionRef()).find("UTM zone 11N"), std::string::npos);
    double gt[6];
    ASSERT_EQ(ds.GetGeoTransform(gt), CE_None);
    EXPECT_EQ(gt[0], 713982.992);
    EXPECT_EQ(gt[5], -3.0);
}

double stored(GDALDataset& ds, int band, const char* key) { return std::stod(item(ds.GetRasterBand(band), key)); }

TEST(GeoTiff, IsTiledCompressedAndDescribed) {
    const TempFolder folder;
    const auto pixels = two_bands_of_pixels(700, 530);
    write_geotiff(folder / "a.tif", two_bands(700, 530), std::span<const float>(pixels));
    const auto ds = open_written(folder / "a.tif");
    ASSERT_TRUE(ds);
    expect_described(*ds);
    expect_same_pixels(*ds, pixels);
    EXPECT_EQ(item(ds.get(), "COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    EXPECT_EQ(item(ds.get(), "PREDICTOR", "IMAGE_STRUCTURE"), "3");
    int width = 0, height = 0;
    ds->GetRasterBand(1)->GetBlockSize(&width, &height);
    EXPECT_EQ(width, 352);  // two across, two down
    EXPECT_EQ(height, 272);
    EXPECT_EQ(folder.entries(), 1);  // no .aux.xml, no temporary
}

TEST(GeoTiff, HoldsTheStatisticsOfItsPixels) {
    const TempFolder folder;
    OutputRaster raster = two_bands(4, 2);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    // Band 1: 2, 4, 4, 4, 5, 5, 7, 9: mean 5, population standard deviation 2. Band 2: nothing.
    const std::vector<float> pixels{2, 4, 4, 4, 5, 5, 7, 9, nan, nan, nan, nan, nan, nan, nan, nan};
    write_geotiff(folder / "a.tif", raster, std::span<const float>(pixels));
    write_cog(folder / "b.tif", raster, pixels);
    for (const char* name : {"a.tif", "b.tif"}) {
        const auto ds = open_written(folder / name);
        EXPECT_EQ(stored(*ds, 1, "STATISTICS_MINIMUM"), 2.0);
        EXPECT_EQ(stored(*ds, 1, "STATISTICS_MAXIMUM"), 9.0);
        EXPECT_EQ(stored(*ds, 1, "STATISTICS_MEAN"), 5.0);
        EXPECT_EQ(stored(*ds, 1, "STATISTICS_STDDEV"), 2.0);
        EXPECT_EQ(stored(*ds, 1, "STATISTICS_VALID_PERCENT"), 100.0);
        EXPECT_EQ(item(ds->GetRasterBand(2), "STATISTICS_MEAN"), "(none)");
        EXPECT_EQ(stored(*ds, 2, "STATISTICS_VALID_PERCENT"), 0.0);
    }
}

TEST(GeoTiff, TheStatisticsSkipHolesWhereverTheyAre) {
    const TempFolder folder;
    constexpr int kCols = 7, kRows = 53;  // several parts, none a multiple of four pixels
    OutputRaster raster = two_bands(kCols, kRows);
    raster.tile_rows = 16;
    std::vector<float> pixels;
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int i = 0; i < 2 * kCols * kRows; ++i) {
        const bool hole = i < 3 || i % 11 == 5;
        pixels.push_back(hole ? std::numeric_limits<float>::quiet_NaN() : 300.0F + static_cast<float>(i % 17));
        if (hole || i >= kCols * kRows) continue;
        sum += i % 17, squares += (i % 17) * (i % 17), count += 1.0;
    }
    TiffWriter writer(folder / "a.tif", raster);
    for (std::size_t b = 0; b < 2; ++b)
        for (int row = 0; row < kRows; row += writer.tile_rows()) {
            const int rows = std::min(writer.tile_rows(), kRows - row);
            writer.write({b, 1, row, rows},
                         std::span<const float>(pixels).subspan(b * kCols * kRows + static_cast<std::size_t>(row * kCols),
                                                                static_cast<std::size_t>(rows * kCols)));
        }
    writer.finish();
    const auto ds = open_written(folder / "a.tif");
    EXPECT_EQ(stored(*ds, 1, "STATISTICS_MINIMUM"), 300.0);
    EXPECT_EQ(stored(*ds, 1, "STATISTICS_MAXIMUM"), 316.0);
    EXPECT_NEAR(stored(*ds, 1, "STATISTICS_MEAN"), 300.0 + sum / count, 1e-9);
    EXPECT_NEAR(stored(*ds, 1, "STATISTICS_STDDEV"), std::sqrt(squares / count - sum * sum / count / count), 1e-9);
    EXPECT_NEAR(stored(*ds, 1, "STATISTICS_VALID_PERCENT"), 100.0 * count / (kCols * kRows), 1e-3);

    ImageStream stream(folder / "a.tif");  // single values are those of the band
    const auto band = stream.read_band(2);
    for (const int i : {0, 5, 100, kCols * kRows - 1}) {
        const float value = stream.read_value(2, i % kCols, i / kCols), expected = band[static_cast<std::size_t>(i)];
        EXPECT_TRUE(value == expected || (std::isnan(value) && std::isnan(expected))) << i;
    }
}

TEST(GeoTiff, ASmallRasterHasSmallTiles) {
    const TempFolder folder;
    const auto pixels = two_bands_of_pixels(40, 21);
    write_geotiff(folder / "a.tif", two_bands(40, 21), std::span<const float>(pixels));
    const auto ds = open_written(folder / "a.tif");
    int width = 0, height = 0;
    ds->GetRasterBand(1)->GetBlockSize(&width, &height);
    EXPECT_EQ(width, 48);
    EXPECT_EQ(height, 32);
    expect_same_pixels(*ds, pixels);
}

TEST(GeoTiff, TheFileIsTheSameForAnyNumberOfThreads) {
    const TempFolder folder;
    const auto pixels = two_bands_of_pixels(1100, 900);
    for (const auto compression : {Compression::Deflate, Compression::Zstd}) {
        OutputRaster raster = two_bands(1100, 900);
        raster.compression = compression;
        for (const int threads : {1, 2, 3}) {
            const CompressionThreads limit(threads);
            write_geotiff(folder / ("g" + std::to_string(threads)), raster, std::span<const float>(pixels));
            write_cog(folder / ("c" + std::to_string(threads)), raster, pixels);
        }
        EXPECT_TRUE(read_text_file(folder / "g1") == read_text_file(folder / "g2"));
        EXPECT_TRUE(read_text_file(folder / "g1") == read_text_file(folder / "g3"));
        EXPECT_TRUE(read_text_file(folder / "c1") == read_text_file(folder / "c2"));
        EXPECT_TRUE(read_text_file(folder / "c1") == read_text_file(folder / "c3"));
    }
}

TEST(GeoTiff, RasterIsTheSameInPartsAndAtOnce) {
    const TempFolder folder;
    OutputRaster raster = two_bands(300, 250);
    raster.tile_rows = 100;  // three tiles of 96
    const auto pixels = two_bands_of_pixels(300, 250);
    write_geotiff(folder / "whole.tif", raster, std::span<const float>(pixels));
    TiffWriter rows(folder / "rows.tif", raster), bands(folder / "bands.tif", raster);
    ASSERT_EQ(rows.tile_rows(), 96);
    EXPECT_EQ(folder.entries(), 3);  // two of them under temporary names
    std::vector<float> part;
    for (int first = 0; first < 250; first += 96) {
        const int count = std::min(96, 250 - first);
        part.clear();
        for (std::size_t b = 0; b < 2; ++b) {
            const auto from = pixels.begin() + static_cast<std::ptrdiff_t>(b * 75000) + 300 * first;
            part.insert(part.end(), from, from + 300 * count);
        }
        rows.write({0, 2, first, count}, part);
    }
    for (std::size_t b : {1U, 0U}) bands.write({b, 1, 0, 250}, std::span(pixels).subspan(b * 75000, 75000));
    rows.finish();
    bands.finish();
    for (const char* name : {"whole.tif", "rows.tif", "bands.tif"}) {
        const auto ds = open_written(folder / name);
        ASSERT_TRUE(ds) << name;
        expect_described(*ds);
        expect_same_pixels(*ds, pixels);
        EXPECT_EQ(stored(*ds, 2, "STATISTICS_MEAN"), stored(*open_written(folder / "whole.tif"), 2, "STATISTICS_MEAN"));
    }
}

TEST(GeoTiff, RefusesPartsThatDoNotFitAndRastersWithHoles) {
    const TempFolder folder;
    OutputRaster raster = two_bands(300, 250);
    raster.tile_rows = 100;
    {
        TiffWriter writer(folder / "a.tif", raster);
        const std::vector<float> rows(300 * 96, 1.0F);
        const auto fails = [&](const RasterPart& part) {
            try {
                writer.write(part, rows);
            } catch (const Error&) {
                return true;
            }
            return false;
        };
        EXPECT_TRUE(fails({2, 1, 0, 96}));    // no such band
        EXPECT_TRUE(fails({0, 1, 50, 96}));   // not at a tile
        EXPECT_TRUE(fails({0, 1, 0, 95}));    // not as many pixels
        EXPECT_TRUE(fails({0, 1, 192, 96}));  // beyond the last row
        EXPECT_FALSE(fails({0, 1, 96, 96}));
        EXPECT_THROW(writer.finish(), Error);
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(GeoTiff, KeepsDoublePrecision) {
    const TempFolder folder;
    OutputRaster raster;
    raster.cols = 3, raster.rows = 1;
    raster.bands = {{.description = "longitude", .unit = "degree"}};
    const std::vector<double> pixels{-114.123456789012, 1.0 / 3.0, std::nan("")};
    write_geotiff(folder / "a.tif", raster, std::span<const double>(pixels));
    const ImageFile image = read_image(folder / "a.tif");
    EXPECT_EQ(image.pixels[0], pixels[0]);
    EXPECT_EQ(image.pixels[1], pixels[1]);
    EXPECT_TRUE(std::isnan(image.pixels[2]));
}

TEST(Cog, HasLayoutOverviewsAndEveryDescription) {
    const TempFolder folder;
    const auto pixels = two_bands_of_pixels(1300, 1100);
    write_cog(folder / "a.tif", two_bands(1300, 1100), pixels);
    EXPECT_EQ(folder.entries(), 1);
    const auto ds = open_written(folder / "a.tif");
    ASSERT_TRUE(ds);
    expect_described(*ds);
    expect_same_pixels(*ds, pixels);
    EXPECT_EQ(item(ds.get(), "LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_EQ(item(ds.get(), "PYROSCENE_RESERVED"), "(none)");
    int width = 0, height = 0;
    ds->GetRasterBand(1)->GetBlockSize(&width, &height);
    EXPECT_EQ(width, 512);
    EXPECT_EQ(height, 512);
    ASSERT_EQ(ds->GetRasterBand(2)->GetOverviewCount(), 2);
    GDALRasterBand* half = ds->GetRasterBand(2)->GetOverview(0);
    EXPECT_EQ(half->GetXSize(), 650);
    float value = 0;
    // Mean of columns 200 and 201, rows 300 and 301 of band 2, whose value is 1000 + row + 0.01 column.
    ASSERT_EQ(half->RasterIO(GF_Read, 100, 150, 1, 1, &value, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
    EXPECT_NEAR(value, 1000.0 + 300.5 + 2.005, 1e-3);
    // Column 2 of the overview mixes columns 4 (nodata) and 5 (valid): nodata stays out of the mean.
    ASSERT_EQ(half->RasterIO(GF_Read, 2, 0, 1, 1, &value, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
    EXPECT_NEAR(value, 1000.0 + 0.5 + 0.05, 1e-3);
}

TEST(Cog, AHundredBandsKeepTheirWavelengths) {
    const TempFolder folder;
    OutputRaster raster = two_bands(30, 20);
    raster.bands.clear();
    for (int b = 0; b < 100; ++b)
        raster.bands.push_back(
            {.description = "band " + std::to_string(b), .unit = "1", .wavelength_um = 0.4 + 0.01 * b, .fwhm_um = 0.01});
    write_cog(folder / "a.tif", raster, std::vector<float>(30 * 20 * 100, 1.0f));
    const ImageFile image = read_image(folder / "a.tif");
    ASSERT_EQ(image.bands.size(), 100u);
    EXPECT_EQ(image.bands[99].description, "band 99");
    EXPECT_NEAR(*image.bands[99].wavelength_um, 1.39, 1e-12);
    const auto ds = open_written(folder / "a.tif");
    EXPECT_NEAR(std::stod(item(ds->GetRasterBand(100), "CENTRAL_WAVELENGTH_UM", "IMAGERY")), 1.39, 1e-12);
}

OutputRaster classes_raster(int cols, int rows) {
    OutputRaster raster = two_bands(cols, rows);
    raster.bands = {{.description = "fire class"}};
    raster.classes = true;
    raster.class_names = {"unburned", "front", "scar"};
    return raster;
}

TEST(ClassRaster, IsByteWithColoursAndNames) {
    const TempFolder folder;
    std::vector<float> pixels(600 * 600);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i % 3);
    pixels[1] = std::numeric_limits<float>::quiet_NaN();
    write_geotiff(folder / "a.tif", classes_raster(600, 600), std::span<const float>(pixels));
    write_cog(folder / "b.tif", classes_raster(600, 600), pixels);
    for (const char* name : {"a.tif", "b.tif"}) {
        const auto ds = open_written(folder / name);
        GDALRasterBand* band = ds->GetRasterBand(1);
        EXPECT_EQ(band->GetRasterDataType(), GDT_Byte) << name;
        EXPECT_EQ(band->GetNoDataValue(), 255.0);
        ASSERT_NE(band->GetColorTable(), nullptr);
        EXPECT_NE(band->GetColorTable()->GetColorEntry(1)->c1, band->GetColorTable()->GetColorEntry(2)->c1);
        EXPECT_EQ(item(band, "class_names"), "{unburned, front, scar}");
        EXPECT_EQ(item(ds.get(), "class_names", "ENVI"), "{unburned, front, scar}");
        EXPECT_EQ(item(ds.get(), "classes", "ENVI"), "3");
        const auto codes = pixels_of(*ds, 1);
        EXPECT_EQ(codes[0], 0.0f);
        EXPECT_EQ(codes[1], 255.0f);
        EXPECT_EQ(codes[2], 2.0f);
        EXPECT_TRUE(std::isnan(read_image(folder / name).pixels[1]));
    }
    // Overviews of classes hold classes, never means: every code is one of the three or nodata.
    const auto cog = open_written(folder / "b.tif");
    ASSERT_EQ(cog->GetRasterBand(1)->GetOverviewCount(), 1);
    std::vector<float> half(300 * 300);
    ASSERT_EQ(cog->GetRasterBand(1)->GetOverview(0)->RasterIO(GF_Read, 0, 0, 300, 300, half.data(), 300, 300, GDT_Float32, 0,
                                                              0, nullptr),
              CE_None);
    for (const float v : half) ASSERT_TRUE(v == 0.0f || v == 1.0f || v == 2.0f || v == 255.0f);
}

std::string runtime_error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Runtime);
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

TEST(Writers, NameTheFileThatFailedAndLeaveNothing) {
    const TempFolder folder;
    write_text_file(folder / "file", "in the way");
    const std::vector<float> pixels(2 * 4 * 2, 1.0f);
    const auto bad_path = folder / "file/inside.tif";
    EXPECT_NE(runtime_error_of([&] {
                  write_geotiff(bad_path, two_bands(4, 2), std::span<const float>(pixels));
              }).find("inside.tif"),
              std::string::npos);
    EXPECT_NE(runtime_error_of([&] { write_cog(bad_path, two_bands(4, 2), pixels); }).find("inside.tif"), std::string::npos);
    const auto path = folder / "a.tif";
    EXPECT_NE(runtime_error_of([&] { write_cog(path, two_bands(5, 2), pixels); }).find("16 pixels for 2 bands of 5 x 2"),
              std::string::npos);
    OutputRaster raster = two_bands(4, 2);
    raster.grid->cols = 9;
    EXPECT_NE(runtime_error_of([&] { write_cog(path, raster, pixels); }).find("map grid of 9 x 2"), std::string::npos);
    raster.grid.reset();
    EXPECT_NE(runtime_error_of([&] { write_cog(path, raster, pixels); }).find("needs a map grid"), std::string::npos);
    raster = two_bands(4, 2);
    raster.acquisition_time = "yesterday";
    EXPECT_NE(runtime_error_of([&] { write_cog(path, raster, pixels); }).find("acquisition time 'yesterday'"),
              std::string::npos);
    const std::vector<float> half(8, 0.5f);
    EXPECT_NE(runtime_error_of([&] { write_cog(path, classes_raster(4, 2), half); }).find("0.5 is not a class"),
              std::string::npos);
    EXPECT_EQ(folder.entries(), 1);
}

/// A disk with room for 100 kB: writes beyond fail with EFBIG.
class SmallDisk {
public:
    SmallDisk() : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit small = before_;
        small.rlim_cur = 100000;
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        (void)std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST(Writers, AFullDiskIsAnErrorAndLeavesNothing) {
    const TempFolder folder;
    std::vector<float> noise(2 * 700 * 600);
    for (std::size_t i = 0; i < noise.size(); ++i)
        noise[i] = static_cast<float>(uniform01({.seed = 1, .stream = 2, .frame = 3}, i));
    {
        const SmallDisk disk;
        EXPECT_NE(runtime_error_of([&] {
                      write_geotiff(folder / "a.tif", two_bands(700, 600), std::span<const float>(noise));
                  }).find("a.tif: cannot be written"),
                  std::string::npos);
        EXPECT_NE(runtime_error_of([&] {
                      write_cog(folder / "b.tif", two_bands(700, 600), noise);
                  }).find("b.tif: cannot be written"),
                  std::string::npos);
    }
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace pyroscene::gis
