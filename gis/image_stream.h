#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gis/raster_output.h"

namespace pyroscene::gis {

/// What an image says of itself.
struct ImageInfo {
    int cols = 0, rows = 0;
    std::vector<OutputBand> bands;
    std::map<std::string, std::string> metadata;  ///< default domain
    bool on_map = false;                          ///< has a CRS and an affine transform
    std::string geolocation;                      ///< file of its geolocation arrays; empty = none
};

/// Reads any raster that GDAL knows a few lines at a time: memory does not grow with the image. Not for several threads at
/// once.
class ImageStream {
public:
    /// Throws an input error: missing file, not a raster.
    explicit ImageStream(const std::filesystem::path& path);
    ~ImageStream();
    ImageStream(ImageStream&&) noexcept;

    [[nodiscard]] const ImageInfo& info() const noexcept;
    [[nodiscard]] const std::filesystem::path& path() const noexcept;
    /// Lines [first, first + count) as [band][line][sample]; nodata becomes NaN, scale and offset are applied.
    /// Throws an input error naming the file when it cannot be read.
    void read(int first, int count, std::span<float> out);
    /// One band as a whole, [line][sample]. \param band  from 1
    [[nodiscard]] std::vector<float> read_band(int band);
    /// One value; reads no more of the file than the block it is in. \param band  from 1
    [[nodiscard]] float read_value(int band, int sample, int line);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pyroscene::gis
