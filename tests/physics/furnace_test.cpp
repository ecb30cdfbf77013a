// Isothermal furnace: flame, ground and sky at one temperature. Whatever the emissivity, absorption, voxel size or view
// angle, every ray in every band must read the black body of that temperature (Kirchhoff).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

const std::vector<double> kLambda_um{0.9, 1.2, 2.2, 3.9, 4.0, 4.3, 8.0, 11.0, 14.0};

/// 4 x 4 cells of 20 m with a flame block 30 m high over the middle, cut into voxels of the given size.
TestScene furnace(double T_K, double reflectance, double absorption_per_m, double voxel_m) {
    TestScene scene({.cols = 8,
                     .rows = 8,
                     .cell_m = 20.0,
                     .ground_K = T_K,
                     .lambda_um = kLambda_um,
                     .reflectance = reflectance,
                     .absorption_per_m = absorption_per_m});
    scene.set_sky(T_K);
    const int n = static_cast<int>(std::lround(60.0 / voxel_m)), nz = static_cast<int>(std::lround(30.0 / voxel_m));
    const fire::VoxelGrid grid{
        .corner_m = {40.0, 40.0, 0.0}, .nx = n, .ny = n, .dx_m = voxel_m, .dy_m = voxel_m, .dz_m = voxel_m};
    scene.set_flame(grid, box_of_voxels(n, n, nz, T_K));
    return scene;
}

std::vector<render::SceneRay> fan_of_rays() {
    std::vector<render::SceneRay> rays;
    for (const double zenith_deg : {0.0, 10.0, 45.0, 70.0}) {
        for (const double azimuth_deg : {0.0, 33.0, 200.0}) {
            for (const Vec3 target :
                 {Vec3{70.0, 70.0, 0.0}, Vec3{41.0, 99.0, 0.0}, Vec3{25.0, 80.0, 0.0}, Vec3{5.0, 5.0, 0.0}}) {
                const double zenith = zenith_deg * kDegree_rad, azimuth = azimuth_deg * kDegree_rad;
                const Vec3 up{std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
                rays.push_back({target + 3000.0 * up, target - 10.0 * up});
            }
        }
    }
    return rays;
}

void expect_black_body(const TestScene& scene, double T_K, const render::GroundIrradiance* light) {
    const auto rays = fan_of_rays();
    const auto image = render::render_image(scene.scene(), light, rays_request(rays));
    EXPECT_GE(std::count(image.coverage.begin(), image.coverage.end(), 1.0F), 40);
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        const double expected = radiometry::planck_radiance(kLambda_um[b], T_K);
        for (std::size_t r = 0; r < rays.size(); ++r) {
            if (image.coverage[r] == 0.0F) continue;  // a grazing ray may leave the raster before it meets rough ground
            ASSERT_NEAR(image.radiance_W_m2_sr_um[b * rays.size() + r] / expected, 1.0, 1e-5)
                << "ray " << r << " at " << kLambda_um[b] << " um";
        }
    }
}

using Case = std::tuple<double, double, double>;  // absorption, voxel size, temperature

class Furnace : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(, Furnace,
                         testing::Combine(testing::Values(0.003, 0.3, 10.0), testing::Values(10.0, 2.5),
                                          testing::Values(300.0, 1000.0)));

TEST_P(Furnace, BlackGround) {
    const auto [absorption, voxel_m, T_K] = GetParam();
    expect_black_body(furnace(T_K, 0.0, absorption, voxel_m), T_K, nullptr);
}

TEST_P(Furnace, BlackGroundAndColouredFlame) {
    const auto [absorption, voxel_m, T_K] = GetParam();
    TestScene scene = furnace(T_K, 0.0, absorption, voxel_m);
    std::vector<float> per_m;
    for (const double lambda : kLambda_um) per_m.push_back(static_cast<float>(absorption / lambda));
    scene.set_absorption(per_m);
    expect_black_body(scene, T_K, nullptr);
}

TEST_P(Furnace, GroundBesideTheFlameReflectsTheSky) {
    const auto [absorption, voxel_m, T_K] = GetParam();
    TestScene scene = furnace(T_K, 0.4, absorption, voxel_m);
    scene.flame = {};  // nothing between sky and ground
    expect_black_body(scene, T_K, nullptr);
}

TEST_P(Furnace, GreyGroundLitByFlameAndSky) {
    const auto [absorption, voxel_m, T_K] = GetParam();
    for (const double reflectance : {0.05, 0.4, 0.9}) {
        TestScene scene = furnace(T_K, reflectance, absorption, voxel_m);
        const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 60.0});
        expect_black_body(scene, T_K, &light);
        std::vector<float> per_m;
        for (const double lambda : kLambda_um) per_m.push_back(static_cast<float>(absorption / lambda));
        scene.set_absorption(per_m);
        const auto coloured_light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 60.0});
        expect_black_body(scene, T_K, &coloured_light);
    }
}

TEST_P(Furnace, RoughGroundWithFrontAndScar) {
    // Slopes hide part of the sky and of the flame from each other; at one temperature nobody notices.
    const auto [absorption, voxel_m, T_K] = GetParam();
    TestScene scene = furnace(T_K, 0.3, absorption, voxel_m);
    scene.set_heights([](double x, double y) { return 6.0 * std::sin(x / 17.0) * std::cos(y / 23.0); });
    scene.surface.front_temperature_K = T_K;
    for (std::size_t i = 0; i < scene.surface.burned.size(); i += 2) {
        scene.surface.burned[i] = 1;
        scene.surface.front_fraction[i] = 0.3F;
    }
    for (const int bounces : {1, 2, 3, 6}) {
        const auto light = render::ground_irradiance(scene.scene(), {.bounces = bounces});
        expect_black_body(scene, T_K, &light);
    }
}

}  // namespace
}  // namespace pyroscene::test
