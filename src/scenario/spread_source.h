#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/fire_frames.h"
#include "scenario/fuel_source.h"
#include "spread/landscape.h"
#include "spread/wind_profile.h"

namespace pyroscene::scenario {

/// A quantity as one number or as rasters.
struct QuantitySource {
    double value = 0.0;
    std::optional<RasterSource> raster;
    double scale = 1.0;  ///< of the raster's values
};

/// Trees above the fuel.
struct CanopySource {
    bool given = false;  ///< the scenario says something of it
    QuantitySource cover, height_m;
    double crown_ratio = 0.5;
};

/// Places on the map: a file of any vector format, or coordinates.
struct ShapesSource {
    std::optional<std::filesystem::path> file;
    std::string layer;  ///< of a file with several
    std::vector<std::array<double, 2>> points, line, polygon;
    std::string crs;      ///< of coordinates (empty = the map's) and of files that do not say theirs
    double time_s = 0.0;  ///< from when on it burns
    bool area = false;    ///< lines that close are outlines of areas
    int line_number = 0;  ///< in the scenario, for messages
};

/// A fire that the program's own model spreads (inputs.spread).
struct SpreadSource {
    FuelSource fuel;
    std::vector<ShapesSource> ignition, barriers;
    std::array<std::optional<double>, spread::kFuelClasses> moisture_pct;  ///< everywhere and always; goes first
    std::optional<RasterSource> moisture_raster;                           ///< five bands for each moment, per cent
    std::optional<std::filesystem::path> moisture_table;                   ///< CSV: time_s and moistures in per cent
    CanopySource canopy;
    spread::SpreadRules rules;
    spread::WindLevel wind_level;   ///< of inputs.wind, when that does not say its own
    bool says_wind_height = false;  ///< `wind_level` is given
    FireFrames frames;
    int line = 0;
};

}  // namespace pyroscene::scenario
