#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "gis/crs.h"
#include "gis/gdal_support.h"

/// One band of a raster file, checked, and its pixels as canonical values.
namespace pyroscene::gis {

/// An opened band with everything needed to place and to convert its pixels.
struct SourceBand {
    DatasetPtr dataset;
    std::string subject;  ///< "<file>, band <n>", for messages
    int band = 1, cols = 0, rows = 0;
    std::array<double, 6> geotransform{};
    CrsInfo crs;
    double scale = 1.0, offset = 0.0;  ///< canonical = scale * stored + offset (file's scale and offset, then the unit)
    double least = -std::numeric_limits<double>::infinity();  ///< canonical values below are no data
};

/// A rectangle of pixels.
struct PixelWindow {
    int col = 0, row = 0, cols = 0, rows = 0;
    [[nodiscard]] bool empty() const noexcept { return cols <= 0 || rows <= 0; }
    [[nodiscard]] std::size_t size() const noexcept {
        return static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
    }
};

/// Opens a band. `unit` is canonical; empty = stored numbers are taken as they are (classes).
/// Input errors: file, georeference or CRS missing, too few bands, unit of another quantity.
SourceBand open_band(const std::filesystem::path& path, int band, const std::string& unit);

/// Turns to another band of the same file. Input errors as above.
void choose_band(SourceBand& source, const std::filesystem::path& path, int band, const std::string& unit);

/// Georeference of a dataset; input error without one.
std::array<double, 6> require_geotransform(GDALDataset& dataset, const std::string& subject);
/// CRS of a dataset; input error when there is none or it is neither geographic nor projected.
CrsInfo require_crs(GDALDataset& dataset, const std::string& subject);

/// Canonical values of a window inside the raster, row-major; nodata, masked and infinite pixels are NaN.
std::vector<float> read_window(const SourceBand& source, const PixelWindow& window);

}  // namespace pyroscene::gis
