// Light of flames on the ground against closed forms: view factors, the inverse square, energy, shadows, the furnace.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/constants.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

using radiometry::planck_radiance;

float irradiance_at(const render::GroundIrradiance& light, int row, int col) {
    const auto r = light.row_of_cell[light.grid.index(row, col)];
    return r < 0 ? 0.0F : light.irradiance_W_m2_um[static_cast<std::size_t>(r) * static_cast<std::size_t>(light.stride)];
}

/// View factor from a point on flat ground to a wall of height h and half width w that stands at distance d and faces it:
///   F = [atan(w/d) - d / sqrt(d^2 + h^2) atan(w / sqrt(d^2 + h^2))] / pi      (both halves; Howell, configuration B-4)
double wall_view_factor(double d, double h, double w) {
    const double slant = std::hypot(d, h);
    return (std::atan(w / d) - d / slant * std::atan(w / slant)) / kPi;
}

TEST(GroundLight, WallOfFlameHasItsViewFactor) {
    // An opaque wall along the eastern side, 20 m high, 400 m long, in front of columns of receiver cells of 5 m.
    for (const double voxel_m : {20.0, 4.0, 1.0}) {
        TestScene scene({.cols = 40, .rows = 80, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 100.0});
        const int nx = std::max(1, static_cast<int>(std::lround(4.0 / voxel_m)));
        const int ny = static_cast<int>(std::lround(400.0 / voxel_m)), nz = static_cast<int>(std::lround(20.0 / voxel_m));
        scene.set_flame(
            {.corner_m = {150.0, 0.0, 0.0}, .nx = nx, .ny = ny, .dx_m = voxel_m, .dy_m = voxel_m, .dz_m = voxel_m},
            box_of_voxels(nx, ny, nz, 1000.0));
        const auto light = render::ground_irradiance(scene.scene(), {});
        const double emitted = kPi * planck_radiance(4.0, 1000.0);
        for (const int col : {0, 10, 20, 26, 28}) {
            const double distance_m = 150.0 - (col + 0.5) * 5.0;
            EXPECT_NEAR(irradiance_at(light, 40, col) / (emitted * wall_view_factor(distance_m, 20.0, 200.0)), 1.0, 0.01)
                << "at " << distance_m << " m, voxels of " << voxel_m << " m";
        }
    }
}

TEST(GroundLight, DiskOfFlameOverheadHasItsViewFactor) {
    // An opaque disk of radius R at height h, parallel to the ground, seen from below at distance a from its axis (Howell,
    // configuration B-13):  F = (1 - (1 + H^2 - r^2) / sqrt((1 + H^2 + r^2)^2 - 4 r^2)) / 2,  H = h / a, r = R / a.
    const double radius_m = 40.0, height_m = 50.0;
    TestScene scene({.cols = 41, .rows = 41, .cell_m = 4.0, .ground_K = 300.0, .absorption_per_m = 100.0});
    std::vector<fire::FlameVoxel> disk;
    for (int j = 0; j < 80; ++j)
        for (int i = 0; i < 80; ++i)
            if (std::hypot(i + 0.5 - 40.0, j + 0.5 - 40.0) < radius_m) disk.push_back({i, j, 0, 1.0F, 1000.0F});
    scene.set_flame({.corner_m = {42.0, 42.0, height_m}, .nx = 80, .ny = 80, .dx_m = 1.0, .dy_m = 1.0, .dz_m = 0.25}, disk);
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 256, .reach_m = 150.0});
    for (const int off : {0, 5, 10, 17}) {  // cells of 4 m east of the axis
        const double a = std::max(4.0 * off, 1e-3), H2 = height_m * height_m / (a * a), r2 = radius_m * radius_m / (a * a);
        const double F = 0.5 * (1.0 - (1.0 + H2 - r2) / std::sqrt((1.0 + H2 + r2) * (1.0 + H2 + r2) - 4.0 * r2));
        EXPECT_NEAR(irradiance_at(light, 20, 20 + off) / (kPi * planck_radiance(4.0, 1000.0) * F), 1.0, 0.01) << a << " m";
    }
}

