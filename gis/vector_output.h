#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "base/raster.h"

namespace pyroscene::gis {

/// Outlines the connected cells whose value is 1 (edges of cells, holes kept) and writes them as GeoJSON (RFC 7946: WGS 84
/// longitude/latitude) with the given text properties and each polygon's area_ha. Written atomically.
void write_polygons(const std::filesystem::path& path, const Raster<std::uint8_t>& mask,
                    const std::map<std::string, std::string>& properties);

}  // namespace pyroscene::gis
