#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "fire/flame_field.h"

namespace pyroscene::fire {
namespace {

FlameParameters voxels(double dx_m, double dy_m, double dz_m) {
    FlameParameters p;
    p.voxel_m = {dx_m, dy_m, dz_m};
    return p;
}

FlameColumn upright() {
    return {.x_m = 12.5, .y_m = -7.5, .z_m = 100.0, .width_m = 5.0, .top_m = 3.0, .temperature_K = 1100.0};
}

/// Flames of all sizes, leanings and places, some of them embers.
std::vector<FlameColumn> many_columns(int count) {
    std::vector<FlameColumn> out;
    const RandomKey key{5, stream_id("test columns"), 0};
    for (int n = 0; n < count; ++n) {
        const auto u = [&](std::uint32_t draw) { return uniform01(key, static_cast<std::uint64_t>(n), draw); };
        const double bottom_m = n % 3 == 0 ? 2.0 * u(0) : 0.0;
        out.push_back({.x_m = 400.0 * u(1) - 200.0,
                       .y_m = 400.0 * u(2) - 200.0,
                       .z_m = 950.0 + 100.0 * u(3),
                       .width_m = 1.0 + 9.0 * u(4),
                       .area_fraction = u(5),
                       .bottom_m = bottom_m,
                       .top_m = bottom_m + 12.0 * u(6) * u(6),
                       .tilt_rad = 1.48 * u(7),
                       .azimuth_rad = 2.0 * kPi * u(8),
                       .temperature_K = 900.0 + 300.0 * u(9)});
    }
    return out;
}

double volume_m3(const std::vector<FlameColumn>& columns) {
    double out = 0.0;
    for (const auto& c : columns) out += c.area_fraction * c.width_m * c.width_m * (c.top_m - c.bottom_m);
    return out;
}

/// Emission-weighted centre of a field, scene frame.
Vec3 centre_of(const FlameField& field) {
    Vec3 sum;
    double fill = 0.0;
    const auto [low_m, high_m] = field.z_range_m();
    const int layers = static_cast<int>(std::lround((high_m - field.grid.corner_m.z) / field.grid.dz_m));
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < field.grid.ny; ++j)
            for (int i = 0; i < field.grid.nx; ++i) {
                const double f = voxel_at(field, i, j, k).fill;
                const auto& g = field.grid;
                sum = sum + f * (g.corner_m + Vec3{(i + 0.5) * g.dx_m, (j + 0.5) * g.dy_m, (k + 0.5) * g.dz_m});
                fill += f;
            }
    EXPECT_LE(low_m, high_m);
    return sum / fill;
}

class EveryVoxelSize : public testing::TestWithParam<double> {};

TEST_P(EveryVoxelSize, ConservesEmissiveVolume) {
    const auto columns = many_columns(300);
    EXPECT_NEAR(voxelise(columns, voxels(GetParam(), GetParam(), GetParam())).emissive_volume_m3() / volume_m3(columns), 1.0,
                1e-6);
    EXPECT_NEAR(voxelise(columns, voxels(GetParam(), 3.0, 1.0)).emissive_volume_m3() / volume_m3(columns), 1.0, 1e-6);
}

TEST_P(EveryVoxelSize, ConservesEmissiveVolumeForEveryTilt) {
    for (const double tilt_deg : {0.0, 10.0, 45.0, 70.0, 85.0}) {
        FlameColumn c = upright();
        c.tilt_rad = tilt_deg * kDegree_rad;
        c.azimuth_rad = 0.7;
        EXPECT_NEAR(voxelise({&c, 1}, voxels(GetParam(), GetParam(), GetParam())).emissive_volume_m3(), 75.0, 75e-6)
            << tilt_deg;
    }
}

// The middle of a sheared prism lies at half its height, shifted by half the height times tan(tilt) downwind; voxels smear
// it by less than half of their edge.
TEST_P(EveryVoxelSize, LeansDownwind) {
    for (const double azimuth_deg : {0.0, 90.0, 180.0, 270.0, 30.0}) {
        FlameColumn c = upright();
        c.top_m = 8.0;
        c.tilt_rad = 60.0 * kDegree_rad;
        c.azimuth_rad = azimuth_deg * kDegree_rad;
        const double shift_m = 4.0 * std::sqrt(3.0);
        const Vec3 centre = centre_of(voxelise({&c, 1}, voxels(GetParam(), GetParam(), GetParam())));
        EXPECT_NEAR(centre.x, 12.5 + shift_m * std::sin(c.azimuth_rad), 0.5 * GetParam() + 1e-4) << azimuth_deg;
        EXPECT_NEAR(centre.y, -7.5 + shift_m * std::cos(c.azimuth_rad), 0.5 * GetParam() + 1e-4) << azimuth_deg;
        EXPECT_NEAR(centre.z, 104.0, 0.5 * GetParam() + 1e-4) << azimuth_deg;
    }
}

INSTANTIATE_TEST_SUITE_P(Metres, EveryVoxelSize, testing::Values(20.0, 10.0, 5.0, 2.0, 1.0));

TEST(Voxelise, SplitsAnUprightColumnByExactOverlap) {
    // Base x 10..15, y -10..-5, z 100..103 over voxels of 4 x 4 x 2 m.
    const FlameColumn c = upright();
    const auto field = voxelise({&c, 1}, voxels(4.0, 4.0, 2.0));
    EXPECT_DOUBLE_EQ(field.grid.corner_m.x, 8.0);
    EXPECT_DOUBLE_EQ(field.grid.corner_m.y, -12.0);
    EXPECT_DOUBLE_EQ(field.grid.corner_m.z, 100.0);
    EXPECT_FLOAT_EQ(voxel_at(field, 0, 0, 0).fill, 0.5F * 0.5F);           // x 10..12, y -10..-8
    EXPECT_FLOAT_EQ(voxel_at(field, 1, 0, 0).fill, 0.75F * 0.5F);          // x 12..15
    EXPECT_FLOAT_EQ(voxel_at(field, 1, 1, 0).fill, 0.75F * 0.75F);         // y -8..-5
    EXPECT_FLOAT_EQ(voxel_at(field, 1, 1, 1).fill, 0.75F * 0.75F * 0.5F);  // z 102..103
    EXPECT_EQ(voxel_at(field, 2, 0, 0).fill, 0.0F);
    EXPECT_EQ(voxel_at(field, 0, 0, 2).fill, 0.0F);
    EXPECT_EQ(voxel_at(field, 1, 1, 1).temperature_K, 1100.0F);
}

TEST(Voxelise, AreaFractionThinsTheFlame) {
    FlameColumn c = upright();
    c.area_fraction = 0.25;
    const auto field = voxelise({&c, 1}, voxels(5.0, 5.0, 1.0));
    EXPECT_FLOAT_EQ(voxel_at(field, 0, 0, 0).fill, 0.25F);
}

TEST(Voxelise, EmbersLeaveAGapBelow) {
    FlameColumn c = upright();
    FlameColumn ember = c;
    ember.bottom_m = 5.0;
    ember.top_m = 6.0;
    const std::vector<FlameColumn> both{c, ember};
    const auto field = voxelise(both, voxels(5.0, 5.0, 1.0));
    for (int k = 0; k < 7; ++k) EXPECT_FLOAT_EQ(voxel_at(field, 0, 0, k).fill, k < 3 || k == 5 ? 1.0F : 0.0F) << k;
}

// 45 degrees to the east, 1 m voxels: layer k lies k + 0.5 m farther east on average.
TEST(Voxelise, ShearsLayerByLayer) {
    FlameColumn c = upright();
    c.tilt_rad = 0.25 * kPi;
    c.azimuth_rad = 0.5 * kPi;
    const auto field = voxelise({&c, 1}, voxels(1.0, 1.0, 1.0));
    for (int k = 0; k < 3; ++k) {
        double fill = 0.0, x = 0.0;
        for (int i = 0; i < field.grid.nx; ++i) {
            const double f = voxel_at(field, i, 2, k).fill;
            fill += f;
            x += f * (field.grid.corner_m.x + i + 0.5);
        }
        EXPECT_NEAR(fill, 5.0, 1e-6) << k;
        EXPECT_NEAR(x / fill, 12.5 + k + 0.5, 1e-6) << k;
    }
}

// 16 m of shear within one thick layer: the 15 voxels that the whole column crosses share it evenly, but for a ripple below 2 %
// that slabs of half a voxel leave.
TEST(Voxelise, ShearsInsideThickVoxels) {
    FlameColumn c = upright();
    c.width_m = 1.0;
    c.y_m = -7.5;
    c.z_m = 0.0;
    c.top_m = 4.0;
    c.tilt_rad = std::atan(4.0);
    c.azimuth_rad = 0.5 * kPi;
    const auto field = voxelise({&c, 1}, voxels(1.0, 1.0, 4.0));
    EXPECT_NEAR(field.grid.corner_m.x, 12.0, 1e-12);
    for (int i = 1; i < 16; ++i) EXPECT_NEAR(voxel_at(field, i, 0, 0).fill, 1.0 / 16.0, 1e-3) << i;
}

TEST(Voxelise, LatticesOfDifferentFramesCoincide) {
    for (const double x_m : {-33.3, 0.1, 471.7}) {
        FlameColumn c = upright();
        c.x_m = x_m;
        const auto corner = voxelise({&c, 1}, voxels(5.0, 2.0, 0.5)).grid.corner_m;
        EXPECT_NEAR(std::remainder(corner.x, 5.0), 0.0, 1e-9);
        EXPECT_NEAR(std::remainder(corner.y, 2.0), 0.0, 1e-9);
        EXPECT_NEAR(std::remainder(corner.z, 0.5), 0.0, 1e-9);
    }
}

TEST(Voxelise, DoesNotDependOnTheOrderOfColumns) {
    auto columns = many_columns(200);
    const auto a = voxelise(columns, voxels(5.0, 5.0, 2.0));
    std::reverse(columns.begin(), columns.end());
    const auto b = voxelise(columns, voxels(5.0, 5.0, 2.0));
    ASSERT_EQ(a.bricks.size(), b.bricks.size());
    for (std::size_t n = 0; n < a.bricks.size(); ++n) {
        EXPECT_EQ(a.bricks[n].fill, b.bricks[n].fill);
        EXPECT_EQ(a.bricks[n].temperature_K, b.bricks[n].temperature_K);
    }
}

TEST(Voxelise, NothingBurningIsAnEmptyField) {
    EXPECT_TRUE(voxelise({}, voxels(5.0, 5.0, 1.0)).empty());
    FlameColumn flat = upright();
    flat.top_m = 0.0;
    EXPECT_TRUE(voxelise({&flat, 1}, voxels(5.0, 5.0, 1.0)).empty());
}

TEST(Voxelise, RefusesWhatCannotBeCut) {
    FlameColumn c = upright();
    EXPECT_THROW(voxelise({&c, 1}, voxels(0.0, 5.0, 1.0)), Error);
    EXPECT_THROW(voxelise({&c, 1}, voxels(1e-3, 1e-3, 1e-3)), Error);
    c.tilt_rad = 0.5 * kPi;
    EXPECT_THROW(voxelise({&c, 1}, voxels(5.0, 5.0, 1.0)), Error);
}

}  // namespace
}  // namespace pyroscene::fire
