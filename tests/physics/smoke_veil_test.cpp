// Light of flames on the ground, through smoke.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

const std::vector<double> kLambda_um{0.87, 2.2, 4.0};

/// Small flames at (x, y) over level ground of 30 x 30 cells of 10 m, in smoke up to 40 m that fills it all.
TestScene scene_in_smoke(const std::vector<std::array<int, 2>>& flames, float smoke_per_m, double smoke_K = 300.0) {
    TestScene scene({.cols = 30, .rows = 30, .cell_m = 10.0, .lambda_um = kLambda_um, .reflectance = 0.2});
    std::vector<fire::FlameVoxel> voxels;
    for (const auto& [x, y] : flames)
        for (int k = 0; k < 4; ++k) voxels.push_back({x, y, k, 1.0F, 1300.0F});
    scene.set_flame({.corner_m = {0.0, 0.0, 0.0}, .nx = 100, .ny = 100, .dx_m = 3.0, .dy_m = 3.0, .dz_m = 3.0}, voxels);
    if (smoke_per_m > 0.0F) {
        scene.optics.smoke_extinction_per_m = {smoke_per_m, 0.5F * smoke_per_m, 0.1F * smoke_per_m};
        scene.plume = fire::make_flame_field(
            {.corner_m = {-50.0, -50.0, 0.0}, .nx = 20, .ny = 20, .dx_m = 20.0, .dy_m = 20.0, .dz_m = 20.0},
            box_of_voxels(20, 20, 2, smoke_K));
    }
    return scene;
}

std::vector<float> light(const TestScene& scene) {
    const auto light = render::ground_irradiance(scene.scene(), {});
    std::vector<float> values;
    for (std::size_t cell = 0; cell < light.grid.size(); ++cell)
        for (std::size_t l = 0; l < kLambda_um.size(); ++l)
            values.push_back(light.irradiance_W_m2_um[static_cast<std::size_t>(light.row_of_cell[cell]) *
                                                          static_cast<std::size_t>(light.stride) +
                                                      l]);
    return values;
}

TEST(SmokeVeil, DimsTheLightOfAFlameByBeersLaw) {
    const auto with = light(scene_in_smoke({{50, 50}}, 0.02F)), without = light(scene_in_smoke({{50, 50}}, 0.0F));
    for (const int col : {2, 8, 12, 19, 25, 29}) {
        const Vec3 way = Vec3{151.5, 151.5, 6.0} - Vec3{10.0 * col + 5.0, 145.0, 0.0};
        const auto cell = static_cast<std::size_t>(15 * 30 + col);
        for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
            const double k_per_m = std::array{0.02, 0.01, 0.002}[l];
            EXPECT_NEAR(with[3 * cell + l] / without[3 * cell + l], std::exp(-k_per_m * length(way)), 0.012)
                << col << ", " << kLambda_um[l] << " um";
        }
    }
}

// Half-way between two flames smoke lies towards both of them.
TEST(SmokeVeil, FlamesOnBothSidesAreEachDimmed) {
    const auto with = light(scene_in_smoke({{10, 50}, {90, 50}}, 0.02F)),
               without = light(scene_in_smoke({{10, 50}, {90, 50}}, 0.0F));
    const auto middle = static_cast<std::size_t>(15 * 30 + 15);
    EXPECT_NEAR(with[3 * middle] / without[3 * middle], std::exp(-0.02 * 120.0), 0.02);
    // Beside one of them the other does not matter.
    const auto beside = static_cast<std::size_t>(15 * 30 + 5);
    EXPECT_NEAR(with[3 * beside] / without[3 * beside], std::exp(-0.02 * 24.5), 0.04);
}

TEST(SmokeVeil, ScatteredLightGoesOn) {
    const auto ratio = [](bool scatters) {
        const auto with = [&](float k) {
            TestScene scene = scene_in_smoke({{50, 50}}, k);
            if (scatters && k > 0.0F) {
                scene.optics.smoke_albedo.assign(kLambda_um.size(), 0.999F);
                scene.optics.smoke_asymmetry.assign(kLambda_um.size(), 0.6F);
            }
            return light(scene);
        };
        const std::size_t cell = 15 * 30 + 25;
        return static_cast<double>(with(0.02F)[3 * cell] / with(0.0F)[3 * cell]);
    };
    // A layer that hardly absorbs passes 1 / (1 + 3/4 (1 - g) t).
    EXPECT_NEAR(ratio(true), 1.0 / (1.0 + 0.75 * 0.4 * 0.02 * 103.7), 0.05);
    EXPECT_GT(ratio(true), 3.0 * ratio(false));
}

// Smoke in the way glows: in the end it fills the solid angle of the flame.
TEST(SmokeVeil, ThickSmokeGlowsInPlaceOfTheFlame) {
    const auto thick = scene_in_smoke({{50, 50}}, 10.0F, 600.0);
    const auto sky = render::ground_irradiance(thick.scene(), {});
    for (const int col : {4, 13, 18}) {
        const auto row = static_cast<std::size_t>(sky.row_of_cell[static_cast<std::size_t>(15 * 30 + col)]);
        const std::size_t at = row * static_cast<std::size_t>(sky.stride) + 2;
        const double all = static_cast<double>(sky.irradiance_W_m2_um[at] + sky.thermal_irradiance_W_m2_um[at]);
        EXPECT_NEAR(all / (kPi * radiometry::planck_radiance(4.0, 600.0)), 1.0, 1e-3) << col;
    }
}

}  // namespace
}  // namespace pyroscene::test
