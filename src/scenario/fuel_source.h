#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/raster_source.h"

namespace pyroscene::scenario {

/// Fuel models of the cells of a raster.
struct FuelSource {
    RasterSource raster;                          ///< codes
    std::string table;                            ///< fbfm13, fbfm40, fbfm53 (both), or a CSV file of fuel models
    std::optional<std::filesystem::path> custom;  ///< more fuel models, which replace those with the same number
    std::vector<int> nonburnable;                 ///< further codes without fire
};

}  // namespace pyroscene::scenario
