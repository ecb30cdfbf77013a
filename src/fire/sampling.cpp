#include "fire/sampling.h"

#include <algorithm>

namespace pyroscene::fire {

float bilinear_or_own(const Raster<float>& raster, double col, double row) noexcept {
    const int last_col = raster.grid.cols - 1, last_row = raster.grid.rows - 1;
    const double x = std::clamp(col - 0.5, 0.0, static_cast<double>(last_col));
    const double y = std::clamp(row - 0.5, 0.0, static_cast<double>(last_row));
    const int c0 = static_cast<int>(x), r0 = static_cast<int>(y);
    const int c1 = std::min(c0 + 1, last_col), r1 = std::min(r0 + 1, last_row);
    const double fx = x - c0, fy = y - r0;
    const double north = (1.0 - fx) * raster.at(r0, c0) + fx * raster.at(r0, c1);
    const double south = (1.0 - fx) * raster.at(r1, c0) + fx * raster.at(r1, c1);
    const double value = (1.0 - fy) * north + fy * south;
    if (!std::isnan(value)) return static_cast<float>(value);
    return raster.at(std::clamp(static_cast<int>(std::floor(row)), 0, last_row),
                     std::clamp(static_cast<int>(std::floor(col)), 0, last_col));
}

}  // namespace pyroscene::fire
