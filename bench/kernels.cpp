// Single parts of the renderer with Google Benchmark, printed as rows of the table of scripts/bench.sh.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "analysis/unmix.h"
#include "base/random.h"
#include "bench/w0_scene.h"
#include "render/flame_march.h"
#include "render/mixture_ray.h"
#include "render/smoke_run.h"
#include "render/spectral_kernels.h"

namespace pyroscene::bench {
namespace {

/// What the machine can do: one exponential per wavelength, one load and one store.
void limit(benchmark::State& state) {
    constexpr int n = 224;
    std::vector<float> k(n, 0.1F), out(n);
    for (auto _ : state) {
        render::spectral_kernels().transmittance(n, k.data(), 0.01F, out.data());
        benchmark::DoNotOptimize(out.data());
    }
    state.counters["items"] = n;
    state.SetLabel("ns per wavelength: an exponential alone, the limit of the rows below");
}
BENCHMARK(limit);

/// One piece of flame with an absorption of its own at every wavelength: one exp and the emission of four Planck rows.
void emit(benchmark::State& state) {
    const int n = render::padded(static_cast<int>(state.range(0)));
    const auto size = static_cast<std::size_t>(n);
    std::vector<float> k(size, 0.1F), rows(4 * size, 1000.0F), tau(size, 1.0F), flame(size, 0.0F);
    for (std::size_t i = 0; i < size; ++i) k[i] += 1e-3F * static_cast<float>(i);
    const std::array<float, 4> weight{-0.06F, 0.56F, 0.56F, -0.06F};
    const int count = static_cast<int>(state.range(1));
    for (auto _ : state) {
        render::spectral_kernels().emit(n, k.data(), 0.01F, rows.data(), n, count, weight.data(), 1.0F, tau.data(),
                                        flame.data());
        benchmark::DoNotOptimize(flame.data());
        if (tau[0] < 1e-3F) std::fill(tau.begin(), tau.end(), 1.0F);
    }
    state.counters["items"] = static_cast<double>(state.range(0));
    state.SetLabel("ns per voxel and wavelength");
}
BENCHMARK(emit)->Args({224, 1})->Args({224, 4})->Args({36, 4});

/// Grey flame: one exp and four weights of Planck rows a voxel, for all wavelengths together.
void grey(benchmark::State& state) {
    constexpr int n = 224;
    const render::PlanckRows planck(std::vector<double>(n, 4.0), n, 800.0, 1200.0, {});
    std::vector<double> weight(static_cast<std::size_t>(planck.row_count()), 0.0);
    double T_K = 801.0, tau = 1.0;
    for (auto _ : state) {
        const double emitted = -tau * std::expm1(-0.3 * 1e-3 * T_K);
        tau = tau < 1e-3 ? 1.0 : tau - emitted;
        const auto found = planck.at(T_K);
        for (int j = 0; j < found.count; ++j)
            weight[static_cast<std::size_t>(found.row + j)] += emitted * found.weight[static_cast<std::size_t>(j)];
        T_K = T_K < 1190.0 ? T_K + 7.3 : 801.0;
        benchmark::DoNotOptimize(weight.data());
    }
    state.counters["items"] = n;
    state.SetLabel("ns per voxel and wavelength, grey flame at 224 wavelengths");
}
BENCHMARK(grey);

/// Flame of soot, atoms and some of the gases, at n wavelengths where all of them absorb.
radiometry::FlameTable table_of_gases(int n, int gases) {
    const auto size = static_cast<std::size_t>(n);
    radiometry::FlameTable table;
    table.stride = n;
    table.row_count = 2;
    table.lowest_K = 900.0;
    table.step_K = 20.0;
    table.continuum_per_m.assign(2 * size, 0.1F);
    std::vector<int> blocks;
    for (int l = 0; l < n; l += radiometry::FlameTable::kLanes) blocks.push_back(l);
    for (int g = 0; g < gases; ++g)
        table.gases.push_back({radiometry::GasSpecies::H2O, blocks, std::vector<float>(6 * size, 0.05F)});
    return table;
}

render::PlanckRows flame_planck(int n) {
    std::vector<double> lambda_um;
    for (int l = 0; l < n; ++l) lambda_um.push_back(2.0 + 0.03 * l);
    return {lambda_um, n, 900.0, 920.0, {}};
}

/// One piece of flame with gas at 224 wavelengths: soot and atoms alone (0 gases), or with that many absorbing everywhere.
void mixture(benchmark::State& state) {
    constexpr int n = 224;
    const auto table = table_of_gases(n, static_cast<int>(state.range(0)));
    const auto planck = flame_planck(n);
    render::MixtureRay ray(table);
    std::vector<float> flame(n, 0.0F);
    int pieces = 0;
    for (auto _ : state) {
        if (pieces++ % 64 == 0) ray.begin();
        ray.add(911.0, 0.2, planck, 1.0F, flame.data());
        benchmark::DoNotOptimize(flame.data());
    }
    state.counters["items"] = n;
    state.SetLabel(fmt::format("ns per voxel and wavelength, soot, alkali lines and {} gases", state.range(0)));
}
BENCHMARK(mixture)->Arg(0)->Arg(1)->Arg(3);

/// A ray through 16 pieces of smoke at 224 wavelengths, marched at 32 nodes: 0 absorbing only, 1 scattering sun, sky and ground
/// once, 2 and flame light, 3 with flame in the pieces too.
void smoke(benchmark::State& state) {
    constexpr int n = 224, kNodes = 32, kSteps = 16;
    const auto kind = state.range(0);
    const std::vector<float> k(n, 0.1F), planck(4 * n, 10.0F), albedo(n, 0.9F), light(n, 50.0F), asymmetry(n, 0.6F),
        weight(4 * n, 0.25F);
    std::vector<float> tau(n, 1.0F), flame(n, 0.0F), emitted(n, 0.0F), scattered(n, 0.0F),
        at_nodes((render::SmokeRun::kSpectra + 3 * kSteps) * kNodes);
    const std::vector<unsigned char> glows(n / 8, 1);
    std::vector<int> first, node_of;  // each block of wavelengths between four nodes
    for (int block = 0; block <= n / 8; ++block) {
        first.push_back(4 * block);
        for (int j = 0; j < 4; ++j) node_of.push_back(block + j);
    }
    std::vector<render::SmokeStep> steps(kSteps);
    float column = 0.0F;
    for (auto& step : steps) {
        step.smoke_m = 0.01F;
        step.flame_m = kind == 3 ? 0.02F : 0.0F;
        step.smoke = step.flame = {planck.data(), 4, {-0.06F, 0.56F, 0.56F, -0.06F}};
        step.sun_column = column++ * 0.02F;
        step.sun_column_far = column * 0.02F;
        step.column_above = step.column_below = step.flame_column = 1.0F;
        step.flame_per_m2 = kind >= 2 ? 1e-4F : 0.0F;
        step.flame_bundling = 0.5F;
    }
    render::SmokeRun run;
    run.steps = steps.data();
    run.count = kSteps;
    run.flame = kind == 3;
    run.flame_light = kind >= 2;
    run.glows = glows.data();
    run.node = {kNodes,   k.data(),     k.data(), asymmetry.data(), k.data(), k.data(),
                k.data(), light.data(), nullptr,  nullptr,          nullptr};
    run.at_nodes = at_nodes.data();
    run.n = n;
    run.first = first.data();
    run.node_of = node_of.data();
    run.weight = weight.data();
    run.albedo = kind == 0 ? nullptr : albedo.data();
    run.sky = run.ground = run.ground_lit = run.irradiance = run.sun = run.flame_radiance = light.data();
    run.tau = tau.data();
    run.flame_out = flame.data();
    run.smoke_out = emitted.data();
    run.scattered_out = scattered.data();
    for (auto _ : state) {
        render::spectral_kernels().emit_smoke(run);
        benchmark::DoNotOptimize(scattered.data());
        std::fill(tau.begin(), tau.end(), 1.0F);
    }
    state.counters["items"] = n * kSteps;
    constexpr std::array<const char*, 4> kWhat{"absorbing smoke", "smoke that scatters sun, sky and ground",
                                               "and flame light", "and flame in the same piece"};
    state.SetLabel(fmt::format("ns per voxel and wavelength, {}", kWhat[static_cast<std::size_t>(kind)]));
}
BENCHMARK(smoke)->Arg(0)->Arg(1)->Arg(2)->Arg(3);

/// Stepwise selection among five spectra at 224 bands, pixels with two or three of them and noise.
void unmix(benchmark::State& state) {
    constexpr int kBands = 224, kMembers = 5, kPixels = 4096;
    analysis::Endmembers library{{"a", "b", "c", "d", "e"}, kBands, {}};
    for (int j = 0; j < kMembers; ++j)
        for (int b = 0; b < kBands; ++b)
            library.spectra.push_back(0.3 + std::exp(-std::pow((b - 45.0 * j - 22.0) / 30.0, 2.0)));
    std::vector<float> pixels(static_cast<std::size_t>(kBands) * kPixels);
    for (int b = 0; b < kBands; ++b) {
        for (int p = 0; p < kPixels; ++p) {
            double sum = 0.002 * standard_normal({1, static_cast<std::uint32_t>(b), 0}, static_cast<std::uint64_t>(p));
            for (int j = 0; j < 2 + p % 2; ++j) sum += (p % 7 + j) / 20.0 * library.spectrum((p + j) % kMembers)[b];
            pixels[static_cast<std::size_t>(b * kPixels + p)] = static_cast<float>(sum);
        }
    }
    const analysis::Unmixer unmixer(library, {});
    std::vector<float> fractions(static_cast<std::size_t>(kMembers) * kPixels), residual(kPixels), chosen(kPixels),
        flag(kPixels);
    for (auto _ : state) {
        unmixer.unmix(pixels.data(), kPixels, kPixels, {fractions, residual, chosen, flag});
        benchmark::DoNotOptimize(fractions.data());
    }
    state.counters["items"] = kPixels;
    state.SetLabel("ns per pixel of 224 bands, stepwise, 5 endmembers");
}
BENCHMARK(unmix);

/// The march alone, through all flames of W0.
void march(benchmark::State& state) {
    const W0Scene scene({});
    const render::FlameColumns flame(scene.flame());
    const W0Camera camera;
    double voxels = 0.0;
    for (auto _ : state) {
        double sum_m = 0.0;
        voxels = 0.0;
        for (int line = 0; line < camera.lines; line += 8) {
            for (int sample = 0; sample < camera.samples; ++sample) {
                const render::SceneRay ray = camera.ray(line, sample);
                render::march_flame(flame, ray.start_m, ray.end_m, [&](float, float, double length_m) {
                    sum_m += length_m;
                    voxels += 1.0;
                    return true;
                });
            }
        }
        benchmark::DoNotOptimize(sum_m);
    }
    state.counters["items"] = camera.samples * camera.lines / 8.0;
    state.SetLabel(
        fmt::format("ns per ray ({:.1f} burning voxels on average)", voxels / (camera.samples * camera.lines / 8.0)));
}
BENCHMARK(march);

/// Sight lines to rough terrain of 512 x 512 cells.
void terrain(benchmark::State& state) {
    MapGrid grid;
    grid.cols = grid.rows = 512;
    grid.cell_m = 30.0;
    grid.west_m = 700000.0;
    grid.north_m = 5200000.0;
    Raster<float> height(grid, "height", "m");
    for (int r = 0; r < 512; ++r) {
        for (int c = 0; c < 512; ++c)
            height.at(r, c) = static_cast<float>(1500.0 + 300.0 * std::sin(r / 40.0) * std::cos(c / 30.0));
    }
    const render::TerrainMesh mesh(height, {grid.west_m, grid.south_m(), 0.0});
    constexpr int kRays = 4096;
    const double tilt = static_cast<double>(state.range(0)) * 3.14159265358979 / 180.0;
    for (auto _ : state) {
        double sum = 0.0;
        for (std::uint64_t i = 0; i < kRays; ++i) {
            const Vec3 ground{5000.0 + 3.0 * static_cast<double>(i % 64), 5000.0 + 3.0 * static_cast<double>(i / 64),
                              1500.0};
            const Vec3 up{0.0, -std::sin(tilt), std::cos(tilt)};
            const auto hit = mesh.intersect(ground + (3000.0 / up.z) * up, ground - (1000.0 / up.z) * up);
            sum += hit ? hit->distance_m : 0.0;
        }
        benchmark::DoNotOptimize(sum);
    }
    state.counters["items"] = kRays;
    state.SetLabel(fmt::format("ns per sight line to rough terrain, {} degrees off nadir", state.range(0)));
}
BENCHMARK(terrain)->Arg(0)->Arg(60);

/// One row of the table per benchmark.
class TableReporter : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            const auto items = run.counters.find("items");
            const double per_item = run.GetAdjustedCPUTime() / (items != run.counters.end() ? items->second.value : 1.0);
            ns_[run.benchmark_name()] = per_item;
            // Beside the machine's limit, where the row is about wavelengths.
            const bool spectral = run.report_label.find("and wavelength") != std::string::npos;
            print(run.benchmark_name(), per_item, run.report_label, spectral);
            if (run.benchmark_name() == "mixture/3")
                print("", (per_item - ns_["mixture/0"]) / 3.0, "ns per voxel and wavelength, each of these gases", true);
        }
    }

private:
    void print(const std::string& name, double ns, const std::string& what, bool beside_limit) {
        const auto limit = ns_.find("limit");
        fmt::print("| {} | {:.3g} {}{} |  |  |  |  |\n", name, ns, what,
                   beside_limit && limit != ns_.end() ? fmt::format("; {:.1f} x the limit", ns / limit->second) : "");
        std::fflush(stdout);
    }

    std::map<std::string, double> ns_;  ///< per item, of the rows so far
};

}  // namespace
}  // namespace pyroscene::bench

int main(int argc, char** argv) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    benchmark::Initialize(&argc, argv);
    pyroscene::bench::TableReporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
}
