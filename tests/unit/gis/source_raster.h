#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/map_grid.h"
#include "unit/base/temp_folder.h"

namespace pyroscene::gis {

/// A raster as a user might have it, written with plain GDAL calls (none of the code under test).
struct SourceRaster {
    int cols = 4, rows = 3;
    std::array<double, 6> geotransform{500000.0, 30.0, 0.0, 5170000.0, 0.0, -30.0};
    std::string crs = "EPSG:32611";  ///< empty = none
    bool georeferenced = true;
    std::string type = "Float32";  ///< GDAL's name
    std::vector<std::vector<double>> bands{};
    std::vector<std::string> units{};  ///< per band, may be shorter
    std::optional<double> nodata{}, scale{}, offset{};
    std::optional<std::vector<unsigned char>> mask{};  ///< per-dataset mask

    /// One more band, value from column and row.
    SourceRaster& band(const std::function<double(int col, int row)>& value, const std::string& unit = "");
    /// One more band, value from map position of the pixel's centre.
    SourceRaster& band_at(const std::function<double(double x, double y)>& value, const std::string& unit = "");
    void write(const std::filesystem::path& path) const;
};

/// EPSG code as WKT.
std::string wkt_of(int epsg);

/// The grid that has exactly the pixels of a north-up source.
MapGrid grid_of(const SourceRaster& source);

/// The text of the input error that `call` throws; a test failure and "" when it does not.
std::string input_error_of(const std::function<void()>& call);

}  // namespace pyroscene::gis
