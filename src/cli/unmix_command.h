#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace pyroscene::cli {

/// What `pyroscene unmix` was asked for.
struct UnmixOptions {
    std::string image, endmembers, truth, noise, sensor, output;
    std::string method = "stepwise", solver = "ucls";
    double alpha = 0.05, pure = 0.98, purest = 0.0;  ///< purest: 0 = not given
    int threads = 0;
    bool quiet = false;
};

/// Names that the options accept.
std::vector<std::string> unmix_methods();
std::vector<std::string> unmix_solvers();

/// Unmixes, writes and prints a summary.
void unmix_command(const UnmixOptions& options, const std::atomic<bool>& interrupted);

}  // namespace pyroscene::cli
