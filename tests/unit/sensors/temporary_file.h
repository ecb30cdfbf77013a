#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace pyroscene::sensors {

/// Writes a file into a folder of this process (test cases run as processes of their own, side by side).
inline std::string temporary_file(const std::string& name, const std::string& text) {
    const auto folder = std::filesystem::path(testing::TempDir()) / ("pyroscene_sensors_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto path = (folder / name).string();
    std::ofstream(path) << text;
    return path;
}

}  // namespace pyroscene::sensors
