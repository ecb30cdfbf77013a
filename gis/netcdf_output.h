#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// A numeric array to write, on named dimensions (none: a scalar).
struct NetCdfVariable {
    std::string name;
    std::vector<std::string> dimensions;
    std::string unit, long_name;
    std::vector<double> values;  ///< row-major
    bool single_precision = true;
};

struct NetCdfFile {
    std::vector<std::pair<std::string, std::size_t>> dimensions;
    std::vector<NetCdfVariable> variables;
    std::map<std::string, std::string> attributes;  ///< of the file
};

/// Writes a netCDF-4 file (GDAL multidimensional API), compressed, atomically. Throws a runtime error when it cannot be
/// written and when a variable has not as many values as its dimensions ask for.
void write_netcdf(const std::filesystem::path& path, const NetCdfFile& file);

}  // namespace pyroscene::gis
