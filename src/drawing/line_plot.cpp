#include "drawing/line_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "drawing/picture_file.h"

namespace pyroscene::drawing {
namespace {

constexpr int kLeft = 92, kRight = 24, kTop = 38, kBottom = 58, kColourBar = 62, kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kInk(30, 30, 30), kPaper(255, 255, 255), kGridLine(225, 225, 225);
/// Blue, orange, green, red, violet, brown (BGR), told apart by colour-blind readers too.
const cv::Scalar kColours[] = {{178, 114, 0}, {0, 94, 213}, {115, 158, 0}, {40, 40, 190}, {167, 121, 204}, {60, 90, 120}};
/// OpenCV draws with 4 bits of sub-pixel position.
constexpr int kShift = 4;

void text(cv::Mat& canvas, const std::string& words, cv::Point at, double scale) {
    cv::putText(canvas, words, at, kFont, scale, kInk, 1, cv::LINE_AA);
}
cv::Size text_size(const std::string& words, double scale) {
    int baseline = 0;
    return cv::getTextSize(words, kFont, scale, 1, &baseline);
}

/// Maps values of one axis to 0..1.
struct Scale {
    double low = 0.0, high = 1.0;
    bool logarithmic = false;

    [[nodiscard]] bool shows(double v) const { return std::isfinite(v) && (!logarithmic || v > 0.0); }
    [[nodiscard]] double position(double v) const {
        return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
    }
};

Scale scale_of(const LinePlot& plot, const PlotAxis& axis, std::vector<double> PlotSeries::*member) {
    Scale scale{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), axis.logarithmic};
    if (plot.image) {
        const bool is_x = &axis == &plot.x;
        return {is_x ? plot.image->x_low : plot.image->y_low, is_x ? plot.image->x_high : plot.image->y_high, false};
    }
    for (const auto& series : plot.series)
        for (const double v : series.*member)
            if (scale.shows(v)) {
                scale.low = std::min(scale.low, v);
                scale.high = std::max(scale.high, v);
            }
    if (scale.low > scale.high) throw input_error("plot '" + plot.title + "'", "has no value to show");
    // Some air around the data, none beyond a limit that was asked for.
    if (axis.logarithmic) {
        if (!(scale.high > scale.low)) scale.high = 2.0 * scale.low, scale.low *= 0.5;
        const double air = std::pow(scale.high / scale.low, 0.03);
        scale.low /= air;
        scale.high *= air;
    } else {
        const double air =
            scale.high > scale.low ? 0.03 * (scale.high - scale.low) : std::max(1e-9, 0.1 * std::abs(scale.low));
        scale.low -= air;
        scale.high += air;
    }
    scale.low = axis.lowest.value_or(scale.low);
    scale.high = axis.highest.value_or(scale.high);
    return scale;
}

/// A diagram's frame on the canvas.
struct Frame {
    cv::Rect box;
    Scale x, y;

    /// In units of 1/16 pixel.
    [[nodiscard]] cv::Point at(double vx, double vy) const {
        const double px = box.x + x.position(vx) * box.width, py = box.y + (1.0 - y.position(vy)) * box.height;
        const auto fine = [](double p) { return static_cast<int>(std::lround(std::clamp(p, -1e4, 1e5) * (1 << kShift))); };
        return {fine(px), fine(py)};
    }
};

void draw_axes(cv::Mat& canvas, const LinePlot& plot, const Frame& f) {
    constexpr double kSmall = 0.42;
    const auto& box = f.box;
    for (const double v : axis_ticks(f.x.low, f.x.high, f.x.logarithmic, box.width / 110)) {
        const int px = box.x + static_cast<int>(std::lround(f.x.position(v) * box.width));
        if (!plot.image) cv::line(canvas, {px, box.y}, {px, box.y + box.height}, kGridLine);
        cv::line(canvas, {px, box.y + box.height}, {px, box.y + box.height + 5}, kInk);
        const auto words = fmt::format("{:.6g}", v);
        text(canvas, words, {px - text_size(words, kSmall).width / 2, box.y + box.height + 20}, kSmall);
    }
    for (const double v : axis_ticks(f.y.low, f.y.high, f.y.logarithmic, std::max(3, box.height / 60))) {
        const int py = box.y + static_cast<int>(std::lround((1.0 - f.y.position(v)) * box.height));
        if (!plot.image) cv::line(canvas, {box.x, py}, {box.x + box.width, py}, kGridLine);
        cv::line(canvas, {box.x - 5, py}, {box.x, py}, kInk);
        const auto words = fmt::format("{:.6g}", v);
        text(canvas, words, {box.x - 9 - text_size(words, kSmall).width, py + 5}, kSmall);
    }
    text(canvas, plot.title, {box.x, box.y - 14}, 0.52);
    text(canvas, plot.x.label, {box.x + (box.width - text_size(plot.x.label, 0.5).width) / 2, box.y + box.height + 44}, 0.5);
    const cv::Size label = text_size(plot.y.label, 0.5);
    if (label.width == 0) return;
    cv::Mat upright(label.height + 10, label.width + 4, CV_8UC3, kPaper), turned;
    text(upright, plot.y.label, {2, label.height + 3}, 0.5);
    cv::rotate(upright, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
    const int top = std::clamp(box.y + (box.height - turned.rows) / 2, 0, std::max(0, canvas.rows - turned.rows));
    if (turned.rows <= canvas.rows) turned.copyTo(canvas(cv::Rect(6, top, turned.cols, turned.rows)));
}

/// Fills the frame with the raster and puts the colour bar to its right.
void draw_image(cv::Mat& canvas, const PlotImage& image, const cv::Rect& box) {
    float largest = 0.0F;
    for (const float v : image.values) largest = std::max(largest, std::isfinite(v) ? v : 0.0F);
    const double high = largest > 0.0F ? std::pow(10.0, std::ceil(std::log10(static_cast<double>(largest)))) : 1.0,
                 low = 1e-3 * high;
    cv::Mat grey(image.rows, image.cols, CV_8UC1), colour, blank;
    for (int row = 0; row < image.rows; ++row)
        for (int col = 0; col < image.cols; ++col) {
            const double v = image.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.cols) +
                                          static_cast<std::size_t>(col)];
            const double p = v > 0.0 ? std::clamp(std::log(v / low) / std::log(high / low), 0.0, 1.0) : -1.0;
            grey.at<unsigned char>(row, col) = static_cast<unsigned char>(p < 0.0 ? 0 : 20 + std::lround(215.0 * p));
        }
    cv::resize(grey, grey, box.size(), 0.0, 0.0, cv::INTER_NEAREST);
    cv::applyColorMap(grey, colour, cv::COLORMAP_INFERNO);
    cv::compare(grey, 0, blank, cv::CMP_EQ);
    colour.setTo(kPaper, blank);
    colour.copyTo(canvas(box));

