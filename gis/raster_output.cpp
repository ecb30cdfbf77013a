#include "gis/raster_output.h"

#include <fmt/format.h>

#include "base/error.h"
#include "gis/tiff_writer.h"

namespace pyroscene::gis {
namespace {

void require_all(const std::filesystem::path& path, const OutputRaster& raster, std::size_t pixels) {
    const auto band = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    if (pixels != band * raster.bands.size())
        throw runtime_error(path.string(), fmt::format("cannot be written: {} pixels for {} bands of {} x {}", pixels,
                                                       raster.bands.size(), raster.cols, raster.rows));
}

template <class T>
void write_whole(const std::filesystem::path& path, const OutputRaster& raster, std::span<const T> pixels,
                 TiffWriter::Sample sample) {
    require_all(path, raster, pixels.size());
    TiffWriter writer(path, raster, sample);
    writer.write({0, raster.bands.size(), 0, raster.rows}, pixels);
    writer.finish();
}

}  // namespace

void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels) {
    write_whole(path, raster, pixels, TiffWriter::Sample::Float32);
}

void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const double> pixels) {
    write_whole(path, raster, pixels, TiffWriter::Sample::Float64);
}

void write_cog(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels) {
    require_all(path, raster, pixels.size());
    CogWriter writer(path, raster);
    const auto band = static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    for (std::size_t b = 0; b < raster.bands.size(); ++b) writer.write_band(b, pixels.subspan(b * band, band));
    writer.finish();
}

}  // namespace pyroscene::gis
