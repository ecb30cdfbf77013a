#include "drawing/quicklook.h"
#include "drawing/picture_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pyroscene::drawing {
namespace {

constexpr int kMargin = 12, kBarWidth = 18, kBarLabels = 92, kHeader = 30, kFooter = 34, kCaption = 22, kLargestSide = 900;
const cv::Scalar kInk(30, 30, 30), kPaper(255, 255, 255), kNoData(200, 200, 200);

void text(cv::Mat& canvas, const std::string& words, cv::Point at, double scale = 0.45) {
    cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, scale, kInk, 1, cv::LINE_AA);
}

struct ColourScale {
    double low = 0.0, high = 1.0;
    bool logarithmic = false;

    [[nodiscard]] double position(double value) const {
        if (!logarithmic) return (value - low) / (high - low);
        return std::log(std::max(value, low) / low) / std::log(high / low);
    }
    [[nodiscard]] double value_at(double position) const {
        return logarithmic ? low * std::pow(high / low, position) : low + position * (high - low);
    }
};

/// From the 0.5 % quantile to the maximum; a flat plane gets a scale of its own size.
ColourScale scale_of(const QuicklookPanel& panel) {
    std::vector<float> valid;
    for (const float v : panel.values)
        if (std::isfinite(v)) valid.push_back(v);
    ColourScale scale;
    if (panel.lowest && panel.highest) return {*panel.lowest, *panel.highest, panel.logarithmic && *panel.lowest > 0.0};
    if (valid.empty()) return scale;
    const auto low = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() / 200);
    std::nth_element(valid.begin(), low, valid.end());
    scale.low = *low;
    scale.high = *std::max_element(low, valid.end());
    if (panel.logarithmic && scale.high > 0.0) {
        scale.low = std::max(scale.low, 1e-6 * scale.high);
        scale.logarithmic = scale.high > 20.0 * scale.low;
    }
    if (!(scale.high > scale.low)) scale.high = scale.low + std::max(1e-6, 1e-3 * std::abs(scale.low));
    return scale;
}

cv::Mat colourise(const QuicklookPanel& panel, const ColourScale& scale) {
    cv::Mat grey(panel.rows, panel.cols, CV_8UC1), colour;
    for (int row = 0; row < panel.rows; ++row)
        for (int col = 0; col < panel.cols; ++col) {
            const float v = panel.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(panel.cols) +
                                         static_cast<std::size_t>(col)];
            const double p = std::isfinite(v) ? std::clamp(scale.position(v), 0.0, 1.0) : 0.0;
            grey.at<unsigned char>(row, col) = static_cast<unsigned char>(std::lround(255.0 * p));
        }
    cv::applyColorMap(grey, colour, cv::COLORMAP_INFERNO);
    for (int row = 0; row < panel.rows; ++row)
        for (int col = 0; col < panel.cols; ++col)
            if (!std::isfinite(panel.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(panel.cols) +
                                            static_cast<std::size_t>(col)]))
                colour.at<cv::Vec3b>(row, col) = cv::Vec3b(200, 200, 200);
    return colour;
}

void draw_colour_bar(cv::Mat& canvas, cv::Rect bar, const ColourScale& scale, const std::string& unit) {
    cv::Mat grey(bar.height, bar.width, CV_8UC1), colour;
    for (int row = 0; row < bar.height; ++row)
        grey.row(row).setTo(static_cast<unsigned char>(255 - 255 * row / std::max(1, bar.height - 1)));
    cv::applyColorMap(grey, colour, cv::COLORMAP_INFERNO);
    colour.copyTo(canvas(bar));
    constexpr int kTicks = 5;
    for (int i = 0; i < kTicks; ++i) {
        const double p = static_cast<double>(i) / (kTicks - 1);
        const int y = bar.y + static_cast<int>(std::lround((1.0 - p) * (bar.height - 1)));
        cv::line(canvas, {bar.x + bar.width, y}, {bar.x + bar.width + 4, y}, kInk);
        text(canvas, fmt::format("{:.4g}", scale.value_at(p)), {bar.x + bar.width + 7, y + 4}, 0.4);
    }
    constexpr double kUnitSize = 0.36;
    int baseline = 0;
    const int width = cv::getTextSize(unit, cv::FONT_HERSHEY_SIMPLEX, kUnitSize, 1, &baseline).width;
    text(canvas, unit, {std::min(bar.x - 2, canvas.cols - width - 2), bar.y + bar.height + 16}, kUnitSize);
}

cv::Mat draw_panel(const QuicklookPanel& panel, double pixel_m) {
    const auto scale = scale_of(panel);
    cv::Mat picture = colourise(panel, scale);
    const double zoom = std::min(1.0, static_cast<double>(kLargestSide) / std::max(panel.cols, panel.rows));
    const double enlarge = std::max(panel.cols, panel.rows) < 256 ? 256.0 / std::max(panel.cols, panel.rows) : 1.0;
    const double factor = zoom * enlarge;
    if (factor != 1.0) cv::resize(picture, picture, {}, factor, factor, factor < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
    cv::Mat canvas(picture.rows + kHeader + kFooter, picture.cols + kBarWidth + kBarLabels + kMargin, CV_8UC3, kPaper);
    picture.copyTo(canvas(cv::Rect(0, kHeader, picture.cols, picture.rows)));
    text(canvas, panel.title, {2, kHeader - 10}, 0.5);
    draw_colour_bar(canvas, cv::Rect(picture.cols + kMargin, kHeader, kBarWidth, picture.rows), scale, panel.unit);
    if (pixel_m > 0.0) draw_scale_bar(canvas, 4, kHeader + picture.rows + 12, picture.cols, pixel_m / factor);
    return canvas;
}

}  // namespace

void write_quicklook(const std::filesystem::path& path, const std::string& caption, std::span<const QuicklookPanel> panels,
                     double pixel_m) {
    constexpr std::size_t kMostInARow = 3;  // four stand two by two
    const std::size_t columns = panels.size() <= kMostInARow ? panels.size() : (panels.size() + 1) / 2;
    std::vector<cv::Mat> drawn;
    int width = kMargin, height = kMargin + kCaption, row_width = kMargin, row_height = 0;
    std::vector<cv::Point> places;
    for (const auto& panel : panels) {
        if (!drawn.empty() && drawn.size() % columns == 0) {
            height += row_height + kMargin;
            row_width = kMargin;
            row_height = 0;
        }
        drawn.push_back(draw_panel(panel, pixel_m));
        places.emplace_back(row_width, height);
        row_width += drawn.back().cols + kMargin;
        row_height = std::max(row_height, drawn.back().rows);
        width = std::max(width, row_width);
    }
    cv::Mat sheet(height + row_height + kMargin, std::max(width, 400), CV_8UC3, kPaper);
    text(sheet, caption, {kMargin, kMargin + 12}, 0.5);
    for (std::size_t k = 0; k < drawn.size(); ++k) drawn[k].copyTo(sheet(cv::Rect(places[k], drawn[k].size())));
    write_picture_file(path, sheet);
}

}  // namespace pyroscene::drawing
