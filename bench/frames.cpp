// Whole frames of scene W0, printed as rows of one markdown table (scripts/bench.sh prints its head):
//   | case | measured | compared with | ratio | limits | condition on the result |
// Every figure is that of a process of its own; figures with a ratio are medians of alternate runs. The product renders 16 lines
// at a time, as a run does, unless a row says otherwise.
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

constexpr double kReflectance = 0.1, kReach_m = 3000.0;
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

constexpr int kWholeImage = 1 << 20;

struct Frame {
    int bands = 3;
    int planes = 0;  ///< GroundLightSettings::directions; 0 = without the light of flames
    int lines_at_once = 16;
    W0Scene::Options scene{};
    W0Camera camera{};
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
    if (frame.planes > 0)
        light = render::ground_irradiance(scene.scene(), {.directions = frame.planes, .reach_m = kReach_m});
    const double lit = cpu_s();
    const render::RenderScene to_render = scene.scene();
    const render::ImageRequest request = frame.camera.request();
    const Monitor monitor;
    render::ImageRenderer renderer(to_render, frame.planes > 0 ? &light : nullptr, request, monitor);
    render::RadianceImage image;
    double mean = 0.0;
    for (int first = 0; first < request.lines; first += frame.lines_at_once) {
        renderer.render(first, std::min(frame.lines_at_once, request.lines - first), image);
        mean += mean_radiance(image, scene.lambda_um(), 4.0) * image.lines / request.lines;
    }
    const double done = cpu_s();
    const double input_MB = static_cast<double>(scene.flame().bricks.size() * sizeof(fire::FlameField::Brick) +
                                                light.irradiance_W_m2_um.size() * sizeof(float)) /
                            1048576.0;
    return {mean,       ready - start, lit - ready,
            done - lit, input_MB,      static_cast<double>(image.radiance_W_m2_sr_um.size() * sizeof(float)) / 1048576.0};
}

