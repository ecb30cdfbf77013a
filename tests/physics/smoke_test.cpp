// Smoke that scatters: closed forms of single scattering, Kirchhoff, energy, what it takes from the ground's light, and the
// light of flames on it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "base/constants.h"
#include "physics/smoke_layer.h"
#include "radiometry/planck.h"
#include "radiometry/smoke.h"

namespace pyroscene::test {
namespace {

using render::Term;

const std::vector<double> kLambda_um{0.55, 0.87, 2.2, 4.0, 11.0};

/// Over black ground at 300 K unless told.
TestScene layer(const Smoke& smoke, int slices, double smoke_K = 300.0, double ground_K = 300.0, double reflectance = 0.0) {
    return smoke_layer({smoke, slices, smoke_K, ground_K, reflectance}, kLambda_um);
}

/// The same with light scattered once only.
TestScene layer_once(const Smoke& smoke, int slices, double reflectance = 0.0) {
    TestScene scene = layer(smoke, slices, 300.0, 300.0, reflectance);
    scene.optics.smoke_multiple_scattering = false;
    return scene;
}

// Chandrasekhar's first order for a slab of optical depth t, sun at mu0, view at mu, scattering angle between them:
//   L = w E p(cos) / mu (1 - exp(-t (1/mu + 1/mu0))) / (1/mu + 1/mu0)
TEST(Smoke, SlabScattersTheSunOnceAsInClosedForm) {
    const double irradiance = 1500.0;
    for (const double depth : {0.02, 0.5, 3.0, 20.0})
        for (const double g : {0.0, 0.65})
            for (const int slices : {1, 7})
                for (const double sun_deg : {0.0, 40.0, 70.0})
                    for (const double view_deg : {0.0, 35.0}) {
                        const Smoke smoke{depth / 200.0, 0.9, g};
                        TestScene scene = layer_once(smoke, slices);
                        scene.to_sun = direction(sun_deg * kDegree_rad, 0.7);
                        scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(),
                                                                                 static_cast<float>(irradiance));
                        const auto ray = ray_from(view_deg * kDegree_rad, 2.0);
                        const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray}));
                        const double mu0 = scene.to_sun.z, mu = std::cos(view_deg * kDegree_rad);
                        const double cosine = dot(scene.to_sun, (ray.end_m - ray.start_m) / length(ray.end_m - ray.start_m));
                        const double slant = 1.0 / mu + 1.0 / mu0;
                        const double expected = smoke.albedo * irradiance * radiometry::henyey_greenstein_per_sr(cosine, g) /
                                                mu * -std::expm1(-depth * slant) / slant;
                        // At 0.55 um the ground and the smoke glow with nothing; the rest of J is the black ground's.
                        EXPECT_NEAR(term(image, Term::SmokeScattering, 0) / expected, 1.0, 2e-5)
                            << "depth " << depth << " g " << g << " slices " << slices << " sun " << sun_deg << " view "
                            << view_deg;
                    }
}

// Looking at the sun's own side of the sky through the layer: no light is lost between the ends, L = w E p t / mu exp(-t / mu).
TEST(Smoke, ForwardScatteringHasItsLimit) {
    // A ray that runs down along the sun's rays' mirror is not possible from above; the limit a + k dS = 0 needs a ray that
    // climbs towards the sun, so march one upwards from under the layer.
    const Smoke smoke{0.004, 0.8, 0.5};
    TestScene scene = layer_once(smoke, 3);
    scene.set_heights([](double, double y) { return y > 130.0 ? 500.0 : 0.0; });
    scene.to_sun = direction(60.0 * kDegree_rad, 0.0);
    scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(), 1000.0F);
    const Vec3 from{80.0, 80.0 - 400.0 * std::tan(60.0 * kDegree_rad) * 0.0 - 300.0, 60.0};
    const render::SceneRay ray{from, from + 900.0 * scene.to_sun};
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray}));
    ASSERT_GT(image.coverage[0], 0.0F);
    const double path = (std::min(300.0, image.hit_z_m[0]) - 100.0) / scene.to_sun.z;
    const double column = (300.0 - 100.0) / scene.to_sun.z;  // smoke between the near end and the sun
    const double expected = smoke.albedo * 1000.0 * radiometry::henyey_greenstein_per_sr(1.0, smoke.asymmetry) *
                            smoke.extinction_per_m * path * std::exp(-smoke.extinction_per_m * column);
    EXPECT_NEAR(term(image, Term::SmokeScattering, 0) / expected, 1.0, 1e-4);
}

