#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pyroscene::drawing {

/// One picture of a quick-look: a plane with its title, unit and pixel size on the ground.
struct QuicklookPanel {
    std::string title, unit;
    int cols = 0, rows = 0;
    std::vector<float> values;                  ///< [row][col], NaN = no data
    bool logarithmic = false;                   ///< colour scale
    std::optional<double> lowest{}, highest{};  ///< of the colour scale; default: from the values
};

/// PNG with the panels side by side (more than three in two rows), each with a colour bar, its numbers and, where pixel_m is above 0, a scale bar in metres.
/// Throws a runtime error naming the file.
void write_quicklook(const std::filesystem::path& path, const std::string& caption, std::span<const QuicklookPanel> panels,
                     double pixel_m);

}  // namespace pyroscene::drawing
