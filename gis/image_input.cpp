#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/band_description.h"
#include "gis/gdal_support.h"
#include "gis/raster_output.h"
#include "gis/tags.h"
#include "gis/units.h"

namespace pyroscene::gis {
namespace {

std::optional<double> micrometres(const char* value, const char* unit) {
    if (value == nullptr) return std::nullopt;
    char* end = nullptr;
    const double number = std::strtod(value, &end);
    if (end == value) return std::nullopt;
    const auto conversion = unit_conversion(unit == nullptr ? "um" : unit, "um");
    return conversion ? std::optional(conversion->scale * number) : std::nullopt;
}

/// Whether pixels may be invalid that do not hold NaN.
bool has_mask(GDALRasterBand& band) {
    const int flags = band.GetMaskFlags();
    if ((flags & GMF_ALL_VALID) != 0) return false;
    return flags != GMF_NODATA || !std::isnan(band.GetNoDataValue());
}

void read_pixels(GDALRasterBand& band, double* out, int cols, int rows, const std::string& subject,
                 const GdalErrors& errors) {
    const bool masked = has_mask(band);
    std::vector<unsigned char> mask(masked ? static_cast<std::size_t>(cols) : 0);
    const double scale = band.GetScale(), offset = band.GetOffset();
    // Rows are read in blocks' height so that every tile is decompressed once (its rows stay in GDAL's cache).
    for (int row = 0; row < rows; ++row, out += cols) {
        CPLErr status = band.RasterIO(GF_Read, 0, row, cols, 1, out, cols, 1, GDT_Float64, 0, 0, nullptr);
        if (masked && status == CE_None)
            status = band.GetMaskBand()->RasterIO(GF_Read, 0, row, cols, 1, mask.data(), cols, 1, GDT_Byte, 0, 0, nullptr);
        if (status != CE_None) throw input_error(subject, "cannot be read: " + errors.message());
        for (int col = 0; col < cols; ++col) {
            const bool valid = !masked || mask[static_cast<std::size_t>(col)] != 0;
            out[col] = valid ? scale * out[col] + offset : std::numeric_limits<double>::quiet_NaN();
        }
    }
}

GDALRasterBand& band_of(GDALDataset& dataset, int band, const std::string& subject) {
    if (band < 1 || band > dataset.GetRasterCount())
        throw input_error(subject, fmt::format("band {} is asked for, found {}", band, dataset.GetRasterCount()));
    return *dataset.GetRasterBand(band);
}

}  // namespace

OutputBand describe_band(GDALRasterBand& band) {
    OutputBand info;
    info.description = band.GetDescription();
    info.unit = band.GetUnitType();
    const char* unit = band.GetMetadataItem("wavelength_units");
    info.wavelength_um = micrometres(band.GetMetadataItem("wavelength"), unit);
    if (!info.wavelength_um)
        info.wavelength_um = micrometres(band.GetMetadataItem("CENTRAL_WAVELENGTH_UM", "IMAGERY"), "um");
    info.fwhm_um = micrometres(band.GetMetadataItem("fwhm"), unit);
    if (!info.fwhm_um) info.fwhm_um = micrometres(band.GetMetadataItem("FWHM_UM", "IMAGERY"), "um");
    for (const auto& [key, value] : default_metadata(band))
        if (!is_derived_band_key(key)) info.metadata.emplace(key, value);
    return info;
}

ImageFile read_image(const std::filesystem::path& path, int most_bands) {
    const DatasetPtr dataset = open_raster(path);
    const GdalErrors errors;
    ImageFile image;
    image.cols = dataset->GetRasterXSize();
    image.rows = dataset->GetRasterYSize();
    image.metadata = default_metadata(*dataset);
    const std::size_t band_size = static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows);
    const int count = std::min(most_bands, dataset->GetRasterCount());
    image.pixels.resize(band_size * static_cast<std::size_t>(count));
    for (int b = 1; b <= count; ++b) {
        GDALRasterBand& band = *dataset->GetRasterBand(b);
        image.bands.push_back(describe_band(band));
        double* out = image.pixels.data() + band_size * static_cast<std::size_t>(b - 1);
        read_pixels(band, out, image.cols, image.rows, path.string(), errors);
    }
    return image;
}

std::vector<double> read_image_band(const std::filesystem::path& path, int band) {
    const DatasetPtr dataset = open_raster(path);
    const GdalErrors errors;
    const int cols = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
    std::vector<double> pixels(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    read_pixels(band_of(*dataset, band, path.string()), pixels.data(), cols, rows, path.string(), errors);
    return pixels;
}

double read_image_pixel(const std::filesystem::path& path, int band, int col, int row) {
    const DatasetPtr dataset = open_raster(path);
    double value = std::nan("");
    const GdalErrors errors;
    if (band_of(*dataset, band, path.string()).RasterIO(GF_Read, col, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr) !=
        CE_None)
        throw input_error(path.string(), "cannot be read: " + errors.message());
    return value;
}

std::optional<std::map<std::string, std::string>> read_metadata(const std::filesystem::path& path) {
    initialise_gdal();
    const GdalErrors errors;
    const DatasetPtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (!dataset) return std::nullopt;
    return default_metadata(*dataset);
}

}  // namespace pyroscene::gis
