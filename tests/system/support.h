#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/raster.h"
#include "gis/raster_output.h"
#include "source_folder.h"

namespace pyroscene::test {

/// A fresh folder under the system's temporary folder, removed at the end.
class ScratchFolder {
public:
    ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder();
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

struct CommandResult {
    int exit_code = -1;
    std::string output;  ///< standard output and standard error together
};
/// Runs a shell command.
CommandResult run_command(const std::string& command);
/// Runs the program that was built with the tests.
CommandResult pyroscene_cli(const std::string& arguments);

/// Writes one float band on a map grid; `value(x_m, y_m)` is taken at cell centres.
void write_band(const std::filesystem::path& file, const MapGrid& grid, const std::string& unit,
                const std::function<double(double x_m, double y_m)>& value,
                const std::map<std::string, std::string>& band_metadata = {});

/// One plane of an image; of the band of that description, whose absence fails the test.
std::vector<double> plane(const gis::ImageFile& image, std::size_t band);
std::vector<double> plane(const gis::ImageFile& image, const std::string& description);
std::size_t band_named(const gis::ImageFile& image, const std::string& description);

std::string file_bytes(const std::filesystem::path& file);

}  // namespace pyroscene::test
