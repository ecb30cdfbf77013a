#include "gis/grid_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

}  // namespace

GridMapping::GridMapping(const MapGrid& grid, const SourceBand& source)
    : grid_(grid), geotransform_(source.geotransform), source_cols_(source.cols), source_rows_(source.rows) {
    if (GDALInvGeoTransform(geotransform_.data(), inverse_.data()) == 0)
        throw input_error(source.subject, "has a degenerate georeference");
    if (same_crs(grid.crs_wkt, source.crs.wkt)) {
        identical_ = same_pixels(grid, source);
    } else {
        to_source_crs_.emplace(grid.crs_wkt, source.crs.wkt);
        wraps_ = source.crs.geographic;
        centre_lon_ = geotransform_[0] + 0.5 * (geotransform_[1] * source_cols_ + geotransform_[2] * source_rows_);
    }
    measure_scale();
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
        if (wraps_) x += 360.0 * std::round((centre_lon_ - x) / 360.0);
        col[i] = inverse_[0] + x * inverse_[1] + y * inverse_[2];
        row[i] = inverse_[3] + x * inverse_[4] + y * inverse_[5];
    }
}

void GridMapping::source_to_grid(std::span<double> col, std::span<double> row) const {
    for (std::size_t i = 0; i < col.size(); ++i) {
        const double c = col[i], r = row[i];
        col[i] = geotransform_[0] + c * geotransform_[1] + r * geotransform_[2];
        row[i] = geotransform_[3] + c * geotransform_[4] + r * geotransform_[5];
    }
    if (to_source_crs_) to_source_crs_->inverse(col, row);
    for (std::size_t i = 0; i < col.size(); ++i) {
        col[i] = grid_.col_at(col[i]);
        row[i] = grid_.row_at(row[i]);
    }
}

void GridMapping::measure_scale() {
    const double c = 0.5 * grid_.cols, r = 0.5 * grid_.rows;
    std::array<double, 4> col{c - 0.5, c + 0.5, c, c}, row{r, r, r - 0.5, r + 0.5};
    grid_to_source(col, row);
    const double cols = std::hypot(col[1] - col[0], col[3] - col[2]), rows = std::hypot(row[1] - row[0], row[3] - row[2]);
    if (std::isfinite(cols) && std::isfinite(rows)) cols_per_cell_ = cols, rows_per_cell_ = rows;
}

PixelWindow GridMapping::source_window(int first_row, int last_row) const {
    constexpr int kSteps = 32;  // a lattice, so that a pole or the bend of a projection inside the grid is not missed
    std::vector<double> col, row;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            col.push_back(static_cast<double>(grid_.cols) * i / kSteps);
            row.push_back(first_row + static_cast<double>(last_row - first_row) * j / kSteps);
        }
    grid_to_source(col, row);
    double low_col = std::numeric_limits<double>::infinity(), high_col = -low_col, low_row = low_col, high_row = -low_col;
    for (std::size_t k = 0; k < col.size(); ++k) {
        if (!std::isfinite(col[k]) || !std::isfinite(row[k])) continue;
        low_col = std::min(low_col, col[k]), high_col = std::max(high_col, col[k]);
        low_row = std::min(low_row, row[k]), high_row = std::max(high_row, row[k]);
    }
    if (!(low_col < source_cols_ && high_col > 0.0 && low_row < source_rows_ && high_row > 0.0)) return {};
    // Margin: the resampling kernel and the curvature between lattice points.
    const double col_margin = 2.0 + 2.0 * cols_per_cell_ + 0.01 * (high_col - low_col);
    const double row_margin = 2.0 + 2.0 * rows_per_cell_ + 0.01 * (high_row - low_row);
    PixelWindow window;
    window.col = static_cast<int>(std::floor(std::max(0.0, low_col - col_margin)));
    window.row = static_cast<int>(std::floor(std::max(0.0, low_row - row_margin)));
    window.cols = static_cast<int>(std::ceil(std::min<double>(source_cols_, high_col + col_margin))) - window.col;
    window.rows = static_cast<int>(std::ceil(std::min<double>(source_rows_, high_row + row_margin))) - window.row;
    return window;
}

}  // namespace pyroscene::gis
