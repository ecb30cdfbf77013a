#pragma once

#include <filesystem>
#include <string>

#include "scenario/fuel_source.h"

namespace pyroscene::scenario {

/// Terrain, fuel and canopy in one file: a landscape of FARSITE (LCP) or LANDFIRE (GeoTIFF). The bands become inputs that the scenario does
/// not give itself.
struct LandscapeSource {
    std::filesystem::path file;
    FuelSource fuel;  ///< its raster is a band of the file
    std::string crs;  ///< of a file that does not say its own
};

}  // namespace pyroscene::scenario
