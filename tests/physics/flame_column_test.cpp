// Emission and absorption along single rays against closed forms and quadrature.

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

using radiometry::planck_radiance;

render::SceneRay straight_down(double x = 83.0, double y = 77.0) { return {{x, y, 2000.0}, {x, y, -10.0}}; }

/// Cold black ground below a slab of 160 x 160 m, `nz` voxels of `dz_m`, so that only the flame is seen.
TestScene slab(double absorption_per_m, int n_across, int nz, double dz_m, double T_K, double fill = 1.0) {
    TestScene scene({.ground_K = 60.0, .absorption_per_m = absorption_per_m});
    const double dx_m = 160.0 / n_across;
    scene.set_flame({.corner_m = {}, .nx = n_across, .ny = n_across, .dx_m = dx_m, .dy_m = dx_m, .dz_m = dz_m},
                    box_of_voxels(n_across, n_across, nz, T_K, fill));
    return scene;
}

TEST(FlameSlab, EmissivityIsBeersLawForAnyVoxelSize) {
    for (const double absorption : {0.03, 0.3, 3.0}) {
        for (const double dz_m : {5.0, 1.0, 0.3, 0.1}) {
            const int nz = static_cast<int>(std::lround(3.0 / dz_m)) > 0 ? static_cast<int>(std::lround(3.0 / dz_m)) : 1;
            const double depth_m = nz * dz_m;
            const TestScene scene = slab(absorption, 32, nz, dz_m, 1100.0);
            const double expected = (1.0 - std::exp(-absorption * depth_m)) * planck_radiance(4.0, 1100.0);
            EXPECT_NEAR(trace(scene, straight_down())[0] / expected, 1.0, 1e-4) << absorption << ' ' << dz_m;
        }
    }
}

TEST(FlameSlab, ObliqueRaysSeeTheSlantPath) {
    const TestScene scene = slab(0.2, 64, 10, 0.5, 1100.0);
    for (const double zenith_deg : {0.0, 20.0, 40.0, 60.0, 80.0}) {
        for (const double azimuth_deg : {0.0, 17.0, 90.0, 222.0}) {
            const double zenith = zenith_deg * kDegree_rad, azimuth = azimuth_deg * kDegree_rad;
            const Vec3 up{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
            const Vec3 target{80.0, 80.0, 0.0};
            const double expected = (1.0 - std::exp(-0.2 * 5.0 / std::cos(zenith))) * planck_radiance(4.0, 1100.0);
            EXPECT_NEAR(trace(scene, {target + 1000.0 * up, target - 5.0 * up})[0] / expected, 1.0, 1e-4)
                << zenith_deg << ' ' << azimuth_deg;
        }
    }
}

TEST(FlameSlab, FilledFractionScalesAbsorption) {
    const TestScene scene = slab(0.3, 8, 4, 5.0, 1100.0, 0.125);
    const double expected = (1.0 - std::exp(-0.3 * 0.125 * 20.0)) * planck_radiance(4.0, 1100.0);
    EXPECT_NEAR(trace(scene, straight_down())[0] / expected, 1.0, 1e-5);
}

TEST(FlameSlab, ThicknessTableOfTheThesis) {
    // Thesis eq 2.8, k = 3 /m: 0.599 at 0.305 m, 0.950 at 1 m, 0.9999 at 3 m; k = 0.3: 0.593 at 3 m; k = 1: 0.95 at 3 m.
    const auto emissivity = [](double k, double depth_m) {
        return trace(slab(k, 8, 1, depth_m, 1100.0), straight_down())[0] / planck_radiance(4.0, 1100.0);
    };
    EXPECT_NEAR(emissivity(3.0, 0.305), 0.599, 5e-4);
    EXPECT_NEAR(emissivity(3.0, 1.0), 0.950, 5e-4);
    EXPECT_NEAR(emissivity(3.0, 3.0), 0.9999, 5e-5);
    EXPECT_NEAR(emissivity(0.3, 3.0), 0.593, 5e-4);
    EXPECT_NEAR(emissivity(1.0, 3.0), 0.950, 5e-4);
}

/// Three voxels of 1 m: 1000 K on top, 900 K, 800 K (thesis eq 4.2-4.11 with beta 0.5 /m at 4 um).
TestScene three_voxels(double ground_K) {
    TestScene scene({.ground_K = ground_K, .absorption_per_m = 0.5});
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < 3; ++k) voxels.push_back({2, 2, k, 1.0F, static_cast<float>(800 + 100 * k)});
    scene.set_flame({.corner_m = {}, .nx = 4, .ny = 4, .dx_m = 40.0, .dy_m = 40.0, .dz_m = 1.0}, voxels);
    return scene;
}

