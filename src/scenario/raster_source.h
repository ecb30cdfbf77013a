#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::scenario {

/// One or several raster files with the bands to read and, for time series, the time of each frame.
struct RasterSource {
    std::vector<std::filesystem::path> files;  ///< absolute
    std::vector<int> bands;                    ///< 1-based; empty = all (time series) or band 1
    std::vector<double> times_s;               ///< one per frame; empty = band metadata time_s
    int line = 0;                              ///< of the key in the scenario, for messages
};

/// Codes whose fuel models ship: Anderson, Scott and Burgan, both.
inline bool is_shipped_fuel_table(const std::string& name) {
    return name == "fbfm13" || name == "fbfm40" || name == "fbfm53";
}

}  // namespace pyroscene::scenario
