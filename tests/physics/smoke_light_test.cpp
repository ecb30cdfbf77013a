// Columns of smoke at the nodes of a plume against marches through its voxels.
#include "render/smoke_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "physics/test_scene.h"
#include "render/smoke_shadow.h"

namespace pyroscene::test {
namespace {

using render::SmokeLight;

constexpr double kVoxel_m = 14.0, kHeight_m = 11.0;
const Vec3 kCorner_m{13.0, 17.0, 7.0};

/// A plume of 12 x 9 x 7 voxels with holes and fills of their own, over a flame.
TestScene scene_with_ragged_plume(Vec3 to_sun) {
    TestScene scene({.cols = 12, .rows = 12});
    scene.set_flame({.corner_m = {40.0, 40.0, 0.0}, .nx = 6, .ny = 6, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0},
                    box_of_voxels(6, 6, 6, 1000.0));
    auto voxels = box_of_voxels(12, 9, 7, 320.0);
    const RandomKey key{.stream = stream_id("ragged plume")};
    for (std::size_t v = 0; v < voxels.size(); ++v)
        voxels[v].fill = static_cast<float>(std::max(uniform01(key, v) - 0.3, 0.0));
    std::erase_if(voxels, [](const auto& voxel) { return !(voxel.fill > 0.0F); });
    scene.plume = fire::make_flame_field(
        {.corner_m = kCorner_m, .nx = 12, .ny = 9, .dx_m = kVoxel_m, .dy_m = kVoxel_m, .dz_m = kHeight_m}, voxels);
    scene.optics.smoke_extinction_per_m = {0.01F};
    scene.optics.smoke_albedo = {0.9F};
    scene.optics.smoke_asymmetry = {0.5F};
    scene.to_sun = normalized(to_sun);
    return scene;
}

TEST(SmokeLight, SunColumnsAreThoseOfTheMarch) {
    for (const Vec3 to_sun : {Vec3{0.0, 0.0, 1.0}, {0.3, -0.2, 1.0}, {-1.0, 2.0, 0.3}, {1.0, 0.0, 0.5}}) {
        const TestScene scene = scene_with_ragged_plume(to_sun);
        const render::RenderScene s = scene.scene();
        const render::SceneTables tables(s);
        const render::FlameColumns plume(scene.plume);
        const SmokeLight light(s, tables, plume);
        for (int k = 0; k <= 7; ++k) {
            for (const int i : {0, 3, 11}) {
                const Vec3 at_m = kCorner_m + Vec3{(i + 0.5) * kVoxel_m, 4.5 * kVoxel_m, k * kHeight_m};
                const auto node = light.at(at_m);
                EXPECT_NEAR(node[SmokeLight::ToSun], render::smoke_to_sun(plume, at_m, s.to_sun), 2e-3) << i << ' ' << k;
                const Vec3 below_m = at_m - (k * kHeight_m / s.to_sun.z) * s.to_sun;
                if (k > 0) {
                    EXPECT_NEAR(node[SmokeLight::PastSun], render::smoke_between(plume, at_m, below_m), 2e-3)
                        << i << ' ' << k;
                }
            }
        }
    }
}

// The flame is one body, whose light comes from its middle.
TEST(SmokeLight, FlameColumnsAreMarchedAtEverySecondNode) {
    const TestScene scene = scene_with_ragged_plume({0.0, 0.0, 1.0});
    const render::RenderScene s = scene.scene();
    const render::SceneTables tables(s);
    const render::FlameColumns plume(scene.plume);
    const SmokeLight light(s, tables, plume);
    const auto place_m = [](int i, int j, int k) {
        return kCorner_m + Vec3{(i + 0.5) * kVoxel_m, (j + 0.5) * kVoxel_m, k * kHeight_m};
    };
    const auto marched = [&](int i, int j, int k) {
        return render::smoke_between(plume, place_m(i, j, k), {70.0, 70.0, 15.0});
    };
    const auto column = [&](int i, int j, int k) { return light.at(place_m(i, j, k))[SmokeLight::ToFlame]; };
    for (const int k : {2, 6, 7}) EXPECT_NEAR(column(4, 6, k), marched(4, 6, k), 1e-3) << k;
    EXPECT_NEAR(column(11, 8, 6), marched(11, 8, 6), 1e-3);
    EXPECT_NEAR(column(5, 6, 6), 0.5 * (marched(4, 6, 6) + marched(6, 6, 6)), 1e-3);
    EXPECT_NEAR(column(4, 5, 3), 0.25 * (marched(4, 4, 2) + marched(4, 6, 2) + marched(4, 4, 4) + marched(4, 6, 4)), 1e-3);
}

}  // namespace
}  // namespace pyroscene::test
