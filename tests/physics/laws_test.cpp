// The laws with every constituent at once: soot, H2O, CO2, CO, CH4, potassium, sodium, and smoke that scatters.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"
#include "radiometry/smoke.h"
#include "source_folder.h"

namespace pyroscene::test {
namespace {

using radiometry::planck_radiance;

/// Green, both sodium lines, potassium line and beside it, soot, gas bands, windows.
const std::vector<double> kLambda_um{0.55, 0.589158326, 0.589755815, 0.766700922, 0.768, 1.2, 2.2,  2.7,
                                     3.31, 3.9,         4.3,         4.67,        6.3,   8.5, 10.6, 14.0};

std::shared_ptr<const radiometry::FlameOptics> tables() {
    static const auto loaded =
        std::make_shared<const radiometry::FlameOptics>(radiometry::load_flame_optics(source_folder() / "data/optical"));
    return loaded;
}

const radiometry::SmokeOptics& smoke_tables() {
    static const auto loaded =
        radiometry::load_smoke_optics(source_folder() / "data/optical/smoke_optics_fine.csv", "savanna");
    return loaded;
}

FlameGas everything() {
    FlameGas gas;
    gas.x_CH4 = 0.005;
    gas.sodium_ppm = 0.3;
    gas.pressure_Pa = 85000.0;
    return gas;
}

/// Flame of 3 x `layers` m over the middle of the map and smoke of the savanna kind from `smoke_bottom_m` up over 60 m.
TestScene scene_with_everything(double flame_K, double smoke_K, double ground_K, double reflectance, int layers,
                                double smoke_bottom_m, double smoke_g_m3) {
    TestScene scene({.cols = 16, .rows = 16, .ground_K = ground_K, .lambda_um = kLambda_um, .reflectance = reflectance});
    const FlameGas gas = everything();
    std::vector<float> soot;
    for (const double lambda_um : kLambda_um)
        soot.push_back(
            static_cast<float>(radiometry::soot_absorption_per_m(tables()->soot, lambda_um, gas.soot_volume_fraction)));
    scene.set_absorption(soot);
    scene.optics.flame_tables = tables();
    scene.optics.flame_gas = gas;
    scene.set_flame({.corner_m = {100.0, 100.0, 0.0}, .nx = 24, .ny = 24, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 1.0},
                    box_of_voxels(24, 24, 3 * layers, flame_K));
    scene.plume = fire::make_flame_field(
        {.corner_m = {-5e4, -5e4, smoke_bottom_m}, .nx = 1, .ny = 1, .dx_m = 1e5, .dy_m = 1e5, .dz_m = 20.0},
        box_of_voxels(1, 1, 3, smoke_K, smoke_g_m3));
    for (const double lambda_um : kLambda_um) {
        const auto at = radiometry::smoke_coefficients(smoke_tables(), lambda_um, 1.0);
        scene.optics.smoke_extinction_per_m.push_back(static_cast<float>(at.extinction_per_m));
        scene.optics.smoke_albedo.push_back(static_cast<float>(at.single_scattering_albedo));
        scene.optics.smoke_asymmetry.push_back(static_cast<float>(at.asymmetry));
    }
    return scene;
}

double smoke_extinction_per_m(std::size_t l, double g_m3) {
    return radiometry::smoke_coefficients(smoke_tables(), kLambda_um[l], g_m3).extinction_per_m;
}

// Smoke inside and above the flame, reflecting ground, sky of the same temperature: a black body at every wavelength.
TEST(EveryConstituent, FurnaceIsABlackBody) {
    for (const double T_K : {400.0, 1100.0, 1500.0})
        for (const double smoke_bottom_m : {2.0, 20.0})
            for (const double smoke_g_m3 : {0.002, 0.2}) {
                TestScene scene = scene_with_everything(T_K, T_K, T_K, 0.3, 2, smoke_bottom_m, smoke_g_m3);
                scene.set_sky(T_K);
                const auto light = render::ground_irradiance(scene.scene(), {.directions = 16, .reach_m = 60.0});
                for (const Vec3 from : {Vec3{160.0, 160.0, 1000.0}, Vec3{600.0, 170.0, 500.0}}) {
                    const auto radiance = trace(scene, {from, {158.0, 161.0, -1.0}}, &light);
                    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
                        const double B = planck_radiance(kLambda_um[l], T_K);
                        if (B < 1e-18) continue;  // counts as zero in the renderer (PlanckRows)
                        EXPECT_NEAR(radiance[l] / B, 1.0, 5e-6) << kLambda_um[l] << " um, " << T_K << " K, smoke from "
                                                                << smoke_bottom_m << " m, " << smoke_g_m3 << " g/m3";
                    }
                }
            }
}

// Slab and gradient: two layers of flame at different temperatures under a layer of cold smoke, against FlamePath times Beer's
// law of the smoke plus its own emission; the sun is off and what smoke scatters is subtracted by its own term.
TEST(EveryConstituent, LayersFollowTheReferencePath) {
    const double upper_K = 900.0, lower_K = 1300.0, ground_K = 700.0, smoke_K = 350.0, smoke_g_m3 = 0.01;
    for (const bool gradient : {false, true}) {
        TestScene scene = scene_with_everything(lower_K, smoke_K, ground_K, 0.0, 1, 40.0, smoke_g_m3);
        auto voxels = box_of_voxels(24, 24, 3, lower_K);
        for (auto& v : voxels)
            if (gradient && v.k == 2) v.temperature_K = static_cast<float>(upper_K);
        scene.set_flame(scene.flame.grid, voxels);
        const auto image =
            render::render_image(scene.scene(), nullptr, rays_request({{{160.0, 161.0, 400.0}, {160.0, 161.0, -1.0}}}));
        for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
            radiometry::FlamePath path(*tables(), kLambda_um[l]);
            path.add(1.0, gradient ? upper_K : lower_K, everything());
            path.add(2.0, lower_K, everything());
            const double k = smoke_extinction_per_m(l, smoke_g_m3), through = std::exp(-60.0 * k);
            const double w = radiometry::smoke_coefficients(smoke_tables(), kLambda_um[l], 1.0).single_scattering_albedo;
            const double expected =
                (1.0 - w) * (1.0 - through) * planck_radiance(kLambda_um[l], smoke_K) +
                through * (path.emitted_radiance() + std::exp(-path.depth()) * planck_radiance(kLambda_um[l], ground_K));
            const double found =
                image.radiance_W_m2_sr_um[l] - image.terms[static_cast<std::size_t>(render::Term::SmokeScattering)][l];
            EXPECT_NEAR(found / expected, 1.0, gradient ? 5e-3 : 5e-4) << kLambda_um[l];
        }
    }
}

