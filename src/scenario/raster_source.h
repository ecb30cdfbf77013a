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

/// The set of fuel models, fbfm13 or fbfm40, to which a code of a shipped table belongs: of fbfm53, which holds both, Anderson's are 1 to 13.
inline std::string fuel_set_of(const std::string& shipped_table, int code) {
    constexpr int kLastAndersonModel = 13;
    if (shipped_table != "fbfm53") return shipped_table;
    return code <= kLastAndersonModel ? "fbfm13" : "fbfm40";
}
/// Whether a standard fuel model is one of a shipped table.
inline bool in_shipped_fuel_table(const std::string& shipped_table, int model) {
    return shipped_table == "fbfm53" || fuel_set_of("fbfm53", model) == shipped_table;
}

}  // namespace pyroscene::scenario
