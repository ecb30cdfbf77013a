#include <cmath>
#include <limits>

#include "gis/resample.h"

namespace pyroscene::gis {
namespace {

struct Position {
    double col = 0.0, row = 0.0;
};

/// Position at fractions of the cell, from its west and north edge.
Position inside(const CellOutline& cell, double u, double v) noexcept {
    const auto at = [u, v](const std::array<double, 4>& c) {
        return std::lerp(std::lerp(c[0], c[1], u), std::lerp(c[3], c[2], u), v);
    };
    return {.col = at(cell.col), .row = at(cell.row)};
}

float pixel_at(const SourcePixels& source, Position p) noexcept {
    // Also false for NaN.
    const bool near = std::abs(p.col) < 1e9 && std::abs(p.row) < 1e9;
    return near ? source.at(static_cast<int>(std::floor(p.col)), static_cast<int>(std::floor(p.row)))
                : std::numeric_limits<float>::quiet_NaN();
}

/// Sum of weights and of weighted values of the four neighbours.
void add_bilinear(const SourcePixels& source, Position p, double& weights, double& sum) noexcept {
    if (std::isnan(pixel_at(source, p))) return;
    const double x = p.col - 0.5, y = p.row - 0.5;
    const int col = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    double point_weights = 0.0, point_sum = 0.0;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const double weight = (dx == 0 ? 1.0 - (x - col) : x - col) * (dy == 0 ? 1.0 - (y - row) : y - row);
            const double value = source.at(col + dx, row + dy);
            if (weight == 0.0 || std::isnan(value)) continue;
            point_weights += weight;
            point_sum += weight * value;
        }
    weights += 1.0;
    sum += point_sum / point_weights;
}

}  // namespace

float SourcePixels::at(int col, int row) const noexcept {
    const int c = col - window.col, r = row - window.row;
    if (c < 0 || r < 0 || c >= window.cols || r >= window.rows) return std::numeric_limits<float>::quiet_NaN();
    return values[static_cast<std::size_t>(r) * static_cast<std::size_t>(window.cols) + static_cast<std::size_t>(c)];
}

float pick_nearest(const SourcePixels& source, const CellOutline& cell) noexcept {
    return pixel_at(source, inside(cell, 0.5, 0.5));
}

float interpolate(const SourcePixels& source, const CellOutline& cell, int n_along_col, int n_along_row) noexcept {
    const Position centre = inside(cell, 0.5, 0.5);
    if (std::isnan(pixel_at(source, centre))) return std::numeric_limits<float>::quiet_NaN();
    double weights = 0.0, sum = 0.0;
    for (int j = 0; j < n_along_row; ++j)
        for (int i = 0; i < n_along_col; ++i)
            add_bilinear(source, inside(cell, (i + 0.5) / n_along_col, (j + 0.5) / n_along_row), weights, sum);
    if (weights == 0.0) add_bilinear(source, centre, weights, sum);
    return static_cast<float>(sum / weights);
}

}  // namespace pyroscene::gis
