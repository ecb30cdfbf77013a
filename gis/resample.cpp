#include "gis/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "gis/extent.h"

namespace pyroscene::gis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Ground area of a pixel of each row, up to a common factor: constant on a map, the ellipsoid's meridian and parallel arcs
/// for north-up geographic pixels (WGS 84; e^2 of the other ellipsoids differs by 1e-4 of itself).
std::vector<double> row_weights(const SourceBand& source, const PixelWindow& window) {
    std::vector<double> weights(static_cast<std::size_t>(window.rows), 1.0);
    if (!source.crs.geographic) return weights;
    constexpr double kEccentricity2 = 6.69437999014e-3;
    for (int row = 0; row < window.rows; ++row) {
        const auto& gt = source.geotransform;
        const double lat_deg = gt[3] + gt[5] * (window.row + row + 0.5) + gt[4] * 0.5 * source.cols;
        const double s = std::sin(std::clamp(lat_deg, -89.999, 89.999) * kDegree_rad);
        weights[static_cast<std::size_t>(row)] = std::sqrt(1.0 - s * s) / std::pow(1.0 - kEccentricity2 * s * s, 2);
    }
    return weights;
}

/// A cell many times wider than the one at the grid's centre has been torn apart by the edge of the source's longitudes, and
/// one with a corner off the projection's domain has no outline.
bool is_usable(const CellOutline& cell, double widest_px) noexcept {
    const auto [west, east] = std::minmax_element(cell.col.begin(), cell.col.end());
    const auto finite = [](double v) { return std::isfinite(v); };
    return std::all_of(cell.col.begin(), cell.col.end(), finite) && std::all_of(cell.row.begin(), cell.row.end(), finite) &&
           *east - *west < widest_px;
}

/// Source pixels held at once (128 MB as float).
constexpr std::size_t kWindowLimit = std::size_t{1} << 25;

/// Points per cell edge for a source with so many pixels along it.
int points_for(double pixels_along_edge) noexcept {
    return std::max(1, static_cast<int>(std::ceil(pixels_along_edge - 0.1)));
}

class Resampler {
public:
    Resampler(const SourceBand& source, const MapGrid& grid, const GridMapping& mapping, Resampling rule)
        : source_(source), grid_(grid), mapping_(mapping), rule_(rule) {}

    /// Grid rows [first, last) into `out`, in strips small enough for memory. True when they touch the source.
    bool run(int first_row, int last_row, float* out) const {
        const PixelWindow window = mapping_.source_window(first_row, last_row);
        if (window.empty()) return false;
        if (window.size() > kWindowLimit && last_row - first_row > 1) {
            const int middle = first_row + (last_row - first_row) / 2;
            const bool upper = run(first_row, middle, out);
            return run(middle, last_row, out + grid_.index(middle - first_row, 0)) || upper;
        }
        const SourcePixels pixels{
            .window = window, .values = read_window(source_, window), .row_weights = row_weights(source_, window)};
        for (int row = first_row; row < last_row; ++row)
            for (const CellOutline& cell : mapping_.outlines(row)) *out++ = value(pixels, cell);
        return true;
    }

private:
    [[nodiscard]] float value(const SourcePixels& pixels, const CellOutline& cell) const noexcept {
        if (!is_usable(cell, widest_px_)) return kNaN;
        switch (rule_) {
            case Resampling::Conserve:
                return average_by_area(pixels, cell);
            case Resampling::Bilinear:
                return interpolate(pixels, cell, points_along_col_, points_along_row_);
            case Resampling::Nearest:
                break;
        }
        return pick_nearest(pixels, cell);
    }

    const SourceBand& source_;
    const MapGrid& grid_;
    const GridMapping& mapping_;
    Resampling rule_;
    int points_along_col_ = points_for(mapping_.pixels_along_col()),
        points_along_row_ = points_for(mapping_.pixels_along_row());
    double widest_px_ = 16.0 + 8.0 * (mapping_.pixels_along_col() + mapping_.pixels_along_row());
};

bool all_nan(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isnan(v); });
}

}  // namespace

std::vector<float> resample(const SourceBand& source, const MapGrid& grid, Resampling rule) {
    const GridMapping mapping(grid, source);
    std::vector<float> values;
    if (mapping.identical()) {
        values = read_window(source, {.cols = source.cols, .rows = source.rows});
    } else {
        values.assign(grid.size(), kNaN);
        if (!Resampler(source, grid, mapping, rule).run(0, grid.rows, values.data()))
            throw input_error(source.subject, fmt::format("does not overlap the map; found {}, expected {}",
                                                          describe_extent(source), describe_extent(grid)));
    }
    if (all_nan(values))
        throw input_error(source.subject, "holds only nodata on the map; expected at least one cell with a value");
    return values;
}

}  // namespace pyroscene::gis
