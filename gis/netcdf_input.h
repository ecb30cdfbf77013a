#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// A numeric array of a netCDF file with its dimensions in file order.
struct NamedArray {
    std::vector<std::size_t> shape;
    std::vector<std::string> dimensions;
    std::string unit;
    std::vector<double> values;  ///< row-major
};

/// Reads one variable (GDAL multidimensional API). Throws an input error naming file and variable.
NamedArray read_netcdf_variable(const std::filesystem::path& path, const std::string& variable);

}  // namespace pyroscene::gis