TEST(ThreeVoxels, MatchTheWorkedExample) {
    const auto ray = straight_down(100.0, 100.0);
    const TestScene above_nothing = three_voxels(60.0);
    EXPECT_NEAR(trace(above_nothing, ray)[0], 1999.2, 0.05);
    const auto image = render::render_image(above_nothing.scene(), nullptr, rays_request({ray}));
    EXPECT_NEAR(1.0 - image.flame_fraction[0], 0.2231, 5e-5);
    EXPECT_NEAR(trace(three_voxels(600.0), ray)[0], 2064.0, 0.05);
}

TEST(ThreeVoxels, SameWhenAbsorptionDependsOnWavelength) {
    TestScene scene = three_voxels(600.0);
    scene.set_absorption({0.5F});
    EXPECT_NEAR(trace(scene, straight_down(100.0, 100.0))[0], 2064.0, 0.05);
}

TEST(FlameGradient, HundredVoxelsMatchQuadrature) {
    // 10 m deep, 1400 K at the base falling to 800 K at the top; the voxels hold the temperature of their middle.
    constexpr int kVoxels = 100;
    constexpr double kDepth_m = 10.0, kAbsorption = 0.35;
    const auto T_K = [](double z_m) { return 1400.0 - 60.0 * z_m; };
    TestScene scene({.ground_K = 60.0, .lambda_um = {1.2, 4.0, 11.0}, .absorption_per_m = kAbsorption});
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < kVoxels; ++k) {
        voxels.push_back({2, 2, k, 1.0F, static_cast<float>(T_K((k + 0.5) * kDepth_m / kVoxels))});
    }
    scene.set_flame({.corner_m = {}, .nx = 4, .ny = 4, .dx_m = 40.0, .dy_m = 40.0, .dz_m = kDepth_m / kVoxels}, voxels);
    for (const bool grey : {true, false}) {
        scene.optics.grey = grey;
        const auto radiance = trace(scene, straight_down(100.0, 100.0));
        for (std::size_t b = 0; b < 3; ++b) {
            double integral = 0.0;  // Simpson over the emission equation, fine enough to be exact here
            constexpr int kSteps = 20000;
            for (int s = 0; s <= kSteps; ++s) {
                const double z = kDepth_m * s / kSteps;
                const double f = kAbsorption * std::exp(-kAbsorption * (kDepth_m - z)) *
                                 planck_radiance(scene.optics.lambda_um[b], T_K(z));
                integral += f * (s == 0 || s == kSteps ? 1.0 : s % 2 == 1 ? 4.0 : 2.0);
            }
            integral *= kDepth_m / kSteps / 3.0;
            EXPECT_NEAR(radiance[b] / integral, 1.0, 2e-3) << b;
        }
    }
}

TEST(FlameGradient, WavelengthsAreIndependentOfEachOther) {
    // Grey by declaration and the same absorption written out per wavelength must agree.
    TestScene scene({.ground_K = 500.0, .lambda_um = {0.9, 1.6, 2.2, 3.5, 4.0, 5.0, 8.0, 10.0, 12.0, 14.0}});
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < 30; ++k) voxels.push_back({1, 1, k, 0.3F, static_cast<float>(800 + 13 * k)});
    scene.set_flame({.corner_m = {}, .nx = 2, .ny = 2, .dx_m = 80.0, .dy_m = 80.0, .dz_m = 2.0}, voxels);
    const auto ray = straight_down(100.0, 100.0);
    const auto grey = trace(scene, ray);
    scene.optics.grey = false;
    const auto spectral = trace(scene, ray);
    for (std::size_t b = 0; b < grey.size(); ++b) EXPECT_NEAR(spectral[b] / grey[b], 1.0, 3e-6);
}

TEST(EmptyFlame, OnlyTheGroundIsSeen) {
    const TestScene scene({.ground_K = 700.0, .lambda_um = {3.0, 4.0}, .reflectance = 0.1});
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({straight_down()}));
    EXPECT_NEAR(image.radiance_W_m2_sr_um[0] / (0.9 * planck_radiance(3.0, 700.0)), 1.0, 1e-6);
    EXPECT_NEAR(image.radiance_W_m2_sr_um[1] / (0.9 * planck_radiance(4.0, 700.0)), 1.0, 1e-6);
    EXPECT_EQ(image.flame_fraction[0], 0.0F);
    EXPECT_TRUE(std::isnan(image.flame_temperature_K[0]));
    EXPECT_NEAR(image.ground_temperature_K[0], 700.0, 1e-2);
}

}  // namespace
}  // namespace pyroscene::test
