#include "gis/grid_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gdal.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

bool same_pixels(const MapGrid& grid, const SourceBand& source) {
    const auto& gt = source.geotransform;
    const double step_tolerance = 1e-6 * grid.cell_m / std::max(grid.cols, grid.rows), origin_tolerance = 1e-6 * grid.cell_m;
    return source.cols == grid.cols && source.rows == grid.rows && std::abs(gt[0] - grid.west_m) <= origin_tolerance &&
           std::abs(gt[3] - grid.north_m) <= origin_tolerance && std::abs(gt[1] - grid.cell_m) <= step_tolerance &&
           std::abs(gt[5] + grid.cell_m) <= step_tolerance && gt[2] == 0.0 && gt[4] == 0.0;
}

/// 0, step, 2 step, ... and last.
std::vector<int> node_positions(int last, int step) {
    std::vector<int> nodes;
    for (int at = 0; at < last; at += step) nodes.push_back(at);
    nodes.push_back(last);
    return nodes;
}

/// Index of the node at or before a position, at most the last but one.
std::size_t node_before(const std::vector<int>& nodes, int position) {
    const auto after = std::upper_bound(nodes.begin(), nodes.end() - 1, position);
    return static_cast<std::size_t>(after - nodes.begin()) - 1;
}

constexpr double kPositionTolerance_px = 0.005;

}  // namespace

GridMapping::GridMapping(const MapGrid& grid, const SourceBand& source)
    : grid_(grid), source_cols_(source.cols), source_rows_(source.rows) {
    auto gt = source.geotransform;
    if (GDALInvGeoTransform(gt.data(), inverse_.data()) == 0)
        throw input_error(source.subject, "has a degenerate georeference");
    const bool one_crs = same_crs(grid.crs_wkt, source.crs.wkt);
    identical_ = one_crs && same_pixels(grid, source);
    if (!one_crs) {
        to_source_crs_.emplace(grid.crs_wkt, source.crs.wkt);
        wraps_ = source.crs.geographic;
        centre_lon_deg_ = gt[0] + 0.5 * (gt[1] * source_cols_ + gt[2] * source_rows_);
    }
    if (identical_) return;
    measure_scale();
    int step = one_crs ? std::max(grid.cols, grid.rows) : 32;
    for (build_lattice(step); step > 1 && !(lattice_error() < kPositionTolerance_px); build_lattice(step))
        step = (step + 1) / 2;
}

void GridMapping::grid_to_source(std::span<double> col, std::span<double> row) const {
    for (std::size_t i = 0; i < col.size(); ++i) {
        col[i] = grid_.west_m + col[i] * grid_.cell_m;
        row[i] = grid_.north_m - row[i] * grid_.cell_m;
    }
    if (to_source_crs_) to_source_crs_->forward(col, row);
    for (std::size_t i = 0; i < col.size(); ++i) {
        double x = col[i];
        const double y = row[i];
        if (wraps_) x += 360.0 * std::round((centre_lon_deg_ - x) / 360.0);
        col[i] = inverse_[0] + x * inverse_[1] + y * inverse_[2];
        row[i] = inverse_[3] + x * inverse_[4] + y * inverse_[5];
    }
}

void GridMapping::measure_scale() {
    const double c = 0.5 * grid_.cols, r = 0.5 * grid_.rows;
    std::array<double, 4> col{c - 0.5, c + 0.5, c, c}, row{r, r, r - 0.5, r + 0.5};
    grid_to_source(col, row);
    const double along_col = std::hypot(col[1] - col[0], row[1] - row[0]),
                 along_row = std::hypot(col[3] - col[2], row[3] - row[2]);
    if (std::isfinite(along_col) && std::isfinite(along_row)) pixels_along_col_ = along_col, pixels_along_row_ = along_row;
}

void GridMapping::build_lattice(int step) {
    node_col_ = node_positions(grid_.cols, step);
    node_row_ = node_positions(grid_.rows, step);
    nodes_ = {};
    for (const int row : node_row_)
        for (const int col : node_col_) {
            nodes_.col.push_back(col);
            nodes_.row.push_back(row);
        }
    grid_to_source(nodes_.col, nodes_.row);
}

