#include "fire/flame_field.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pyroscene::fire {
namespace {

VoxelGrid grid() { return {{100.0, 200.0, 50.0}, 20, 10, 2.0, 3.0, 0.5}; }

TEST(FlameField, KeepsEveryVoxelWhereItWas) {
    const std::vector<FlameVoxel> voxels{{0, 0, 0, 0.25F, 900.0F}, {19, 9, 31, 1.5F, 1200.0F}, {7, 8, 8, 0.5F, 1000.0F}};
    const auto field = make_flame_field(grid(), voxels);
    EXPECT_EQ(field.brick_cols, 3);  // 20 voxels in bricks of 8
    EXPECT_EQ(field.brick_rows, 2);
    for (const auto& v : voxels) {
        EXPECT_EQ(voxel_at(field, v.i, v.j, v.k).fill, v.fill);
        EXPECT_EQ(voxel_at(field, v.i, v.j, v.k).temperature_K, v.temperature_K);
    }
    EXPECT_EQ(voxel_at(field, 1, 0, 0).fill, 0.0F);
    EXPECT_EQ(voxel_at(field, 0, 0, 8).fill, 0.0F);
    EXPECT_EQ(voxel_at(field, -1, 0, 0).fill, 0.0F);
    EXPECT_EQ(voxel_at(field, 20, 0, 0).fill, 0.0F);
    // The documented place in the brick: voxel (7, 0, 0) of the brick of (7, 8, 8) is (k 0, j 0, i 7).
    const auto& column = field.columns[1 * 3 + 0];
    EXPECT_EQ(column.z_begin, 1);
    EXPECT_EQ(field.bricks[static_cast<std::size_t>(column.first_brick)].fill[7], 0.5F);
}

TEST(FlameField, SummarisesVolumeHeightAndTemperature) {
    const std::vector<FlameVoxel> voxels{{0, 0, 9, 0.25F, 900.0F}, {1, 0, 9, 0.75F, 1200.0F}};
    const auto field = make_flame_field(grid(), voxels);
    EXPECT_DOUBLE_EQ(field.emissive_volume_m3(), 1.0 * 2.0 * 3.0 * 0.5);
    EXPECT_DOUBLE_EQ(field.z_range_m()[0], 54.0);  // layers 8..15 of 0.5 m above 50 m
    EXPECT_DOUBLE_EQ(field.z_range_m()[1], 58.0);
    EXPECT_EQ(field.temperature_range_K()[0], 900.0);
    EXPECT_EQ(field.temperature_range_K()[1], 1200.0);
}

TEST(FlameField, BricksOfAColumnAreContiguous) {
    const std::vector<FlameVoxel> voxels{{0, 0, 3, 1.0F, 900.0F}, {0, 0, 40, 1.0F, 900.0F}, {9, 0, 17, 1.0F, 900.0F}};
    const auto field = make_flame_field(grid(), voxels);
    EXPECT_EQ(field.columns[0].brick_count, 6);  // bricks 0..5
    EXPECT_EQ(field.columns[1].brick_count, 1);
    EXPECT_EQ(field.columns[1].z_begin, 2);
    EXPECT_EQ(field.columns[2].brick_count, 0);
    EXPECT_EQ(field.bricks.size(), 7U);
    for (const float fill : field.bricks[2].fill) EXPECT_EQ(fill, 0.0F);
}

// Thin soot emits in proportion to T^5: (0.25 900^5 + 0.75 1100^5)^(1/5) = 1062.72 K.
TEST(FlameField, MergesVoxelsSoThatTheirEmissionIsKept) {
    const std::vector<FlameVoxel> voxels{{3, 3, 3, 0.5F, 900.0F}, {3, 3, 3, 1.5F, 1100.0F}};
    const auto v = voxel_at(make_flame_field(grid(), voxels), 3, 3, 3);
    EXPECT_FLOAT_EQ(v.fill, 2.0F);
    const double T5 = 0.25 * std::pow(900.0, 5) + 0.75 * std::pow(1100.0, 5);
    EXPECT_NEAR(std::pow(v.temperature_K, 5) / T5, 1.0, 1e-6);
}

TEST(FlameField, MergesInAnyOrderToTheSameBits) {
    std::vector<FlameVoxel> voxels;
    for (int n = 0; n < 5000; ++n)
        voxels.push_back({n % 5, n % 3, n % 7, 1e-3F * static_cast<float>(1 + (n * 7919) % 1013),
                          900.0F + static_cast<float>((n * 31) % 300)});
    const auto a = make_flame_field(grid(), voxels);
    std::reverse(voxels.begin(), voxels.end());
    std::rotate(voxels.begin(), voxels.begin() + 1234, voxels.end());
    const auto b = make_flame_field(grid(), voxels);
    ASSERT_EQ(a.bricks.size(), b.bricks.size());
    for (std::size_t n = 0; n < a.bricks.size(); ++n) {
        EXPECT_EQ(a.bricks[n].fill, b.bricks[n].fill);
        EXPECT_EQ(a.bricks[n].temperature_K, b.bricks[n].temperature_K);
    }
}

// 1 + 2^-24 lies halfway between two floats; four times 2^-54 tip it over only when they are added before the large ones.
TEST(FlameField, RoundsTheSameInAnyOrder) {
    std::vector<FlameVoxel> voxels{{0, 0, 0, 1.0F, 900.0F}, {0, 0, 0, 0x1p-24F, 900.0F}};
    voxels.insert(voxels.end(), 4, {0, 0, 0, 0x1p-54F, 900.0F});
    const float fill = voxel_at(make_flame_field(grid(), voxels), 0, 0, 0).fill;
    std::reverse(voxels.begin(), voxels.end());
    EXPECT_EQ(voxel_at(make_flame_field(grid(), voxels), 0, 0, 0).fill, fill);
}

TEST(FlameField, IsEmptyWithoutFlame) {
    const std::vector<FlameVoxel> nothing{{3, 3, 3, 0.0F, 900.0F}};
    const auto field = make_flame_field(grid(), nothing);
    EXPECT_TRUE(field.empty());
    EXPECT_EQ(field.emissive_volume_m3(), 0.0);
    EXPECT_EQ(field.z_range_m(), (std::array<double, 2>{0.0, 0.0}));
    EXPECT_EQ(field.temperature_range_K(), (std::array<double, 2>{0.0, 0.0}));
    EXPECT_EQ(voxel_at(field, 3, 3, 3).fill, 0.0F);
    EXPECT_EQ(voxel_at(FlameField{}, 0, 0, 0).fill, 0.0F);
}

TEST(FlameField, RefusesVoxelsOutsideAndBadFills) {
    for (const FlameVoxel& v :
         {FlameVoxel{-1, 0, 0, 1.0F, 900.0F}, FlameVoxel{20, 0, 0, 1.0F, 900.0F}, FlameVoxel{0, 10, 0, 1.0F, 900.0F},
          FlameVoxel{0, 0, -1, 1.0F, 900.0F}, FlameVoxel{0, 0, 0, -1.0F, 900.0F}}) {
        EXPECT_THROW(make_flame_field(grid(), {&v, 1}), Error) << v.i << ' ' << v.j << ' ' << v.k;
    }
    EXPECT_THROW(make_flame_field(VoxelGrid{}, {}), Error);
}

}  // namespace
}  // namespace pyroscene::fire
