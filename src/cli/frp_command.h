#pragma once

#include <atomic>
#include <string>

namespace pyroscene::cli {

/// What `pyroscene frp` was asked for.
struct FrpOptions {
    std::string image, method = "mir", coefficient = "fit", sensor, output;
    int mir_band = 0, tir_band = 0;  ///< 0 = choose
    double mir_transmittance = 1.0, tir_transmittance = 1.0, mir_path = 0.0, tir_path = 0.0;
    double mir_noise = 0.0, tir_noise = 0.0, least_temperature_K = 310.0;
    bool no_background = false, quiet = false;
};

/// Computes, writes and prints a summary.
void frp_command(const FrpOptions& options, const std::atomic<bool>& interrupted);

}  // namespace pyroscene::cli
