#pragma once

#include <filesystem>
#include <string>

namespace pyroscene::cli {

struct SensorsOptions {
    std::string id;  ///< or the path of a sensor file; empty = all
    bool json = false;
    std::filesystem::path plot;       ///< PNG of the spectral responses of one sensor
    std::filesystem::path footprint;  ///< scenario whose acquisitions are outlined
    std::filesystem::path output;     ///< for the outlines; empty = standard output
};

/// `pyroscene sensors [ID]`: list or one sensor in full, on standard output; or one of the files above.
/// Throws std::invalid_argument for options that do not go together.
void sensors_command(const SensorsOptions& options);

}  // namespace pyroscene::cli
