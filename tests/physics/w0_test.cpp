// The benchmark scene W0 (140 x 140 cells, 13 061 burning voxels): the accuracy that the speed figures rest on.

#include <gtest/gtest.h>

#include <cmath>

#include "bench/baseline.h"
#include "bench/w0_scene.h"

namespace pyroscene::test {
namespace {

using bench::W0Camera;
using bench::W0Scene;

TEST(W0, HoldsTheFlamesOfTheReference) {
    const W0Scene scene({});
    std::size_t burning = 0;
    for (const auto& brick : scene.flame().bricks) {
        for (const float fill : brick.fill) burning += fill > 0.0F ? 1U : 0U;
    }
    EXPECT_EQ(burning, 13061U);  // 1 % of 142 x 142 x 64
    const auto [low, high] = scene.flame().temperature_range_K();
    EXPECT_GE(low, 795.0);
    EXPECT_LE(high, 1100.0);
}

TEST(W0, DirectMeanIsTheReference) {
    // Published mean over the 640 x 512 pixels at 4.0 um: 338.50 (emissivity 0.9, no reflected light).
    const W0Scene scene({.lambda_um = {4.0}, .reflectance = 0.1});
    const auto image = render::render_image(scene.scene(), nullptr, W0Camera{}.request());
    EXPECT_NEAR(bench::mean_radiance(image, scene.lambda_um(), 4.0) / 338.50, 1.0, 1e-4);
}

TEST(W0, PixelsMatchExactMarching) {
    for (const bool grey : {true, false}) {
        const W0Scene scene({.lambda_um = {1.35, 4.0, 9.5}, .reflectance = 0.1, .grey = grey});
        W0Camera camera;
        camera.samples /= 8, camera.lines /= 8, camera.pixel_rad *= 7.93;  // so that no ray runs along a face between cells
        const auto image = render::render_image(scene.scene(), nullptr, camera.request());
        const bench::ExactMarch exact(scene, 0.1);
        const std::size_t pixels = image.coverage.size();
        for (std::size_t i = 0; i < pixels; ++i) {
            const auto ray = camera.ray(static_cast<int>(i) / camera.samples, static_cast<int>(i) % camera.samples);
            for (std::size_t b = 0; b < 3; ++b) {
                const double expected = exact.radiance(ray, scene.lambda_um()[b]);
                ASSERT_NEAR(image.radiance_W_m2_sr_um[b * pixels + i] / expected, 1.0, 1e-4) << i << ' ' << b;
            }
        }
    }
}

TEST(W0, MeanWithReflectedLightIsTheReference) {
    // 361.8 +- 0.5 %: ground of reflectance 0.1 that reflects the light of the flames once.
    const W0Scene scene({.lambda_um = {4.0}, .reflectance = 0.1});
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 3000.0});
    W0Camera camera;
    camera.samples /= 2, camera.lines /= 2, camera.pixel_rad *= 2.0;
    const auto image = render::render_image(scene.scene(), &light, camera.request());
    EXPECT_NEAR(bench::mean_radiance(image, scene.lambda_um(), 4.0) / 361.8, 1.0, 5e-3);
}

TEST(W0, VoxelsCutSmallerAreTheSameField) {
    W0Camera camera;
    camera.samples /= 8, camera.lines /= 8, camera.pixel_rad *= 8.0;
    const W0Scene coarse({.lambda_um = {4.0}}), fine({.lambda_um = {4.0}, .voxel_split = 2});
    const auto a = render::render_image(coarse.scene(), nullptr, camera.request());
    const auto b = render::render_image(fine.scene(), nullptr, camera.request());
    for (std::size_t i = 0; i < a.coverage.size(); ++i) {
        ASSERT_NEAR(b.radiance_W_m2_sr_um[i] / a.radiance_W_m2_sr_um[i], 1.0, 1e-5);
    }
}

}  // namespace
}  // namespace pyroscene::test