// Everything at one temperature: scattering must not show, whatever albedo, asymmetry and depth.
TEST(Smoke, FurnaceStaysBlackThroughScatteringSmoke) {
    for (const double T_K : {300.0, 900.0})
        for (const double depth : {0.1, 2.0, 30.0})
            for (const double albedo : {0.5, 1.0})
                for (const double reflectance : {0.0, 0.2, 0.4}) {
                    TestScene scene = layer({depth / 200.0, albedo, 0.6}, 4, T_K, T_K, reflectance);
                    scene.optics.smoke_multiple_scattering = reflectance != 0.2;
                    scene.set_sky(T_K);
                    const fire::VoxelGrid grid{
                        .corner_m = {40.0, 40.0, 0.0}, .nx = 8, .ny = 8, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0};
                    scene.set_flame(grid, box_of_voxels(8, 8, 30, T_K));  // reaches into the layer
                    scene.set_absorption({0.3F, 0.2F, 0.1F, 0.05F, 0.01F});
                    scene.surface.front_temperature_K = T_K;
                    scene.surface.front_fraction[scene.surface.grid.index(2, 5)] = 0.7F;
                    const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 60.0});
                    for (const double view : {0.0, 0.6}) {
                        const auto radiance = trace(scene, ray_from(view, 1.0), &light);
                        for (std::size_t b = 1; b < kLambda_um.size(); ++b)
                            EXPECT_NEAR(radiance[b] / radiometry::planck_radiance(kLambda_um[b], T_K), 1.0, 1e-5)
                                << kLambda_um[b] << " um " << T_K << " K depth " << depth << " albedo " << albedo;
                    }
                }
}

// What a beam loses is what is absorbed and what is scattered: smoke of albedo w in a field of mean radiance J = B(T_sky) and
// cold itself sends w (1 - e^-t) J to the sensor; absorbed, it would send (1 - w)(1 - e^-t) B. The sum over both is extinction.
TEST(Smoke, ScatteredAndAbsorbedMakeWhatIsExtinguished) {
    const double T_K = 800.0, depth = 1e-3;  // thin: the light on the smoke is the unattenuated surroundings'
    for (const double albedo : {0.0, 0.3, 0.95}) {
        TestScene hot_smoke = layer({depth / 200.0, albedo, 0.6}, 2, T_K, 300.0);
        TestScene hot_surround = layer({depth / 200.0, albedo, 0.6}, 2, 300.0, T_K);
        hot_surround.set_sky(T_K);
        const auto image = [&](const TestScene& scene) {
            return render::render_image(scene.scene(), nullptr, rays_request({ray_from(0.0, 0.0)}));
        };
        const auto emitted = image(hot_smoke), scattered = image(hot_surround);
        for (std::size_t b = 2; b < kLambda_um.size(); ++b) {
            const double B = radiometry::planck_radiance(kLambda_um[b], T_K);
            const double absorbed_share = term(emitted, Term::SmokeEmission, b) / B;
            const double scattered_share = albedo > 0.0 ? term(scattered, Term::SmokeScattering, b) / B : 0.0;
            EXPECT_NEAR((absorbed_share + scattered_share) / -std::expm1(-depth), 1.0, 4e-3) << albedo;
            EXPECT_NEAR(absorbed_share / -std::expm1(-depth), 1.0 - albedo, 1e-5);
            EXPECT_NEAR(term(scattered, Term::GroundEmission, b) / B, std::exp(-depth), 1e-6);
        }
    }
}

// Direct sun on the ground below: E mu0 exp(-t / mu0) r / pi, then through the layer to the sensor; the sky by exp(-1.66 t).
TEST(Smoke, DimsTheSunAndTheSkyOnTheGround) {
    const double depth = 0.8, reflectance = 0.3;
    TestScene scene = layer_once({depth / 200.0, 0.9, 0.6}, 3, reflectance);
    scene.to_sun = direction(50.0 * kDegree_rad, 4.0);
    scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(), 1200.0F);
    scene.atmosphere.diffuse_irradiance_W_m2_um.assign(kLambda_um.size(), 200.0F);
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray_from(0.5, 1.0)}));
    const double through = std::exp(-depth / std::cos(0.5)), mu0 = scene.to_sun.z;
    EXPECT_NEAR(term(image, Term::ReflectedSun, 0) / (1200.0 * mu0 * std::exp(-depth / mu0) * reflectance / kPi * through),
                1.0, 1e-5);
    EXPECT_NEAR(term(image, Term::ReflectedSky, 0) / (200.0 * std::exp(-1.66 * depth) * reflectance / kPi * through), 1.0,
                1e-5);
}