std::vector<double> baseline_frame(int bands, int directions) {
    const W0Scene scene({.lambda_um = benchmark_wavelengths_um(bands), .reflectance = kReflectance});
    const Baseline baseline(scene, kReflectance);
    const auto image = baseline.render({}, directions);
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

/// r.m.s. of the pixels' relative deviations from an image with many more directions, at 4.0 um: sampling noise, %.
template <class Image>
double noise_percent(const Image& image, const Image& converged) {
    double squares = 0.0;
    for (std::size_t i = 0; i < converged.size(); ++i) {
        const double deviation = static_cast<double>(image[i]) / static_cast<double>(converged[i]) - 1.0;
        squares += deviation * deviation;
    }
    return 100.0 * std::sqrt(squares / static_cast<double>(converged.size()));
}

/// Noise of the product with each number of planes, then that of the baseline with each number of directions.
std::vector<double> noise(const std::vector<int>& planes, const std::vector<int>& directions) {
    constexpr int kConvergedPlanes = 1024, kConvergedDirections = 48 * 48;
    const W0Scene scene({.lambda_um = {4.0}, .reflectance = kReflectance});
    const W0Camera camera;
    const auto ours = [&](int count) {
        const auto light = render::ground_irradiance(scene.scene(), {.directions = count, .reach_m = kReach_m});
        return render::render_image(scene.scene(), &light, camera.request()).radiance_W_m2_sr_um;
    };
    const Baseline baseline(scene, kReflectance);
    const auto theirs = [&](int count) { return baseline.render(camera, count).radiance_W_m2_sr_um; };
    std::vector<double> percent;
    const auto our_converged = ours(kConvergedPlanes);
    for (const int count : planes) percent.push_back(noise_percent(ours(count), our_converged));
    const auto their_converged = theirs(kConvergedDirections);
    for (const int count : directions) percent.push_back(noise_percent(theirs(count), their_converged));
    return percent;
}

/// One row of the product against the baseline, and one of the product's parts.
Usage against_baseline(const std::string& name, const Frame& frame, int directions, int pairs, std::string_view limits,
                       std::string_view remark = "") {
    const Pair p = measure_alternately([&] { return render_frame(frame); },
                                       [&] { return baseline_frame(frame.bands, directions); }, pairs);
    row(name, fmt::format("{:.3f} s CPU, {:.0f} MB", p.first.cpu_s, p.first.peak_MB),
        fmt::format("baseline{} {:.3f} s", directions > 0 ? fmt::format(", {} directions,", directions) : "",
                    p.second.cpu_s),
        fmt::format("{:.2f}", p.cpu_ratio), limits,
        condition(p.first.results[kMean], directions > 0 ? kLitMean : kDirectMean, directions > 0 ? 5e-3 : 1e-4) +
            std::string(remark));
    return p.first;
}

void show_parts(const std::string& name, const Frame& frame, const Usage& used, int pairs) {
    const double render_s = used.results[kRender_s], rays = 640.0 * 512.0;
    row(name + ", render phase", fmt::format("{:.3f} s CPU", render_s), "", "", "",
        fmt::format("{:.2f} M rays/s", 1e-6 * rays / render_s));
    if (frame.planes > 0) {
        row(name + ", ground light", fmt::format("{:.3f} s CPU", used.results[kLight_s]), "", "", "",
            fmt::format("{:.1f} us per receiver", 1e6 * used.results[kLight_s] / 19600.0));
    }
    const Usage two = measure_median([&] { return render_frame(frame); }, pairs, 2);
    row(name + ", 2 threads", fmt::format("{:.3f} s wall", two.wall_s), fmt::format("1 thread {:.3f} s wall", used.wall_s),
        fmt::format("{:.2f}", used.wall_s / two.wall_s), ">= 1.8", "");
}

void direct_frames(int pairs, std::string_view only) {
    for (const int bands : {3, 36, 224}) {
        const std::string name = fmt::format("B1 direct, {} bands", bands);
        if (!is_wanted(name, only)) continue;
        const Frame frame{.bands = bands};
        const Usage used = against_baseline(name + ", end to end, 1 thread", frame, 0, pairs,
                                            bands == 224 ? "P 1.5, G 0.7; at most 0.2 s" : "");
        show_parts(name, frame, used, pairs);
        if (bands == 224) {
            against_baseline(name + ", whole image in memory as in the baseline",
                             {.bands = bands, .lines_at_once = kWholeImage}, 0, pairs, "");
        }
    }
}

/// The baseline's directions are the same for all cells, so that few of them show every flame many times over: it is run with
/// as many as a receiver of the product has rays at its coarsest, and with four times as many, which still is far noisier.
void lit_frames(int pairs, std::string_view only) {
    constexpr int kPlanes = 64, kFewPlanes = 8, kDirections = 256, kFewDirections = 64;  // a plane has eight rays
    if (!is_wanted("B2 reflected flame light, 3 bands", only) && !is_wanted("B2 reflected flame light, 224 bands", only))
        return;
    const auto percent = measure([&] { return noise({kPlanes, kFewPlanes}, {kDirections, kFewDirections}); }).results;
    const auto remark = [&](std::size_t which) {
        return fmt::format("; noise {:.1f} %, baseline {:.0f} %", percent[which], percent[2 + which]);
    };
    for (const int bands : {3, 224}) {
        const std::string name = fmt::format("B2 reflected flame light, {} bands", bands);
        if (!is_wanted(name, only)) continue;
        const Frame frame{.bands = bands, .planes = kPlanes};
        const Usage used =
            against_baseline(name + ", end to end, 1 thread", frame, kDirections, pairs, "P 1.5, G 0.5", remark(0));
        show_parts(name, frame, used, pairs);
        against_baseline(name + fmt::format(", {} planes: as many rays", kFewPlanes), {.bands = bands, .planes = kFewPlanes},
                         kFewDirections, pairs, "P 1.5, G 0.5", remark(1));
    }
}

/// Growth with one quantity at a time: ratio of CPU seconds to the plain frame of 36 bands.
void growth(int pairs, std::string_view only) {
    const Frame plain{.bands = 36, .lines_at_once = kWholeImage};
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
    pyroscene::bench::direct_frames(pairs, only);
    pyroscene::bench::lit_frames(pairs, only);
    pyroscene::bench::growth(pairs, only);
    return 0;
}
