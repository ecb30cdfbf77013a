// Arrival times against those of other programs (tests/data/propagation).
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "gis/raster_input.h"
#include "source_folder.h"
#include "spread/landscape.h"

namespace pyroscene::spread {
namespace {

const std::filesystem::path& folder() {
    static const auto path = source_folder() / "tests" / "data" / "propagation";
    return path;
}

Raster<float> reference(const char* name, const char* unit) {
    static const MapGrid grid = gis::make_map_grid(folder() / "A_toa_analytic_s.tif", {}, {});
    return gis::read_band({folder() / name, 1, gis::Resampling::Nearest, name, unit}, grid);
}

Weather steady(double wind_m_s, double from_deg) {
    const double to_rad = from_deg * kDegree_rad + kPi;
    return {0.0, {wind_m_s * std::sin(to_rad)}, {wind_m_s * std::cos(to_rad)}, {{{0.06}, {0.07}, {0.08}, {0.6}, {0.9}}}};
}

std::vector<Seed> line(const MapGrid& grid, double x0, double y0, double x1, double y1) {
    std::vector<Seed> seeds;
    const int steps = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / (0.25 * grid.cell_m));
    for (int i = 0; i <= steps; ++i)
        seeds.push_back(
            {grid.col_at(std::lerp(x0, x1, double(i) / steps)), grid.row_at(std::lerp(y0, y1, double(i) / steps)), 0.0});
    return seeds;
}

/// Quotients of two rasters where both have a value and the second is larger than a bound, in ascending order.
std::vector<double> ratios(const Raster<float>& a, const Raster<float>& b, double bound) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        if (std::isfinite(a.values[i]) && b.values[i] > bound) out.push_back(a.values[i] / b.values[i]);
    std::sort(out.begin(), out.end());
    return out;
}
double quantile(const std::vector<double>& sorted, double q) {
    return sorted.at(static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1)));
}

TEST(ReferenceFire, AIsTheExactEllipse) {
    const auto exact = reference("A_toa_analytic_s.tif", "s");
    const MapGrid& grid = exact.grid;
    const Landscape land{Raster<std::uint16_t>(grid, "fuel", "1", 3), standard_fuel_models(),
                         Raster<float>(grid, "slope", "1"), Raster<float>(grid, "slope", "1")};
    const auto fire =
        spread_fire(land, {steady(6.0, 270.0)}, {}, {{grid.col_at(499010.0), grid.row_at(4000010.0), 0.0}}, 1500.0);
    int compared = 0;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const double expected = exact.at(row, col);
            if (std::hypot(grid.x_centre_m(col) - 499010.0, grid.y_centre_m(row) - 4000010.0) < 100.0) continue;
            if (std::isnan(expected) || expected > 1490.0) continue;
            EXPECT_NEAR(fire.arrival_time_s.at(row, col) / expected, 1.0, 0.0005) << row << ' ' << col;
            ++compared;
        }
    EXPECT_GT(compared, 900);
    // Where the exact fire has not come, ours has not either.
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (std::isnan(exact.values[i]) && std::isfinite(fire.arrival_time_s.values[i])) {
            EXPECT_GT(fire.arrival_time_s.values[i], 1480.0F);
        }
    }
    const auto to_level_set = ratios(fire.arrival_time_s, reference("A_toa_pyretechnics_s.tif", "s"), 120.0);
    EXPECT_NEAR(quantile(to_level_set, 0.5), 1.0 / 0.984, 0.01);
    auto intensity = reference("A_fli_pyretechnics_kW_m.tif", "kW m-1");
    for (auto& v : intensity.values) v *= 1000.0F;
    const auto to_intensity = ratios(fire.fireline_intensity_W_m, intensity, 1.0);
    EXPECT_NEAR(quantile(to_intensity, 0.5), 1.0, 0.04);
}

TEST(ReferenceFire, BRunsOverAHillThroughTwoFuelsAndAroundABarrier) {
    const auto slope = reference("B_slope_deg.tif", ""), aspect = reference("B_aspect_deg.tif", ""),
               fuel = reference("B_fuel.tif", "");
    const MapGrid& grid = slope.grid;
    Landscape land{Raster<std::uint16_t>(grid, "fuel", "1", 0), standard_fuel_models(), Raster<float>(grid, "slope", "1"),
                   Raster<float>(grid, "slope", "1")};
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const double rise = std::tan(slope.values[i] * kDegree_rad), upslope_rad = aspect.values[i] * kDegree_rad + kPi;
        land.slope_east.values[i] = static_cast<float>(rise * std::sin(upslope_rad));
        land.slope_north.values[i] = static_cast<float>(rise * std::cos(upslope_rad));
        land.fuel.values[i] = fuel.values[i] == 99.0F ? std::uint16_t{0} : static_cast<std::uint16_t>(fuel.values[i]);
    }
    const auto fire = spread_fire(land, {steady(4.0, 255.0)}, {}, line(grid, 498800, 3999600, 498800, 4000400), 2400.0);
    const auto level_set = reference("B_toa_pyretechnics_s.tif", "s"), marched = reference("B_toa_elmfire_s.tif", "s");
    EXPECT_NEAR(quantile(ratios(fire.arrival_time_s, level_set, 120.0), 0.5), 1.0, 0.04);
    EXPECT_NEAR(quantile(ratios(fire.arrival_time_s, marched, 120.0), 0.5), 1.0, 0.02);
    // Fuel by fuel: Pyretechnics has chaparral spread by a quarter faster than BEHAVE, ELMFIRE and we do.
    const auto only = [&](Raster<float> raster, float code) {
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (fuel.values[i] != code) raster.values[i] = std::numeric_limits<float>::quiet_NaN();
        return raster;
    };
    const auto grass = ratios(fire.arrival_time_s, only(level_set, 3.0F), 120.0);
    EXPECT_NEAR(quantile(grass, 0.5), 1.0, 0.02);
    EXPECT_GT(quantile(grass, 0.05), 0.98);
    EXPECT_LT(quantile(grass, 0.95), 1.06);
    const auto chaparral = ratios(fire.arrival_time_s, only(marched, 4.0F), 120.0);
    EXPECT_NEAR(quantile(chaparral, 0.5), 1.0, 0.03);
    auto intensity = only(reference("B_fli_pyretechnics_kW_m.tif", "kW m-1"), 3.0F);
    for (auto& v : intensity.values) v *= 1000.0F;
    const auto by_level_set = ratios(fire.fireline_intensity_W_m, intensity, 1.0);
    EXPECT_NEAR(quantile(by_level_set, 0.5), 1.0, 0.03);
    EXPECT_GT(quantile(by_level_set, 0.05), 0.9);
    EXPECT_LT(quantile(by_level_set, 0.95), 1.1);
    // Behind the barrier the fire comes late, and on it never.
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            if (fuel.at(row, col) == 99.0F) {
                EXPECT_TRUE(std::isnan(fire.arrival_time_s.at(row, col)));
            }
        }
}

}  // namespace
}  // namespace pyroscene::spread
