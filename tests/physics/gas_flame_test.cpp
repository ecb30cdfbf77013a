// Flame with soot, hot gas and potassium: what the renderer makes of it against closed forms and the reference path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"
#include "source_folder.h"

namespace pyroscene::test {
namespace {

const std::vector<double> kLambda_um{0.7665, 0.9, 1.38, 2.2, 2.7, 3.9, 4.19, 4.3, 4.5, 6.3, 8.5, 10.6, 14.0};

std::shared_ptr<const radiometry::FlameOptics> tables() {
    static const auto loaded =
        std::make_shared<const radiometry::FlameOptics>(radiometry::load_flame_optics(source_folder() / "data/optical"));
    return loaded;
}

/// 8 x 8 cells of 20 m; flame over the middle (40 to 100 m), its height and fill given.
TestScene scene_with_gas(double flame_K, double ground_K, double reflectance, int layers, double fill,
                         const FlameGas& gas = {}) {
    TestScene scene({.ground_K = ground_K, .lambda_um = kLambda_um, .reflectance = reflectance});
    std::vector<float> soot;
    for (const double lambda_um : kLambda_um)
        soot.push_back(
            static_cast<float>(radiometry::soot_absorption_per_m(tables()->soot, lambda_um, gas.soot_volume_fraction)));
    scene.set_absorption(soot);
    scene.optics.flame_tables = tables();
    scene.optics.flame_gas = gas;
    const fire::VoxelGrid grid{.corner_m = {40.0, 40.0, 0.0}, .nx = 12, .ny = 12, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 1.0};
    scene.set_flame(grid, box_of_voxels(12, 12, layers, flame_K, fill));
    return scene;
}

TEST(GasFlame, FurnaceIsABlackBody) {
    for (const double T_K : {400.0, 1000.0, 1500.0}) {
        for (const double reflectance : {0.0, 0.4}) {
            for (const double fill : {0.02, 1.0}) {
                TestScene scene = scene_with_gas(T_K, T_K, reflectance, 7, fill);
                scene.set_sky(T_K);
                const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 60.0});
                for (const Vec3 from : {Vec3{70.0, 70.0, 1000.0}, Vec3{600.0, 80.0, 500.0}}) {
                    const auto radiance = trace(scene, {from, {68.0, 71.0, -1.0}}, &light);
                    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
                        EXPECT_NEAR(radiance[l] / radiometry::planck_radiance(kLambda_um[l], T_K), 1.0, 5e-6)
                            << kLambda_um[l] << " um, " << T_K << " K, fill " << fill;
                    }
                }
            }
        }
    }
}

// Flame and black front of one temperature radiate together what a black body does, whatever the flame hides of the front.
TEST(GasFlame, ExitanceOfAnIsothermalFireIsThatOfABlackBody) {
    const double T_K = 1100.0, black = kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 4.0);
    for (const bool gas : {true, false})
        for (const bool smoky : {false, true})
            for (const double fill : {0.02, 0.2, 1.0}) {
                TestScene scene = scene_with_gas(T_K, 300.0, 0.0, 7, fill);
                if (!gas) scene.optics.flame_tables = nullptr;
                scene.surface.front_temperature_K = T_K;
                std::fill(scene.surface.front_fraction.begin(), scene.surface.front_fraction.end(), 1.0F);
                if (smoky) {
                    scene.optics.smoke_extinction_per_m.assign(kLambda_um.size(), 0.02F);
                    scene.plume = fire::make_flame_field(
                        {.corner_m = {0.0, 0.0, 3.0}, .nx = 16, .ny = 16, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 10.0},
                        box_of_voxels(16, 16, 2, 320.0));
                }
                const auto image =
                    render::render_image(scene.scene(), nullptr, rays_request({{{70.0, 70.0, 1000.0}, {68.0, 71.0, -1.0}}}));
                EXPECT_GT(image.flame_fraction[0], 0.01F);
                EXPECT_NEAR(image.radiant_exitance_W_m2[0] / black, 1.0, 1e-6) << gas << smoky << fill;
            }
}

