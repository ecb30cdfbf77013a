#include <gtest/gtest.h>
#include <cmath>
#include <set>

#include "base/error.h"
#include "fire/flame_field.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::frame;
using test::kNaN;

/// Height rises 0.1 m per metre to the east of x = 1000 and is 300 m there; bilinear interpolation is exact between centres.
Raster<float> slope(const MapGrid& grid) {
    Raster<float> out(grid, "terrain", "m");
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            out.at(row, col) = static_cast<float>(300.0 + 0.1 * (grid.x_centre_m(col) - 1000.0));
    return out;
}

double volume_m3(const std::vector<FlameColumn>& columns) {
    double out = 0.0;
    for (const auto& c : columns) out += c.area_fraction * c.width_m * c.width_m * (c.top_m - c.bottom_m);
    return out;
}

std::vector<FlameColumn> columns_of(const FireState& state, const FireParameters& p, int refinement = 4) {
    return make_columns(state, surface_at(state, state.time_s, p, refinement), slope(state.cell_class.grid), p, {},
                        {1030, 4990, 0});
}

// Volume of eq 4.21 with the cell's power: sum of H A / q''' over the front.
TEST(Columns, HoldTheVolumeThatTheHeatFluxFeeds) {
    const std::vector<float> flux{2e3F, 3.3e4F, 4e5F, 5.92e6F};
    const double delivered_m3 = 400.0 * (2e3 + 3.3e4 + 4e5 + 5.92e6) / 2e6;
    for (const Physics physics : {Physics::Default, Physics::Thesis}) {
        FireParameters p;
        p.physics = physics;
        for (const int refinement : {1, 3, 4}) {
            EXPECT_NEAR(volume_m3(columns_of(advance(nullptr, frame(0.0, flux, 5.0F), p), p, refinement)) / delivered_m3,
                        1.0, 1e-6);
        }
    }
}

TEST(Columns, StandOnTheTerrainInTheSceneFrame) {
    const FireParameters p;
    const auto columns = columns_of(advance(nullptr, frame(0.0, {0.0F, 5e5F, 0.0F}), p), p, 2);
    ASSERT_EQ(columns.size(), 4U);
    // Fine cells of 10 m in map cell 1: x = 1025, 1035; y = 4995, 4985; origin (1030, 4990).
    EXPECT_NEAR(columns[0].x_m, -5.0, 1e-9);
    EXPECT_NEAR(columns[0].y_m, 5.0, 1e-9);
    EXPECT_NEAR(columns[0].z_m, 302.5, 1e-4);
    EXPECT_NEAR(columns[3].x_m, 5.0, 1e-9);
    EXPECT_NEAR(columns[3].y_m, -5.0, 1e-9);
    EXPECT_NEAR(columns[3].z_m, 303.5, 1e-4);
    for (const auto& c : columns) {
        EXPECT_EQ(c.width_m, 10.0);
        EXPECT_EQ(c.area_fraction, 1.0);
        EXPECT_EQ(c.bottom_m, 0.0);
        EXPECT_FLOAT_EQ(static_cast<float>(c.top_m), 0.25F);  // 5e5 / 2e6
        EXPECT_EQ(c.temperature_K, 1100.0);
    }
}

// The flaming part of a cell is as tall as a fully flaming cell: a front narrower than a cell is not a lower flame.
TEST(Columns, AreAsTallInAPartlyFlamingCell) {
    const FireParameters p;
    const auto columns = columns_of(advance(nullptr, frame(0.0, {5e4F, 5e5F}), p), p, 1);
    ASSERT_EQ(columns.size(), 2U);
    EXPECT_NEAR(columns[0].top_m, columns[1].top_m, 1e-6);
    EXPECT_NEAR(columns[0].area_fraction, 0.1, 1e-6);
}

