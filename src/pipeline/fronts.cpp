#include "pipeline/fronts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace pyroscene::pipeline {
namespace {

constexpr auto kFrontClass = static_cast<std::uint8_t>(fire::CellClass::Front);

/// Length of the outlines of one piece through the centres of its rim cells, in cells.
double outline_cells(const cv::Mat& labels, const cv::Rect& box, int label) {
    const cv::Mat piece = labels(box) == label;
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(piece, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
    double length = 0.0;
    // Steps of a slanting edge would count too long (up to 8 %): taken as straight where they leave the line by less than a cell.
    constexpr double kStep = 1.0;
    std::vector<cv::Point> straight;
    for (const auto& contour : contours) {
        cv::approxPolyDP(contour, straight, kStep, true);
        length += cv::arcLength(straight, true);
    }
    return length;
}

double band_length_cells(double outline, double area) {
    const double half = 0.5 * outline + 2.0;  // length + width
    return 0.5 * half + std::sqrt(std::max(0.0, 0.25 * half * half - area));
}

}  // namespace

Fronts find_fronts(const fire::FireState& state, const Raster<float>& heat_flux_W_m2) {
    const MapGrid& grid = state.cell_class.grid;
    if (!(heat_flux_W_m2.grid == grid)) throw input_error("heat flux", "is not on the grid of the fire state");
    cv::Mat front(grid.rows, grid.cols, CV_8UC1), labels, boxes, centroids;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            front.at<std::uint8_t>(row, col) = state.cell_class.at(row, col) == kFrontClass ? 255 : 0;
    const int count = cv::connectedComponentsWithStats(front, labels, boxes, centroids, 8, CV_32S);

    Fronts out;
    out.label = Raster<int>(grid, "front", "1");
    out.fronts.resize(static_cast<std::size_t>(count - 1));
    const double cell_m2 = grid.cell_area_m2();
    std::vector<double> heat_W(out.fronts.size(), 0.0), volume_m3(out.fronts.size(), 0.0);
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const int label = labels.at<int>(row, col);
            if (label == 0) continue;
            const auto i = static_cast<std::size_t>(label - 1);
            Front& f = out.fronts[i];
            ++f.cells;
            f.flaming_area_m2 += state.front_fraction.at(row, col) * cell_m2;
            f.x_m += grid.x_centre_m(col);
            f.y_m += grid.y_centre_m(row);
            heat_W[i] += heat_flux_W_m2.at(row, col) * cell_m2;
            volume_m3[i] += state.flame_height_m.at(row, col) * cell_m2;
        }
    for (std::size_t i = 0; i < out.fronts.size(); ++i) {
        Front& f = out.fronts[i];
        const int label = static_cast<int>(i) + 1;
        const cv::Rect box(boxes.at<int>(label, cv::CC_STAT_LEFT), boxes.at<int>(label, cv::CC_STAT_TOP),
                           boxes.at<int>(label, cv::CC_STAT_WIDTH), boxes.at<int>(label, cv::CC_STAT_HEIGHT));
        f.label = label;
        f.area_m2 = f.cells * cell_m2;
        f.length_m = grid.cell_m * band_length_cells(outline_cells(labels, box, label), f.cells);
        f.mean_depth_m = f.flaming_area_m2 / f.length_m;
        f.intensity_kW_m = 1e-3 * heat_W[i] / f.length_m;
        f.mean_flame_height_m = f.flaming_area_m2 > 0.0 ? volume_m3[i] / f.flaming_area_m2 : 0.0;
        f.x_m /= f.cells;
        f.y_m /= f.cells;
    }
    // OpenCV numbers pieces by their first cell in reading order; a stable sort keeps that among equal ones.
    std::stable_sort(out.fronts.begin(), out.fronts.end(), [](const Front& a, const Front& b) { return a.cells > b.cells; });
    std::vector<int> rank(static_cast<std::size_t>(count), 0);
    for (std::size_t i = 0; i < out.fronts.size(); ++i) {
        rank[static_cast<std::size_t>(out.fronts[i].label)] = static_cast<int>(i) + 1;
        out.fronts[i].label = static_cast<int>(i) + 1;
    }
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            out.label.at(row, col) = rank[static_cast<std::size_t>(labels.at<int>(row, col))];
    return out;
}

std::string fronts_csv(const Fronts& fronts) {
    std::string out =
        "front,cells,area_m2,flaming_area_m2,length_m,mean_depth_m,intensity_kW_m,mean_flame_height_m,x_m,y_m\n";
    for (const auto& f : fronts.fronts)
        fmt::format_to(std::back_inserter(out), "{},{},{:.6g},{:.6g},{:.6g},{:.5g},{:.6g},{:.5g},{:.3f},{:.3f}\n", f.label,
                       f.cells, f.area_m2, f.flaming_area_m2, f.length_m, f.mean_depth_m, f.intensity_kW_m,
                       f.mean_flame_height_m, f.x_m, f.y_m);
    return out;
}

std::filesystem::path fronts_path(std::filesystem::path state_file) {
    return state_file.replace_filename(state_file.stem().string() + "_fronts.csv");
}

void record_fronts(RunReport& report, const Fronts& fronts, const std::string& frame) {
    const auto prefix = "fronts/" + frame + "/";
    double length_m = 0.0;
    for (const auto& f : fronts.fronts) length_m += f.length_m;
    report.record(prefix + "count", static_cast<double>(fronts.fronts.size()));
    report.record(prefix + "total_length_m", length_m);
    if (fronts.fronts.empty()) return;
    const auto& largest = fronts.fronts.front();
    report.record(prefix + "largest_cells", largest.cells);
    report.record(prefix + "largest_length_m", largest.length_m);
    report.record(prefix + "largest_mean_depth_m", largest.mean_depth_m);
    report.record(prefix + "largest_intensity_kW_m", largest.intensity_kW_m);
}

}  // namespace pyroscene::pipeline
