#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pyroscene::scenario {

/// History files of WRF-SFIRE instead of rasters.
struct WrfSource {
    std::vector<std::filesystem::path> files;
    std::string crs;  ///< of an idealised run, with its corner
    std::optional<double> west_m, south_m;
    bool plume = false;      ///< hot air above the fire from its heating (RTHFRTEN)
    std::string fuel_table;  ///< what NFUEL_CAT counts, as CoverSource::table; empty = cover is not read from the files
};

}  // namespace pyroscene::scenario
