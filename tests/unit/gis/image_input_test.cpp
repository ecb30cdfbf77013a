#include "gis/raster_output.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "unit/gis/written_raster.h"

namespace pyroscene::gis {
namespace {

TEST(ReadImage, GivesBackWhatWasWritten) {
    const TempFolder folder;
    const auto pixels = two_bands_of_pixels(60, 50);
    write_geotiff(folder / "a.tif", two_bands(60, 50), std::span<const float>(pixels));
    const ImageFile image = read_image(folder / "a.tif");
    EXPECT_EQ(image.cols, 60);
    EXPECT_EQ(image.rows, 50);
    ASSERT_EQ(image.bands.size(), 2u);
    EXPECT_EQ(image.bands[0].description, "MWIR 3.0-5.0 um radiance");
    EXPECT_EQ(image.bands[0].unit, "W m-2 sr-1 um-1");
    EXPECT_EQ(image.bands[0].wavelength_um, 3.95);
    EXPECT_EQ(image.bands[1].fwhm_um, 2.5);
    EXPECT_EQ(image.bands[0].metadata, (std::map<std::string, std::string>{{"band_id", "MWIR"}}));
    EXPECT_EQ(image.metadata.at("synthetic"), "true");
    for (std::size_t i = 0; i < pixels.size(); ++i)
        ASSERT_TRUE(image.pixels[i] == pixels[i] || (std::isnan(image.pixels[i]) && std::isnan(pixels[i])));
}

TEST(ReadImage, ABandOrAPixelIsThatOfTheWhole) {
    const TempFolder folder;
    OutputRaster raster = two_bands(70, 50);
    raster.tile_rows = 16;
    auto pixels = two_bands_of_pixels(70, 50);
    pixels[3] = std::nanf("");
    write_geotiff(folder / "a.tif", raster, std::span<const float>(pixels));
    const auto second = read_image_band(folder / "a.tif", 2);
    ASSERT_EQ(second.size(), 70u * 50u);
    for (std::size_t i = 0; i < second.size(); ++i) {
        const float written = pixels[second.size() + i];
        ASSERT_TRUE(second[i] == written || (std::isnan(second[i]) && std::isnan(written))) << i;
    }
    EXPECT_EQ(read_image_pixel(folder / "a.tif", 2, 69, 49), pixels.back());
    EXPECT_TRUE(std::isnan(read_image_pixel(folder / "a.tif", 1, 3, 0)));
    EXPECT_THROW((void)read_image_band(folder / "a.tif", 3), Error);
    EXPECT_THROW((void)read_image_pixel(folder / "a.tif", 0, 0, 0), Error);
}

TEST(ReadImage, UnderstandsNanometresAndScales) {
    const TempFolder folder;
    SourceRaster source{.type = "Int16", .nodata = -1.0, .scale = 0.01, .offset = 5.0};
    source.band([](int c, int) { return c == 0 ? -1 : 100 * c; }).write(folder / "a.tif");
    {
        const TestDataset ds(GDALDataset::Open((folder / "a.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        ds->GetRasterBand(1)->SetMetadataItem("wavelength", "2210");
        ds->GetRasterBand(1)->SetMetadataItem("wavelength_units", "Nanometers");
    }
    const ImageFile image = read_image(folder / "a.tif");
    EXPECT_NEAR(*image.bands[0].wavelength_um, 2.21, 1e-12);
    EXPECT_FALSE(image.bands[0].fwhm_um);
    EXPECT_TRUE(std::isnan(image.pixels[0]));
    EXPECT_DOUBLE_EQ(image.pixels[3], 8.0);
}

TEST(ReadMetadata, IsNothingForWhatIsNoRaster) {
    const TempFolder folder;
    EXPECT_FALSE(read_metadata(folder / "missing.tif"));
    write_text_file(folder / "text.tif", "text");
    EXPECT_FALSE(read_metadata(folder / "text.tif"));
    const std::vector<float> pixels(16, 1.0f);
    write_cog(folder / "a.tif", two_bands(4, 2), pixels);
    EXPECT_EQ(read_metadata(folder / "a.tif")->at("run"), "abc <&> \"quoted\"");
}

}  // namespace
}  // namespace pyroscene::gis
