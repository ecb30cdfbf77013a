#pragma once

#include <filesystem>
#include <vector>

namespace pyroscene::scenario {

/// One or several raster files with the bands to read and, for time series, the time of each frame.
struct RasterSource {
    std::vector<std::filesystem::path> files;  ///< absolute
    std::vector<int> bands;                    ///< 1-based; empty = all (time series) or band 1
    std::vector<double> times_s;               ///< one per frame; empty = band metadata time_s
    int line = 0;                              ///< of the key in the scenario, for messages
};

}  // namespace pyroscene::scenario
