#pragma once

#include <string>

namespace pyroscene::cli {

/// What `pyroscene compare` was asked for.
struct CompareOptions {
    std::string synthetic, real, output;
    double threshold = 0.0, largest_shift = 0.1;
    bool has_threshold = false, no_registration = false, quiet = false;
};

/// Compares, writes and prints the scores.
void compare_command(const CompareOptions& options);

}  // namespace pyroscene::cli
