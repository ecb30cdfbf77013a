#include "gis/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace pyroscene::gis {

std::array<double, 6> geotransform_of(const MapGrid& grid) noexcept {
    return {grid.west_m, grid.cell_m, 0.0, grid.north_m, 0.0, -grid.cell_m};
}

Extent extent_of(const std::array<double, 6>& gt, int cols, int rows, const CrsTransform* transform) {
    constexpr int kSteps = 64;  // points along each side: the sides bend in another projection
    std::vector<double> x, y;
    const auto add = [&](double col, double row) {
        x.push_back(gt[0] + col * gt[1] + row * gt[2]);
        y.push_back(gt[3] + col * gt[4] + row * gt[5]);
    };
    for (int i = 0; i <= kSteps; ++i) {
        const double col = static_cast<double>(cols) * i / kSteps, row = static_cast<double>(rows) * i / kSteps;
        add(col, 0.0), add(col, rows), add(0.0, row), add(cols, row);
    }
    if (transform != nullptr) transform->forward(x, y);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    if (std::any_of(x.begin(), x.end(), [](double v) { return std::isnan(v); })) return {kNaN, kNaN, kNaN, kNaN};
    const auto [west, east] = std::minmax_element(x.begin(), x.end());
    const auto [south, north] = std::minmax_element(y.begin(), y.end());
    return {.west = *west, .east = *east, .south = *south, .north = *north};
}

namespace {

std::string describe(const std::array<double, 6>& gt, int cols, int rows, const std::string& crs) {
    const CrsTransform to_lonlat(crs, kGeographicCrs);
    const Extent e = extent_of(gt, cols, rows, &to_lonlat);
    return fmt::format("longitude {:.4f} to {:.4f}, latitude {:.4f} to {:.4f}", e.west, e.east, e.south, e.north);
}

}  // namespace

std::string describe_extent(const SourceBand& source) {
    return describe(source.geotransform, source.cols, source.rows, source.crs.wkt);
}
std::string describe_extent(const MapGrid& grid) {
    return describe(geotransform_of(grid), grid.cols, grid.rows, grid.crs_wkt);
}

}  // namespace pyroscene::gis
