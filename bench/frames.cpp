// Whole frames of scene W0, printed as rows of one markdown table (scripts/bench.sh prints its head):
//   | case | measured | compared with | ratio | limits | condition on the result |
// Every figure is that of a process of its own; figures with a ratio are medians of alternate runs.
//   bench_frames [--pairs N] [--only WORDS]      WORDS: part of a name in the first column, such as "B2 reflected flame light, 3"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "bench/baseline.h"
#include "bench/measure.h"
#include "bench/w0_scene.h"

namespace pyroscene::bench {
namespace {

constexpr double kReflectance = 0.1;
constexpr double kDirectMean = 338.50, kLitMean = 361.8;  // 4.0 um, W m-2 sr-1 um-1

void row(std::string_view what, std::string_view measured, std::string_view compared = "", std::string_view ratio = "",
         std::string_view limits = "", std::string_view condition = "") {
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", what, measured, compared, ratio, limits, condition);
    std::fflush(stdout);
}

double cpu_s() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

struct Frame {
    int bands = 3;
    bool light = false;
    W0Scene::Options scene{};
    W0Camera camera{};
    int lines_at_once = 0;  ///< 0: the whole image
};

enum Result { kMean, kSetup_s, kLight_s, kRender_s, kInput_MB, kOutput_MB };

/// Renders a frame with the product; results as named above.
std::vector<double> render_frame(Frame frame) {
    const double start = cpu_s();
    frame.scene.lambda_um = benchmark_wavelengths_um(frame.bands);
    frame.scene.reflectance = kReflectance;
    const W0Scene scene(frame.scene);
    const double ready = cpu_s();
    render::GroundIrradiance light;
    if (frame.light) light = render::ground_irradiance(scene.scene(), {.directions = 64, .reach_m = 3000.0});
    const double lit = cpu_s();
    const render::RenderScene to_render = scene.scene();
    const render::ImageRequest request = frame.camera.request();
    const Monitor monitor;
    render::ImageRenderer renderer(to_render, frame.light ? &light : nullptr, request, monitor);
    render::RadianceImage image;
    const int lines_at_once = frame.lines_at_once > 0 ? frame.lines_at_once : request.lines;
    double mean = 0.0;
    for (int first = 0; first < request.lines; first += lines_at_once) {
        renderer.render(first, std::min(lines_at_once, request.lines - first), image);
        mean += mean_radiance(image, scene.lambda_um(), 4.0) * image.lines / request.lines;
    }
    const double done = cpu_s();
    const double input_MB = static_cast<double>(scene.flame().bricks.size() * sizeof(fire::FlameField::Brick) +
                                                light.irradiance_W_m2_um.size() * sizeof(float)) /
                            1048576.0;
    return {mean,       ready - start, lit - ready,
            done - lit, input_MB,      static_cast<double>(image.radiance_W_m2_sr_um.size() * sizeof(float)) / 1048576.0};
}

std::vector<double> baseline_frame(int bands, bool light) {
    const W0Scene scene({.lambda_um = benchmark_wavelengths_um(bands), .reflectance = kReflectance});
    const Baseline baseline(scene, kReflectance);
    const auto image = baseline.render({}, light);
    double sum = 0.0;
    const auto lambda_um = scene.lambda_um();
    std::size_t band = 0;
    while (std::abs(lambda_um[band] - 4.0) > 1e-6) ++band;
    const std::size_t pixels = static_cast<std::size_t>(image.samples) * static_cast<std::size_t>(image.lines);
    for (std::size_t i = 0; i < pixels; ++i) sum += image.radiance_W_m2_sr_um[band * pixels + i];
    return {sum / static_cast<double>(pixels)};
}

std::string condition(double mean, double expected, double relative) {
    const bool holds = std::abs(mean / expected - 1.0) <= relative;
    return fmt::format("4.0 um mean {:.3f} (expected {:.2f} +- {:g} %): {}", mean, expected, 100.0 * relative,
                       holds ? "ok" : "FAILED");
}

bool is_wanted(std::string_view name, std::string_view only) { return name.find(only) != std::string_view::npos; }

void frames_against_baseline(int pairs, std::string_view only) {
    for (const bool light : {false, true}) {
        for (const int bands : {3, 36, 224}) {
            const std::string name = fmt::format("{} {} bands", light ? "B2 reflected flame light," : "B1 direct,", bands);
            if ((light && bands == 36) || !is_wanted(name, only)) continue;
            const Pair p = measure_alternately(
                [&] {
                    return render_frame({bands, light, {}, {}});
                },
                [&] { return baseline_frame(bands, light); }, pairs);
            row(name + ", end to end, 1 thread", fmt::format("{:.3f} s CPU, {:.0f} MB", p.first.cpu_s, p.first.peak_MB),
                fmt::format("baseline {:.3f} s", p.second.cpu_s), fmt::format("{:.2f}", p.cpu_ratio),
                light          ? "P 1.5, G 0.5"
                : bands == 224 ? "P 1.5, G 0.7"
                               : "",
                condition(p.first.results[kMean], light ? kLitMean : kDirectMean, light ? 5e-3 : 1e-4));
            const double render_s = p.first.results[kRender_s], rays = 640.0 * 512.0;
            row(name + ", render phase", fmt::format("{:.3f} s CPU", render_s), "", "", "",
                fmt::format("{:.2f} M rays/s", 1e-6 * rays / render_s));
            if (light) {
                row(name + ", ground light", fmt::format("{:.3f} s CPU", p.first.results[kLight_s]), "", "", "",
                    fmt::format("{:.1f} us per receiver", 1e6 * p.first.results[kLight_s] / 19600.0));
            }
            if (!light && bands == 224) {
                Frame in_pieces{bands, light, {}, {}};
                in_pieces.lines_at_once = 16;
                const Pair piecewise = measure_alternately([&] { return render_frame(in_pieces); },
                                                           [&] { return baseline_frame(bands, light); }, pairs);
                row(name + ", 16 lines at a time as a run renders them",
                    fmt::format("{:.3f} s CPU, {:.0f} MB", piecewise.first.cpu_s, piecewise.first.peak_MB),
                    fmt::format("baseline {:.3f} s, whole image", piecewise.second.cpu_s),
                    fmt::format("{:.2f}", piecewise.cpu_ratio), "",
                    condition(piecewise.first.results[kMean], kDirectMean, 1e-4));
            }
            const Usage two = measure_median([&] { return render_frame({bands, light, {}, {}}); }, pairs, 2);
            row(name + ", 2 threads", fmt::format("{:.3f} s wall", two.wall_s),
                fmt::format("1 thread {:.3f} s wall", p.first.wall_s), fmt::format("{:.2f}", p.first.wall_s / two.wall_s),
                ">= 1.8", "");
        }
    }
}

/// Growth with one quantity at a time: ratio of CPU seconds to the plain frame of 36 bands.
void growth(int pairs, std::string_view only) {
    const Frame plain{36, false, {}, {}};
    const auto against_plain = [&](std::string_view what, const Frame& changed, std::string_view limit) {
        const std::string name = fmt::format("B3 {}", what);
        if (!is_wanted(name, only)) return Pair{};
        const Pair p =
            measure_alternately([&] { return render_frame(changed); }, [&] { return render_frame(plain); }, pairs);
        row(name, fmt::format("{:.3f} s CPU", p.first.cpu_s), fmt::format("plain {:.3f} s", p.second.cpu_s),
            fmt::format("{:.2f}", p.cpu_ratio), limit, "");
        return p;
    };
    Frame rays = plain;
    rays.camera.samples *= 2, rays.camera.lines *= 2, rays.camera.pixel_rad /= 2.0;
    against_plain("rays x4", rays, "<= 4.2");
    Frame voxels = plain;
    voxels.scene.voxel_split = 2;
    against_plain("voxels x8, same field", voxels, "<= 2.2, G 1.5");
    Frame occupied = plain;
    occupied.scene.columns_per_cell = 3;
    against_plain("occupancy x3", occupied, "<= 2.0");
    Frame empty = plain;
    empty.scene.flame = false;
    against_plain("no flame", empty, "<= 1.5");
    Frame oblique = plain;
    oblique.camera.tilt_rad = 60.0 * 3.14159265358979 / 180.0;
    against_plain("oblique 60 degrees", oblique, "<= 3");
    Frame many = plain;
    many.bands = 224;
    const Pair p = against_plain("bands 36 to 224", many, "<= 6.2 (linear)");
    if (p.first.results.empty()) return;
    const double allowed_MB = p.first.results[kInput_MB] + 1.2 * p.first.results[kOutput_MB] + 16.0;
    row("B3 memory, 224 bands", fmt::format("{:.0f} MB", p.first.peak_MB),
        fmt::format("input {:.0f} + 1.2 x output {:.0f} + program 16 MB", p.first.results[kInput_MB],
                    p.first.results[kOutput_MB]),
        fmt::format("{:.2f}", p.first.peak_MB / allowed_MB), "<= 1", "");
}

}  // namespace
}  // namespace pyroscene::bench

int main(int argc, char** argv) {
    int pairs = 3;
    std::string_view only;
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::string_view(argv[i]) == "--pairs") pairs = std::atoi(argv[i + 1]);
        if (std::string_view(argv[i]) == "--only") only = argv[i + 1];
    }
    pyroscene::bench::frames_against_baseline(pairs, only);
    pyroscene::bench::growth(pairs, only);
    return 0;
}