TEST(Columns, EmbersAreDetachedAboveTheFlame) {
    FireParameters p;
    p.embers.drift = false;
    p.flaming_heat_flux_W_m2 = 2e6;
    auto state = advance(nullptr, frame(0.0, {2e6F, 6e6F}), p);
    state = advance(&state, frame(6.0, {1e7F, 0.0F}), p);  // 5 m, cut at 2 + sqrt(2)
    FlameParameters flame;
    flame.ember_gap_m = 0.75;
    const auto columns = make_columns(state, surface_at(state, 6.0, p, 1), slope(state.cell_class.grid), p, flame, {});
    ASSERT_EQ(columns.size(), 2U);
    EXPECT_NEAR(columns[0].top_m, 2.0 + std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(columns[1].bottom_m - columns[0].top_m, 0.75, 1e-6);
    EXPECT_NEAR(columns[1].top_m - columns[1].bottom_m, 3.0 - std::sqrt(2.0), 1e-6);
    EXPECT_EQ(columns[1].x_m, columns[0].x_m);
    EXPECT_NEAR(volume_m3(columns), 400.0 * 5.0, 1e-3);
}

TEST(Columns, CarryTiltAndAzimuthOfTheirCell) {
    const FireParameters p;
    const auto state = advance(nullptr, frame(0.0, {0.0F, 5e5F}, 3.0F, -3.0F), p);
    for (const auto& c : columns_of(state, p)) {
        EXPECT_EQ(c.tilt_rad, state.flame_tilt_rad.at(0, 1));
        EXPECT_EQ(c.azimuth_rad, state.flame_azimuth_rad.at(0, 1));
        EXPECT_GT(c.tilt_rad, 0.0);
    }
}

TEST(Columns, JitterIsBoundedSeededAndFollowsTheTerrain) {
    FireParameters p;
    const auto state = advance(nullptr, frame(0.0, std::vector<float>(12, 5e5F)), p);
    const auto still = columns_of(state, p);
    p.jitter_m = 2.0;
    const auto moved = columns_of(state, p);
    ASSERT_EQ(moved.size(), still.size());
    double mean_x = 0.0, mean_y = 0.0, mean_xy = 0.0, farthest_m = 0.0;
    for (std::size_t n = 0; n < moved.size(); ++n) {
        const double dx = moved[n].x_m - still[n].x_m, dy = moved[n].y_m - still[n].y_m;
        mean_x += dx / static_cast<double>(moved.size());
        mean_y += dy / static_cast<double>(moved.size());
        mean_xy += dx * dy / static_cast<double>(moved.size());
        farthest_m = std::max({farthest_m, std::abs(dx), std::abs(dy)});
        const double x_map_m = moved[n].x_m + 1030.0;  // terrain is a plane between the outermost centres
        if (x_map_m > 1010.0 && x_map_m < 1230.0) {
            EXPECT_NEAR(moved[n].z_m, 300.0 + 0.1 * (x_map_m - 1000.0), 1e-3);
        }
    }
    EXPECT_LE(farthest_m, 2.0);
    EXPECT_GT(farthest_m, 1.8);
    // Mean of 192 uniform deviates of half width 2: sd 2 / sqrt(3 * 192) = 0.083.
    EXPECT_LT(std::abs(mean_x), 0.33);
    EXPECT_LT(std::abs(mean_y), 0.33);
    EXPECT_LT(std::abs(mean_xy), 0.4);  // independent axes: variance 4/3, so sd 1.33 / sqrt(192) = 0.096
    EXPECT_EQ(columns_of(state, p)[7].x_m, moved[7].x_m);
    p.seed = 99;
    EXPECT_NE(columns_of(state, p)[7].x_m, moved[7].x_m);
}

TEST(Columns, JitterChangesFromFrameToFrame) {
    FireParameters p;
    p.jitter_m = 1.0;
    const auto first = advance(nullptr, frame(0.0, {5e5F}), p);
    const auto second = advance(&first, frame(6.0, {5e5F}), p);
    EXPECT_NE(columns_of(first, p)[0].x_m, columns_of(second, p)[0].x_m);
}

TEST(Columns, AreLeftOutWhereTerrainIsUnknown) {
    const FireParameters p;
    const auto state = advance(nullptr, frame(0.0, {5e5F, 5e5F, 5e5F}), p);
    auto terrain = slope(state.cell_class.grid);
    terrain.at(0, 1) = kNaN;
    const auto columns = make_columns(state, surface_at(state, 0.0, p, 2), terrain, p, {}, {});
    EXPECT_EQ(columns.size(), 8U);
    for (const auto& c : columns) EXPECT_FALSE(c.x_m > 1020.0 && c.x_m < 1040.0);
}

TEST(Columns, RefuseForeignGrids) {
    const FireParameters p;
    const auto state = advance(nullptr, frame(0.0, {5e5F}), p);
    const auto surface = surface_at(state, 0.0, p, 1);
    EXPECT_THROW(make_columns(state, surface, slope(test::small_grid(1, 1, 30.0)), p, {}, {}), Error);
    const auto other = advance(nullptr, frame(0.0, {5e5F, 0.0F}), p);
    EXPECT_THROW(make_columns(other, surface, slope(other.cell_class.grid), p, {}, {}), Error);
}

}  // namespace
}  // namespace pyroscene::fire
