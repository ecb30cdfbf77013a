#include "fire/flame_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

const VoxelGrid kGrid{.corner_m = {10.0, 20.0, 0.0}, .nx = 24, .ny = 24, .dx_m = 1.0, .dy_m = 2.0, .dz_m = 0.5};

FlameField box(int nx, int ny, int nz, float fill) {
    std::vector<FlameVoxel> voxels;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) voxels.push_back({i, j, k, fill, 1000.0F});
    return make_flame_field(kGrid, voxels);
}

TEST(FlameBodies, ABoxHasItsVolumeSurfaceAndMeanChord) {
    const auto bodies = flame_bodies(box(8, 4, 6, 0.5F));  // 8 x 8 x 3 m
    ASSERT_EQ(bodies.size(), 1U);
    EXPECT_NEAR(bodies[0].filled_m3, 0.5 * 192.0, 1e-9);
    EXPECT_NEAR(bodies[0].area_m2, 2.0 * (0.5 * 64.0 + 24.0 + 24.0), 1e-9);
    EXPECT_NEAR(bodies[0].chord_m(), 4.0 * 96.0 / 160.0, 1e-12);
    EXPECT_NEAR(bodies[0].middle_m.x, 14.0, 1e-9);
    EXPECT_NEAR(bodies[0].middle_m.y, 24.0, 1e-9);
    EXPECT_NEAR(bodies[0].middle_m.z, 1.5, 1e-9);
    EXPECT_NEAR(bodies[0].T_K, 1000.0, 1e-6);
}

TEST(FlameBodies, FacesBetweenBricksAreNotOutside) {
    double volume = 0.0, area = 0.0;
    const auto bodies = flame_bodies(box(16, 8, 8, 1.0F));  // 16 x 16 x 4 m in two bricks
    EXPECT_EQ(bodies.size(), 2U);
    for (const auto& body : bodies) {
        volume += body.filled_m3;
        area += body.area_m2;
    }
    EXPECT_NEAR(volume, 1024.0, 1e-9);
    EXPECT_NEAR(area, 2.0 * (256.0 + 64.0 + 64.0), 1e-9);
}

TEST(FlameBodies, TheInsideSharesTheSurfaceOfItsNeighbours) {
    const auto bodies = flame_bodies(box(24, 24, 24, 1.0F));  // 24 x 48 x 12 m in 27 bricks
    ASSERT_EQ(bodies.size(), 27U);
    EXPECT_NEAR(bodies[13].area_m2, 2.0 * (24.0 * 48.0 + 24.0 * 12.0 + 48.0 * 12.0) / 27.0, 1e-9);
}

TEST(FlameBodies, NoFlameNoBody) { EXPECT_TRUE(flame_bodies({}).empty()); }

}  // namespace
}  // namespace pyroscene::fire
