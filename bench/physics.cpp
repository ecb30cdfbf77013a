// Scene W0 with all physics on (physics_scene.h), printed as rows of the table of scripts/bench.sh.
//   bench_physics [--runs N] [--sensor wasp|modis-terra|aviris-classic]
// Reading tables and picking wavelengths (make_spectral_scene of a run) is outside the figures: it is the same for any image.

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "bench/measure.h"
#include "bench/physics_scene.h"

namespace pyroscene::bench {
namespace {

struct Case {
    const char* sensor;
    const char* group;  ///< "" = all bands
    double goal_s;
};
constexpr Case kCases[] = {{"wasp", "ir", 3.0}, {"modis-terra", "", 6.0}, {"aviris-classic", "", 20.0}};

double cpu_s() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// CPU seconds of scene, ground light and image, then what doubling its directions changes in the light, %.
std::vector<double> frame(const PhysicsTables& tables, const radiometry::SpectralGrid& grid) {
    const double start = cpu_s();
    const PhysicsScene scene(tables, grid);
    const double ready = cpu_s();
    auto light = render::ground_irradiance(scene.scene(), {});
    const double lit = cpu_s();
    const auto image = render::render_image(scene.scene(), &light, W0Camera{}.request());
    const double done = cpu_s();
    if (!(image.radiance_W_m2_sr_um[image.radiance_W_m2_sr_um.size() / 2] > 0.0F)) throw std::runtime_error("dark image");
    return {ready - start, lit - ready, done - lit};
}

double doubling_percent(const PhysicsTables& tables, const radiometry::SpectralGrid& grid) {
    const PhysicsScene scene(tables, grid);
    render::GroundLightSettings settings;
    settings.estimate_error = true;
    return 100.0 * render::ground_irradiance(scene.scene(), settings).sampling_error.total_relative;
}

/// Band means of a few rays without light on the ground.
std::vector<double> band_means(const PhysicsTables& tables, const radiometry::SpectralGrid& grid) {
    const PhysicsScene scene(tables, grid);
    W0Camera camera;
    camera.samples = 20, camera.lines = 16, camera.pixel_rad = 0.032;
    const auto image = render::render_image(scene.scene(), nullptr, camera.request());
    const std::size_t pixels = image.coverage.size();
    std::vector<double> means(static_cast<std::size_t>(image.bands), 0.0);
    for (std::size_t b = 0; b < means.size(); ++b)
        for (std::size_t i = 0; i < pixels; ++i) means[b] += image.radiance_W_m2_sr_um[b * pixels + i];
    return means;
}

void report(const PhysicsTables& tables, const Case& wanted, int runs) {
    const auto sensor = sensors::load_sensor(wanted.sensor);
    std::vector<Spectrum> responses;
    std::vector<std::string> ids;
    for (const auto& band : sensor.bands) {
        if (*wanted.group != '\0' && band.group != wanted.group) continue;
        responses.push_back(band.response);
        ids.push_back(band.id);
    }
    const auto grid = picked_grid(tables, responses);
    const Usage empty = measure([] { return std::vector<double>{0.0}; });  // what the parent has read
    const Usage used = measure_median([&] { return frame(tables, grid); }, runs);
    const auto coarse = measure([&] { return band_means(tables, grid); }).results;
    const auto fine = measure([&] { return band_means(tables, fine_grid(tables, responses)); }).results;
    const double doubling = measure([&] { return std::vector<double>{doubling_percent(tables, grid)}; }).results[0];
    double worst = 0.0;
    std::size_t worst_band = 0;
    for (std::size_t b = 0; b < fine.size(); ++b) {
        const double error = coarse[b] / fine[b] - 1.0;
        if (std::abs(error) > std::abs(worst)) worst = error, worst_band = b;
    }
    const bool holds = std::abs(worst) <= 5e-3 && std::abs(doubling) <= 2.0;
    fmt::print(
        "| W0, all physics, {} bands of {} on {} wavelengths | {:.2f} s CPU (ground light {:.2f}, image {:.2f}), {:.0f} MB "
        "| | {:.2f} | G {:g} s | worst band {} {:+.2f} % from 1 cm-1 (0.5), doubled directions change the flames' light "
        "by {:+.1f} % (2): {} |\n",
        responses.size(), wanted.sensor, grid.size(), used.cpu_s, used.results[1], used.results[2],
        used.peak_MB - empty.peak_MB, used.cpu_s / wanted.goal_s, wanted.goal_s, ids[worst_band], 100.0 * worst, doubling,
        holds ? "ok" : "FAILED");
    std::fflush(stdout);
}

}  // namespace
}  // namespace pyroscene::bench

int main(int argc, char** argv) {
    using namespace pyroscene::bench;
    int runs = 3;
    std::string_view only;
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::string_view(argv[i]) == "--runs") runs = std::atoi(argv[i + 1]);
        if (std::string_view(argv[i]) == "--sensor") only = argv[i + 1];
    }
    try {
        const PhysicsTables tables;
        for (const Case& wanted : kCases)
            if (only.empty() || only == wanted.sensor) report(tables, wanted, runs);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_physics: {}\n", e.what());
        return 1;
    }
    return 0;
}