// Reciprocity: the transmittance of hot flame, cooler flame and smoke does not depend on which of them comes first.
TEST(EveryConstituent, TransmitsTheSameBothWays) {
    const auto transmittance = [](bool upside_down) {
        std::array<std::vector<float>, 2> seen;
        for (const int bright : {0, 1}) {
            // Smoke in the flame: 20 m of it from 2 m below ground would not do, so voxels of 1 m in the upper or lower half.
            TestScene scene = scene_with_everything(1000.0, 350.0, bright != 0 ? 3000.0 : 300.0, 0.0, 1, 200.0, 0.0);
            auto voxels = box_of_voxels(24, 24, 3, 1200.0);
            for (auto& v : voxels)
                if ((v.k == 2) != upside_down) v.temperature_K = 700.0F;
            if (upside_down)
                for (auto& v : voxels) v.temperature_K = v.k == 0 ? 700.0F : 1200.0F;
            scene.set_flame(scene.flame.grid, voxels);
            scene.plume = fire::make_flame_field(
                {.corner_m = {-5e4, -5e4, upside_down ? 0.0 : 2.0}, .nx = 1, .ny = 1, .dx_m = 1e5, .dy_m = 1e5, .dz_m = 1.0},
                box_of_voxels(1, 1, 1, 350.0, 0.3));
            const auto image =
                render::render_image(scene.scene(), nullptr, rays_request({{{160.0, 161.0, 400.0}, {160.0, 161.0, -1.0}}}));
            seen[static_cast<std::size_t>(bright)].assign(
                image.terms[static_cast<std::size_t>(render::Term::GroundEmission)].begin(),
                image.terms[static_cast<std::size_t>(render::Term::GroundEmission)].end());
        }
        std::vector<double> tau;
        for (std::size_t l = 0; l < kLambda_um.size(); ++l)
            tau.push_back(static_cast<double>(seen[1][l]) / planck_radiance(kLambda_um[l], 3000.0));
        return tau;
    };
    const auto up = transmittance(false), down = transmittance(true);
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) EXPECT_NEAR(up[l], down[l], 2e-5) << kLambda_um[l];
}

