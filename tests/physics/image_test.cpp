// Images: truth planes, coverage, weights, threads, cancelling.

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

render::SceneRay down(double x, double y) { return {{x, y, 1000.0}, {x, y, -100.0}}; }

/// A lively small fire: front strip, scar, vegetation, leaning flames of many temperatures, hilly ground.
TestScene small_fire() {
    TestScene scene({.cols = 16,
                     .rows = 12,
                     .cell_m = 10.0,
                     .ground_K = 305.0,
                     .lambda_um = {1.6, 2.2, 4.0, 9.0, 11.0},
                     .reflectance = 0.2,
                     .absorption_per_m = 0.25});
    scene.set_heights([](double x, double y) { return 5.0 + 4.0 * std::sin(x / 25.0) + 0.05 * y; });
    for (int r = 0; r < 12; ++r) {
        for (int c = 0; c < 16; ++c) {
            const auto i = scene.surface.grid.index(r, c);
            scene.surface.burned[i] = c < 9 ? 1 : 0;
            scene.surface.front_fraction[i] = c == 8 ? 0.5F : 0.0F;
            if (c < 8) scene.surface.base_temperature_K[i] = 340.0F + 30.0F * static_cast<float>(c);
        }
    }
    std::vector<fire::FlameVoxel> voxels;
    for (int j = 0; j < 24; ++j) {
        for (int k = 0; k < 12; ++k) {
            const auto n = static_cast<std::uint64_t>(100 * j + k);
            voxels.push_back(
                {17 + k / 3, j, k + 2, 0.7F, static_cast<float>(1100.0 - 20.0 * k + 10.0 * uniform01({.seed = 2}, n))});
        }
    }
    scene.set_flame({.corner_m = {}, .nx = 32, .ny = 24, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 2.0}, voxels);
    scene.set_sky(260.0);
    return scene;
}

/// 4 sub-rays per pixel of 2 m, nadir.
render::ImageRequest nadir_request(int samples, int lines) {
    render::ImageRequest request;
    request.samples = samples;
    request.lines = lines;
    request.rays_per_pixel = 4;
    request.ray_weight = {0.4, 0.3, 0.2, 0.1};
    request.rays = [](int line, int begin, int end, std::span<render::SceneRay> out) {
        for (int s = begin; s < end; ++s) {
            for (int r = 0; r < 4; ++r) {
                out[static_cast<std::size_t>(4 * (s - begin) + r)] =
                    down(2.0 * s + 0.5 + r % 2, 119.0 - 2.0 * line + 0.5 * (r / 2));
            }
        }
    };
    request.view = [](int, int, Vec3) { return render::PixelView{}; };
    return request;
}

bool same_bytes(std::span<const float> a, std::span<const float> b) {
    const auto x = std::as_bytes(a), y = std::as_bytes(b);
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
}

TEST(Image, BytesDoNotDependOnTheNumberOfThreads) {
    for (const bool grey : {true, false}) {
        TestScene scene = small_fire();
        scene.optics.grey = grey;
        const auto render_with = [&](std::size_t threads) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const auto light = render::ground_irradiance(scene.scene(), {});
            auto image = render::render_image(scene.scene(), &light, nadir_request(70, 55));
            return std::pair(light, std::move(image));
        };
        const auto [light1, image1] = render_with(1);
        const auto [light4, image4] = render_with(4);
        EXPECT_TRUE(same_bytes(light1.irradiance_W_m2_um, light4.irradiance_W_m2_um));
        EXPECT_TRUE(same_bytes(light1.thermal_irradiance_W_m2_um, light4.thermal_irradiance_W_m2_um));
        EXPECT_EQ(light1.row_of_cell, light4.row_of_cell);
        EXPECT_TRUE(same_bytes(image1.radiance_W_m2_sr_um, image4.radiance_W_m2_sr_um));
        for (std::size_t t = 0; t < image1.terms.size(); ++t) EXPECT_TRUE(same_bytes(image1.terms[t], image4.terms[t])) << t;
        EXPECT_TRUE(same_bytes(image1.flame_fraction, image4.flame_fraction));
        EXPECT_TRUE(same_bytes(image1.radiant_exitance_W_m2, image4.radiant_exitance_W_m2));
    }
}

