// Unmixing speed (B4): an image of 614 x 512 pixels, 224 bands, mixtures of up to three of five endmembers with noise. Stepwise selection
// by `pyroscene::imagery::unmix_image` against plain least squares (ucls, which selects nothing) of Orfeo ToolBox when it is
// installed (Debian: otb-bin), whole processes alternately, one thread each. Prints one row of the benchmark table.
//   bench_unmix [--pairs N]
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "base/files.h"
#include "base/random.h"
#include "bench/measure.h"
#include "gis/raster_output.h"
#include "imagery/unmix_image.h"
#include "radiometry/planck.h"

namespace {

namespace fs = std::filesystem;
using namespace pyroscene;

constexpr int kCols = 614, kRows = 512, kBands = 224, kMembers = 5, kBlock = 8;
constexpr const char* kNames[kMembers] = {"hot_ground", "flame", "scar", "grass", "soil"};

double lambda_um(int band) { return 0.38 + (2.5 - 0.38) * band / (kBands - 1); }

/// Reflected sunlight of a white surface with the air's bands.
double sunlight(double w) {
    double L = 6.8e-5 * radiometry::planck_radiance(w, 5778.0) * 0.7 / 3.14159265358979;
    constexpr double bands[][3] = {
        {0.76, 0.006, 0.5}, {0.94, 0.02, 0.5}, {1.13, 0.02, 0.6}, {1.38, 0.04, 0.97}, {1.87, 0.05, 0.95}};
    for (const auto& [centre, width, depth] : bands) L *= 1.0 - depth * std::exp(-std::pow((w - centre) / width, 2));
    return L;
}

/// Radiance of an endmember [W m-2 sr-1 um-1]: hot ground of 1073 K, thin flame of 1000 K, scar of 600 K under ash, grass, soil.
double radiance(int member, double w) {
    switch (member) {
        case 0:
            return 0.9 * radiometry::planck_radiance(w, 1073.15);
        case 1:
            return (1.0 - std::exp(-0.6 / w)) * radiometry::planck_radiance(w, 1000.0);
        case 2:
            return (0.04 + 0.05 * w) * sunlight(w) + 0.9 * radiometry::planck_radiance(w, 600.0);
        case 3:
            return (0.05 + 0.35 / (1.0 + std::exp(-(w - 0.72) / 0.02)) - 0.12 * std::max(w - 1.3, 0.0)) * sunlight(w);
        default:
            return (0.08 + 0.14 * std::sqrt(w)) * sunlight(w);
    }
}

/// Fractions of a pixel: blocks of 8 x 8 pixels share one of the sets of at most three endmembers, none less than a thirtieth.
std::array<double, kMembers> fractions(int row, int col) {
    std::vector<unsigned> sets;
    for (unsigned set = 1; set < 1U << kMembers; ++set)
        if (__builtin_popcount(set) <= 3) sets.push_back(set);
    const auto block = static_cast<std::uint64_t>((row / kBlock) * 1000 + col / kBlock),
               pixel = static_cast<std::uint64_t>(row) * kCols + static_cast<std::uint64_t>(col);
    const unsigned set = sets[static_cast<std::size_t>(uniform01({7, 1, 0}, block) * static_cast<double>(sets.size()))];
    std::array<double, kMembers> f{};
    double sum = 0.0;
    for (unsigned k = 0; k < kMembers; ++k)
        if (set >> k & 1U) sum += f[k] = -std::log(uniform01({7, 2, 0}, pixel, k));
    for (unsigned k = 0; k < kMembers; ++k)
        if (set >> k & 1U) f[k] = 0.9 * f[k] / sum + 0.1 / __builtin_popcount(set);
    return f;
}

void write(const fs::path& file, std::vector<gis::OutputBand> bands, int cols, int rows, const std::vector<float>& pixels) {
    gis::OutputRaster out;
    out.cols = cols, out.rows = rows, out.bands = std::move(bands);
    gis::write_geotiff(file, out, std::span<const float>(pixels));
}

/// cube.tif (uncompressed, pixel interleaved, as such cubes come), truth.tif, endmembers.tif (1 x 5) and endmembers.csv.
void write_inputs(const fs::path& folder) {
    std::vector<double> library;
    std::string csv = "wavelength_um";
    std::vector<gis::OutputBand> bands, classes;
    for (const auto* name : kNames) {
        csv += std::string(",") + name;
        classes.push_back({std::string("fraction_") + name, "1", {}, {}, {}});
    }
    csv += "\n";
    std::vector<float> members;
    for (int b = 0; b < kBands; ++b) {
        csv += fmt::format("{:.6f}", lambda_um(b));
        bands.push_back({"radiance", "W m-2 sr-1 um-1", lambda_um(b), 0.0095, {}});
        for (int k = 0; k < kMembers; ++k) {
            library.push_back(radiance(k, lambda_um(b)));
            csv += fmt::format(",{:.8g}", library.back());
            members.push_back(static_cast<float>(library.back()));
        }
        csv += "\n";
    }
    write_text_file(folder / "endmembers.csv", csv);
    write(folder / "endmembers.tif", bands, kMembers, 1, members);
    constexpr std::size_t kPixels = static_cast<std::size_t>(kCols) * kRows;
    constexpr double kNoise = 0.02;
    std::vector<float> cube(kPixels * kBands), truth(kPixels * kMembers);
    for (std::size_t p = 0; p < kPixels; ++p) {
        const auto f = fractions(static_cast<int>(p / kCols), static_cast<int>(p % kCols));
        for (std::size_t k = 0; k < kMembers; ++k) truth[k * kPixels + p] = static_cast<float>(f[k]);
        for (std::size_t b = 0; b < kBands; ++b) {
            double L = kNoise * standard_normal({7, 3, 0}, p * kBands + b);
            for (std::size_t k = 0; k < kMembers; ++k) L += f[k] * library[b * kMembers + k];
            cube[b * kPixels + p] = static_cast<float>(L);
        }
    }
    write(folder / "truth.tif", classes, kCols, kRows, truth);
    write(folder / "compressed.tif", bands, kCols, kRows, cube);
    const auto command = fmt::format("gdal_translate -q -co INTERLEAVE=PIXEL '{}' '{}'",
                                     (folder / "compressed.tif").string(), (folder / "cube.tif").string());
    if (std::system(command.c_str()) != 0) throw std::runtime_error("gdal_translate failed");
}

/// Unmixes with the truth at hand and returns the rms error over all endmembers.
std::vector<double> unmix(const fs::path& folder, bool stepwise, bool scored) {
    imagery::UnmixJob job;
    job.image = folder / "cube.tif";
    job.endmembers = folder / "endmembers.csv";
    if (scored) job.truth = folder / "truth.tif";
    job.settings.stepwise = stepwise;
    job.threads = 1;
    job.output = folder / "fractions.tif";
    double squares = 0.0;
    const auto report = imagery::unmix_image(job);
    for (const auto& score : report.scores) squares += score.rms_error * score.rms_error;
    return {std::sqrt(squares / kMembers)};
}

std::vector<double> orfeo(const fs::path& folder) {
    const auto command = fmt::format(
        "OTB_MAX_RAM_HINT=256 ITK_GLOBAL_DEFAULT_NUMBER_OF_THREADS=1 otbcli_HyperspectralUnmixing -in '{0}/cube.tif' -ie "
        "'{0}/endmembers.tif' -ua ucls -out '{0}/orfeo.tif' float > '{0}/orfeo.log' 2>&1",
        folder.string());
    if (std::system(command.c_str()) != 0) throw std::runtime_error("otbcli_HyperspectralUnmixing failed");
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int pairs = argc == 3 && std::string(argv[1]) == "--pairs" ? std::atoi(argv[2]) : 3;
        const bench::TemporaryFolder scratch;
        const fs::path& folder = scratch.path;
        // Written by a child: its arrays must not count as memory of the run.
        (void)bench::measure([&] {
            write_inputs(folder);
            return std::vector<double>{};
        });
        const auto error = bench::measure([&] { return unmix(folder, true, true); }).results.front(),
                   plain_error = bench::measure([&] { return unmix(folder, false, true); }).results.front();
        const auto ours = [&] { return unmix(folder, true, false); };
        const bool peer = std::system("command -v otbcli_HyperspectralUnmixing > /dev/null 2>&1") == 0;
        bench::Pair runs;
        if (peer)
            runs = bench::measure_alternately(
                ours, [&] { return orfeo(folder); }, pairs);
        else
            runs.first = bench::measure_median(ours, pairs);
        std::cout << fmt::format(
            "| B4 stepwise unmixing {} x {} x {}, {} endmembers, 1 thread | {:.2f} s CPU, {:.0f} MB | {} | {} | P 1.5 x, "
            "600 MB; "
            "G 0.7 x, 150 MB | rms error {:.5f}, with all endmembers {:.5f} |\n",
            kCols, kRows, kBands, kMembers, runs.first.cpu_s, runs.first.peak_MB,
            peer ? fmt::format("Orfeo ToolBox ucls {:.2f} s CPU, {:.0f} MB", runs.second.cpu_s, runs.second.peak_MB)
                 : std::string("Orfeo ToolBox is not installed (otb-bin)"),
            peer ? fmt::format("{:.2f} x", runs.cpu_ratio) : std::string(), error, plain_error);
        return error <= plain_error ? 0 : 1;
    } catch (const std::exception& e) {
        std::cerr << "bench_unmix: " << e.what() << '\n';
        return 1;
    }
}
