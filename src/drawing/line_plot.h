#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pyroscene::drawing {

/// One curve or cloud of points. Values that are not finite, or not above 0 on a logarithmic axis, are gaps.
struct PlotSeries {
    std::string label;  ///< in the legend; empty = not there
    std::vector<double> x, y;
    bool points = false;  ///< markers instead of a line
};

/// One axis: label with unit, scale and, when given, limits; otherwise those of the data.
struct PlotAxis {
    std::string label;
    bool logarithmic = false;
    std::optional<double> lowest, highest;
};

/// A raster drawn inside the frame, below the curves, with a colour bar: logarithmic over up to three decades below its largest
/// value. Values that are not above 0 stay white.
struct PlotImage {
    int cols = 0, rows = 0;
    std::vector<float> values;  ///< [row][col], row 0 at the top
    double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
    std::string unit;
};

/// One diagram with frame, grid, ticks at round numbers and legend. Texts are ASCII: the font has no other letters.
struct LinePlot {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
    int width_px = 900, height_px = 480;
    std::optional<PlotImage> image = {};
};

/// Round tick positions of an axis from low to high: 1, 2 or 5 times a power of ten, about `about` of them; on a logarithmic
/// axis powers of ten, with 2 and 5 between them where there are few and steps of several powers where there are many.
std::vector<double> axis_ticks(double low, double high, bool logarithmic, int about);

/// Width and height in pixels that a diagram leaves inside its frame.
std::array<int, 2> plot_area(const LinePlot& plot, bool with_colour_bar);

/// Bytes of a PNG with the diagrams one below the other. Throws an input error when a diagram has no value to show or x and y
/// differ in number.
std::string line_plots_png(std::span<const LinePlot> plots);
/// The same as a file; throws a runtime error naming it when it cannot be written.
void write_line_plots(const std::filesystem::path& path, std::span<const LinePlot> plots);

}  // namespace pyroscene::drawing
