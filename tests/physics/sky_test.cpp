// Rays that end in the sky: what is there, seen alone and through flame.

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

const std::vector<double> kLambda_um{1.2, 3.9, 10.6};

/// A slab of flame 6 m thick along x, 20 m wide and high, over black ground at 300 K.
TestScene slab(double flame_K) {
    TestScene scene({.lambda_um = kLambda_um, .absorption_per_m = 0.2});
    scene.set_flame({.corner_m = {60.0, 60.0, 0.0}, .nx = 6, .ny = 20, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 1.0},
                    box_of_voxels(6, 20, 20, flame_K));
    return scene;
}

/// From 40 m before the slab at 5 m height, `up` per unit of length above the level.
render::SceneRay towards_slab(double up) {
    const Vec3 start{20.0, 70.0, 5.0}, way{std::sqrt(1.0 - up * up), 0.0, up};
    return {start, start + 400.0 * way, true};
}

TEST(Sky, IsTheIrradianceOfTheGroundOverPi) {
    TestScene scene({.lambda_um = kLambda_um});
    scene.atmosphere.diffuse_irradiance_W_m2_um = {120.0F, 2.0F, 0.0F};
    scene.atmosphere.thermal_irradiance_W_m2_um = {0.0F, 0.3F, 12.0F};
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({towards_slab(0.3)}));
    const std::array<double, 3> expected{120.0 / kPi, 2.3 / kPi, 12.0 / kPi};
    for (std::size_t b = 0; b < expected.size(); ++b) {
        EXPECT_NEAR(image.radiance_W_m2_sr_um[b] / expected[b], 1.0, 1e-6);
        double sum = 0.0;
        for (const auto& term : image.terms)
            if (!term.empty()) sum += term[b];
        EXPECT_NEAR(sum / expected[b], 1.0, 1e-6);
    }
    EXPECT_EQ(image.coverage[0], 0.0F);  // no ground, no place on the map
    EXPECT_TRUE(std::isnan(image.hit_x_m[0]));
    EXPECT_EQ(image.background_fraction[0], 0.0F);
    EXPECT_TRUE(std::isnan(image.ground_temperature_K[0]));
}

// The thermal sky brightens towards the horizon, where it is as warm as the air; over the hemisphere it is the irradiance.
TEST(Sky, BrightensTowardsTheHorizonAndKeepsItsIrradiance) {
    constexpr double kAir_K = 290.0;
    for (const double emissivity : {0.15, 0.45, 0.8}) {
        TestScene scene({.lambda_um = kLambda_um});
        for (std::size_t b = 0; b < kLambda_um.size(); ++b)
            scene.atmosphere.thermal_irradiance_W_m2_um[b] =
                static_cast<float>(emissivity * kPi * radiometry::planck_radiance(kLambda_um[b], kAir_K));
        auto lit = scene.scene();
        lit.air_K = kAir_K;
        std::vector<render::SceneRay> rays;
        constexpr int kAngles = 200;
        for (int k = 0; k < kAngles; ++k) rays.push_back(towards_slab((k + 0.5) / kAngles));
        const auto image = render::render_image(lit, nullptr, rays_request(rays));
        for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
            const double black = radiometry::planck_radiance(kLambda_um[b], kAir_K);
            double irradiance = 0.0, last = 2.0 * black;
            for (int k = 0; k < kAngles; ++k) {
                const double L = image.radiance_W_m2_sr_um[b * kAngles + static_cast<std::size_t>(k)];
                EXPECT_LE(L, last * (1.0 + 1e-6));
                last = L;
                irradiance += 2.0 * kPi * L * (k + 0.5) / kAngles / kAngles;
            }
            EXPECT_NEAR(irradiance / (emissivity * kPi * black), 1.0, 0.015) << emissivity;
            EXPECT_GT(image.radiance_W_m2_sr_um[b * kAngles] / black, 0.98);
        }
    }
}

TEST(Sky, IsBlackInSpaceAndShinesThroughFlame) {
    constexpr double kFlame_K = 1100.0, kSky_K = 260.0;
    for (const double up : {0.0, 0.1, 0.25}) {
        const double depth = 0.2 * 6.0 / std::sqrt(1.0 - up * up), tau = std::exp(-depth);
        TestScene scene = slab(kFlame_K);
        const auto dark = trace(scene, towards_slab(up));
        scene.set_sky(kSky_K);
        const auto bright = trace(scene, towards_slab(up));
        for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
            const double flame = (1.0 - tau) * radiometry::planck_radiance(kLambda_um[b], kFlame_K),
                         sky = tau * radiometry::planck_radiance(kLambda_um[b], kSky_K);
            EXPECT_NEAR(dark[b] / flame, 1.0, 2e-5) << kLambda_um[b];
            EXPECT_NEAR(bright[b] / (flame + sky), 1.0, 2e-5) << kLambda_um[b];
        }
    }
}

TEST(Sky, ClosesTheFurnace) {
    constexpr double kT_K = 1000.0;
    TestScene scene = slab(kT_K);
    std::fill(scene.surface.base_temperature_K.begin(), scene.surface.base_temperature_K.end(), static_cast<float>(kT_K));
    scene.set_sky(kT_K);
    for (const double up : {-0.1, 0.0, 0.2, 0.9}) {
        const auto read = trace(scene, towards_slab(up));
        for (std::size_t b = 0; b < kLambda_um.size(); ++b)
            EXPECT_NEAR(read[b] / radiometry::planck_radiance(kLambda_um[b], kT_K), 1.0, 1e-5) << up;
    }
}

TEST(Sky, IsOnlyWhereLinesOfSightAreOpen) {
    TestScene scene({.lambda_um = kLambda_um});
    scene.set_sky(300.0);
    auto ray = towards_slab(0.3);
    ray.open = false;
    EXPECT_TRUE(std::isnan(trace(scene, ray)[0]));
}

// Half of the pixel's rays meet the ground, half the sky: each counts by its weight.
TEST(Sky, SharesAPixelWithTheGround) {
    TestScene scene({.ground_K = 500.0, .lambda_um = kLambda_um});
    scene.set_sky(250.0);
    auto request = rays_request({towards_slab(0.0)});
    request.rays = [](int, int, int, std::span<render::SceneRay> out) {
        out[0] = towards_slab(-0.1);
        out[1] = towards_slab(0.1);
    };
    request.rays_per_pixel = 2;
    request.ray_weight = {0.5, 0.5};
    const auto image = render::render_image(scene.scene(), nullptr, request);
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        const double expected = 0.5 * radiometry::planck_radiance(kLambda_um[b], 500.0) +
                                0.5 * radiometry::planck_radiance(kLambda_um[b], 250.0);
        EXPECT_NEAR(image.radiance_W_m2_sr_um[b] / expected, 1.0, 2e-5);
    }
    EXPECT_EQ(image.coverage[0], 0.5F);
    EXPECT_EQ(image.background_fraction[0], 0.5F);
    EXPECT_NEAR(image.hit_x_m[0], 20.0 + 5.0 / 0.1 * std::sqrt(0.99), 1e-3);  // of the ray that came down
    EXPECT_NEAR(image.ground_temperature_K[0], 500.0, 1e-3);
}

}  // namespace
}  // namespace pyroscene::test
