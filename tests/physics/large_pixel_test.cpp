// Pixels far wider than the fire in them: energy, rays spent, surroundings.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "physics/test_scene.h"
#include "radiometry/planck.h"

namespace pyroscene::test {
namespace {

/// Parallel light of one zenith angle onto square pixels of a box response, two strata along each axis.
struct Instrument {
    double pixel_m, west_m = 0.0, south_m = 0.0;
    int samples = 1, lines = 1;
    double zenith_rad = 0.0;

    [[nodiscard]] render::SceneRay ray(double x_m, double y_m) const {
        const double shift_m = 1000.0 * std::tan(zenith_rad);
        return {{x_m + shift_m, y_m, 1000.0}, {x_m - 0.01 * shift_m, y_m, -10.0}};
    }
    /// Share of a pixel from its south-west corner.
    [[nodiscard]] render::PartView view(int line, int sample, const render::PixelPart& p) const {
        const double width_m = std::ldexp(pixel_m / 2, -p.level_u), height_m = std::ldexp(pixel_m / 2, -p.level_v);
        const double x_m = west_m + sample * pixel_m + (p.index_u + 0.5) * width_m;
        const double y_m = south_m + (lines - line) * pixel_m - (p.index_v + 0.5) * height_m;
        return {ray(x_m, y_m), {width_m, 0.0, 0.0}, {0.0, -height_m, 0.0}};
    }
    [[nodiscard]] render::ImageRequest request(std::atomic<long>* rays = nullptr) const {
        render::ImageRequest r;
        r.samples = samples;
        r.lines = lines;
        r.rays_per_pixel = 4;
        r.ray_weight.assign(4, 0.25);
        r.terms = false;
        r.view = [](int, int, Vec3) { return render::PixelView{}; };
        r.rays = [*this](int line, int begin, int end, std::span<render::SceneRay> out) {
            for (int s = begin; s < end; ++s)
                for (int k = 0; k < 4; ++k)
                    out[static_cast<std::size_t>(4 * (s - begin) + k)] =
                        view(line, s, {.index_u = k % 2, .index_v = k / 2}).ray;
        };
        r.parts_per_axis = 2;
        r.part_levels = 11;
        r.parts = [*this, rays](int line) -> render::ImageRequest::PartsOfLine {
            return
                [*this, rays, line](int sample, std::span<const render::PixelPart> parts, std::span<render::PartView> out) {
                    for (std::size_t i = 0; i < parts.size(); ++i) out[i] = view(line, sample, parts[i]);
                    if (rays != nullptr) *rays += static_cast<long>(parts.size());
                };
        };
        return r;
    }
};

/// 1200 m of vegetation in cells of 30 m, two dozen of them burning, some as scars that have cooled.
TestScene patchy_fire(double reflectance = 0.0) {
    TestScene scene(
        {.cols = 40, .rows = 40, .cell_m = 30.0, .ground_K = 300.0, .lambda_um = {3.96}, .reflectance = reflectance});
    for (std::uint64_t k = 0; k < 24; ++k) {
        const auto row = 8 + static_cast<int>(24 * uniform01({.seed = 3}, 2 * k));
        const auto col = 8 + static_cast<int>(24 * uniform01({.seed = 3}, 2 * k + 1));
        const auto i = scene.surface.grid.index(row, col);
        scene.surface.burned[i] = 1;
        if (k % 3 == 0)
            scene.surface.base_temperature_K[i] = 500.0F;
        else
            scene.surface.front_fraction[i] = 0.05F * static_cast<float>(k % 5 + 1);
    }
    return scene;
}

/// Sum over cells of what the fire adds to the radiance, times area [W sr-1 um-1].
double planted_power(const TestScene& scene) {
    const auto planck = [](double T_K) { return radiometry::planck_radiance(3.96, T_K); };
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.surface.burned.size(); ++i) {
        const double f = scene.surface.front_fraction[i];
        sum += f * planck(scene.surface.front_temperature_K) + (1.0 - f) * planck(scene.surface.base_temperature_K[i]) -
               planck(300.0);
    }
    return sum * 900.0;
}

double seen_power(const render::RadianceImage& image, double pixel_m, double background) {
    double sum = 0.0;
    for (const float L : image.radiance_W_m2_sr_um) sum += static_cast<double>(L) - background;
    return sum * pixel_m * pixel_m;
}

TEST(LargePixel, HoldsThePowerOfCellsMuchSmallerThanItself) {
    const TestScene scene = patchy_fire();
    const double background = radiometry::planck_radiance(3.96, 300.0), truth = planted_power(scene);
    // Pixel grids that do not fit the cells, in many places: nothing cancels by symmetry.
    constexpr int kPlaces = 12;
    for (const auto& [pixel_m, samples] : {std::pair{100.0, 11}, {370.0, 3}, {1050.0, 1}}) {
        double mean = 0.0, square = 0.0;
        for (int k = 0; k < kPlaces; ++k) {
            const Instrument camera{.pixel_m = pixel_m,
                                    .west_m = 41.3 + 0.71 * k,
                                    .south_m = 63.9 - 0.93 * k,
                                    .samples = samples,
                                    .lines = samples};
            const auto image = render::render_image(scene.scene(), nullptr, camera.request());
            const double error = seen_power(image, pixel_m, background) / truth - 1.0;
            EXPECT_LT(std::abs(error), 0.015) << pixel_m;
            mean += error / kPlaces;
            square += error * error / kPlaces;
        }
        EXPECT_LT(std::sqrt(square), 0.005) << pixel_m;
        EXPECT_LT(std::abs(mean), 4.0 * std::sqrt(square / kPlaces)) << pixel_m;  // no bias
    }
}

TEST(LargePixel, SpendsRaysOnFireOnly) {
    const TestScene scene = patchy_fire();
    std::atomic<long> rays{0};
    const Instrument camera{.pixel_m = 1050.0, .west_m = 47.3, .south_m = 61.9};
    (void)render::render_image(scene.scene(), nullptr, camera.request(&rays));
    // As dense everywhere as where it flames: 16 cells to 0.2 % need sqrt(2/3) / (0.002 sqrt 16) = k^1.5, a point in every
    // (30 m / k)^2.
    const double everywhere = std::pow(1050.0 / 30.0 * std::pow(std::sqrt(2.0 / 3.0) / (0.002 * 4.0), 2.0 / 3.0), 2);
    EXPECT_LT(static_cast<double>(rays), 0.08 * everywhere);
    TestScene cold({.cols = 40, .rows = 40, .cell_m = 30.0, .ground_K = 300.0, .lambda_um = {3.96}});
    rays = 0;
    (void)render::render_image(cold.scene(), nullptr, camera.request(&rays));
    EXPECT_EQ(rays, 0);  // the plain rays of the request are enough
}

TEST(LargePixel, FlamesSeenAskewKeepTheirPower) {
    // Flames of 5 m voxels stand on a few places of a slope and lean out of the cells they burn on.
    TestScene scene(
        {.cols = 40, .rows = 40, .cell_m = 30.0, .ground_K = 300.0, .lambda_um = {3.96}, .absorption_per_m = 0.1});
    scene.set_heights([](double x, double y) { return 150.0 + 0.1 * x - 0.05 * y; });
    std::vector<fire::FlameVoxel> voxels;
    for (const auto& [i0, j0] : {std::pair{70, 80}, {100, 141}, {151, 90}}) {
        const auto ground = static_cast<int>(std::ceil((150.0 + 0.1 * 5.0 * i0 - 0.05 * 5.0 * j0) / 2.0));
        for (int k = 0; k < 8; ++k)
            for (int j = 0; j < 6; ++j) voxels.push_back({i0 + k / 3, j0 + j, ground + k, 0.8F, 1100.0F});
    }
    scene.set_flame({.corner_m = {}, .nx = 240, .ny = 240, .dx_m = 5.0, .dy_m = 5.0, .dz_m = 2.0}, voxels);
    const double background = radiometry::planck_radiance(3.96, 300.0);
    for (const double zenith_deg : {0.0, 50.0}) {
        const double zenith_rad = zenith_deg * kDegree_rad;
        const double west_m = 200.0 - 190.0 * std::tan(zenith_rad);
        const Instrument fine{
            .pixel_m = 2.0, .west_m = west_m, .south_m = 200.0, .samples = 400, .lines = 400, .zenith_rad = zenith_rad};
        auto dense = fine.request();
        dense.parts = {};
        const double truth = seen_power(render::render_image(scene.scene(), nullptr, dense), 2.0, background);
        const Instrument coarse{.pixel_m = 800.0, .west_m = west_m, .south_m = 200.0, .zenith_rad = zenith_rad};
        const double seen = seen_power(render::render_image(scene.scene(), nullptr, coarse.request()), 800.0, background);
        EXPECT_GT(truth, 0.0);
        EXPECT_NEAR(seen / truth, 1.0, 0.005) << zenith_deg;
    }
}

TEST(LargePixel, BeyondTheSceneLieItsSurroundings) {
    const TestScene scene = patchy_fire(0.1);
    auto surrounded = scene.scene();
    surrounded.surroundings = render::RenderScene::Surroundings{0, 0.0};
    const double background = 0.9 * radiometry::planck_radiance(3.96, 300.0);
    const Instrument camera{.pixel_m = 1200.0, .west_m = -3000.0, .south_m = 0.0, .samples = 4};
    const auto image = render::render_image(surrounded, nullptr, camera.request());
    EXPECT_EQ(image.coverage[0], 0.0F);
    EXPECT_NEAR(image.radiance_W_m2_sr_um[0] / background, 1.0, 1e-6);
    EXPECT_EQ(image.background_fraction[0], 1.0F);
    EXPECT_NEAR(image.hit_x_m[0], -2400.0, 1e-6);
    EXPECT_NEAR(image.coverage[3], 0.5, 1e-6);
    // What sticks out over both edges holds all power.
    const Instrument wide{.pixel_m = 2900.0, .west_m = -800.0, .south_m = -900.0};
    const auto whole = render::render_image(surrounded, nullptr, wide.request());
    EXPECT_NEAR(seen_power(whole, 2900.0, background) / (0.9 * planted_power(scene)), 1.0, 0.005);
    EXPECT_LT(whole.coverage[0], 0.5);
}

}  // namespace
}  // namespace pyroscene::test