TEST(GroundLight, WallOfFlameWithinOnePercent) {
    // The wall of the test above with as many directions as the claim needs, and away from its foot.
    TestScene scene({.cols = 40, .rows = 80, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 100.0});
    scene.set_flame({.corner_m = {150.0, 0.0, 0.0}, .nx = 1, .ny = 100, .dx_m = 4.0, .dy_m = 4.0, .dz_m = 4.0},
                    box_of_voxels(1, 100, 5, 1000.0));
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 256});
    for (const int col : {0, 10, 20, 26}) {
        const double distance_m = 150.0 - (col + 0.5) * 5.0;
        EXPECT_NEAR(
            irradiance_at(light, 40, col) / (kPi * planck_radiance(4.0, 1000.0) * wall_view_factor(distance_m, 20.0, 200.0)),
            1.0, 0.01)
            << distance_m;
    }
}

TEST(GroundLight, SlopesTurnedToTheWallReceiveMore) {
    // Ground rising 20 degrees towards the south: its normal leans north. A long high wall in the north fills all that
    // is north of the zenith: F = (1 + cos a) / 2 with a the angle between normal and wall plane seen from above.
    TestScene scene({.cols = 81, .rows = 21, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 100.0});
    const double slope = std::tan(20.0 * kDegree_rad);
    scene.set_heights([&](double, double y) { return 40.0 - slope * y; });
    scene.set_flame({.corner_m = {-2000.0, 80.0, -100.0}, .nx = 880, .ny = 1, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 50.0},
                    box_of_voxels(880, 1, 80, 1000.0));
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 128, .reach_m = 4000.0});
    // Seen from the slope the wall fills a lune between the horizon of the slope and the zenith: angle 90 + 20 degrees.
    const double expected = (1.0 - std::cos(110.0 * kDegree_rad)) / 2.0;
    EXPECT_NEAR(irradiance_at(light, 10, 40) / (kPi * planck_radiance(4.0, 1000.0)), expected, 0.02 * expected);
}

/// How irradiance at receivers more than `gap_m` away from a point on the map compares with what `expected` says.
struct Deviation {
    double mean = 0.0, rms = 0.0, worst = 0.0;
};
template <class Expected>
Deviation deviation(const render::GroundIrradiance& light, Vec3 from_m, double gap_m, Expected&& expected) {
    Deviation all;
    double count = 0.0;
    for (int row = 0; row < light.grid.rows; ++row) {
        for (int col = 0; col < light.grid.cols; ++col) {
            const double x_m = (col + 0.5) * light.grid.cell_m, y_m = (light.grid.rows - row - 0.5) * light.grid.cell_m;
            if (std::hypot(x_m - from_m.x, y_m - from_m.y) < gap_m) continue;
            const double error = irradiance_at(light, row, col) / expected(row, col, x_m, y_m) - 1.0;
            all.mean += error, all.rms += error * error, count += 1.0;
            all.worst = std::max(all.worst, std::abs(error));
        }
    }
    return {all.mean / count, std::sqrt(all.rms / count), all.worst};
}

TEST(GroundLight, FarThinFlameFollowsTheInverseSquare) {
    // One voxel, optically thin: it radiates k V B into every direction; on the ground E = I cos(theta) / r^2.
    constexpr double kPerMetre = 1e-4;
    for (const double size_m : {4.0, 1.0}) {
        for (const double bottom_m : {20.0, 0.0}) {
            TestScene scene({.cols = 70, .rows = 50, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = kPerMetre});
            const Vec3 middle{152.0, 122.0, bottom_m + size_m / 2.0}, half{size_m / 2.0, size_m / 2.0, size_m / 2.0};
            const std::vector<fire::FlameVoxel> one{{0, 0, 0, 1.0F, 1000.0F}};
            scene.set_flame({.corner_m = middle - half, .nx = 1, .ny = 1, .dx_m = size_m, .dy_m = size_m, .dz_m = size_m},
                            one);
            const auto light = render::ground_irradiance(scene.scene(), {});
            const double intensity = kPerMetre * size_m * size_m * size_m * planck_radiance(4.0, 1000.0);
            const auto error = deviation(light, middle, 20.0, [&](int, int, double x_m, double y_m) {
                const double r = length(middle - Vec3{x_m, y_m, 0.0});
                return intensity * middle.z / (r * r * r);
            });
            EXPECT_LT(std::abs(error.mean), 2e-3) << size_m << " m, " << bottom_m << " m above ground";
            EXPECT_LT(error.rms, 5e-3) << size_m << " m, " << bottom_m << " m above ground";
            EXPECT_LT(error.worst, 0.015) << size_m << " m, " << bottom_m << " m above ground";
        }
    }
}

