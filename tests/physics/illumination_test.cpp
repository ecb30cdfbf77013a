// Sun and sky on ground at several heights.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"

namespace pyroscene::test {
namespace {

constexpr double kBase_m = 200.0;
constexpr std::array<double, 3> kHeights_m{1000.0, 0.0, -500.0};
const std::vector<double> kLambda_um{0.55, 2.2, 10.6};

/// Light of each kind on ground at height i of kHeights_m, at wavelength l.
float direct(std::size_t i, std::size_t l) {
    return 1000.0F - 130.0F * static_cast<float>(i) - 10.0F * static_cast<float>(l);
}
float diffuse(std::size_t i, std::size_t l) { return 60.0F + 45.0F * static_cast<float>(i) - 7.0F * static_cast<float>(l); }
float thermal(std::size_t i, std::size_t l) { return 5.0F + 3.0F * static_cast<float>(i * i) + static_cast<float>(l); }

/// Air that lets through everything, with sun and sky of several heights, or those of height 0 only.
void set_light(TestScene& scene, bool levels) {
    const std::size_t n = kLambda_um.size();
    auto& air = scene.atmosphere;
    const auto fill = [&](radiometry::GroundIllumination& light, std::size_t i) {
        light = {};
        for (std::size_t l = 0; l < n; ++l) {
            light.direct_normal_irradiance_W_m2_um.push_back(direct(i, l));
            light.diffuse_irradiance_W_m2_um.push_back(diffuse(i, l));
            light.thermal_irradiance_W_m2_um.push_back(thermal(i, l));
        }
    };
    fill(air, 1);
    scene.to_sun = normalized(Vec3{0.3, 0.2, 0.8});
    if (!levels) return;
    air.height_m.assign(kHeights_m.begin(), kHeights_m.end());
    for (std::size_t i = 0; i < kHeights_m.size(); ++i) fill(air.illumination.emplace_back(), i);
    for (auto* table : {&air.transmittance, &air.solar_correlation}) table->assign(3 * n, 1.0F);
    for (auto* table : {&air.path_thermal_W_m2_sr_um, &air.path_solar_a0, &air.path_solar_a1, &air.path_solar_a2,
                        &air.adjacency_W_m2_sr_um})
        table->assign(3 * n, 0.0F);
}

render::RenderScene with_base(const TestScene& scene) {
    render::RenderScene s = scene.scene();
    s.air_base_m = kBase_m;
    return s;
}

/// Linear between the heights, constant beyond them.
double expected(float (*light)(std::size_t, std::size_t), std::size_t l, double above_base_m) {
    const double h = std::clamp(above_base_m, kHeights_m.back(), kHeights_m.front());
    const std::size_t i = h >= kHeights_m[1] ? 0 : 1;
    const double f = (kHeights_m[i] - h) / (kHeights_m[i] - kHeights_m[i + 1]);
    return (1.0 - f) * static_cast<double>(light(i, l)) + f * static_cast<double>(light(i + 1, l));
}

TEST(Illumination, GroundIsLitAsAtItsHeight) {
    const double reflectance = 0.3;
    for (const double z_m : {-2000.0, -300.0, 0.0, 200.0, 450.0, 700.0, 1199.0, 1200.0, 3000.0}) {
        TestScene scene({.lambda_um = kLambda_um, .reflectance = reflectance});
        scene.set_heights([&](double, double) { return z_m; });
        set_light(scene, true);
        const auto image = render::render_image(with_base(scene), nullptr,
                                                rays_request({{{80.0, 70.0, z_m + 500.0}, {80.0, 70.0, z_m - 10.0}}}));
        const auto term = [&](render::Term t, std::size_t l) {
            return static_cast<double>(image.terms[static_cast<std::size_t>(t)][l]);
        };
        for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
            const double above_m = z_m - kBase_m;
            EXPECT_NEAR(term(render::Term::ReflectedSun, l) * kPi / reflectance / scene.to_sun.z,
                        expected(direct, l, above_m), 1e-3)
                << z_m << " m";
            EXPECT_NEAR(term(render::Term::ReflectedSky, l) * kPi / reflectance, expected(diffuse, l, above_m), 1e-4);
            EXPECT_NEAR(term(render::Term::ReflectedThermalSky, l) * kPi / reflectance, expected(thermal, l, above_m), 1e-5);
        }
    }
}

TEST(Illumination, SkyBesideFlamesIsThatOfTheHeightOfTheCell) {
    const auto light_at = [&](double z_m, bool levels) {
        TestScene scene({.lambda_um = kLambda_um, .reflectance = 0.2});
        scene.set_heights([&](double, double) { return z_m; });
        set_light(scene, levels);
        scene.set_flame({.corner_m = {60.0, 60.0, z_m}, .nx = 4, .ny = 4, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 5.0},
                        box_of_voxels(4, 4, 3, 1100.0));
        return render::ground_irradiance(with_base(scene), {});
    };
    const double z_m = 800.0;
    const auto by_height = light_at(z_m, true), as_at_base = light_at(z_m, false);
    ASSERT_FALSE(by_height.sky_irradiance_W_m2_um.empty());
    for (std::size_t row = 0; row < 64; ++row) {
        for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
            const std::size_t i = row * static_cast<std::size_t>(by_height.stride) + l;
            EXPECT_NEAR(by_height.sky_irradiance_W_m2_um[i] / as_at_base.sky_irradiance_W_m2_um[i],
                        expected(diffuse, l, z_m - kBase_m) / static_cast<double>(diffuse(1, l)), 1e-5);
            EXPECT_NEAR(by_height.thermal_irradiance_W_m2_um[i] / as_at_base.thermal_irradiance_W_m2_um[i],
                        expected(thermal, l, z_m - kBase_m) / static_cast<double>(thermal(1, l)), 1e-5);
        }
    }
}