// Ground beside the smoke, with the smoke between it and the sun: sunlight that smoke sends down is sky light once, and the
// thermal sky, which has no smoke in it, stays what it is. Near flames as elsewhere.
TEST(Smoke, BesideItScattersSunlightIntoTheSunlitSkyOnly) {
    const double reflectance = 0.3;
    TestScene scene = layer({0.004, 0.9, 0.6}, 2, 300.0, 300.0, reflectance);
    scene.plume =
        fire::make_flame_field({.corner_m = {240.0, -5e4, 100.0}, .nx = 1, .ny = 1, .dx_m = 1e5, .dy_m = 1e5, .dz_m = 100.0},
                               box_of_voxels(1, 1, 2, 300.0));
    scene.to_sun = direction(60.0 * kDegree_rad, 90.0 * kDegree_rad);
    scene.set_sky(280.0);
    scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(), 1200.0F);
    scene.atmosphere.diffuse_irradiance_W_m2_um.assign(kLambda_um.size(), 200.0F);
    const render::SceneRay down{{80.0, 80.0, 1000.0}, {80.0, 80.0, -1.0}};
    const auto dark = render::render_image(scene.scene(), nullptr, rays_request({down}));
    const std::vector<fire::FlameVoxel> spark{{0, 0, 0, 1e-6F, 1000.0F}};
    scene.set_flame({.corner_m = {20.0, 20.0, 0.0}, .nx = 1, .ny = 1, .dx_m = 2.0, .dy_m = 2.0, .dz_m = 2.0}, spark);
    const auto light = render::ground_irradiance(scene.scene(), {.reach_m = 300.0});
    ASSERT_FALSE(light.thermal_irradiance_W_m2_um.empty());
    const auto lit = render::render_image(scene.scene(), &light, rays_request({down}));
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        const double thermal = reflectance * radiometry::planck_radiance(kLambda_um[b], 280.0);
        EXPECT_NEAR(term(dark, Term::ReflectedThermalSky, b), thermal, 1e-5 * thermal) << kLambda_um[b];
        EXPECT_NEAR(term(lit, Term::ReflectedThermalSky, b), thermal, 1e-4 * thermal) << kLambda_um[b];
        EXPECT_GT(term(dark, Term::ReflectedSky, b), 1.2 * reflectance * 200.0 / kPi);
        EXPECT_NEAR(term(lit, Term::ReflectedSky, b) / term(dark, Term::ReflectedSky, b), 1.0, 1e-4);
    }
}

// What single scattering leaves out (docs/physics-render.md has the table): little when thin, most of the light when thick.
TEST(Smoke, SingleScatteringIsTheThinLimitOfAllOrders) {
    const double mu0 = std::cos(40.0 * kDegree_rad), albedo = 0.9, g = 0.6;
    double before = 1.0;
    for (const double depth : {0.002, 0.1, 0.3, 1.0, 3.0}) {
        TestScene scene = layer_once({depth / 200.0, albedo, g}, 2);
        scene.to_sun = direction(40.0 * kDegree_rad, 0.7);
        scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(), 1000.0F);
        const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray_from(0.0, 0.0)}));
        const double rendered = term(image, Term::SmokeScattering, 0) / 1000.0;
        const Orders orders = orders_of_scattering(depth, albedo, g, mu0);
        EXPECT_NEAR(rendered / orders.first, 1.0, 0.01) << depth;
        const double share = rendered / orders.all;
        std::printf("optical depth %.3f: single scattering is %.0f %% of all orders\n", depth, 100.0 * share);
        EXPECT_GT(share, depth < 0.01 ? 0.98 : 0.0);
        EXPECT_LT(share, before + 0.01);
        before = share;
    }
}