TEST(GroundLight, FarUnevenFlameIsSeenByFewPlanes) {
    // Some 160 columns of unlike height and fill in 40 m x 40 m: the default against many times as many planes.
    TestScene scene({.cols = 40, .rows = 40, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 0.3});
    std::vector<fire::FlameVoxel> voxels;
    for (int n = 0; n < 400; ++n) {
        if (n * 7919 % 101 < 60) continue;
        const int height = 1 + n * 31 % 37 % 8;
        for (int k = 0; k < height; ++k)
            voxels.push_back({n % 20, n / 20, k, 0.3F + 0.1F * static_cast<float>((n + k) * 13 % 8),
                              1200.0F - 60.0F * static_cast<float>(k)});
    }
    scene.set_flame({.corner_m = {150.0, 150.0, 0.0}, .nx = 20, .ny = 20, .dx_m = 2.0, .dy_m = 2.0, .dz_m = 1.0}, voxels);
    const auto fine = render::ground_irradiance(scene.scene(), {.directions = 2048});
    struct Bound {
        int directions;
        double mean, rms;
    };
    for (const Bound& bound : {Bound{64, 0.01, 0.04}, Bound{128, 3e-3, 0.015}, Bound{256, 2e-3, 6e-3}}) {
        const auto light = render::ground_irradiance(scene.scene(), {.directions = bound.directions});
        const auto error = deviation(light, {170.0, 170.0, 0.0}, 60.0,
                                     [&](int row, int col, double, double) { return irradiance_at(fine, row, col); });
        EXPECT_LT(std::abs(error.mean), bound.mean) << bound.directions;
        EXPECT_LT(error.rms, bound.rms) << bound.directions;
    }
}

TEST(GroundLight, HalfOfAThinFlamesPowerReachesTheGround) {
    // Sum over the plane: 4 pi k V B (1 - h / sqrt(h^2 + R^2)) / 2 within radius R of a small flame at height h.
    for (const double cell_m : {20.0, 7.0}) {
        const int cells = static_cast<int>(std::lround(420.0 / cell_m));
        TestScene scene({.cols = cells, .rows = cells, .cell_m = cell_m, .ground_K = 300.0, .absorption_per_m = 0.01});
        const std::vector<fire::FlameVoxel> one{{0, 0, 0, 1.0F, 1000.0F}};
        const double middle = 0.5 * cells * cell_m, height_m = 9.0;
        scene.set_flame({.corner_m = {middle - 1.5, middle - 1.5, height_m - 1.5},
                         .nx = 1,
                         .ny = 1,
                         .dx_m = 3.0,
                         .dy_m = 3.0,
                         .dz_m = 3.0},
                        one);
        const double reach_m = 180.0;
        const auto light = render::ground_irradiance(scene.scene(), {.directions = 256, .reach_m = reach_m});
        double power = 0.0;
        for (int r = 0; r < cells; ++r) {
            for (int c = 0; c < cells; ++c) power += irradiance_at(light, r, c) * cell_m * cell_m;
        }
        const double emitted = 4.0 * kPi * 0.01 * 27.0 * planck_radiance(4.0, 1000.0);
        EXPECT_NEAR(power / (emitted * 0.5 * (1.0 - height_m / std::hypot(height_m, reach_m))), 1.0, 0.03) << cell_m;
    }
}

TEST(GroundLight, OpaqueFlameOverheadIsAWholeSky) {
    TestScene scene({.cols = 9, .rows = 9, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 10.0});
    scene.set_flame({.corner_m = {-2000.0, -2000.0, 1.0}, .nx = 10, .ny = 10, .dx_m = 410.0, .dy_m = 410.0, .dz_m = 4.0},
                    box_of_voxels(10, 10, 2, 900.0));
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 64, .reach_m = 1900.0});
    EXPECT_NEAR(irradiance_at(light, 4, 4) / (kPi * planck_radiance(4.0, 900.0)), 1.0, 1e-4);
}

