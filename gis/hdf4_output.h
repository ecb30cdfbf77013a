#pragma once

#include <filesystem>

#include "gis/array_file.h"

namespace pyroscene::gis {

/// Writes scientific data sets and text attributes of an HDF4 file (HDF4's SD interface), compressed, atomically. Groups are
/// not known. Throws a runtime error when it cannot be written and when a variable has not as many values as its dimensions
/// ask for.
void write_hdf4(const std::filesystem::path& path, const ArrayFile& file);

}  // namespace pyroscene::gis
