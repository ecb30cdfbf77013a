#include "pipeline/session.h"

#include "gis/raster_output.h"

namespace pyroscene::pipeline {

bool is_current(const std::filesystem::path& file, const std::string& fingerprint, const RunOptions& options) {
    if (options.force) return false;
    const auto metadata = gis::read_metadata(file);
    if (!metadata) return false;
    const auto it = metadata->find("FINGERPRINT");
    return it != metadata->end() && it->second == fingerprint;
}

}  // namespace pyroscene::pipeline