TEST(GroundLight, RidgeHidesTheFlameBehindIt) {
    TestScene scene({.cols = 60, .rows = 9, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 1.0});
    const fire::VoxelGrid grid{.corner_m = {500.0, 0.0, 0.0}, .nx = 1, .ny = 9, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 2.0};
    scene.set_flame(grid, box_of_voxels(1, 9, 5, 1100.0));
    const auto open = render::ground_irradiance(scene.scene(), {});
    EXPECT_GT(irradiance_at(open, 4, 20), 0.5F);
    scene.set_heights([](double x, double) { return std::abs(x - 400.0) < 11.0 ? 30.0 : 0.0; });
    const auto hidden = render::ground_irradiance(scene.scene(), {});
    EXPECT_EQ(irradiance_at(hidden, 4, 20), 0.0F);  // far behind the ridge
    EXPECT_GT(irradiance_at(hidden, 4, 45), 1.0F);  // between ridge and flame
}

TEST(GroundLight, OfAWallBehindARidgeTheTopIsSeen) {
    // The ridge hides the wall up to the line of sight over its crest, which is as high all along the wall. The crest is sharper
    // than the cells, and lines of sight are askew to them.
    TestScene scene({.cols = 60, .rows = 160, .cell_m = 5.0, .ground_K = 300.0, .absorption_per_m = 100.0});
    const double crest_m = 20.0, crest_x_m = 102.5;
    scene.set_heights([&](double x, double) { return std::max(0.0, crest_m * (1.0 - std::abs(x - crest_x_m) / 7.0)); });
    scene.set_flame({.corner_m = {150.0, 0.0, 0.0}, .nx = 1, .ny = 200, .dx_m = 4.0, .dy_m = 4.0, .dz_m = 1.0},
                    box_of_voxels(1, 200, 60, 1000.0));
    const auto light = render::ground_irradiance(scene.scene(), {.reach_m = 1000.0});
    for (const int col : {0, 3, 6, 9}) {
        const double x_m = (col + 0.5) * 5.0, away_m = 150.0 - x_m;
        const double F =
            wall_view_factor(away_m, 60.0, 400.0) - wall_view_factor(away_m, crest_m * away_m / (crest_x_m - x_m), 400.0);
        EXPECT_NEAR(irradiance_at(light, 80, col) / (kPi * planck_radiance(4.0, 1000.0) * F), 1.0, 0.01) << x_m << " m";
    }
}

TEST(GroundLight, SlopesSeeTheHotFootOfAWallInProportion) {
    // A long opaque wall whose lowest four metres are hot and the rest cold, on ground that rises from it. Between angles a and b
    // above the receiver's own surface a strip without end has the view factor (cos a - cos b) / 2.
    for (const double slope : {0.0, 0.15, 0.3}) {
        TestScene scene(
            {.cols = 40, .rows = 9, .cell_m = 5.0, .ground_K = 300.0, .lambda_um = {1.0}, .absorption_per_m = 100.0});
        scene.set_heights([&](double x, double) { return slope * (x - 100.0); });
        auto wall = box_of_voxels(1, 80, 16, 1200.0);
        for (auto& voxel : wall)
            if (voxel.k >= 4) voxel.temperature_K = 600.0F;
        scene.set_flame({.corner_m = {99.0, -1977.5, 0.0}, .nx = 1, .ny = 80, .dx_m = 1.0, .dy_m = 50.0, .dz_m = 1.0}, wall);
        const auto light = render::ground_irradiance(scene.scene(), {.directions = 1024, .reach_m = 2500.0});
        for (const int col : {22, 23, 26}) {
            const double away_m = (col + 0.5) * 5.0 - 100.0, up_m = slope * away_m;
            const double own = std::atan(slope), hot = std::atan((4.0 - up_m) / away_m) + own;
            const double F = 0.5 * (1.0 - std::cos(hot));
            EXPECT_NEAR(irradiance_at(light, 4, col) / (kPi * planck_radiance(1.0, 1200.0) * F), 1.0, 0.015)
                << slope << ", " << away_m << " m";
        }
    }
}