TEST(Image, IsTheSameInLinesAndAtOnce) {
    const TestScene test = small_fire();
    const auto scene = test.scene();
    const auto request = nadir_request(70, 55);
    const auto whole = render::render_image(scene, nullptr, request);
    const Monitor monitor;
    render::ImageRenderer renderer(scene, nullptr, request, monitor);
    render::RadianceImage lines;  // used again and again, for fewer lines at the end
    const std::size_t n = whole.coverage.size();
    for (int first = 0; first < 55; first += 16) {
        const int count = std::min(16, 55 - first);
        renderer.render(first, count, lines);
        ASSERT_EQ(lines.first_line, first);
        const std::size_t part = static_cast<std::size_t>(count) * 70, at = static_cast<std::size_t>(first) * 70;
        ASSERT_EQ(lines.coverage.size(), part);
        const auto same = [&](const auto& some, const auto& all, std::size_t planes) {
            bool equal = some.size() == part * planes;
            for (std::size_t b = 0; b < planes && equal; ++b)
                equal = std::memcmp(&some[b * part], &all[b * n + at], part * sizeof(some[0])) == 0;
            return equal;
        };
        const auto bands = static_cast<std::size_t>(whole.bands);
        EXPECT_TRUE(same(lines.radiance_W_m2_sr_um, whole.radiance_W_m2_sr_um, bands)) << first;
        EXPECT_TRUE(same(lines.terms[0], whole.terms[0], bands)) << first;
        EXPECT_TRUE(same(lines.hit_z_m, whole.hit_z_m, 1)) << first;
        EXPECT_TRUE(same(lines.radiant_exitance_W_m2, whole.radiant_exitance_W_m2, 1)) << first;
    }
}

TEST(Image, FractionsSumToOne) {
    const TestScene scene = small_fire();
    const auto image = render::render_image(scene.scene(), nullptr, nadir_request(70, 55));
    double flame = 0.0;
    for (std::size_t i = 0; i < image.coverage.size(); ++i) {
        EXPECT_NEAR(image.coverage[i], 1.0, 1e-6);
        EXPECT_NEAR(
            image.flame_fraction[i] + image.front_fraction[i] + image.scar_fraction[i] + image.background_fraction[i], 1.0,
            1e-6);
        flame += image.flame_fraction[i];
    }
    EXPECT_GT(flame, 10.0);
}

TEST(Image, RadianceWithoutTermsIsTheSame) {
    const TestScene scene = small_fire();
    auto request = nadir_request(40, 20);
    const auto with = render::render_image(scene.scene(), nullptr, request);
    request.terms = false;
    const auto without = render::render_image(scene.scene(), nullptr, request);
    EXPECT_TRUE(same_bytes(with.radiance_W_m2_sr_um, without.radiance_W_m2_sr_um));
    EXPECT_TRUE(without.terms[0].empty());
}

TEST(Image, PixelIsTheWeightedMeanOfItsRays) {
    const TestScene scene = small_fire();
    auto request = nadir_request(70, 1);
    request.terms = false;
    const auto whole = render::render_image(scene.scene(), nullptr, request);
    std::vector<render::SceneRay> rays(280);
    request.rays(0, 0, 70, rays);
    const auto single = render::render_image(scene.scene(), nullptr, rays_request(rays, false));
    for (std::size_t b = 0; b < 5; ++b) {
        for (std::size_t s = 0; s < 70; ++s) {
            double mean = 0.0;
            for (std::size_t r = 0; r < 4; ++r)
                mean += request.ray_weight[r] * single.radiance_W_m2_sr_um[b * 280 + 4 * s + r];
            EXPECT_NEAR(whole.radiance_W_m2_sr_um[b * 70 + s] / mean, 1.0, 2e-6);
        }
    }
}

TEST(Image, TruthOfAMixedPixel) {
    // Black ground: scar 500 K with a quarter of front 1073.15 K; half the rays on vegetation at ambient 300 K.
    TestScene scene({.cols = 2, .rows = 1, .cell_m = 10.0, .ground_K = 300.0});
    scene.surface.burned = {1, 0};
    scene.surface.front_fraction = {0.25F, 0.0F};
    scene.surface.base_temperature_K = {500.0F, 300.0F};
    auto request = rays_request({down(5.0, 5.0)});
    request.rays_per_pixel = 2;
    request.ray_weight = {0.5, 0.5};
    request.rays = [](int, int, int, std::span<render::SceneRay> out) {
        out[0] = down(5.0, 5.0);
        out[1] = down(15.0, 5.0);
    };
    const auto image = render::render_image(scene.scene(), nullptr, request);
    EXPECT_NEAR(image.front_fraction[0], 0.125, 1e-6);
    EXPECT_NEAR(image.scar_fraction[0], 0.375, 1e-6);
    EXPECT_NEAR(image.background_fraction[0], 0.5, 1e-6);
    const double front_T4 = std::pow(1073.15, 4), scar_T4 = std::pow(500.0, 4), cold_T4 = std::pow(300.0, 4);
    EXPECT_NEAR(image.ground_temperature_K[0], std::pow(0.125 * front_T4 + 0.375 * scar_T4 + 0.5 * cold_T4, 0.25), 1e-2);
    const double exitance = kStefanBoltzmann_W_m2_K4 * (0.125 * front_T4 + 0.375 * (scar_T4 - cold_T4));
    EXPECT_NEAR(image.radiant_exitance_W_m2[0] / exitance, 1.0, 1e-6);
    EXPECT_NEAR(image.hit_x_m[0], 10.0, 1e-6);
    const double expected = 0.125 * radiometry::planck_radiance(4.0, 1073.15) +
                            0.375 * radiometry::planck_radiance(4.0, 500.0) + 0.5 * radiometry::planck_radiance(4.0, 300.0);
    EXPECT_NEAR(image.radiance_W_m2_sr_um[0] / expected, 1.0, 2e-6);
}

