#pragma once

#include <filesystem>
#include <string>

namespace pyroscene::pipeline {

/// File names of one acquisition's outputs; `suffix` is "_<group>" when several camera groups are rendered, else empty.
struct AcquisitionFiles {
    std::filesystem::path folder;
    std::string suffix;

    [[nodiscard]] std::filesystem::path file(const std::string& stem) const { return folder / (stem + suffix + ".tif"); }
    [[nodiscard]] std::filesystem::path radiance() const { return file("radiance"); }
    [[nodiscard]] std::filesystem::path geolocation() const { return file("geolocation"); }
    [[nodiscard]] std::filesystem::path truth() const { return file("truth"); }
};

}  // namespace pyroscene::pipeline
