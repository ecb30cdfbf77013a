#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// Where a model that computes in metres of its own is put on Earth.
struct LocalPlacement {
    std::string crs;                     ///< projected, metres
    double west_m = 0.0, south_m = 0.0;  ///< map coordinates of the model's origin
};

/// Bands on one grid, row 0 in the north, NaN = no data.
struct MemoryRaster {
    int cols = 0, rows = 0;
    std::array<double, 6> geotransform{};
    std::string crs_wkt, unit;
    std::vector<std::vector<float>> bands;
};

/// Name of a file in memory: /vsimem/<folder>_<hash of the key>/<name>.<ending>.
std::string memory_name(const std::string& folder, const std::string& key, const std::string& name, const char* ending);

/// Keeps a raster under such a name, as a GeoTIFF, and returns it, which every reader of rasters takes. It lives
/// as long as the process; one of the same name and key is replaced.
std::filesystem::path keep_in_memory(const std::string& folder, const std::string& key, const std::string& name,
                                     const MemoryRaster& raster);

/// North-up georeference of pixels of a size.
std::array<double, 6> north_up(double west_m, double north_m, double cell_x_m, double cell_y_m) noexcept;

/// The raster itself when it says its CRS or none is given, else one in memory that reads it and says `crs`. Throws an input error when
/// both say different ones.
std::filesystem::path with_crs(const std::filesystem::path& file, const std::string& crs, const std::string& key);

}  // namespace pyroscene::gis
