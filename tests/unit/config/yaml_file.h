#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "config/yaml.h"

namespace pyroscene::config {

/// A YAML file that lives as long as the test needs it.
class YamlFile {
public:
    explicit YamlFile(const std::string& text) {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() / (std::string("pyroscene_") + std::to_string(::getpid()) + "_" +
                                                          test->name() + std::to_string(count()++) + ".yaml");
        std::ofstream(path_) << text;
    }
    YamlFile(const YamlFile&) = delete;
    YamlFile& operator=(const YamlFile&) = delete;
    ~YamlFile() { std::filesystem::remove(path_); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    static int& count() {
        static int value = 0;
        return value;
    }
    std::filesystem::path path_;
};

/// The problems as "line key.path: message", in the order they were found.
inline std::vector<std::string> texts(const Document& document) {
    std::vector<std::string> result;
    for (const auto& p : document.problems()) result.push_back(std::to_string(p.line) + " " + p.key_path + ": " + p.message);
    return result;
}

using Lines = std::vector<std::string>;

}  // namespace pyroscene::config