TEST(GroundLight, FlameThatStandsOnTheGroundIsSeenFromUnderIt) {
    // In the middle of a wide opaque block: the black body's pi B, whether the voxels begin at the ground or below it.
    for (const double bottom_m : {0.0, -2.0}) {
        TestScene scene({.cols = 9, .rows = 9, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 10.0});
        scene.set_flame({.corner_m = {0.0, 0.0, bottom_m}, .nx = 9, .ny = 9, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 4.0},
                        box_of_voxels(9, 9, 5, 900.0));
        const auto light = render::ground_irradiance(scene.scene(), {});
        EXPECT_NEAR(irradiance_at(light, 4, 4) / (kPi * planck_radiance(4.0, 900.0)), 1.0, 1e-4) << bottom_m;
    }
}

TEST(GroundLight, InterpolatedReceiversAreAsGoodAsTracedOnes) {
    // A bent front of uneven flames. Ground that is off level by two millimetres in one corner is traced cell by cell.
    TestScene scene({.cols = 100, .rows = 90, .cell_m = 20.0});
    std::vector<fire::FlameVoxel> voxels;
    for (int i = 0; i < 40; ++i) {
        const int j = 20 + i * i / 100, height = 2 + i * 7 % 5;
        for (int k = 0; k < height; ++k) voxels.push_back({i, j, k, 1.0F, static_cast<float>(1150 - 30 * k)});
    }
    scene.set_flame({.corner_m = {400.0, 400.0, 0.0}, .nx = 50, .ny = 50, .dx_m = 20.0, .dy_m = 20.0, .dz_m = 5.0}, voxels);
    const auto level = render::ground_irradiance(scene.scene(), {.reach_m = 5000.0});
    scene.set_heights([](double x, double y) { return x < 20.0 && y < 20.0 ? 2e-3 : 0.0; });
    const auto traced = render::ground_irradiance(scene.scene(), {.reach_m = 5000.0});
    const auto fine = render::ground_irradiance(scene.scene(), {.directions = 1024, .reach_m = 5000.0});
    const auto error = [&](const render::GroundIrradiance& light) {
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (int r = 0; r < 87; ++r) {
            for (int c = 0; c < 100; ++c) {
                const double relative = irradiance_at(light, r, c) / irradiance_at(fine, r, c) - 1.0;
                sum += relative, squares += relative * relative, count += 1.0;
            }
        }
        return std::array<double, 2>{sum / count, std::sqrt(squares / count)};
    };
    const auto [mean, rms] = error(level);
    const auto [traced_mean, traced_rms] = error(traced);
    EXPECT_LT(std::abs(mean), 0.01);
    EXPECT_LT(rms, 0.09);
    EXPECT_LT(rms, traced_rms);
}

TEST(GroundLight, ReachBoundsTheReceivers) {
    TestScene scene({.cols = 60, .rows = 9, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 1.0});
    scene.set_flame({.corner_m = {500.0, 0.0, 0.0}, .nx = 1, .ny = 9, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 2.0},
                    box_of_voxels(1, 9, 5, 1100.0));
    const auto light = render::ground_irradiance(scene.scene(), {.directions = 64, .reach_m = 100.0});
    EXPECT_EQ(light.row_of_cell[light.grid.index(4, 38)], -1);
    EXPECT_GE(light.row_of_cell[light.grid.index(4, 42)], 0);
    scene.flame = {};
    const auto none = render::ground_irradiance(scene.scene(), {});
    EXPECT_TRUE(none.irradiance_W_m2_um.empty());
    EXPECT_EQ(none.row_of_cell.size(), 540U);
}

TEST(GroundLight, ColouredFlameMatchesGreyFlamesOneByOne) {
    // Traced at a few absorption nodes and interpolated: each wavelength must agree with a grey flame of its own k.
    const std::vector<double> lambda_um{0.9, 1.3, 2.0, 4.0, 10.0};
    const std::vector<float> k{1.3F, 0.8F, 0.5F, 0.2F, 0.03F};
    const auto make = [&](double absorption) {
        TestScene scene({.cols = 12,
                         .rows = 12,
                         .cell_m = 10.0,
                         .ground_K = 300.0,
                         .lambda_um = lambda_um,
                         .absorption_per_m = absorption});
        std::vector<fire::FlameVoxel> voxels;
        for (int j = 0; j < 12; ++j) {
            for (int n = 0; n < 8; ++n) voxels.push_back({11 + n / 3, j, n, 0.8F, static_cast<float>(1150 - 35 * n)});
        }
        scene.set_flame({.corner_m = {}, .nx = 24, .ny = 12, .dx_m = 5.0, .dy_m = 10.0, .dz_m = 1.5}, voxels);
        return scene;
    };
    TestScene coloured = make(0.1);
    coloured.set_absorption(k);
    const auto all = render::ground_irradiance(coloured.scene(), {});
    for (std::size_t l = 0; l < lambda_um.size(); ++l) {
        const auto single = render::ground_irradiance(make(k[l]).scene(), {});
        for (std::size_t row = 0; row < 144; ++row) {
            const double expected = single.irradiance_W_m2_um[row * static_cast<std::size_t>(single.stride) + l];
            EXPECT_NEAR(all.irradiance_W_m2_um[row * static_cast<std::size_t>(all.stride) + l], expected,
                        3e-3 * expected + 1e-6);
        }
    }
}

