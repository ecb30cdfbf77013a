#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pyroscene::pipeline {

/// SHA-256 as lower-case hex.
std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace pyroscene::pipeline
