// Rays are marched through smoke at a few nodes along wavelength: many wavelengths together against each of them alone, which
// is its own node.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/test_scene.h"
#include "radiometry/smoke.h"
#include "radiometry/soot.h"
#include "render/pixel.h"
#include "source_folder.h"

namespace pyroscene::test {
namespace {

using render::Term;

/// A column of smoke, denser and warmer below, over and around a flame of soot, by day.
TestScene smoky_scene(const std::vector<double>& lambda_um) {
    TestScene scene({.ground_K = 310.0, .lambda_um = lambda_um, .reflectance = 0.2});
    static const auto smoke =
        radiometry::load_smoke_optics(source_folder() / "data/optical/smoke_optics_fine.csv", "savanna");
    static const auto soot = radiometry::load_soot_optics(source_folder() / "data/optical/soot_optics.csv");
    std::vector<float> absorption;
    for (const double lambda : lambda_um) {
        const auto at = radiometry::smoke_coefficients(smoke, lambda, 1.0);
        scene.optics.smoke_extinction_per_m.push_back(static_cast<float>(at.extinction_per_m));
        scene.optics.smoke_albedo.push_back(static_cast<float>(at.single_scattering_albedo));
        scene.optics.smoke_asymmetry.push_back(static_cast<float>(at.asymmetry));
        absorption.push_back(static_cast<float>(radiometry::soot_absorption_per_m(soot, lambda, 2e-7)));
        scene.atmosphere.direct_normal_irradiance_W_m2_um[scene.optics.smoke_albedo.size() - 1] =
            static_cast<float>(1500.0 * std::exp(-lambda));
    }
    scene.set_sky(280.0);
    scene.set_absorption(absorption);
    scene.to_sun = {0.5, 0.0, std::sqrt(0.75)};
    scene.set_flame({.corner_m = {60.0, 60.0, 0.0}, .nx = 8, .ny = 8, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 2.0},
                    box_of_voxels(8, 8, 6, 1100.0));
    std::vector<fire::FlameVoxel> voxels;
    for (int k = 0; k < 12; ++k)
        for (int n = 0; n < 64; ++n)
            voxels.push_back({n % 8, n / 8, k, 0.02F / static_cast<float>(k + 1), 400.0F - 8.0F * static_cast<float>(k)});
    scene.plume = fire::make_flame_field(
        {.corner_m = {40.0, 40.0, 0.0}, .nx = 8, .ny = 8, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 10.0}, voxels);
    scene.optics.smoke_multiple_scattering = false;  // its own nodes differ between the two scenes
    return scene;
}

TEST(SmokeNodes, ManyWavelengthsAgreeWithEachAlone) {
    std::vector<double> lambda_um;
    for (int i = 0; i < 400; ++i) lambda_um.push_back(0.4 * std::pow(35.0, i / 399.0));
    const render::SceneRay through_flame{{80.0, 75.0, 400.0}, {82.0, 76.0, -1.0}},
        beside{{45.0, 75.0, 400.0}, {45.0, 70.0, -1.0}};
    const TestScene all = smoky_scene(lambda_um);
    const auto together = render::render_image(all.scene(), nullptr, rays_request({through_flame, beside}));
    const auto scene = all.scene();
    render::SmokeRun run;
    render::PreparedScene(scene, nullptr).smoke->nodes.set(run);
    EXPECT_LT(run.node.n, 200);  // otherwise nothing is interpolated
    for (std::size_t l = 0; l < lambda_um.size(); l += 13) {
        SCOPED_TRACE(lambda_um[l]);
        const auto alone =
            render::render_image(smoky_scene({lambda_um[l]}).scene(), nullptr, rays_request({through_flame, beside}));
        for (std::size_t ray = 0; ray < 2; ++ray) {
            const double total = alone.radiance_W_m2_sr_um[ray];
            for (const Term term : {Term::SmokeScattering, Term::SmokeEmission, Term::FlameEmission, Term::GroundEmission}) {
                const auto t = static_cast<std::size_t>(term);
                EXPECT_NEAR(together.terms[t][2 * l + ray] / total, alone.terms[t][ray] / total, 2e-3)
                    << static_cast<int>(t);
            }
            EXPECT_NEAR(together.radiance_W_m2_sr_um[2 * l + ray] / total, 1.0, 2e-3);
        }
    }
}

}  // namespace
}  // namespace pyroscene::test
