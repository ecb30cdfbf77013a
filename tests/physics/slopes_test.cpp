// Slopes that hide the sky from each other and light each other, and flames as point sources, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"
#include "render/scene_tables.h"
#include "render/sky_view.h"
#include "render/terrain_sight.h"

namespace pyroscene::test {
namespace {

using radiometry::planck_radiance;

constexpr int kCols = 81, kRows = 601;
constexpr double kCell_m = 10.0;

/// A straight valley along y, its sides `slope` steep, 800 m wide and 6 km long.
TestScene valley(double slope_rad, double reflectance) {
    TestScene scene({.cols = kCols, .rows = kRows, .cell_m = kCell_m, .ground_K = 280.0, .reflectance = reflectance});
    const double middle_m = 0.5 * kCols * kCell_m;
    scene.set_heights([&](double x, double) { return std::abs(x - middle_m) * std::tan(slope_rad); });
    return scene;
}

/// Share of the sky that a cell of one side sees: the valley is as good as endless, so the problem is plane. The other
/// side's rim stands at elevation e; between the own surface, a below the horizontal, and e all is terrain:
///   V = 1 - (1 - cos(a + e)) / 2
double sky_view_in_valley(double slope_rad, int col) {
    const double from_middle_m = (kCols / 2 - col) * kCell_m, rim_m = (kCols / 2 + 0.5) * kCell_m;
    const double e = std::atan((rim_m - from_middle_m) * std::tan(slope_rad) / (rim_m + from_middle_m));
    return 1.0 - (1.0 - std::cos(slope_rad + e)) / 2.0;
}

TEST(Slopes, SkyViewInAValley) {
    for (const double slope_deg : {15.0, 30.0, 45.0}) {
        const double slope_rad = slope_deg * kDegree_rad;
        const TestScene scene = valley(slope_rad, 0.3);
        const auto light = render::ground_irradiance(scene.scene(), {});
        for (const int col : {10, 20, 30, 37}) {
            EXPECT_NEAR(light.sky_view->at(light.grid.index(kRows / 2, col)), sky_view_in_valley(slope_rad, col), 0.025)
                << slope_deg << " degrees, column " << col;
        }
    }
}

// Cells are looked at in runs along a row; each sees what it sees from itself alone, at the rim of the map too.
TEST(Slopes, SkyViewIsThatOfEachCellByItself) {
    TestScene scene({.cols = 75, .rows = 50, .cell_m = 30.0});
    scene.set_heights([](double x, double y) {
        return 1200.0 + 90.0 * std::sin(x / 170.0) * std::cos(y / 230.0) + 25.0 * std::sin(x / 31.0 + y / 47.0);
    });
    const auto sky = render::ground_irradiance(scene.scene(), {}).sky_view;
    double least = 1.0;
    for (std::size_t cell = 0; cell < scene.heights.grid.size(); ++cell) {
        const double hidden_sr = render::hidden_by_terrain(*scene.scene().terrain, render::receiver_at(scene.scene(), cell),
                                                           1, [](Vec3, double) {});
        EXPECT_NEAR(sky->at(cell), 1.0 - hidden_sr / kPi, 5e-5) << cell;
        least = std::min(least, sky->at(cell));
    }
    EXPECT_LT(least, 0.95);
}

// Low flames under voxels that the ground cuts: seen from above, thin flame radiates k V B whatever the slope and wherever
// the ground lies between the faces of voxels.
TEST(Slopes, LowFlamesAreNotBuried) {
    for (const double slope : {0.0, 0.3, 1.0})
        for (const double z_m : {0.0, 0.37, 0.75}) {
            TestScene scene({.cols = 12, .rows = 12, .cell_m = 20.0, .ground_K = 300.0, .absorption_per_m = 1e-3});
            scene.set_heights([&](double x, double y) { return z_m + slope * (0.8 * x - 0.6 * y); });
            std::vector<fire::FlameColumn> columns;
            for (double x_m = 62.5; x_m < 180.0; x_m += 15.0)
                columns.push_back({.x_m = x_m,
                                   .y_m = 112.5,
                                   .z_m = scene.terrain->height_at(x_m, 112.5),
                                   .width_m = 5.0,
                                   .top_m = 0.4,
                                   .tilt_rad = 0.5,
                                   .azimuth_rad = 2.0,
                                   .temperature_K = 1100.0});
            const double volume_m3 = static_cast<double>(columns.size()) * 25.0 * 0.4;
            const fire::FlameGround ground{scene.heights, scene.origin_m};
            scene.flame = fire::voxelise(columns, {}, &ground);
            EXPECT_NEAR(scene.flame.emissive_volume_m3() / volume_m3, 1.0, 1e-5);
            constexpr double kStep_m = 0.5;
            std::vector<render::SceneRay> rays;
            for (double x_m = 40.2; x_m < 200.0; x_m += kStep_m)
                for (double y_m = 90.2; y_m < 140.0; y_m += kStep_m) rays.push_back({{x_m, y_m, 900.0}, {x_m, y_m, -400.0}});
            const auto image = render::render_image(scene.scene(), nullptr, rays_request(rays));
            double power = 0.0;
            for (const float L : image.terms[static_cast<std::size_t>(render::Term::FlameEmission)])
                power += static_cast<double>(L) * kStep_m * kStep_m;
            EXPECT_NEAR(power / (1e-3 * volume_m3 * planck_radiance(4.0, 1100.0)), 1.0, 0.02) << slope << ' ' << z_m;
        }
}

TEST(Slopes, PlaneGroundSeesTheWholeSky) {
    const TestScene scene({.cols = 8, .rows = 8});
    EXPECT_EQ(render::ground_irradiance(scene.scene(), {}).sky_view, nullptr);
    TestScene inclined({.cols = 8, .rows = 8});
    inclined.set_heights([](double x, double y) { return 0.3 * x - 0.2 * y; });
    // A raster that ends sees sky beyond its rim; nothing of it stands above its own plane.
    const auto open = render::ground_irradiance(inclined.scene(), {}).sky_view;
    for (std::size_t cell = 0; cell < inclined.heights.grid.size(); ++cell) EXPECT_NEAR(open->at(cell), 1.0, 2e-3);
}

TEST(Slopes, TheHiddenSkyIsReplacedByTerrain) {
    const double slope_rad = 30.0 * kDegree_rad, sky_K = 400.0, ground_K = 280.0, rho = 0.4;
    TestScene scene = valley(slope_rad, rho);
    scene.set_sky(sky_K);
    const auto light = render::ground_irradiance(scene.scene(), {});
    const double sky = planck_radiance(4.0, sky_K), own = (1.0 - rho) * planck_radiance(4.0, ground_K);
    for (const int col : {10, 30}) {
        const double x_m = (col + 0.5) * kCell_m, y_m = 0.5 * kRows * kCell_m;
        const double z_m = std::abs(x_m - 0.5 * kCols * kCell_m) * std::tan(slope_rad);
        const double open = sky_view_in_valley(slope_rad, col);
        const double expected = own + rho * (open * sky + (1.0 - open) * (own + rho * sky));
        const auto radiance = trace(scene, {{x_m, y_m, z_m + 2000.0}, {x_m, y_m, z_m - 10.0}}, &light);
        EXPECT_NEAR(radiance[0] / expected, 1.0, 0.015) << col;
    }
}

TEST(Slopes, ReflectionsBetweenTwoSlopesSumAGeometricSeries) {
    const double rho = 0.6, view_factor = 0.35;
    const TestScene scene({.cols = 4, .rows = 4, .reflectance = rho});
    const render::SceneTables tables(scene.scene());
    // Two rows that see each other only.
    const auto seen = static_cast<float>(kPi * view_factor / 4.0);
    std::vector<std::vector<render::TerrainPatch>> patches(2);
    for (int i = 0; i < 4; ++i) {
        patches[0].push_back({1, 0, seen});
        patches[1].push_back({0, 0, seen});
    }
    const auto values = 2 * static_cast<std::size_t>(tables.stride);
    for (const int bounces : {1, 2, 3, 8}) {
        for (const int decay : {1, 4}) {
            std::vector<float> irradiance(values, 2.0F), change = irradiance;
            render::reflect_between_slopes(tables, patches, std::vector<float>(values, 1.0F), bounces, decay, irradiance,
                                           change);
            const double q = rho * view_factor;
            EXPECT_NEAR(irradiance[0], 2.0 * (1.0 - std::pow(q, bounces)) / (1.0 - q), 1e-5) << bounces << ' ' << decay;
        }
    }
}

TEST(Slopes, FlameLightGrowsWithBouncesAndConverges) {
    TestScene scene(
        {.cols = 40, .rows = 60, .cell_m = 10.0, .ground_K = 300.0, .reflectance = 0.5, .absorption_per_m = 1.0});
    scene.set_heights([](double x, double) { return std::abs(x - 200.0); });
    scene.set_flame({.corner_m = {190.0, 0.0, 0.0}, .nx = 2, .ny = 60, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0},
                    box_of_voxels(2, 60, 6, 1100.0));
    std::vector<double> total;
    for (const int bounces : {1, 2, 3, 6}) {
        const auto light = render::ground_irradiance(scene.scene(), {.directions = 64, .bounces = bounces, .decay = 1});
        double sum = 0.0;
        for (const float e : light.irradiance_W_m2_um) sum += static_cast<double>(e);
        total.push_back(sum);
    }
    EXPECT_GT(total[1], 1.02 * total[0]);
    EXPECT_GT(total[2], total[1]);
    EXPECT_LT(total[3] - total[2], total[2] - total[1]);
    EXPECT_LT(total[3],
              total[0] / (1.0 - 0.5 * 0.5));  // half of the light is absorbed, at most half of the rest is seen again
}

TEST(Slopes, ThinFlamesAsPointSources) {
    TestScene scene({.cols = 60, .rows = 60, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 0.01});
    const std::vector<fire::FlameVoxel> one{{0, 0, 0, 1.0F, 1000.0F}};
    scene.set_flame({.corner_m = {150.0, 150.0, 20.0}, .nx = 1, .ny = 1, .dx_m = 4.0, .dy_m = 4.0, .dz_m = 4.0}, one);
    render::GroundLightSettings settings;
    settings.flames = render::GroundLightSettings::Flames::PointSources;
    const double intensity = 0.01 * 64.0 * planck_radiance(4.0, 1000.0);
    const auto at = [&](const render::GroundIrradiance& light, int col) {
        const auto row = static_cast<std::size_t>(light.row_of_cell[light.grid.index(33, col)]);
        return static_cast<double>(light.irradiance_W_m2_um[row * static_cast<std::size_t>(light.stride)]);
    };
    settings.point_source_cut = 0.0;
    const auto all = render::ground_irradiance(scene.scene(), settings);
    settings.point_source_cut = 1e-3;  // 31.6 m
    const auto near = render::ground_irradiance(scene.scene(), settings);
    for (const int col : {0, 10, 20, 28, 30, 40, 55}) {
        const Vec3 way = Vec3{152.0, 152.0, 22.0} - Vec3{(col + 0.5) * 5.0, (59 - 33 + 0.5) * 5.0, 0.0};
        const double r = length(way), expected = intensity * way.z / (r * r * r);
        EXPECT_NEAR(at(all, col) / expected, 1.0, 0.01) << col;
        if (r > 38.0) {
            EXPECT_EQ(at(near, col), 0.0) << col;
        }
        if (r < 28.0) {
            EXPECT_NEAR(at(near, col) / expected, 1.0, 0.01) << col;
        }
    }
}

TEST(Slopes, DoublingTheDirectionsTellsTheError) {
    TestScene scene({.cols = 40, .rows = 40, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 0.5});
    scene.set_flame({.corner_m = {100.0, 60.0, 0.0}, .nx = 2, .ny = 20, .dx_m = 4.0, .dy_m = 4.0, .dz_m = 2.0},
                    box_of_voxels(2, 20, 4, 1100.0));
    double last = 1.0;
    for (const int directions : {64, 256, 1024}) {
        const auto error =
            render::ground_irradiance(scene.scene(), {.directions = directions, .estimate_error = true}).sampling_error;
        EXPECT_GT(error.receivers, 100);
        EXPECT_LT(std::abs(error.total_relative), 0.02) << directions;
        EXPECT_LT(error.rms_relative, last) << directions;
        last = std::max(error.rms_relative, 1e-12);
    }
    EXPECT_LT(last, 0.01);
}

}  // namespace
}  // namespace pyroscene::test
