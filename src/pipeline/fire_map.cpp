#include "pipeline/fire_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/constants.h"
#include "drawing/line_plot.h"
#include "drawing/picture_file.h"

namespace pyroscene::pipeline {
namespace {

constexpr int kLeft = 78, kTop = 16, kBottom = 62, kRight = 190, kLargestSide = 760;
const cv::Scalar kInk(30, 30, 30), kPaper(255, 255, 255);
const cv::Vec3b kFrontColour(30, 20, 235), kNoData(225, 225, 225);

void text(cv::Mat& canvas, const std::string& words, cv::Point at, double scale = 0.42) {
    cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, scale, kInk, 1, cv::LINE_AA);
}

/// Lambert's cosine of the terrain under a light at 45 degrees in the north-west.
double shade(const Raster<float>& z_m, int row, int col) {
    constexpr double kExaggeration = 1.0;
    const auto& g = z_m.grid;
    const auto at = [&](int r, int c) {
        return static_cast<double>(z_m.at(std::clamp(r, 0, g.rows - 1), std::clamp(c, 0, g.cols - 1)));
    };
    const double east = kExaggeration * (at(row, col + 1) - at(row, col - 1)) / (2.0 * g.cell_m);
    const double north = kExaggeration * (at(row - 1, col) - at(row + 1, col)) / (2.0 * g.cell_m);
    const double s = std::sqrt(0.5);
    const double cosine = (0.5 * east - 0.5 * north + s) / std::sqrt(1.0 + east * east + north * north);
    return std::isfinite(cosine) ? std::clamp(0.5 + 0.5 * cosine / s, 0.0, 1.12) : 1.0;
}

struct TimeRange {
    double first_s = 0.0, last_s = 0.0;
};

TimeRange times_of(const fire::FireState& state) {
    TimeRange range{state.time_s, 0.0};
    for (std::size_t i = 0; i < state.cell_class.values.size(); ++i) {
        const auto c = static_cast<fire::CellClass>(state.cell_class.values[i]);
        const double t_s = state.arrival_time_s[i];
        if (c == fire::CellClass::Scar && std::isfinite(t_s)) range.first_s = std::min(range.first_s, t_s);
    }
    range.last_s = std::max(state.time_s, range.first_s + 1.0);
    return range;
}

/// Colours of 0..255: from the oldest scar to the newest.
cv::Mat time_colours() {
    cv::Mat ramp(256, 1, CV_8UC1), colours;
    for (int k = 0; k < 256; ++k) ramp.at<unsigned char>(k, 0) = static_cast<unsigned char>(30 + k * 195 / 255);
    cv::applyColorMap(ramp, colours, cv::COLORMAP_PLASMA);
    return colours;
}

/// Columns and rows that hold fire and outlines, with a margin; everything when there is neither.
cv::Rect part_to_show(const MapGrid& g, const fire::FireState& state, const std::vector<MapOutline>& outlines) {
    constexpr double kMargin = 0.3;
    double left = g.cols, right = 0.0, top = g.rows, bottom = 0.0;
    const auto take = [&](double col, double row) {
        left = std::min(left, col), right = std::max(right, col);
        top = std::min(top, row), bottom = std::max(bottom, row);
    };
    for (int row = 0; row < g.rows; ++row)
        for (int col = 0; col < g.cols; ++col) {
            const auto c = static_cast<fire::CellClass>(state.cell_class.at(row, col));
            if (c == fire::CellClass::Front || c == fire::CellClass::Scar) take(col + 0.5, row + 0.5);
        }
    for (const auto& outline : outlines)
        for (const auto& [x_m, y_m] : outline.ring_xy_m)
            if (std::isfinite(x_m) && std::isfinite(y_m)) take(g.col_at(x_m), g.row_at(y_m));
    if (!(right > left && bottom > top)) return {0, 0, g.cols, g.rows};
    const double margin = kMargin * std::max(right - left, bottom - top);
    const int c0 = std::clamp(static_cast<int>(left - margin), 0, g.cols - 1),
              c1 = std::clamp(static_cast<int>(right + margin), c0 + 1, g.cols),
              r0 = std::clamp(static_cast<int>(top - margin), 0, g.rows - 1),
              r1 = std::clamp(static_cast<int>(bottom + margin), r0 + 1, g.rows);
    return {c0, r0, c1 - c0, r1 - r0};
}

cv::Mat draw_cells(const Raster<float>& terrain_m, const fire::FireState& state, const TimeRange& times) {
    const auto& g = terrain_m.grid;
    const cv::Mat colours = time_colours();
    cv::Mat picture(g.rows, g.cols, CV_8UC3);
    for (int row = 0; row < g.rows; ++row)
        for (int col = 0; col < g.cols; ++col) {
            cv::Vec3b colour(205, 216, 214);
            const auto c = static_cast<fire::CellClass>(state.cell_class.at(row, col));
            if (c == fire::CellClass::Scar) {
                const double p = (static_cast<double>(state.arrival_time_s.at(row, col)) - times.first_s) /
                                 (times.last_s - times.first_s);
                colour = colours.at<cv::Vec3b>(
                    static_cast<int>(std::lround(255.0 * (std::isfinite(p) ? std::clamp(p, 0.0, 1.0) : 0.0))), 0);
            } else if (c == fire::CellClass::Front) {
                colour = kFrontColour;
            } else if (c != fire::CellClass::Unburned) {
                colour = kNoData;
            }
            const double light = c == fire::CellClass::Front ? 1.0 : shade(terrain_m, row, col);
            for (int k = 0; k < 3; ++k)
                picture.at<cv::Vec3b>(row, col)[k] = cv::saturate_cast<unsigned char>(light * colour[k]);
        }
    return picture;
}

void draw_frame(cv::Mat& canvas, const MapGrid& g, const cv::Rect& box) {
    cv::rectangle(canvas, box, kInk);
    const double width_km = g.cols * g.cell_m * 1e-3, height_km = g.rows * g.cell_m * 1e-3;
    for (const double km : drawing::axis_ticks(g.west_m * 1e-3, g.east_m() * 1e-3, false, std::max(2, box.width / 130))) {
        const int px = box.x + static_cast<int>(std::lround((km - g.west_m * 1e-3) / width_km * box.width));
        cv::line(canvas, {px, box.y + box.height}, {px, box.y + box.height + 5}, kInk);
        text(canvas, fmt::format("{:.7g}", km), {px - 22, box.y + box.height + 19});
    }
    for (const double km : drawing::axis_ticks(g.south_m() * 1e-3, g.north_m * 1e-3, false, std::max(2, box.height / 110))) {
        const int py = box.y + static_cast<int>(std::lround((g.north_m * 1e-3 - km) / height_km * box.height));
        cv::line(canvas, {box.x - 5, py}, {box.x, py}, kInk);
        text(canvas, fmt::format("{:.7g}", km), {4, py + 5});
    }
    text(canvas, "east, north [km]", {box.x + box.width - 118, box.y + box.height + 40});
    drawing::draw_scale_bar(canvas, box.x, box.y + box.height + 32, box.width, g.cols * g.cell_m / box.width);
}

void draw_legend(cv::Mat& canvas, const cv::Rect& box, const TimeRange& times) {
    const int x = box.x + box.width + 16;
    cv::rectangle(canvas, cv::Rect(x, box.y + 4, 14, 14), cv::Scalar(kFrontColour[0], kFrontColour[1], kFrontColour[2]),
                  cv::FILLED);
    text(canvas, "burning", {x + 22, box.y + 16});
    cv::line(canvas, {x, box.y + 33}, {x + 14, box.y + 33}, kInk, 2);
    text(canvas, "image", {x + 22, box.y + 38});
    text(canvas, "burnt at [min]", {x, box.y + 66});
    const int height = std::clamp(box.height - 100, 40, 180);
    cv::Mat bar;
    cv::resize(time_colours(), bar, cv::Size(14, height), 0.0, 0.0, cv::INTER_LINEAR);
    cv::flip(bar, bar, 0);
    bar.copyTo(canvas(cv::Rect(x, box.y + 76, 14, height)));
    for (int k = 0; k <= 4; ++k)
        text(canvas, fmt::format("{:.4g}", (times.first_s + (times.last_s - times.first_s) * k / 4.0) / 60.0),
             {x + 22, box.y + 80 + height - height * k / 4});
}

void draw_outlines(cv::Mat& canvas, const MapGrid& g, const cv::Rect& box, const std::vector<MapOutline>& outlines) {
    cv::Mat inside = canvas(box);
    const double scale = box.width / (g.cols * g.cell_m);
    for (const auto& outline : outlines) {
        if (outline.ring_xy_m.empty()) continue;
        std::vector<cv::Point> ring;
        for (const auto& [x_m, y_m] : outline.ring_xy_m)
            ring.emplace_back(static_cast<int>(std::lround(std::clamp((x_m - g.west_m) * scale, -1e5, 1e5))),
                              static_cast<int>(std::lround(std::clamp((g.north_m - y_m) * scale, -1e5, 1e5))));
        cv::polylines(inside, ring, true, kPaper, 4, cv::LINE_AA);
        cv::polylines(inside, ring, true, kInk, 2, cv::LINE_AA);
        const auto top = std::min_element(ring.begin(), ring.end(), [](auto a, auto b) { return a.y + a.x < b.y + b.x; });
        const cv::Point at(std::clamp(top->x + 6, 4, std::max(4, box.width - 150)),
                           std::clamp(top->y + 16, 14, box.height - 4));
        cv::putText(inside, outline.label, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, kPaper, 3, cv::LINE_AA);
        text(inside, outline.label, at, 0.45);
    }
}

}  // namespace

std::string fire_map_png(const Raster<float>& terrain_m, const fire::FireState& state,
                         const std::vector<MapOutline>& outlines) {
    const auto part = part_to_show(terrain_m.grid, state, outlines);
    MapGrid g = terrain_m.grid;  // of the part
    g.west_m += part.x * g.cell_m;
    g.north_m -= part.y * g.cell_m;
    g.cols = part.width;
    g.rows = part.height;
    const auto times = times_of(state);
    cv::Mat picture = draw_cells(terrain_m, state, times)(part).clone();
    const double factor = static_cast<double>(kLargestSide) / std::max(g.cols, g.rows);
    cv::resize(picture, picture, {}, factor, factor, factor < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
    const cv::Rect box(kLeft, kTop, picture.cols, picture.rows);
    cv::Mat canvas(picture.rows + kTop + kBottom, picture.cols + kLeft + kRight, CV_8UC3, kPaper);
    picture.copyTo(canvas(box));
    draw_outlines(canvas, g, box, outlines);
    draw_frame(canvas, g, box);
    draw_legend(canvas, box, times);
    return drawing::png_of(canvas);
}

}  // namespace pyroscene::pipeline