TEST(GroundLight, SkyIsDimmedByTheFlameInFrontOfIt) {
    // Transmittance of a thin flame over the whole sky seen from its middle: 1 - E_flame / (pi B), whatever the geometry.
    TestScene scene({.cols = 8, .rows = 8, .cell_m = 20.0, .ground_K = 300.0, .absorption_per_m = 0.02});
    scene.set_sky(280.0);
    scene.atmosphere.diffuse_irradiance_W_m2_um = {0.5F};
    scene.set_flame({.corner_m = {}, .nx = 16, .ny = 16, .dx_m = 10.0, .dy_m = 10.0, .dz_m = 5.0},
                    box_of_voxels(16, 16, 4, 1100.0));
    const auto light = render::ground_irradiance(scene.scene(), {});
    const double through = 1.0 - irradiance_at(light, 4, 4) / (kPi * planck_radiance(4.0, 1100.0));
    EXPECT_GT(through, 0.2);
    EXPECT_LT(through, 0.8);
    const auto row =
        static_cast<std::size_t>(light.row_of_cell[light.grid.index(4, 4)]) * static_cast<std::size_t>(light.stride);
    EXPECT_NEAR(light.sky_irradiance_W_m2_um[row] / (0.5 * through), 1.0, 3e-3);
    EXPECT_NEAR(light.thermal_irradiance_W_m2_um[row] / (kPi * planck_radiance(4.0, 280.0) * through), 1.0, 3e-3);
}

TEST(GroundLight, BurningSlopesLightEachOther) {
    // A V-shaped valley whose eastern slope burns: the western one receives its glow, as light of the fire and not of the sky.
    TestScene scene({.cols = 20, .rows = 9, .cell_m = 10.0, .ground_K = 300.0, .absorption_per_m = 0.3});
    scene.set_heights([](double x, double) { return std::abs(x - 100.0); });
    for (int r = 0; r < 9; ++r) {
        for (int c = 12; c < 20; ++c) {
            const auto cell = scene.surface.grid.index(r, c);
            scene.surface.burned[cell] = 1;
            scene.surface.base_temperature_K[cell] = 900.0F;  // a scar that glows fills what does not flame
            scene.surface.front_fraction[cell] = 0.75F;
        }
    }
    const std::vector<fire::FlameVoxel> spark{{0, 0, 0, 0.001F, 1000.0F}};
    scene.set_flame({.corner_m = {100.0, 40.0, 30.0}, .nx = 1, .ny = 1, .dx_m = 2.0, .dy_m = 2.0, .dz_m = 2.0}, spark);
    const auto light = render::ground_irradiance(scene.scene(), {});
    const auto thermal_at = [&](int col) {
        return light.thermal_irradiance_W_m2_um[static_cast<std::size_t>(light.row_of_cell[light.grid.index(4, col)]) *
                                                static_cast<std::size_t>(light.stride)];
    };
    EXPECT_GT(irradiance_at(light, 4, 5), 0.05 * kPi * planck_radiance(4.0, 1073.15));
    EXPECT_LT(irradiance_at(light, 4, 5), 0.5 * kPi * planck_radiance(4.0, 1073.15));
    EXPECT_LT(irradiance_at(light, 4, 15), 1e-2F * irradiance_at(light, 4, 5));  // the burning slope faces cold ground
    for (const int col : {5, 15}) EXPECT_LT(thermal_at(col), kPi * planck_radiance(4.0, 300.0)) << col;
}

}  // namespace
}  // namespace pyroscene::test