/// Chord of a line through the box [0, a] x [0, a] x [0, h].
double chord_m(Vec3 from, Vec3 d, double a, double h) {
    double begin = -1e9, end = 1e9;
    const std::array<double, 3> p{from.x, from.y, from.z}, u{d.x, d.y, d.z}, size{a, a, h};
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(u[i]) < 1e-12) {
            if (p[i] < 0.0 || p[i] > size[i]) return 0.0;
            continue;
        }
        const double s = -p[i] / u[i], t = (size[i] - p[i]) / u[i];
        begin = std::max(begin, std::min(s, t));
        end = std::min(end, std::max(s, t));
    }
    return std::max(end - begin, 0.0);
}

/// Distance from a point inside the box to its surface.
double exit_m(Vec3 p, Vec3 d, double a, double h) {
    const auto one = [](double x, double u, double size) { return u > 0.0 ? (size - x) / u : u < 0.0 ? -x / u : 1e9; };
    return std::min({one(p.x, d.x, a), one(p.y, d.y, a), one(p.z, d.z, h)});
}

// Energy: what leaves a box of flame over all its faces, gathered from rendered rays, is what its volume emits less what it
// absorbs itself. Soot, gas, atoms and smoke fill the box together; the smoke absorbs only, since light that is scattered
// twice is lost by design. The box is isothermal: rays from above see half of all directions, and the other half is its
// mirror image.
TEST(EveryConstituent, FluxOutOfABoxIsEmittedLessAbsorbed) {
    const double T_K = 1200.0, a = 6.0, h = 4.0, smoke_g_m3 = 0.3;
    TestScene scene = scene_with_everything(T_K, T_K, 60.0, 0.0, 1, 0.0, smoke_g_m3);
    scene.set_flame({.corner_m = {157.0, 157.0, 0.0}, .nx = 6, .ny = 6, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 1.0},
                    box_of_voxels(6, 6, 4, T_K));
    scene.plume =
        fire::make_flame_field({.corner_m = {157.0, 157.0, 0.0}, .nx = 3, .ny = 3, .dx_m = 2.0, .dy_m = 2.0, .dz_m = 2.0},
                               box_of_voxels(3, 3, 2, T_K, smoke_g_m3));
    std::fill(scene.optics.smoke_albedo.begin(), scene.optics.smoke_albedo.end(), 0.0F);
    const std::size_t n = kLambda_um.size();

    constexpr int kZenith = 6, kAzimuth = 6;
    std::vector<double> flux(n, 0.0), net(n, 0.0);
    double shadow_m2_sr = 0.0;  // of the box over these directions; over all of them pi times its surface
    // Optical depth over chord per wavelength, for the volume integral.
    constexpr int kNodes = 400;
    const double longest_m = std::sqrt(2.0 * a * a + h * h);
    const auto node_m = [&](int i) { return longest_m * i * i / (1.0 * kNodes * kNodes); };  // dense at the surface
    std::vector<std::vector<double>> tau(n, std::vector<double>(kNodes + 1, 1.0));
    for (std::size_t l = 0; l < n; ++l)
        for (int i = 1; i <= kNodes; ++i) {
            radiometry::FlamePath path(*tables(), kLambda_um[l]);
            path.add(node_m(i), T_K, everything());
            tau[l][static_cast<std::size_t>(i)] =
                std::exp(-path.depth() - smoke_extinction_per_m(l, smoke_g_m3) * node_m(i));
        }
    for (int z = 0; z < kZenith; ++z)
        for (int q = 0; q < kAzimuth; ++q) {
            const double mu = (z + 0.5) / kZenith, s = std::sqrt(1.0 - mu * mu), phi = 2.0 * kPi * (q + 0.37) / kAzimuth;
            const Vec3 up{s * std::cos(phi), s * std::sin(phi), mu};
            const double solid_sr = 2.0 * kPi / (kZenith * kAzimuth);
            shadow_m2_sr += 2.0 * solid_sr * (a * a * mu + a * h * (std::abs(up.x) + std::abs(up.y)));
            // Lines through a horizontal window that holds the box's slanted shadow; its area counts times mu.
            const double reach_m = h * s / mu;
            const int side = 90;
            const double width_m = a + 2.0 * reach_m, spot_m = width_m / side;
            std::vector<render::SceneRay> rays;
            for (int i = 0; i < side * side; ++i) {
                const Vec3 at{-reach_m + (i % side + 0.5) * spot_m, -reach_m + (i / side + 0.5) * spot_m, 0.0};
                if (!(chord_m(at, up, a, h) > 0.0)) continue;
                const Vec3 origin{157.0, 157.0, 0.0};
                rays.push_back({origin + at + (10.0 / mu) * up, origin + at - (1.0 / mu) * up});
            }
            const auto image = render::render_image(scene.scene(), nullptr, rays_request(rays, false));
            for (std::size_t r = 0; r < rays.size(); ++r) {
                if (!(image.coverage[r] > 0.0F)) continue;
                for (std::size_t l = 0; l < n; ++l)
                    flux[l] += 2.0 * static_cast<double>(image.radiance_W_m2_sr_um[l * rays.size() + r]) * spot_m * spot_m *
                               mu * solid_sr;
            }
            // Volume: emission at x that leaves along the direction, B (-d tau / ds) at the distance to the surface.
            constexpr int kCells = 50;
            const auto edge = [](int i) { return 0.5 - 0.5 * std::cos(kPi * i / kCells); };  // dense at the faces
            for (int i = 0; i < kCells * kCells * kCells; ++i) {
                const std::array<int, 3> cell{i % kCells, i / kCells % kCells, i / (kCells * kCells)};
                std::array<double, 3> middle{}, width{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double size = axis == 2 ? h : a;
                    middle[axis] = 0.5 * size * (edge(cell[axis]) + edge(cell[axis] + 1));
                    width[axis] = size * (edge(cell[axis] + 1) - edge(cell[axis]));
                }
                const double out_m = exit_m({middle[0], middle[1], middle[2]}, up, a, h);
                const int node = std::min(static_cast<int>(kNodes * std::sqrt(out_m / longest_m)), kNodes - 1);
                const double each = 2.0 * solid_sr * width[0] * width[1] * width[2] / (node_m(node + 1) - node_m(node));
                for (std::size_t l = 0; l < n; ++l)
                    net[l] += each * (tau[l][static_cast<std::size_t>(node)] - tau[l][static_cast<std::size_t>(node) + 1]);
            }
        }
    EXPECT_NEAR(shadow_m2_sr / (kPi * (2.0 * a * a + 4.0 * a * h)), 1.0, 0.02);
    int black = 0, grey = 0;
    for (std::size_t l = 0; l < n; ++l) {
        const double B = planck_radiance(kLambda_um[l], T_K), metre = tau[l][130], decimetre = tau[l][kNodes / 10];
        if (decimetre < 1e-3) {  // line centres: a black body of the box's shadow
            EXPECT_NEAR(flux[l] / (B * shadow_m2_sr), 1.0, 0.01) << kLambda_um[l];
            ++black;
        } else if (metre > 0.01) {  // thicker, and the volume integral lacks the skin
            EXPECT_NEAR(flux[l] / (net[l] * B), 1.0, 0.01) << kLambda_um[l];
            ++grey;
        }
    }
    EXPECT_EQ(black, 3);
    EXPECT_EQ(grey, 12);
}

}  // namespace
}  // namespace pyroscene::test
