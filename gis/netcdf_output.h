#pragma once

#include <filesystem>

#include "gis/array_file.h"

namespace pyroscene::gis {

/// Writes a netCDF-4 file (GDAL multidimensional API), compressed, atomically. Throws a runtime error when it cannot be
/// written and when a variable has not as many values as its dimensions ask for.
void write_netcdf(const std::filesystem::path& path, const ArrayFile& file);

}  // namespace pyroscene::gis
