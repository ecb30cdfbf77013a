#include "render/flame_march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace pyroscene::render {
namespace {

fire::VoxelGrid lattice(int nx, int ny) {
    return {.corner_m = {100.0, 50.0, 10.0}, .nx = nx, .ny = ny, .dx_m = 5.0, .dy_m = 4.0, .dz_m = 2.0};
}

std::vector<fire::FlameVoxel> full(int nx, int ny, int nz) {
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) voxels.push_back({i, j, k, 1.0F, static_cast<float>(800 + i + 10 * j + 100 * k)});
        }
    }
    return voxels;
}

/// Length of the segment inside a box: slabs, the closed form the march must add up to.
double length_in_box(Vec3 from, Vec3 to, Vec3 low, Vec3 high) {
    double begin = 0.0, end = 1.0;
    const auto cut = [&](double f, double t, double l, double h) {
        const double d = t - f;
        if (d == 0.0) {
            if (f < l || f > h) end = -1.0;
            return;
        }
        begin = std::max(begin, std::min((l - f) / d, (h - f) / d));
        end = std::min(end, std::max((l - f) / d, (h - f) / d));
    };
    cut(from.x, to.x, low.x, high.x);
    cut(from.y, to.y, low.y, high.y);
    cut(from.z, to.z, low.z, high.z);
    return std::max(0.0, end - begin) * length(to - from);
}

TEST(FlameMarch, LengthsAddUpToTheChord) {
    const auto field = make_flame_field(lattice(21, 19), full(21, 19, 17));
    const FlameColumns flame(field);
    const Vec3 low = field.grid.corner_m, high = low + Vec3{21 * 5.0, 19 * 4.0, 17 * 2.0};
    const RandomKey key{.seed = 11};
    for (std::uint64_t n = 0; n < 3000; ++n) {
        const auto point = [&](std::uint32_t draw) {
            return Vec3{low.x - 60.0 + 225.0 * uniform01(key, n, draw), low.y - 60.0 + 196.0 * uniform01(key, n, draw + 1),
                        low.z - 60.0 + 154.0 * uniform01(key, n, draw + 2)};
        };
        const Vec3 from = point(0);
        Vec3 to = point(3);
        if (n % 5 == 0) to = {from.x, from.y, -50.0};  // vertical
        if (n % 5 == 1) to.z = from.z;                 // horizontal
        double sum = 0.0, last = -1.0;
        march_flame(flame, from, to, [&](float, float fill, double length_m) {
            sum += fill * length_m;
            last = length_m;
            return true;
        });
        EXPECT_NEAR(sum, length_in_box(from, to, low, high), 1e-9 * length(to - from)) << n;
        EXPECT_TRUE(sum == 0.0 || last > 0.0);
    }
}

TEST(FlameMarch, VisitsVoxelsFromTheStartOn) {
    const auto field = make_flame_field(lattice(16, 8), full(16, 8, 9));
    std::vector<float> seen;
    const double x = 100.0 + 5.0 * 3.5, y = 50.0 + 4.0 * 2.5;
    march_flame(FlameColumns(field), {x, y, 500.0}, {x, y, 0.0}, [&](float T_K, float, double length_m) {
        EXPECT_NEAR(length_m, 2.0, 1e-9);
        seen.push_back(T_K);
        return true;
    });
    ASSERT_EQ(seen.size(), 9U);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_FLOAT_EQ(seen[k], 800.0F + 3.0F + 20.0F + 100.0F * static_cast<float>(8 - k));
}

TEST(FlameMarch, StopsWhereTheSegmentEndsAndWhenAsked) {
    const auto field = make_flame_field(lattice(16, 8), full(16, 8, 9));
    const FlameColumns flame(field);
    double sum = 0.0;
    const auto add = [&](float, float, double length_m) {
        sum += length_m;
        return true;
    };
    march_flame(flame, {120.0, 60.0, 500.0}, {120.0, 60.0, 10.0 + 18.0 - 3.0}, add);  // ground inside the flame
    EXPECT_NEAR(sum, 3.0, 1e-9);
    int visits = 0;
    march_flame(flame, {120.0, 60.0, 500.0}, {120.0, 60.0, 0.0}, [&](float, float, double) { return ++visits < 4; });
    EXPECT_EQ(visits, 4);
}

TEST(FlameMarch, GapsAreSkipped) {
    // Two voxels in far corners of a large lattice with nothing between.
    const std::vector<fire::FlameVoxel> voxels{{0, 0, 0, 0.5F, 900.0F}, {99, 99, 40, 0.25F, 1200.0F}};
    const auto field =
        make_flame_field({.corner_m = {}, .nx = 100, .ny = 100, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 1.0}, voxels);
    std::vector<float> fills;
    march_flame(FlameColumns(field), {99.9, 99.9, 40.9}, {-0.1, -0.1, -0.1}, [&](float, float fill, double) {
        fills.push_back(fill);
        return true;
    });
    EXPECT_EQ(fills, (std::vector<float>{0.25F, 0.5F}));
}

TEST(FlameMarch, EmptyFieldIsNothing) {
    const fire::FlameField field;
    int visits = 0;
    march_flame(FlameColumns(field), {0, 0, 10}, {0, 0, 0}, [&](float, float, double) { return ++visits > 0; });
    EXPECT_EQ(visits, 0);
}

}  // namespace
}  // namespace pyroscene::render