    constexpr int kWidth = 14;
    cv::Mat ramp(box.height, kWidth, CV_8UC1), bar;
    for (int row = 0; row < box.height; ++row)
        ramp.row(row).setTo(static_cast<unsigned char>(235 - 215 * row / std::max(1, box.height - 1)));
    cv::applyColorMap(ramp, bar, cv::COLORMAP_INFERNO);
    const int left = box.x + box.width + 12;
    bar.copyTo(canvas(cv::Rect(left, box.y, kWidth, box.height)));
    for (int decade = 0; decade <= 3; ++decade)
        text(canvas, fmt::format("{:g}", high * std::pow(10.0, decade - 3)),
             {left + kWidth + 5, box.y + box.height - box.height * decade / 3 + 5}, 0.4);
    text(canvas, image.unit, {box.x + box.width + 60 - text_size(image.unit, 0.42).width, box.y + box.height + 44}, 0.42);
}

void draw_series(cv::Mat& canvas, const PlotSeries& series, const Frame& f, const cv::Scalar& colour) {
    // Drawn on a copy of the frame's inside, so that nothing leaves it.
    cv::Mat inside = canvas(f.box);
    const cv::Point corner(f.box.x << kShift, f.box.y << kShift);
    std::optional<cv::Point> before;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!f.x.shows(series.x[i]) || !f.y.shows(series.y[i])) {
            before.reset();
            continue;
        }
        const cv::Point here = f.at(series.x[i], series.y[i]) - corner;
        if (series.points)
            cv::circle(inside, here, 3 << kShift, colour, 1, cv::LINE_AA, kShift);
        else if (before)
            cv::line(inside, *before, here, colour, 2, cv::LINE_AA, kShift);
        before = here;
    }
}

/// Of the four corners of the frame the one whose legend would hide least of the curves.
cv::Rect legend_place(const LinePlot& plot, const Frame& f, cv::Size size) {
    constexpr int kAir = 8, kSteps = 16;
    const auto& box = f.box;
    const int left = box.x + kAir, right = box.x + box.width - size.width - kAir, top = box.y + kAir,
              bottom = box.y + box.height - size.height - kAir;
    cv::Rect best;
    int fewest = std::numeric_limits<int>::max();
    for (const cv::Point corner : {cv::Point(right, top), {left, top}, {right, bottom}, {left, bottom}}) {
        const cv::Rect place(corner, size);
        int hidden = 0;
        for (const auto& series : plot.series)
            for (std::size_t i = 0; i < series.x.size(); ++i) {
                if (!f.x.shows(series.x[i]) || !f.y.shows(series.y[i])) continue;
                const cv::Point here = f.at(series.x[i], series.y[i]) / (1 << kShift);
                const bool line = !series.points && i > 0 && f.x.shows(series.x[i - 1]) && f.y.shows(series.y[i - 1]);
                const cv::Point before = line ? f.at(series.x[i - 1], series.y[i - 1]) / (1 << kShift) : here;
                for (int k = 1; k <= (line ? kSteps : 1); ++k)
                    hidden += place.contains(before + (here - before) * (static_cast<double>(k) / kSteps)) ? 1 : 0;
            }
        if (hidden < fewest) {
            fewest = hidden;
            best = place;
        }
    }
    return best;
}

