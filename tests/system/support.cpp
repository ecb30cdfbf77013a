#include "system/support.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace pyroscene::test {

ScratchFolder::ScratchFolder() {
    static std::atomic<int> counter{0};
    path_ = std::filesystem::temp_directory_path() / fmt::format("pyroscene_test_{}_{}", ::getpid(), counter++);
    std::filesystem::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

CommandResult run_command(const std::string& command) {
    CommandResult result;
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) result.output.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

CommandResult pyroscene_cli(const std::string& arguments) {
    return run_command(std::string(PYROSCENE_BINARY) + " " + arguments);
}

void write_band(const std::filesystem::path& file, const MapGrid& grid, const std::string& unit,
                const std::function<double(double, double)>& value,
                const std::map<std::string, std::string>& band_metadata) {
    gis::OutputRaster out;
    out.grid = grid;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.bands.push_back({"test", unit, {}, {}, band_metadata});
    std::vector<float> pixels;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            pixels.push_back(static_cast<float>(value(grid.x_centre_m(col), grid.y_centre_m(row))));
    gis::write_geotiff(file, out, std::span<const float>(pixels));
}

std::vector<double> plane(const gis::ImageFile& image, std::size_t band) {
    const auto n = static_cast<std::ptrdiff_t>(image.cols) * image.rows;
    const auto first = image.pixels.begin() + static_cast<std::ptrdiff_t>(band) * n;
    return {first, first + n};
}

std::size_t band_named(const gis::ImageFile& image, const std::string& description) {
    for (std::size_t b = 0; b < image.bands.size(); ++b)
        if (image.bands[b].description == description) return b;
    ADD_FAILURE() << "no band " << description;
    return 0;
}

std::vector<double> plane(const gis::ImageFile& image, const std::string& description) {
    return plane(image, band_named(image, description));
}

std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

}  // namespace pyroscene::test
