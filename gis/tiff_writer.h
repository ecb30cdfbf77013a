#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "gis/raster_output.h"

namespace pyroscene::gis {

/// Pixels of a file in the making: rows [first_row, first_row + rows) of `bands` bands from `first_band` (0 = first) on.
struct RasterPart {
    std::size_t first_band = 0, bands = 1;
    int first_row = 0, rows = 0;
};

/// Writes a tiled, compressed GeoTIFF part by part, so that memory holds a part and never the raster: a band at a time, or
/// some rows of all bands. Pixels and descriptions are the same whatever the parts; the file appears when it is finished.
/// Not for several threads at once.
class TiffWriter {
public:
    enum class Sample { Float32, Float64 };  ///< Byte where the raster holds classes

    /// Throws a runtime error naming the file: sizes that do not fit, a file that cannot be made.
    TiffWriter(const std::filesystem::path& path, OutputRaster raster, Sample sample = Sample::Float32);
    TiffWriter(TiffWriter&&) noexcept;
    ~TiffWriter();

    [[nodiscard]] const OutputRaster& raster() const noexcept;
    /// Height of the tiles: where parts may begin and end, besides the last row.
    [[nodiscard]] int tile_rows() const noexcept;
    /// `pixels` is [band][row][col] of the part. Each pixel of the raster is written once; rows of one band in ascending order.
    void write(const RasterPart& part, std::span<const float> pixels);
    void write(const RasterPart& part, std::span<const double> pixels);
    /// Control points that are known only when all pixels are.
    void set_control_points(std::vector<GroundControlPoint> points);
    /// Statistics and descriptions, then the final name. Throws a runtime error when parts are missing.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Rows of a part that takes about 64 MB when a row of the whole raster holds so many values; TIFF's tiles are multiples of 16.
int rows_of_part(std::size_t values_per_row, int rows) noexcept;

/// Writes a Cloud-Optimized GeoTIFF (overviews by average, nearest for classes, statistics) band by band. Needs a map grid, or
/// `like` with a raster on a map. Bands wait, uncompressed, in a file beside the target that is removed in the end.
class CogWriter {
public:
    CogWriter(const std::filesystem::path& path, OutputRaster raster);
    CogWriter(CogWriter&&) noexcept;
    ~CogWriter();

    /// \param band  from 0 on, each once
    void write_band(std::size_t band, std::span<const float> pixels);
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pyroscene::gis