TEST(Image, FlameTruthOfASlab) {
    TestScene scene({.ground_K = 60.0, .absorption_per_m = 0.1});
    scene.set_flame({.corner_m = {}, .nx = 2, .ny = 2, .dx_m = 80.0, .dy_m = 80.0, .dz_m = 5.0},
                    box_of_voxels(2, 2, 2, 1100.0));
    const auto image = render::render_image(scene.scene(), nullptr, rays_request({down(50.0, 50.0)}));
    const double opacity = 1.0 - std::exp(-1.0);
    EXPECT_NEAR(image.flame_fraction[0], opacity, 1e-6);
    EXPECT_NEAR(image.flame_temperature_K[0], 1100.0, 1e-2);
    EXPECT_NEAR(image.radiant_exitance_W_m2[0] / (opacity * kStefanBoltzmann_W_m2_K4 * std::pow(1100.0, 4)), 1.0, 1e-5);
}

TEST(Image, OutsideTheSceneIsNoData) {
    TestScene scene({.cols = 4, .rows = 4, .cell_m = 10.0, .ground_K = 300.0});
    scene.surface.base_temperature_K[scene.surface.grid.index(0, 0)] = NAN;  // north-west cell
    auto request = rays_request({down(20.0, 20.0), down(80.0, 20.0), down(5.0, 35.0)});
    const auto image = render::render_image(scene.scene(), nullptr, request);
    EXPECT_FALSE(std::isnan(image.radiance_W_m2_sr_um[0]));
    for (const std::size_t i : {1, 2}) {
        EXPECT_TRUE(std::isnan(image.radiance_W_m2_sr_um[i]));
        EXPECT_TRUE(std::isnan(image.hit_x_m[i]));
        EXPECT_TRUE(std::isnan(image.flame_fraction[i]));
        EXPECT_EQ(image.coverage[i], 0.0F);
    }
}

TEST(Image, PartlyCoveredPixelIsTheMeanOfWhatIsCovered) {
    TestScene scene({.cols = 2, .rows = 1, .cell_m = 10.0, .ground_K = 600.0});
    auto request = rays_request({down(5.0, 5.0)});
    request.rays_per_pixel = 2;
    request.ray_weight = {0.25, 0.75};
    request.rays = [](int, int, int, std::span<render::SceneRay> out) {
        out[0] = down(19.0, 5.0);
        out[1] = down(25.0, 5.0);
    };
    const auto image = render::render_image(scene.scene(), nullptr, request);
    EXPECT_NEAR(image.coverage[0], 0.25, 1e-6);
    EXPECT_NEAR(image.radiance_W_m2_sr_um[0] / radiometry::planck_radiance(4.0, 600.0), 1.0, 1e-6);
    EXPECT_NEAR(image.hit_x_m[0], 19.0, 1e-6);
}

TEST(Image, StopsWhenCancelledAndReportsProgress) {
    const TestScene scene = small_fire();
    std::atomic<bool> cancelled{true};
    Monitor monitor;
    monitor.cancelled = &cancelled;
    EXPECT_THROW((void)render::render_image(scene.scene(), nullptr, nadir_request(70, 55), monitor), Cancelled);
    EXPECT_THROW((void)render::ground_irradiance(scene.scene(), {}, monitor), Cancelled);
    cancelled = false;
    double last = 0.0;
    bool rises = true;
    monitor.progress = [&](double done) {
        rises = rises && done > last;
        last = done;
    };
    (void)render::render_image(scene.scene(), nullptr, nadir_request(70, 55), monitor);
    EXPECT_TRUE(rises);
    EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(Image, PartsThatDoNotFitAreRefused) {
    TestScene scene = small_fire();
    scene.optics.reflectance.pop_back();
    EXPECT_THROW((void)render::render_image(scene.scene(), nullptr, nadir_request(4, 4)), Error);
    TestScene strange = small_fire();
    strange.cover.values[0] = 9;
    EXPECT_THROW((void)render::render_image(strange.scene(), nullptr, nadir_request(4, 4)), Error);
    auto request = nadir_request(4, 4);
    request.ray_weight.pop_back();
    EXPECT_THROW((void)render::render_image(small_fire().scene(), nullptr, request), Error);
}

}  // namespace
}  // namespace pyroscene::test
