#include "base/sparse_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace pyroscene {
namespace {

MapGrid grid(int cols, int rows) {
    return {.cols = cols, .rows = rows, .west_m = 0.0, .north_m = 0.0, .cell_m = 30.0, .crs_wkt = "test"};
}

TEST(SparseRaster, HoldsWhatWasSetAndElsewhereTheFill) {
    SparseRaster<float> raster(grid(100, 7), "height", "m", -1.0F);
    for (const std::size_t cell : {std::size_t{0}, std::size_t{63}, std::size_t{64}, std::size_t{699}})
        raster.set(cell, static_cast<float>(cell) + 0.5F);
    raster.set(63, 7.0F);
    std::vector<float> all(700);
    raster.copy(0, all);
    for (std::size_t cell = 0; cell < all.size(); ++cell) {
        const bool is_set = cell == 0 || cell == 63 || cell == 64 || cell == 699;
        const float expected = cell == 63 ? 7.0F : is_set ? static_cast<float>(cell) + 0.5F : -1.0F;
        EXPECT_EQ(raster[cell], expected) << cell;
        EXPECT_EQ(all[cell], expected) << cell;
    }
    EXPECT_EQ(raster.at(6, 99), 699.5F);
    EXPECT_EQ(raster.cells_held(), 3 * SparseRaster<float>::kRun);  // cells 0..63, 64..127 and 640..699
}

TEST(SparseRaster, SettingTheFillCostsNoMemory) {
    SparseRaster<float> unknown(grid(1000, 1000), "time", "s", std::numeric_limits<float>::quiet_NaN());
    for (std::size_t cell = 0; cell < unknown.grid.size(); ++cell)
        unknown.set(cell, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(unknown.cells_held(), 0U);
    EXPECT_TRUE(std::isnan(unknown.at(999, 999)));
    unknown.set(5, 1.0F);
    unknown.set(5, std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(std::isnan(unknown[5]));
}

}  // namespace
}  // namespace pyroscene