void draw_legend(cv::Mat& canvas, const LinePlot& plot, const Frame& f) {
    constexpr double kSize = 0.45;
    constexpr int kRow = 20, kSample = 30;
    int widest = 0, rows = 0;
    for (const auto& series : plot.series)
        if (!series.label.empty()) {
            widest = std::max(widest, text_size(series.label, kSize).width);
            ++rows;
        }
    if (rows == 0) return;
    const cv::Rect frame = legend_place(plot, f, {widest + kSample + 18, rows * kRow + 8});
    cv::rectangle(canvas, frame, kPaper, cv::FILLED);
    cv::rectangle(canvas, frame, kGridLine);
    int y = frame.y + 18;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const auto& series = plot.series[i];
        if (series.label.empty()) continue;
        const auto& colour = kColours[i % std::size(kColours)];
        if (series.points)
            cv::circle(canvas, {frame.x + 6 + kSample / 2, y - 4}, 3, colour, 1, cv::LINE_AA);
        else
            cv::line(canvas, {frame.x + 6, y - 4}, {frame.x + kSample, y - 4}, colour, 2, cv::LINE_AA);
        text(canvas, series.label, {frame.x + kSample + 10, y}, kSize);
        y += kRow;
    }
}

cv::Mat draw(const LinePlot& plot) {
    for (const auto& series : plot.series)
        if (series.x.size() != series.y.size())
            throw input_error("plot '" + plot.title + "'", fmt::format("series '{}' has {} x and {} y values", series.label,
                                                                       series.x.size(), series.y.size()));
    cv::Mat canvas(plot.height_px, plot.width_px, CV_8UC3, kPaper);
    const auto [width, height] = plot_area(plot, plot.image.has_value());
    const Frame frame{
        {kLeft, kTop, width, height}, scale_of(plot, plot.x, &PlotSeries::x), scale_of(plot, plot.y, &PlotSeries::y)};
    if (plot.image) draw_image(canvas, *plot.image, frame.box);
    draw_axes(canvas, plot, frame);
    for (std::size_t i = 0; i < plot.series.size(); ++i)
        draw_series(canvas, plot.series[i], frame, kColours[i % std::size(kColours)]);
    cv::rectangle(canvas, frame.box, kInk);
    draw_legend(canvas, plot, frame);
    return canvas;
}

cv::Mat draw_sheet(std::span<const LinePlot> plots) {
    std::vector<cv::Mat> drawn;
    int width = 1, height = 0;
    for (const auto& plot : plots) {
        drawn.push_back(draw(plot));
        width = std::max(width, drawn.back().cols);
        height += drawn.back().rows;
    }
    cv::Mat sheet(std::max(1, height), width, CV_8UC3, kPaper);
    int y = 0;
    for (const auto& canvas : drawn) {
        canvas.copyTo(sheet(cv::Rect(0, y, canvas.cols, canvas.rows)));
        y += canvas.rows;
    }
    return sheet;
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, bool logarithmic, int about) {
    std::vector<double> ticks;
    constexpr double kRounding = 1e-9;
    if (logarithmic) {
        const double decades = std::log10(high / low);
        const bool few = decades < 3.0;
        const int step = std::max(1, static_cast<int>(std::ceil(decades / (2.0 * std::max(1, about)))));
        const int first = static_cast<int>(std::floor(std::log10(low)));
        for (int decade = first - (first % step + step) % step; std::pow(10.0, decade) <= high; decade += step)
            for (const double factor : {1.0, 2.0, 5.0}) {
                const double v = factor * std::pow(10.0, decade);
                if ((few || factor == 1.0) && v >= low * (1.0 - kRounding) && v <= high * (1.0 + kRounding))
                    ticks.push_back(v);
            }
        return ticks;
    }
    const double rough = (high - low) / std::max(1, about), decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = (rough <= 1.5 * decade   ? 1.0
                         : rough <= 3.5 * decade ? 2.0
                         : rough <= 7.5 * decade ? 5.0
                                                 : 10.0) *
                        decade;
    for (double k = std::ceil(low / step - kRounding); k * step <= high + kRounding * step; k += 1.0)
        ticks.push_back(k == 0.0 ? 0.0 : k * step);
    return ticks;
}

std::array<int, 2> plot_area(const LinePlot& plot, bool with_colour_bar) {
    return {plot.width_px - kLeft - kRight - (with_colour_bar ? kColourBar : 0), plot.height_px - kTop - kBottom};
}

std::string line_plots_png(std::span<const LinePlot> plots) { return png_of(draw_sheet(plots)); }

void write_line_plots(const std::filesystem::path& path, std::span<const LinePlot> plots) {
    write_picture_file(path, draw_sheet(plots));
}

}  // namespace pyroscene::drawing
