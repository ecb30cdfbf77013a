#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace pyroscene::cli {

/// What `pyroscene export` was asked for.
struct ExportOptions {
    std::string scenario, format, output;  ///< output: file; empty = out/<scenario>/export/<acquisition or time>.<ext>
    std::vector<std::string> acquisitions;
    std::optional<double> time_s;
    std::vector<double> voxel_m;
    std::optional<int> layers;
    std::vector<double> window_m;  ///< side-view: west, east, south, north of the map's centre
    bool above_ground = false;
    int material = 206;                   ///< the thesis's
    double concentration_ppm = 1000.203;  ///< likewise
    bool quiet = false;
    const std::atomic<bool>* cancelled = nullptr;
};

/// Names that --format accepts.
std::vector<std::string> export_formats();

/// Writes the flames of one moment in the format of another program, whole files only. Throws input and runtime errors;
/// std::invalid_argument for a wrong command line.
void export_command(const ExportOptions& options);

}  // namespace pyroscene::cli
