#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace pyroscene::sensors {

/// Folder of this process (test cases run as processes of their own, side by side), removed when it ends.
struct FolderOfProcess {
    FolderOfProcess() { std::filesystem::create_directories(path); }
    ~FolderOfProcess() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    FolderOfProcess(const FolderOfProcess&) = delete;
    FolderOfProcess& operator=(const FolderOfProcess&) = delete;

    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("pyroscene_sensors_" + std::to_string(::getpid()));
};

inline std::string temporary_file(const std::string& name, const std::string& text) {
    static const FolderOfProcess folder;
    const auto path = (folder.path / name).string();
    std::ofstream(path) << text;
    return path;
}

}  // namespace pyroscene::sensors