TEST(Illumination, SkyThroughThinSmokeIsThatOfTheHeight) {
    const double reflectance = 0.3, z_m = 700.0;
    TestScene scene({.lambda_um = kLambda_um, .reflectance = reflectance});
    scene.set_heights([&](double, double) { return z_m; });
    set_light(scene, true);
    scene.optics.smoke_extinction_per_m.assign(kLambda_um.size(), 1e-7F);
    scene.plume = fire::make_flame_field(
        {.corner_m = {-500.0, -500.0, z_m + 20.0}, .nx = 24, .ny = 24, .dx_m = 50.0, .dy_m = 50.0, .dz_m = 20.0},
        box_of_voxels(24, 24, 2, 300.0));
    const auto image = render::render_image(with_base(scene), nullptr,
                                            rays_request({{{80.0, 70.0, z_m + 500.0}, {80.0, 70.0, z_m - 10.0}}}));
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
        const auto irradiance = [&](render::Term t) {
            return static_cast<double>(image.terms[static_cast<std::size_t>(t)][l]) * kPi / reflectance;
        };
        EXPECT_NEAR(irradiance(render::Term::ReflectedSun) / scene.to_sun.z, expected(direct, l, z_m - kBase_m), 0.02);
        EXPECT_NEAR(irradiance(render::Term::ReflectedSky), expected(diffuse, l, z_m - kBase_m), 0.01);
        EXPECT_NEAR(irradiance(render::Term::ReflectedThermalSky), expected(thermal, l, z_m - kBase_m), 0.01);
    }
}

TEST(Illumination, HeightsOfOneLightChangeNothing) {
    const auto radiance = [](bool levels) {
        TestScene scene({.cols = 16, .rows = 16, .lambda_um = kLambda_um, .reflectance = 0.5});
        scene.set_heights([](double x, double y) { return 300.0 + 4.0 * std::abs(x - 150.0) + 0.5 * y; });
        set_light(scene, levels);
        for (auto& light : scene.atmosphere.illumination) light = scene.atmosphere;
        scene.set_flame({.corner_m = {140.0, 100.0, 330.0}, .nx = 4, .ny = 4, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 5.0},
                        box_of_voxels(4, 4, 5, 1100.0));
        const auto light = render::ground_irradiance(with_base(scene), {.bounces = 3});
        std::vector<render::SceneRay> rays;
        for (int i = 0; i < 12; ++i) rays.push_back({{20.0 + 25.0 * i, 150.0, 3000.0}, {20.0 + 25.0 * i, 150.0, 0.0}});
        return render::render_image(with_base(scene), &light, rays_request(rays)).radiance_W_m2_sr_um;
    };
    const auto with = radiance(true), without = radiance(false);
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t i = 0; i < with.size(); ++i) EXPECT_NEAR(with[i] / without[i], 1.0F, 2e-6F) << i;
}

}  // namespace
}  // namespace pyroscene::test
