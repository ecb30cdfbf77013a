// The terms of the at-sensor radiance (eq 4.44) against the same equation written out by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

using radiometry::planck_radiance;
using render::Term;

/// Air with arbitrary but plausible numbers at one view node and two wavelengths, sun at 45 degrees in the south.
TestScene scene_with_air() {
    TestScene scene({.ground_K = 310.0, .lambda_um = {2.2, 11.0}, .reflectance = 0.25});
    auto& air = scene.atmosphere;
    air.direct_normal_irradiance_W_m2_um = {60.0F, 0.1F};
    air.diffuse_irradiance_W_m2_um = {5.0F, 0.02F};
    air.thermal_irradiance_W_m2_um = {0.01F, 12.0F};
    air.transmittance = {0.9F, 0.7F};
    air.path_thermal_W_m2_sr_um = {0.0005F, 1.5F};
    air.path_solar_a0 = {0.3F, 0.001F};
    air.solar_correlation = {0.95F, 0.9F};
    air.adjacency_W_m2_sr_um = {0.2F, 0.0F};
    scene.to_sun = {0.0, -std::sqrt(0.5), std::sqrt(0.5)};
    return scene;
}

double term(const render::RadianceImage& image, Term t, std::size_t band) {
    return image.terms[static_cast<std::size_t>(t)][band * static_cast<std::size_t>(image.samples)];
}

TEST(AtSensor, EveryTermIsItsFormula) {
    const TestScene scene = scene_with_air();
    const auto image =
        render::render_image(scene.scene(), nullptr, rays_request({{{80.0, 80.0, 900.0}, {80.0, 80.0, -1.0}}}));
    const auto& air = scene.atmosphere;
    for (std::size_t b = 0; b < 2; ++b) {
        const double tau = air.transmittance[b], rho = 0.25;
        EXPECT_NEAR(term(image, Term::GroundEmission, b) / (0.75 * planck_radiance(scene.optics.lambda_um[b], 310.0) * tau),
                    1.0, 1e-6);
        EXPECT_NEAR(term(image, Term::ReflectedSun, b) / (rho / kPi * air.direct_normal_irradiance_W_m2_um[b] *
                                                          std::sqrt(0.5) * air.solar_correlation[b] * tau),
                    1.0, 1e-6);
        EXPECT_NEAR(term(image, Term::ReflectedSky, b) / (rho / kPi * air.diffuse_irradiance_W_m2_um[b] * tau), 1.0, 1e-6);
        EXPECT_NEAR(term(image, Term::ReflectedThermalSky, b) / (rho / kPi * air.thermal_irradiance_W_m2_um[b] * tau), 1.0,
                    1e-6);
        EXPECT_EQ(term(image, Term::ReflectedFlame, b), 0.0);
        EXPECT_EQ(term(image, Term::FlameEmission, b), 0.0);
        EXPECT_FLOAT_EQ(static_cast<float>(term(image, Term::PathSolar, b)), air.path_solar_a0[b]);
        EXPECT_FLOAT_EQ(static_cast<float>(term(image, Term::PathThermal, b)), air.path_thermal_W_m2_sr_um[b]);
        EXPECT_FLOAT_EQ(static_cast<float>(term(image, Term::Adjacency, b)), air.adjacency_W_m2_sr_um[b]);
    }
}

TEST(AtSensor, TermsSumToTheTotal) {
    TestScene scene = scene_with_air();
    scene.set_flame({.corner_m = {}, .nx = 16, .ny = 16, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 1.0},
                    box_of_voxels(16, 16, 3, 1100.0, 0.2));
    for (std::size_t i = 0; i < scene.surface.burned.size(); i += 3) {
        scene.surface.burned[i] = 1;
        scene.surface.front_fraction[i] = 0.4F;
    }
    scene.set_heights([](double x, double y) { return 0.1 * x + 3.0 * std::sin(y / 20.0); });
    std::vector<render::SceneRay> rays;
    for (std::uint64_t i = 0; i < 64; ++i) {
        const double x = 160.0 * uniform01({.seed = 5}, i, 0), y = 160.0 * uniform01({.seed = 5}, i, 1);
        rays.push_back({{x, y, 1000.0}, {x, y, -50.0}});
    }
    const auto light = render::ground_irradiance(scene.scene(), {});
    for (const bool grey : {true, false}) {
        scene.optics.grey = grey;
        const auto image = render::render_image(scene.scene(), &light, rays_request(rays));
        for (std::size_t i = 0; i < image.radiance_W_m2_sr_um.size(); ++i) {
            double sum = 0.0;
            for (const auto& t : image.terms)
                if (!t.empty()) sum += t[i];  // the smoke term is there with a plume only
            EXPECT_NEAR(sum / image.radiance_W_m2_sr_um[i], 1.0, 1e-6);
        }
    }
}

TEST(AtSensor, FacetsTurnedFromTheSunAreDark) {
    TestScene scene = scene_with_air();
    scene.set_heights([](double, double y) { return 1.2 * y; });  // the slope faces the sun, in the south
    const render::SceneRay ray{{80.0, 80.0, 900.0}, {80.0, 80.0, -1.0}};
    const Vec3 normal = normalized(Vec3{0.0, -1.2, 1.0});
    const auto south = render::render_image(scene.scene(), nullptr, rays_request({ray}));
    EXPECT_NEAR(term(south, Term::ReflectedSun, 0) / (0.25 / kPi * 60.0 * dot(normal, scene.to_sun) * 0.95 * 0.9), 1.0,
                1e-5);
    scene.set_heights([](double, double y) { return 200.0 - 1.2 * y; });
    const auto north = render::render_image(scene.scene(), nullptr, rays_request({ray}));
    EXPECT_EQ(term(north, Term::ReflectedSun, 0), 0.0);
}

TEST(AtSensor, TerrainCastsShadows) {
    TestScene scene = scene_with_air();
    scene.set_heights([](double, double y) { return y > 40.0 && y < 60.0 ? 60.0 : 0.0; });  // a ridge along y = 50
    const auto image = render::render_image(
        scene.scene(), nullptr,
        rays_request({{{80.0, 90.0, 900.0}, {80.0, 90.0, -1.0}}, {{80.0, 145.0, 900.0}, {80.0, 145.0, -1.0}}}));
    const auto& sun = image.terms[static_cast<std::size_t>(Term::ReflectedSun)];
    EXPECT_EQ(sun[0], 0.0F);  // 40 m behind 60 m of height, sun at 45 degrees
    EXPECT_GT(sun[1], 1.0F);
}

TEST(AtSensor, WaspMediumWavePeakOfTheThesis) {
    // Errata E22: 1100 K seen with emissivity 1 and no air is 4634.8 in a 3-5 um box, 0.99 of the thesis's figure 4590.
    TestScene scene({.ground_K = 1100.0});
    const Spectrum box{.kind = Quantity::Response, .lambda_um = {3.0, 5.0}, .value = {1.0, 1.0}};
    scene.spectral = radiometry::make_spectral_grid(std::span(&box, 1));
    const auto n = static_cast<std::size_t>(scene.spectral.size());
    scene.optics.lambda_count = static_cast<int>(n);
    scene.optics.lambda_um = scene.spectral.lambda_um;
    scene.optics.flame_absorption_per_m.assign(n, 0.3F);
    scene.optics.reflectance.assign(2 * n, 0.0F);
    scene.atmosphere = radiometry::vacuum(static_cast<int>(n));
    EXPECT_NEAR(trace(scene, {{80.0, 80.0, 900.0}, {80.0, 80.0, -1.0}})[0], 4634.8, 0.1);
}

}  // namespace
}  // namespace pyroscene::test