double GridMapping::lattice_error() const {
    Line exact, interpolated;
    for (std::size_t j = 0; j + 1 < node_row_.size(); ++j)
        for (std::size_t i = 0; i + 1 < node_col_.size(); ++i) {
            exact.col.push_back(0.5 * (node_col_[i] + node_col_[i + 1]));
            exact.row.push_back(0.5 * (node_row_[j] + node_row_[j + 1]));
            const std::size_t k = j * node_col_.size() + i, below = k + node_col_.size();
            const auto middle = [&](const std::vector<double>& v) {
                return 0.25 * (v[k] + v[k + 1] + v[below] + v[below + 1]);
            };
            interpolated.col.push_back(middle(nodes_.col));
            interpolated.row.push_back(middle(nodes_.row));
        }
    grid_to_source(exact.col, exact.row);
    double worst = 0.0;
    for (std::size_t i = 0; i < exact.col.size(); ++i) {
        const double error = std::hypot(exact.col[i] - interpolated.col[i], exact.row[i] - interpolated.row[i]);
        if (!(error <= worst)) worst = error;
        if (std::isnan(error)) return error;
    }
    return worst;
}

GridMapping::Line GridMapping::corner_line(int grid_row) const {
    const std::size_t j = node_before(node_row_, grid_row), across = node_col_.size();
    const double v = static_cast<double>(grid_row - node_row_[j]) / (node_row_[j + 1] - node_row_[j]);
    Line line;
    for (int col = 0; col <= grid_.cols; ++col) {
        const std::size_t i = node_before(node_col_, col), k = j * across + i;
        const double u = static_cast<double>(col - node_col_[i]) / (node_col_[i + 1] - node_col_[i]);
        const auto at = [&](const std::vector<double>& node) {
            return std::lerp(std::lerp(node[k], node[k + 1], u), std::lerp(node[k + across], node[k + across + 1], u), v);
        };
        line.col.push_back(at(nodes_.col));
        line.row.push_back(at(nodes_.row));
    }
    return line;
}

std::vector<CellOutline> GridMapping::outlines(int grid_row) const {
    const Line upper = corner_line(grid_row), lower = corner_line(grid_row + 1);
    std::vector<CellOutline> cells(static_cast<std::size_t>(grid_.cols));
    for (std::size_t c = 0; c < cells.size(); ++c) {
        cells[c].col = {upper.col[c], upper.col[c + 1], lower.col[c + 1], lower.col[c]};
        cells[c].row = {upper.row[c], upper.row[c + 1], lower.row[c + 1], lower.row[c]};
    }
    return cells;
}

PixelWindow GridMapping::source_window(int first_row, int last_row) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double low_col = kInfinity, high_col = -kInfinity, low_row = kInfinity, high_row = -kInfinity;
    const auto include = [&](const Line& line) {
        for (std::size_t k = 0; k < line.col.size(); ++k) {
            if (std::isnan(line.col[k]) || std::isnan(line.row[k])) continue;
            low_col = std::min(low_col, line.col[k]), high_col = std::max(high_col, line.col[k]);
            low_row = std::min(low_row, line.row[k]), high_row = std::max(high_row, line.row[k]);
        }
    };
    // Between these lines the lattice is bilinear, so they hold its extremes.
    include(corner_line(first_row));
    include(corner_line(last_row));
    for (const int row : node_row_)
        if (row > first_row && row < last_row) include(corner_line(row));
    if (!(low_col < source_cols_ && high_col > 0.0 && low_row < source_rows_ && high_row > 0.0)) return {};
    constexpr double kMargin = 2.0;  // the neighbours that interpolation asks for
    PixelWindow window;
    window.col = static_cast<int>(std::floor(std::max(0.0, low_col - kMargin)));
    window.row = static_cast<int>(std::floor(std::max(0.0, low_row - kMargin)));
    window.cols = static_cast<int>(std::ceil(std::min<double>(source_cols_, high_col + kMargin))) - window.col;
    window.rows = static_cast<int>(std::ceil(std::min<double>(source_rows_, high_row + kMargin))) - window.row;
    return window;
}

}  // namespace pyroscene::gis