TEST(Smoke, TermsSumToTheTotal) {
    TestScene scene = layer({0.01, 0.9, 0.6}, 5, 320.0, 310.0, 0.2);
    scene.to_sun = direction(0.6, 4.0);
    scene.atmosphere.direct_normal_irradiance_W_m2_um.assign(kLambda_um.size(), 900.0F);
    scene.atmosphere.diffuse_irradiance_W_m2_um.assign(kLambda_um.size(), 100.0F);
    scene.set_flame({.corner_m = {40.0, 40.0, 0.0}, .nx = 8, .ny = 8, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0},
                    box_of_voxels(8, 8, 6, 1100.0));
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 200.0});
    const auto image = render::render_image(scene.scene(), &light, rays_request({ray_from(0.3, 1.0)}));
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        double sum = 0.0;
        for (const auto& each : image.terms) sum += each[b];
        EXPECT_NEAR(sum / image.radiance_W_m2_sr_um[b], 1.0, 1e-6);
        EXPECT_GT(term(image, Term::SmokeScattering, b), 0.0F);
    }
}

// A thin block of flame far below a thin puff: J = I / (4 pi r^2) 4 pi p(cos), I = k V B.
TEST(Smoke, ScattersTheLightOfADistantFlame) {
    const double k_per_m = 0.01, T_K = 1500.0, extinction_per_m = 1e-5, g = 0.5;
    TestScene scene({.ground_K = 1.0, .lambda_um = kLambda_um, .absorption_per_m = k_per_m});
    scene.optics.grey = false;
    scene.set_flame({.corner_m = {76.0, 76.0, 0.0}, .nx = 8, .ny = 8, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 1.0},
                    box_of_voxels(8, 8, 8, T_K));
    scene.plume = fire::make_flame_field(
        {.corner_m = {180.0, 40.0, 200.0}, .nx = 1, .ny = 1, .dx_m = 10.0, .dy_m = 80.0, .dz_m = 10.0},
        box_of_voxels(1, 1, 1, 1.0));
    const auto n = kLambda_um.size();
    scene.optics.smoke_extinction_per_m.assign(n, static_cast<float>(extinction_per_m));
    scene.optics.smoke_albedo.assign(n, 0.9F);
    scene.optics.smoke_asymmetry.assign(n, static_cast<float>(g));
    // Straight down through the puff is off the map; look at it at a slant that ends on the map.
    const Vec3 puff{185.0, 80.0, 205.0}, flame{80.0, 80.0, 4.0}, eye{260.0, 80.0, 500.0};
    const Vec3 down = (puff - eye) / length(puff - eye);
    const render::SceneRay ray{eye, eye + (501.0 / -down.z) * down};
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray}));
    ASSERT_GT(image.coverage[0], 0.0F);
    const Vec3 way = puff - flame;
    const double r_m = length(way), cosine = dot(way / r_m, -1.0 * down);
    const double inside_m = 10.0 / std::max(std::abs(down.z), std::abs(down.x));
    for (const std::size_t b : {std::size_t{0}, std::size_t{2}}) {
        const double intensity = k_per_m * 512.0 * radiometry::planck_radiance(kLambda_um[b], T_K);
        const double expected =
            extinction_per_m * inside_m * 0.9 * intensity / (r_m * r_m) * radiometry::henyey_greenstein_per_sr(cosine, g);
        EXPECT_NEAR(term(image, Term::SmokeScattering, b) / expected, 1.0, 0.03) << kLambda_um[b];
    }
}

