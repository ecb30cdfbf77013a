// Smoke that scatters light any number of times, against exact solutions for plane layers: van de Hulst's tables, Chandrasekhar's
// H functions, Monte Carlo; conservation of energy and the limits of thin and thick.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "base/constants.h"
#include "physics/smoke_layer.h"

namespace pyroscene::test {
namespace {

using render::Term;

const std::vector<double> kLambda_um{0.55};
constexpr double kIrradiance = 1000.0;

TestScene sunlit_layer(const Smoke& smoke, double sun_cosine, int slices = 20, double reflectance = 0.0) {
    TestScene scene = smoke_layer({smoke, slices, 300.0, 300.0, reflectance}, kLambda_um);
    scene.to_sun = direction(std::acos(sun_cosine), 0.7);
    scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(1, static_cast<float>(kIrradiance));
    return scene;
}

double scattered(const TestScene& scene, const render::SceneRay& ray) {
    return term(render::render_image(scene.scene(), nullptr, rays_request({ray})), Term::SmokeScattering, 0) / kIrradiance;
}

/// From under the layer into the sky above it.
double scattered_down(const TestScene& scene, double view_cosine) {
    const Vec3 up = direction(std::acos(view_cosine), 2.0), from{80.0, 80.0, 50.0};
    return scattered(scene, {from, from + (400.0 / view_cosine) * up, true});
}

/// Smoke of an optical depth in its 200 m.
Smoke of_depth(double depth, double albedo, double asymmetry) { return {depth / 200.0, albedo, asymmetry}; }

/// Flux through the top per flux of the sun through it, by Gauss' rule over 8 cosines and 8 azimuths.
double plane_albedo(const TestScene& scene) {
    constexpr std::array<double, 8> kCosine{0.01985507, 0.10166676, 0.2372338,  0.40828268,
                                            0.59171732, 0.7627662,  0.89833324, 0.98014493},
        kWeight{0.05061427, 0.11119052, 0.15685332, 0.18134189, 0.18134189, 0.15685332, 0.11119052, 0.05061427};
    double flux = 0.0;
    for (std::size_t i = 0; i < kCosine.size(); ++i)
        for (int a = 0; a < 8; ++a)
            flux +=
                kWeight[i] * kCosine[i] * 2.0 * kPi / 8.0 * scattered(scene, ray_from(std::acos(kCosine[i]), a * kPi / 4.0));
    return flux / scene.to_sun.z;
}

/// Chandrasekhar's H for isotropic scattering, by iterating his integral equation: 1/H = sqrt(1 - w) + w/2 int mu' H / (mu + mu').
double h_function(double albedo, double mu) {
    constexpr int kPoints = 200;
    std::vector<double> h(kPoints, 1.0), at(kPoints);
    for (int i = 0; i < kPoints; ++i) at[static_cast<std::size_t>(i)] = (i + 0.5) / kPoints;
    const auto next = [&](double x) {
        double sum = 0.0;
        for (std::size_t j = 0; j < at.size(); ++j) sum += at[j] * h[j] / (x + at[j]) / kPoints;
        return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
    };
    for (int n = 0; n < 2000; ++n) {
        double change = 0.0;
        std::vector<double> better(h.size());
        for (std::size_t i = 0; i < at.size(); ++i) better[i] = 0.5 * (h[i] + next(at[i]));
        for (std::size_t i = 0; i < at.size(); ++i) change = std::max(change, std::abs(better[i] - h[i]));
        h = better;
        if (change < 1e-6) break;
    }
    return next(mu);
}

// Van de Hulst (1980, Multiple Light Scattering, table 37; the third problem of DISORT's test programme): Henyey and Greenstein
// with g = 0.75, no absorption, sun overhead, irradiance pi. Radiance up at the top and down at the bottom at cosines 0.1, 0.5
// and 1 (without the beam itself), diffuse flux up and down.
TEST(SmokeDiffusion, FollowsVanDeHulstsTables) {
    struct Row {
        double depth;
        std::array<double, 3> up, down;
        double flux_up, flux_down;
    };
    for (const Row& row : {Row{1.0, {0.151159, 0.101103, 0.0395460}, {0.213750, 0.266648, 3.05855}, 0.247374, 1.73849},
                           Row{8.0, {0.379740, 0.519598, 0.493302}, {0.236362, 0.422350, 0.669581}, 1.59096, 1.54958}}) {
        const TestScene scene = sunlit_layer(of_depth(row.depth, 1.0, 0.75), 1.0);
        const std::array<double, 3> cosine{0.1, 0.5, 1.0};
        for (std::size_t i = 0; i < cosine.size(); ++i) {
            const double up = kPi * scattered(scene, ray_from(std::acos(cosine[i]), 2.0)),
                         down = kPi * scattered_down(scene, cosine[i]);
            std::printf("depth %g, cosine %.1f: up %.3f of van de Hulst's, down %.3f\n", row.depth, cosine[i],
                        up / row.up[i], down / row.down[i]);
            constexpr std::array<double, 3> kUpWithin{0.35, 0.2, 0.05}, kDownWithin{0.15, 0.15, 0.4};  // 1: into the beam
            EXPECT_NEAR(up / row.up[i], 1.0, kUpWithin[i]);
            EXPECT_NEAR(down / row.down[i], 1.0, kDownWithin[i]);
        }
        const double up = kPi * plane_albedo(scene) / row.flux_up;
        // What comes down, seen as light on grey ground.
        TestScene grey = sunlit_layer(of_depth(row.depth, 1.0, 0.75), 1.0, 20, 1e-3);
        const auto image = render::render_image(grey.scene(), nullptr, rays_request({ray_from(0.0, 0.0)}));
        const double irradiance = term(image, Term::ReflectedSky, 0) * kPi / 1e-3 / std::exp(-row.depth);
        const double down = kPi * irradiance / kIrradiance / row.flux_down;
        std::printf("depth %g: flux up %.3f of van de Hulst's, down %.3f\n", row.depth, up, down);
        EXPECT_NEAR(up, 1.0, 0.15);
        EXPECT_NEAR(down, 1.0, 0.01);
    }
}

// Reflection of a half-space that scatters isotropically: L = w E mu0 H(mu) H(mu0) / (4 pi (mu + mu0)), Chandrasekhar 1960.
TEST(SmokeDiffusion, FollowsTheHFunctionsOfThickSmoke) {
    for (const double albedo : {0.5, 0.9, 0.99, 1.0})
        for (const double sun : {1.0, 0.6, 0.3})
            for (const double view : {1.0, 0.5}) {
                const TestScene scene = sunlit_layer(of_depth(albedo < 1.0 ? 60.0 : 2000.0, albedo, 0.0), sun, 200);
                const double exact =
                    albedo / (4.0 * kPi) * sun / (sun + view) * h_function(albedo, sun) * h_function(albedo, view);
                EXPECT_NEAR(scattered(scene, ray_from(std::acos(view), 2.0)) / exact, 1.0, 0.09)
                    << albedo << " " << sun << " " << view;
            }
}

// Seen from straight above, all orders of scattering; single scattering alone gives 12 % at depth 3.
TEST(SmokeDiffusion, AgreesWithMonteCarlo) {
    for (const double albedo : {0.9, 0.99})
        for (const double sun_deg : {20.0, 70.0})
            for (const double depth : {0.1, 1.0, 5.0}) {
                const double mu0 = std::cos(sun_deg * kDegree_rad);
                const TestScene scene = sunlit_layer(of_depth(depth, albedo, 0.6), mu0);
                const double ratio =
                    scattered(scene, ray_from(0.0, 0.0)) / orders_of_scattering(depth, albedo, 0.6, mu0).all;
                std::printf("albedo %.2f, sun %.0f deg, depth %4.1f: %.3f of all orders\n", albedo, sun_deg, depth, ratio);
                EXPECT_NEAR(ratio, 1.0, 0.12);
            }
}

// The first order in the depth is single scattering; the second order is the diffuse light's.
TEST(SmokeDiffusion, SingleScatteringWhenThin) {
    for (const double depth : {1e-4, 1e-3, 1e-2}) {
        TestScene scene = sunlit_layer(of_depth(depth, 0.95, 0.6), 0.7);
        const double all = scattered(scene, ray_from(0.3, 1.0));
        scene.optics.smoke_multiple_scattering = false;
        const double more = all / scattered(scene, ray_from(0.3, 1.0)) - 1.0;
        EXPECT_GT(more, depth);
        EXPECT_LT(more, 4.0 * depth);
    }
}

TEST(SmokeDiffusion, VoxelsDoNotMatter) {
    for (const double depth : {0.5, 5.0, 50.0}) {
        const auto seen = [&](int slices) {
            return scattered(sunlit_layer(of_depth(depth, 0.95, 0.6), 0.7, slices), ray_from(0.3, 1.0));
        };
        const double fine = seen(200);
        for (const int slices : {1, 3, 20}) EXPECT_NEAR(seen(slices) / fine, 1.0, 0.01) << depth << " " << slices;
    }
}

// Nothing absorbs: what goes up and what comes down is what the sun sent. Up from the radiances, down from light on the ground.
TEST(SmokeDiffusion, KeepsTheSunsEnergy) {
    for (const double g : {0.0, 0.6, 0.8})
        for (const double sun : {1.0, 0.5, 0.2})
            for (const double depth : {0.3, 3.0, 30.0}) {
                const double up = plane_albedo(sunlit_layer(of_depth(depth, 1.0, g), sun));
                const TestScene grey = sunlit_layer(of_depth(depth, 1.0, g), sun, 20, 1e-3);
                const auto image = render::render_image(grey.scene(), nullptr, rays_request({ray_from(0.0, 0.0)}));
                const double reflected = term(image, Term::ReflectedSky, 0) + term(image, Term::ReflectedSun, 0);
                const double down = reflected * kPi / 1e-3 / std::exp(-depth) / kIrradiance / sun;
                EXPECT_NEAR(up + down, 1.0, 0.09) << "g " << g << " sun " << sun << " depth " << depth;
                EXPECT_LT(down, 1.0 + 1e-5);
                EXPECT_LT(up, 1.0);
            }
}

// A cube of smoke is no layer: its sides are lit and leak. Sun from the east at 50 degrees, seen from straight above.
TEST(SmokeDiffusion, StandsForACube) {
    const double mu0 = std::cos(50.0 * kDegree_rad), albedo = 0.95, g = 0.6;
    for (const double depth : {1.0, 5.0, 20.0}) {
        TestScene scene = sunlit_layer(of_depth(depth, albedo, g), mu0);
        scene.to_sun = direction(50.0 * kDegree_rad, kPi / 2.0);
        constexpr int kVoxels = 20;
        scene.plume = fire::make_flame_field(
            {.corner_m = {-20.0, -20.0, 100.0}, .nx = kVoxels, .ny = kVoxels, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 10.0},
            box_of_voxels(kVoxels, kVoxels, kVoxels, 300.0));
        const auto mean_over_top = [&] {
            std::vector<render::SceneRay> rays;
            for (double x = -15.0; x < 180.0; x += 10.0)
                for (double y = -15.0; y < 180.0; y += 10.0) rays.push_back({{x, y, 500.0}, {x, y, 0.0}, true});
            const auto image = render::render_image(scene.scene(), nullptr, rays_request(rays));
            const auto& plane = image.terms[static_cast<std::size_t>(Term::SmokeScattering)];
            return std::accumulate(plane.begin(), plane.end(), 0.0) / static_cast<double>(rays.size()) / kIrradiance;
        };
        const double all = mean_over_top();
        scene.optics.smoke_multiple_scattering = false;
        const double once = mean_over_top();
        const Orders exact = orders_in_cube(depth, albedo, g, mu0);
        std::printf("cube of depth %g: %.2f of all orders, scattered once %.2f\n", depth, all / exact.all, once / exact.all);
        EXPECT_NEAR(all / exact.all, 1.0, 0.3);
        EXPECT_NEAR(once / exact.first, 1.0, 0.05);
    }
}

}  // namespace
}  // namespace pyroscene::test
