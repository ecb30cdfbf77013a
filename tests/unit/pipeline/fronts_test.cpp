#include "pipeline/fronts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pyroscene::pipeline {
namespace {

/// A map of 20 m cells where `burns` says what is front; each such cell flames on half its area with 1 m mean height.
template <class F>
Fronts fronts_of(int cols, int rows, const F& burns, float heat_flux_W_m2 = 1e5F) {
    const MapGrid grid{.cols = cols, .rows = rows, .west_m = 1000.0, .north_m = 9000.0, .cell_m = 20.0, .crs_wkt = "test"};
    fire::FireState state;
    state.cell_class = Raster<std::uint8_t>(grid, "class", "1");
    state.front_fraction = SparseRaster<float>(grid, "front_fraction", "1");
    state.flame_height_m = SparseRaster<float>(grid, "flame_height", "m");
    Raster<float> flux(grid, "heat flux", "W m-2");
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            if (burns(col, row)) {
                state.cell_class.at(row, col) = static_cast<std::uint8_t>(fire::CellClass::Front);
                state.front_fraction.set(grid.index(row, col), 0.5F);
                state.flame_height_m.set(grid.index(row, col), 1.0F);
                flux.at(row, col) = heat_flux_W_m2;
            }
    return find_fronts(state, flux);
}

TEST(Fronts, AStraightLineHasItsLengthDepthAndIntensity) {
    const auto found = fronts_of(60, 9, [](int col, int row) { return row == 4 && col >= 10 && col < 50; });
    ASSERT_EQ(found.fronts.size(), 1U);
    const auto& f = found.fronts.front();
    EXPECT_EQ(f.cells, 40);
    EXPECT_DOUBLE_EQ(f.area_m2, 40 * 400.0);
    EXPECT_NEAR(f.length_m, 800.0, 1e-9);
    EXPECT_NEAR(f.mean_depth_m, 10.0, 1e-9);        // half of a 20 m cell flames
    EXPECT_NEAR(f.intensity_kW_m, 2000.0, 1e-6);    // 1e5 W m-2 over 20 m
    EXPECT_NEAR(f.mean_flame_height_m, 2.0, 1e-6);  // 1 m mean height over half the area
    EXPECT_NEAR(f.x_m, 1000.0 + 20.0 * 30.0, 1e-9);
    EXPECT_NEAR(f.y_m, 9000.0 - 20.0 * 4.5, 1e-9);
}

// Closed forms, to a cell or two: diagonal, thick band at 30 degrees, ring, square.
TEST(Fronts, LengthHoldsForAnyShape) {
    const auto diagonal = fronts_of(60, 60, [](int col, int row) { return row == col && col >= 5 && col < 45; });
    ASSERT_EQ(diagonal.fronts.size(), 1U);  // corners touch
    EXPECT_NEAR(diagonal.fronts[0].length_m, 40 * 20.0 * std::sqrt(2.0), 20.0);

    const auto band = fronts_of(120, 120, [](int col, int row) {
        const double x = col - 60.0, y = row - 60.0, c = std::cos(0.5236), s = std::sin(0.5236);
        return std::abs(x * c + y * s) <= 40.0 && std::abs(y * c - x * s) <= 4.0;
    });
    ASSERT_EQ(band.fronts.size(), 1U);
    EXPECT_NEAR(band.fronts[0].length_m / 20.0, 81.0, 2.5);

    const auto ring = fronts_of(120, 120, [](int col, int row) {
        const double r = std::hypot(col - 60.0, row - 60.0);
        return r >= 38.0 && r <= 42.0;
    });
    ASSERT_EQ(ring.fronts.size(), 1U);
    EXPECT_NEAR(ring.fronts[0].length_m / 20.0 / (2.0 * 3.14159265 * 40.0), 1.0, 0.06);

    const auto square = fronts_of(20, 20, [](int col, int row) { return col >= 5 && col < 15 && row >= 5 && row < 15; });
    EXPECT_NEAR(square.fronts[0].length_m, 200.0, 1e-9);
}

TEST(Fronts, PiecesAreNumberedBySize) {
    const auto found = fronts_of(
        30, 10, [](int col, int row) { return (row == 1 && col < 3) || (row == 8 && col < 7) || (row == 5 && col == 20); });
    ASSERT_EQ(found.fronts.size(), 3U);
    EXPECT_EQ(found.fronts[0].cells, 7);
    EXPECT_EQ(found.fronts[1].cells, 3);
    EXPECT_EQ(found.fronts[2].cells, 1);
    EXPECT_EQ(found.label.at(8, 0), 1);
    EXPECT_EQ(found.label.at(1, 2), 2);
    EXPECT_EQ(found.label.at(5, 20), 3);
    EXPECT_EQ(found.label.at(0, 0), 0);
    EXPECT_NEAR(found.fronts[2].length_m, 20.0, 1e-9);
    const auto csv = fronts_csv(found);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
    EXPECT_EQ(csv.find("front,cells,area_m2,"), 0U);
}

TEST(Fronts, NothingBurns) {
    const auto found = fronts_of(4, 4, [](int, int) { return false; });
    EXPECT_TRUE(found.fronts.empty());
    RunReport report;
    record_fronts(report, found, "t000000000");
    EXPECT_EQ(report.values().at("fronts/t000000000/count"), 0.0);
}

}  // namespace
}  // namespace pyroscene::pipeline
