// Plume voxels on a lattice of their own, merged in order with the flame along each ray.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"
#include "render/mixed_march.h"

namespace pyroscene::test {
namespace {

using render::MixedPiece;
using render::Term;

const std::vector<double> kLambda_um{1.2, 2.2, 4.0, 11.0};

/// Flame block of 30 m and, shifted and of other voxels, a plume that overlaps it and reaches beyond it on all sides.
TestScene scene_with_plume(double ground_K, double flame_K, double smoke_K, double flame_per_m, double smoke_per_m) {
    TestScene scene({.ground_K = ground_K, .lambda_um = kLambda_um, .absorption_per_m = flame_per_m});
    scene.set_flame({.corner_m = {40.0, 40.0, 0.0}, .nx = 6, .ny = 6, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0},
                    box_of_voxels(6, 6, 6, flame_K));
    scene.plume =
        fire::make_flame_field({.corner_m = {13.0, 17.0, 7.0}, .nx = 9, .ny = 8, .dx_m = 14.0, .dy_m = 15.0, .dz_m = 11.0},
                               box_of_voxels(9, 8, 6, smoke_K));
    scene.optics.smoke_extinction_per_m.assign(kLambda_um.size(), static_cast<float>(smoke_per_m));
    return scene;
}

// Kirchhoff with both constituents, grey and coloured: nothing but the black body may be seen.
TEST(Plume, IsothermalFurnaceStaysBlack) {
    for (const double smoke_per_m : {1e-4, 0.02, 1.0}) {
        for (const double reflectance : {0.0, 0.4}) {
            TestScene scene = scene_with_plume(900.0, 900.0, 900.0, 0.1, smoke_per_m);
            scene.optics.reflectance.assign(2 * kLambda_um.size(), static_cast<float>(reflectance));
            scene.set_sky(900.0);
            scene.set_absorption({0.3F, 0.2F, 0.05F, 0.01F});
            const auto light = render::ground_irradiance(scene.scene(), {});
            for (const double dx : {0.0, 60.0, -90.0}) {
                const auto radiance = trace(scene, {{70.0 - dx, 71.0, 400.0}, {70.0 + 0.1 * dx, 69.0, -1.0}}, &light);
                for (std::size_t b = 0; b < kLambda_um.size(); ++b)
                    EXPECT_NEAR(radiance[b] / radiometry::planck_radiance(kLambda_um[b], 900.0), 1.0, 1e-5);
            }
        }
    }
}

// Straight down through plume (66 m above 7 m) and flame (30 m): 43 m plume, 23 m of both, 7 m of flame, then the ground.
TEST(Plume, OverlapHasTheClosedFormOfThreeLayers) {
    const double kf = 0.03, ks = 0.01, Tf = 1100.0, Ts = 500.0, Tg = 300.0;
    const TestScene scene = scene_with_plume(Tg, Tf, Ts, kf, ks);
    const auto radiance = trace(scene, {{71.0, 72.0, 400.0}, {71.0, 72.0, -1.0}});
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        const auto B = [&](double T_K) { return radiometry::planck_radiance(kLambda_um[b], T_K); };
        const double top = std::exp(-ks * 43.0), both = std::exp(-(kf + ks) * 23.0), low = std::exp(-kf * 7.0);
        const double expected = (1.0 - top) * B(Ts) + top * (1.0 - both) * (kf * B(Tf) + ks * B(Ts)) / (kf + ks) +
                                top * both * (1.0 - low) * B(Tf) + top * both * low * B(Tg);
        EXPECT_NEAR(radiance[b] / expected, 1.0, 1e-5) << kLambda_um[b];
    }
}

TEST(Plume, TermsAndFractionsSumUp) {
    const TestScene scene = scene_with_plume(300.0, 1100.0, 500.0, 0.03, 0.01);
    const auto image =
        render::render_image(scene.scene(), nullptr, rays_request({{{71.0, 72.0, 400.0}, {71.0, 72.0, -1.0}}}));
    ASSERT_EQ(image.smoke_fraction.size(), 1U);
    const double top = std::exp(-0.43), both = std::exp(-0.92), low = std::exp(-0.21);
    EXPECT_NEAR(image.smoke_fraction[0], (1.0 - top) + top * (1.0 - both) * 0.25, 1e-6);
    EXPECT_NEAR(image.flame_fraction[0], top * (1.0 - both) * 0.75 + top * both * (1.0 - low), 1e-6);
    EXPECT_NEAR(image.smoke_fraction[0] + image.flame_fraction[0] + image.front_fraction[0] + image.scar_fraction[0] +
                    image.background_fraction[0],
                1.0, 1e-6);
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        double sum = 0.0;
        for (const auto& term : image.terms) sum += term[b];
        EXPECT_NEAR(sum / image.radiance_W_m2_sr_um[b], 1.0, 1e-6);
        EXPECT_GT(image.terms[static_cast<std::size_t>(Term::SmokeEmission)][b], 0.0F);
    }
}

// A ray that misses the plume must not notice that there is one.
TEST(Plume, LeavesOtherRaysAsTheyAre) {
    const TestScene with = scene_with_plume(300.0, 1100.0, 500.0, 0.03, 0.01);
    TestScene without = scene_with_plume(300.0, 1100.0, 500.0, 0.03, 0.01);
    without.plume = {};
    const render::SceneRay beside{{5.0, 5.0, 400.0}, {5.0, 5.0, -1.0}};
    EXPECT_EQ(trace(with, beside), trace(without, beside));
    EXPECT_TRUE(render::render_image(without.scene(), nullptr, rays_request({beside})).smoke_fraction.empty());
}

// Random rays: path lengths of the merged pieces are those of each lattice alone.
TEST(Plume, MergedPiecesKeepTheLengthsOfBothLattices) {
    const TestScene scene = scene_with_plume(300.0, 1100.0, 500.0, 0.03, 0.01);
    const render::FlameColumns flame(scene.flame), plume(scene.plume);
    const RandomKey key{3, 0, 0};
    std::vector<render::RaySegment> f, s;
    int both = 0;
    for (std::uint64_t n = 0; n < 2000; ++n) {
        const Vec3 from{160.0 * uniform01(key, n, 0), 160.0 * uniform01(key, n, 1), 200.0};
        const Vec3 to{160.0 * uniform01(key, n, 2), 160.0 * uniform01(key, n, 3), 0.0};
        render::list_segments(flame, from, to, f);
        render::list_segments(plume, from, to, s);
        double flame_m = 0.0, smoke_m = 0.0;
        render::merge_segments(f, s, length(to - from), [&](const MixedPiece& piece) {
            flame_m += piece.flame_m;
            smoke_m += piece.smoke_m;
            both += piece.flame_m > 0.0 && piece.smoke_m > 0.0 ? 1 : 0;
        });
        const auto sum_m = [&](const std::vector<render::RaySegment>& segments) {
            return std::accumulate(segments.begin(), segments.end(), 0.0, [&](double sum, const render::RaySegment& g) {
                return sum + g.fill * (g.to - g.from) * length(to - from);
            });
        };
        ASSERT_NEAR(flame_m, sum_m(f), 1e-9);
        ASSERT_NEAR(smoke_m, sum_m(s), 1e-9);
    }
    EXPECT_GT(both, 500);
}

}  // namespace
}  // namespace pyroscene::test