// A burning cell far below a thin puff: J = eps B a cos / r^2 p(cos); not a glimmer below its own level.
TEST(Smoke, ScattersTheLightOfADistantFront) {
    const double extinction_per_m = 1e-5, g = 0.5, reflectance = 0.2;
    for (const double share : {1.0, 0.25}) {
        TestScene scene({.ground_K = 1.0, .lambda_um = kLambda_um, .reflectance = reflectance});
        scene.surface.front_fraction[scene.surface.grid.index(3, 3)] = static_cast<float>(share);  // centre at 70, 90
        const auto n = kLambda_um.size();
        scene.optics.smoke_extinction_per_m.assign(n, static_cast<float>(extinction_per_m));
        scene.optics.smoke_albedo.assign(n, 0.9F);
        scene.optics.smoke_asymmetry.assign(n, static_cast<float>(g));
        const Vec3 puff{185.0, 80.0, 305.0}, front{70.0, 90.0, 0.0}, eye{260.0, 80.0, 600.0};
        const Vec3 down = (puff - eye) / length(puff - eye);
        const render::SceneRay ray{eye, eye + (601.0 / -down.z) * down};
        const auto seen = [&](double bottom_m) {
            scene.plume = fire::make_flame_field(
                {.corner_m = {180.0, 40.0, bottom_m}, .nx = 1, .ny = 1, .dx_m = 10.0, .dy_m = 80.0, .dz_m = 10.0},
                box_of_voxels(1, 1, 1, 1.0));
            return render::render_image(scene.scene(), nullptr, rays_request({ray}));
        };
        const auto image = seen(300.0);
        ASSERT_GT(image.coverage[0], 0.0F);
        const Vec3 way = puff - front;
        const double r_m = length(way), cosine = dot(way / r_m, -1.0 * down);
        const double inside_m = 10.0 / std::max(std::abs(down.z), std::abs(down.x));
        for (const std::size_t b : {std::size_t{0}, std::size_t{2}}) {
            const double L =
                (1.0 - reflectance) * radiometry::planck_radiance(kLambda_um[b], scene.surface.front_temperature_K);
            const double expected = extinction_per_m * inside_m * 0.9 * L * share * 400.0 * way.z / (r_m * r_m * r_m) *
                                    radiometry::henyey_greenstein_per_sr(cosine, g);
            EXPECT_NEAR(term(image, Term::SmokeScattering, b) / expected, 1.0, 0.03) << kLambda_um[b];
        }
    }
}

/// Share of the sphere that the box [72, 88] x [72, 88] x [0, 8] fills, seen from a point over its middle (two-sided faces of a
/// rectangle seen from its axis: solid angle 4 asin(a b / sqrt((a^2 + d^2)(b^2 + d^2))) of the top face hides the rest).
double box_share_from_above(double height_above_top_m) {
    const double half = 8.0, d2 = height_above_top_m * height_above_top_m;
    return 4.0 * std::asin(half * half / (half * half + d2)) / (4.0 * kPi);
}

// Opaque flames near the smoke: point sources against the solid angle that the flame really fills (isotropic scattering).
TEST(Smoke, PointSourcesStandForNearFlames) {
    for (const double above_m : {8.0, 16.0, 32.0, 64.0}) {
        TestScene scene({.cols = 16, .rows = 16, .ground_K = 1.0, .lambda_um = kLambda_um, .absorption_per_m = 50.0});
        scene.optics.grey = false;
        scene.set_flame({.corner_m = {72.0, 72.0, 0.0}, .nx = 16, .ny = 16, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 1.0},
                        box_of_voxels(16, 16, 8, 1500.0));
        scene.plume = fire::make_flame_field(
            {.corner_m = {79.0, 79.0, 7.0 + above_m}, .nx = 1, .ny = 1, .dx_m = 2.0, .dy_m = 2.0, .dz_m = 2.0},
            box_of_voxels(1, 1, 1, 1.0));
        const auto n = kLambda_um.size();
        scene.optics.smoke_extinction_per_m.assign(n, 1e-5F);
        scene.optics.smoke_albedo.assign(n, 0.9F);
        scene.optics.smoke_asymmetry.assign(n, 0.0F);
        // Through the puff and past the flame, at 60 degrees.
        const Vec3 puff{80.0, 80.0, 8.0 + above_m}, d = normalized(Vec3{std::sqrt(3.0), 0.0, -1.0});
        const render::SceneRay ray{puff - 50.0 * d, puff + ((puff.z + 1.0) / 0.5) * d};
        const auto image = render::render_image(scene.scene(), nullptr, rays_request({ray}));
        ASSERT_GT(image.coverage[0], 0.0F);
        const double inside_m = 2.0 / d.x;
        const double expected =
            1e-5 * inside_m * 0.9 * radiometry::planck_radiance(2.2, 1500.0) * box_share_from_above(above_m);
        const double ratio = term(image, Term::SmokeScattering, 2) / expected;
        std::printf("opaque flame of 16 x 16 x 8 m, smoke %.0f m above it: %.2f of its light\n", above_m, ratio);
        EXPECT_NEAR(ratio, 1.0, above_m > 20.0 ? 0.2 : 0.35);  // a point in the middle of a body is too far below its top
    }
}

}  // namespace
}  // namespace pyroscene::test
