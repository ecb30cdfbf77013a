#include "fire/gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pyroscene::fire {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kWidestWindow = 4;  ///< cells from the middle
constexpr double kExplained = 0.5;
constexpr int kFewestCells = 4;

/// Least-squares plane through arrival times around a cell; x and y in cells, times relative to the middle's.
class PlaneFit {
public:
    void add(double x, double y, double t_s) noexcept {
        ++n_;
        x_ += x, y_ += y, t_ += t_s;
        xx_ += x * x, xy_ += x * y, yy_ += y * y;
        xt_ += x * t_s, yt_ += y * t_s, tt_ += t_s * t_s;
        if (std::find(times_.begin(), times_.begin() + different_, t_s) == times_.begin() + different_ &&
            different_ < static_cast<int>(times_.size()))
            times_[static_cast<std::size_t>(different_++)] = t_s;
    }

    /// Magnitude of the gradient [s per cell]; 0 where the cells do not tell.
    [[nodiscard]] double gradient() const noexcept {
        if (n_ < kFewestCells || different_ < static_cast<int>(times_.size())) return 0.0;
        const double n = n_;
        const double xx = xx_ - x_ * x_ / n, xy = xy_ - x_ * y_ / n, yy = yy_ - y_ * y_ / n;
        const double xt = xt_ - x_ * t_ / n, yt = yt_ - y_ * t_ / n, tt = tt_ - t_ * t_ / n;
        const double determinant = xx * yy - xy * xy;
        if (!(determinant > 1e-9 * xx * yy)) return 0.0;  // all in one line
        const double gx = (xt * yy - yt * xy) / determinant, gy = (yt * xx - xt * xy) / determinant;
        return gx * xt + gy * yt > kExplained * tt ? std::hypot(gx, gy) : 0.0;
    }

private:
    int n_ = 0, different_ = 0;
    std::array<double, 3> times_{};
    double x_ = 0.0, y_ = 0.0, t_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0, xt_ = 0.0, yt_ = 0.0, tt_ = 0.0;
};

double gradient_at(const Raster<float>& t, int row, int col) noexcept {
    const double middle_s = t.at(row, col);
    for (int radius = 1; radius <= kWidestWindow; ++radius) {
        PlaneFit fit;
        for (int r = std::max(0, row - radius); r <= std::min(t.grid.rows - 1, row + radius); ++r)
            for (int c = std::max(0, col - radius); c <= std::min(t.grid.cols - 1, col + radius); ++c)
                if (const double time_s = t.at(r, c); std::isfinite(time_s)) fit.add(c - col, r - row, time_s - middle_s);
        if (const double gradient = fit.gradient(); gradient > 0.0) return gradient;
    }
    return 0.0;
}

/// Mean of the known values among the eight neighbours; NaN when there is none.
float mean_of_neighbours(const Raster<float>& raster, int row, int col) noexcept {
    double sum = 0.0;
    int count = 0;
    for (int r = std::max(0, row - 1); r <= std::min(raster.grid.rows - 1, row + 1); ++r)
        for (int c = std::max(0, col - 1); c <= std::min(raster.grid.cols - 1, col + 1); ++c)
            if (const float v = raster.at(r, c); !std::isnan(v)) sum += v, ++count;
    return count == 0 ? kNaN : static_cast<float>(sum / count);
}

/// Fills burnt cells without rate from their neighbours, one ring at a time, so that the result does not depend on the order.
void fill_from_neighbours(Raster<float>& rate, const Raster<float>& arrival_s) {
    for (int ring = 0; ring < kWidestWindow; ++ring) {
        const Raster<float> before = rate;
        for (int row = 0; row < rate.grid.rows; ++row)
            for (int col = 0; col < rate.grid.cols; ++col)
                if (std::isnan(before.at(row, col)) && std::isfinite(arrival_s.at(row, col)))
                    rate.at(row, col) = mean_of_neighbours(before, row, col);
    }
}

/// Rise over run between the cells before and after one, in the direction of growing index.
float difference(const Raster<float>& z_m, std::size_t middle, const std::size_t* before,
                 const std::size_t* after) noexcept {
    const auto value = [&](const std::size_t* cell) { return cell == nullptr ? kNaN : z_m.values[*cell]; };
    const float low = value(before), here = z_m.values[middle], high = value(after);
    const auto edge_m = static_cast<float>(z_m.grid.cell_m);
    if (!std::isnan(low) && !std::isnan(high)) return (high - low) / (2.0F * edge_m);
    const float rise_m = std::isnan(high) ? here - low : high - here;
    return std::isnan(rise_m) ? 0.0F : rise_m / edge_m;
}

}  // namespace

Raster<float> spread_rate_m_s(const Raster<float>& arrival_time_s, double maximum_m_s) {
    const MapGrid& grid = arrival_time_s.grid;
    Raster<float> rate(grid, "spread_rate", "m s-1", kNaN);
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            if (!std::isfinite(arrival_time_s.at(row, col))) continue;
            const double gradient = gradient_at(arrival_time_s, row, col);
            if (gradient > 0.0) rate.at(row, col) = static_cast<float>(std::min(maximum_m_s, grid.cell_m / gradient));
        }
    }
    fill_from_neighbours(rate, arrival_time_s);
    return rate;
}

TerrainSlope terrain_slope(const Raster<float>& terrain_m) {
    const MapGrid& grid = terrain_m.grid;
    TerrainSlope slope{Raster<float>(grid, "slope_east", "1"), Raster<float>(grid, "slope_north", "1")};
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t cell = grid.index(row, col);
            const std::size_t west = cell - 1, east = cell + 1, north = grid.index(row - 1, col),
                              south = grid.index(row + 1, col);
            slope.east.values[cell] =
                difference(terrain_m, cell, col > 0 ? &west : nullptr, col + 1 < grid.cols ? &east : nullptr);
            slope.north.values[cell] =
                difference(terrain_m, cell, row + 1 < grid.rows ? &south : nullptr, row > 0 ? &north : nullptr);
        }
    }
    return slope;
}

}  // namespace pyroscene::fire