// Layers that cool upwards, before space: true exitance against pi times the reference path's radiance, summed over wavelengths.
TEST(GasFlame, ExitanceOfCoolingFlameIsThatOfItsSpectrum) {
    constexpr int kLayers = 10, kWavelengths = 300;
    constexpr double kShortest_um = 0.5, kLongest_um = 40.0;
    for (const auto& [tip_K, tolerance] : {std::pair{500.0, 0.02}, {310.0, 0.065}})
        for (const double length_m : {0.2, 1.0, 4.0}) {
            TestScene scene = scene_with_gas(1100.0, 10.0, 0.0, 1, 1.0);
            scene.optics.gas = scene.optics.flame_gas;
            auto voxels = box_of_voxels(12, 12, kLayers, 1100.0, length_m / kLayers);
            for (auto& v : voxels) v.temperature_K += static_cast<float>((tip_K - 1100.0) * v.k / (kLayers - 1));
            scene.set_flame(scene.flame.grid, voxels);
            const auto image =
                render::render_image(scene.scene(), nullptr, rays_request({{{70.0, 71.0, 100.0}, {70.0, 71.0, -1.0}}}));
            double expected = 0.0;
            for (int i = 0; i < kWavelengths; ++i) {
                const double step = std::log(kLongest_um / kShortest_um) / kWavelengths;
                const double lambda_um = kShortest_um * std::exp((i + 0.5) * step);
                radiometry::FlamePath path(*tables(), lambda_um);
                for (int k = kLayers - 1; k >= 0; --k)
                    path.add(length_m / kLayers, 1100.0 + (tip_K - 1100.0) * k / (kLayers - 1), scene.optics.flame_gas);
                expected += kPi * path.emitted_radiance() * lambda_um * step;
            }
            EXPECT_NEAR(image.radiant_exitance_W_m2[0] / expected, 1.0, tolerance) << tip_K << " K, " << length_m << " m";
        }
}

TEST(GasFlame, SlabEmitsAndTransmitsLikeTheReferencePath) {
    for (const double fill : {0.1, 1.0}) {
        const TestScene scene = scene_with_gas(1100.0, 900.0, 0.0, 3, fill);
        for (const double slant : {0.0, 1.0}) {  // straight down, and 45 degrees
            const auto radiance = trace(scene, {{70.0 + 102.0 * slant, 71.0, 101.0}, {70.0, 71.0, -1.0}});
            for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
                radiometry::FlamePath path(*tables(), kLambda_um[l]);
                path.add(3.0 * fill * std::sqrt(1.0 + slant * slant), 1100.0, scene.optics.flame_gas);
                const double expected =
                    path.emitted_radiance() + std::exp(-path.depth()) * radiometry::planck_radiance(kLambda_um[l], 900.0);
                EXPECT_NEAR(radiance[l] / expected, 1.0, 2e-4) << kLambda_um[l] << " um, fill " << fill;
            }
        }
    }
}

TEST(GasFlame, LayersOfTwoTemperaturesFollowTheReferencePath) {
    TestScene scene = scene_with_gas(1400.0, 300.0, 0.0, 2, 1.0);
    auto voxels = box_of_voxels(12, 12, 2, 1400.0);
    for (auto& v : voxels)
        if (v.k == 1) v.temperature_K = 850.0F;
    scene.set_flame(scene.flame.grid, voxels);
    const auto radiance = trace(scene, {{70.0, 71.0, 100.0}, {70.0, 71.0, -1.0}});
    for (std::size_t l = 1; l < kLambda_um.size(); ++l) {
        radiometry::FlamePath path(*tables(), kLambda_um[l]);
        path.add(1.0, 850.0, scene.optics.flame_gas);
        path.add(1.0, 1400.0, scene.optics.flame_gas);
        const double expected =
            path.emitted_radiance() + std::exp(-path.depth()) * radiometry::planck_radiance(kLambda_um[l], 300.0);
        EXPECT_NEAR(radiance[l] / expected, 1.0, 4e-3) << kLambda_um[l];
    }
}

