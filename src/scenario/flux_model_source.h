#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::scenario {

/// Heat flux in the files of a program that writes no rasters (inputs.heat_flux.model).
struct FluxModelSource {
    std::string model;                         ///< quic-fire or fds
    std::vector<std::filesystem::path> files;  ///< of all moments, or the index of an FDS run
    std::string crs;                           ///< projected, metres
    double west_m = 0.0, south_m = 0.0;        ///< where the origin of the model's coordinates lies
    int cols = 0, rows = 0;                    ///< QUIC-Fire: its grid
    double cell_m = 2.0;
    std::string quantity;   ///< FDS; empty = its heat release
    double offset_s = 0.0;  ///< of the model's clock: its 0 is so long after `start`
};

}  // namespace pyroscene::scenario
