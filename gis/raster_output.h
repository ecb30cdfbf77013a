#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/map_grid.h"

namespace pyroscene::gis {

/// What a band carries besides its pixels. Wavelengths are written in band metadata (wavelength, wavelength_units, fwhm), in
/// the ENVI domain and in the IMAGERY domain.
struct OutputBand {
    std::string description{}, unit{};
    std::optional<double> wavelength_um{}, fwhm_um{};
    std::map<std::string, std::string> metadata{};
};

/// Ties pixels of a sensor-geometry image to the ground.
struct GroundControlPoint {
    double sample = 0.0, line = 0.0;  ///< pixel corner at integers
    double lon_deg = 0.0, lat_deg = 0.0, h_m = 0.0;
};

/// Deflate is read by every program; Zstd is several times faster on large image cubes, but some commercial readers lack it;
/// None is for files that do not stay.
enum class Compression { Deflate, Zstd, None };

/// Of images that others read: Zstd from 65 bands on (imaging spectrometers), where DEFLATE takes most of a run's time.
inline Compression compression_of_image(std::size_t bands) noexcept {
    return bands > 64 ? Compression::Zstd : Compression::Deflate;
}

/// Description of an output raster. Float32 with NaN nodata, or Byte with nodata 255 when `classes` is set.
struct OutputRaster {
    int cols = 0, rows = 0;
    std::vector<OutputBand> bands;
    std::optional<MapGrid> grid;  ///< map geometry: CRS and transform
    std::optional<std::filesystem::path>
        geolocation;                                 ///< sensor geometry: file with longitude in band 1, latitude in band 2
    std::vector<GroundControlPoint> control_points;  ///< sensor geometry: fall-back for programs without geolocation arrays
    std::optional<std::filesystem::path> like;  ///< instead of these three: a raster of the same size whose CRS, transform,
                                                ///< control points and geolocation arrays are taken over
    std::map<std::string, std::string> rpc;     ///< sensor geometry of a frame: GDAL's metadata domain RPC
    std::map<std::string, std::string> metadata;  ///< default domain
    bool synthetic = true;                        ///< adds synthetic=true; false only for what is made of a real image
    std::string acquisition_time;                 ///< ISO 8601 UTC; also TIFFTAG_DATETIME. Empty = none
    bool classes = false;                         ///< Byte, class names from `class_names`
    std::vector<std::string> class_names;
    Compression compression = Compression::Deflate;
    int tile_rows = 0;  ///< most rows of a tile, as TiffWriter takes its parts; 0 = by the number of bands
};

/// While it lives, writers compress with this many threads (0 = all cores, as without it). Files are the same for any number. Of
/// the process: not for several threads at once.
class CompressionThreads {
public:
    explicit CompressionThreads(int threads) noexcept;
    ~CompressionThreads();
    CompressionThreads(const CompressionThreads&) = delete;
    CompressionThreads& operator=(const CompressionThreads&) = delete;

private:
    int before_;
};

/// Tiled, compressed GeoTIFF. `pixels` is [band][row][col]. Written under a temporary name and renamed; statistics included.
/// Throws a runtime error naming the file.
void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels);
/// Double precision, for geolocation.
void write_geotiff(const std::filesystem::path& path, const OutputRaster& raster, std::span<const double> pixels);

/// Cloud-Optimized GeoTIFF (512 tiles, overviews by average, nearest for classes, statistics). `raster.grid` is required, or `like`
/// with a raster on a map.
void write_cog(const std::filesystem::path& path, const OutputRaster& raster, std::span<const float> pixels);

/// A raster of our own (or any) read whole, for the products phase and resume.
struct ImageFile {
    int cols = 0, rows = 0;
    std::vector<OutputBand> bands;
    std::map<std::string, std::string> metadata;
    std::vector<double> pixels;  ///< [band][row][col], nodata -> NaN
};
/// \param most_bands  only that many from the first on
ImageFile read_image(const std::filesystem::path& path, int most_bands = std::numeric_limits<int>::max());
/// One band of it, [row][col]. \param band  from 1
std::vector<double> read_image_band(const std::filesystem::path& path, int band);
/// One pixel of it.
double read_image_pixel(const std::filesystem::path& path, int band, int col, int row);
/// Only the default-domain metadata; nullopt when the file cannot be opened.
std::optional<std::map<std::string, std::string>> read_metadata(const std::filesystem::path& path);

}  // namespace pyroscene::gis