TEST(GasFlame, TransmitsTheSameBothWays) {
    // A cold slit of light below or above: only transmittance counts, and it must not depend on the order of the layers.
    const auto through = [](double lower_K, double upper_K, double ground_K) {
        TestScene scene = scene_with_gas(1000.0, ground_K, 0.0, 2, 1.0);
        auto voxels = box_of_voxels(12, 12, 2, lower_K);
        for (auto& v : voxels)
            if (v.k == 1) v.temperature_K = static_cast<float>(upper_K);
        scene.set_flame(scene.flame.grid, voxels);
        return trace(scene, {{70.0, 71.0, 100.0}, {70.0, 71.0, -1.0}});
    };
    const auto up_hot = through(600.0, 1200.0, 3000.0), up_dark = through(600.0, 1200.0, 300.0);
    const auto down_hot = through(1200.0, 600.0, 3000.0), down_dark = through(1200.0, 600.0, 300.0);
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
        const double B =
            radiometry::planck_radiance(kLambda_um[l], 3000.0) - radiometry::planck_radiance(kLambda_um[l], 300.0);
        EXPECT_NEAR((up_hot[l] - up_dark[l]) / B, (down_hot[l] - down_dark[l]) / B, 2e-5) << kLambda_um[l];
    }
}

/// Length in the box [100, 105] x [40, 100] x [0, 4] m of the ray from (50, 70, 0) with components (dx, dy, dz), dx > 0.
double length_in_wall_m(double dx, double dy, double dz) {
    double from = 50.0 / dx, to = 55.0 / dx;
    if (dy != 0.0) to = std::min(to, 30.0 / std::abs(dy));
    if (dz > 0.0) to = std::min(to, 4.0 / dz);
    return std::max(to - from, 0.0);
}

/// Irradiance of flat ground by the wall per B, brute force over the directions that meet it.
double wall_irradiance_sr(const std::function<double(double)>& emissivity) {
    constexpr int kAround = 150, kUp = 150;
    const double widest = std::atan2(30.0, 50.0), highest = std::atan2(4.0, 50.0);
    double sum = 0.0;
    for (int a = 0; a < kAround; ++a) {
        const double azimuth = widest * (2.0 * (a + 0.5) / kAround - 1.0);
        for (int e = 0; e < kUp; ++e) {
            const double elevation = highest * (e + 0.5) / kUp, c = std::cos(elevation);
            const double length_m = length_in_wall_m(c * std::cos(azimuth), c * std::sin(azimuth), std::sin(elevation));
            if (length_m > 0.0) sum += emissivity(length_m) * std::sin(elevation) * c;
        }
    }
    return sum * (2.0 * widest / kAround) * (highest / kUp);
}

TEST(GasFlame, WallOfGasLightsTheGround) {
    for (const double fill : {0.02, 0.3}) {
        TestScene scene = scene_with_gas(1100.0, 300.0, 0.5, 2, fill);
        const fire::VoxelGrid grid{
            .corner_m = {100.0, 40.0, 0.0}, .nx = 1, .ny = 12, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 0.25};
        scene.set_flame(grid, box_of_voxels(1, 12, 16, 1100.0, fill));
        const auto light = render::ground_irradiance(scene.scene(), {.directions = 256, .reach_m = 500.0});
        const auto row = light.row_of_cell[4 * 8 + 2];
        ASSERT_GE(row, 0);
        for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
            const double sr = wall_irradiance_sr([&](double length_m) {
                radiometry::FlamePath path(*tables(), kLambda_um[l]);
                path.add(length_m * fill, 1100.0, scene.optics.flame_gas);
                return -std::expm1(-path.depth());
            });
            const double expected = sr * radiometry::planck_radiance(kLambda_um[l], 1100.0);
            const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(light.stride) + l;
            EXPECT_NEAR(light.irradiance_W_m2_um[at] / expected, 1.0, 0.025) << kLambda_um[l] << " um, fill " << fill;
        }
    }
}

}  // namespace
}  // namespace pyroscene::test
