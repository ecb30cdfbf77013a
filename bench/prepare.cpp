// Prepare speed: 830 frames of 140 x 140 cells (the thesis's run) through the prepare phase, against 83 frames of the same
// fire, each in a process of its own: seconds and peak memory. Prints one row of the benchmark table.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "gis/crs.h"
#include "gis/raster_output.h"
#include "measure.h"
#include "pipeline/run.h"

namespace {

namespace fs = std::filesystem;
using namespace pyroscene;

constexpr int kCells = 140;
constexpr double kStep_s = 6.0;

/// A front that crosses the map from west to east in 830 frames, two to four cells deep, brighter where it is wavy.
float heat_flux_W_m2(int row, int col, int frame) {
    const double front = 5.0 + 130.0 * frame / 830.0 + 6.0 * std::sin(row / 9.0);
    const double behind = front - col;
    if (behind < 0.0 || behind > 30.0) return 0.0F;
    return static_cast<float>(1.5e6 * std::exp(-behind / 1.5) * (1.0 + 0.8 * std::sin(0.7 * row + 0.3 * frame)));
}

void write_raster(const fs::path& file, const MapGrid& grid, std::vector<gis::OutputBand> bands,
                  const std::vector<float>& pixels) {
    gis::OutputRaster out;
    out.grid = grid;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.bands = std::move(bands);
    gis::write_geotiff(file, out, std::span<const float>(pixels));
}

fs::path write_fire(const fs::path& folder, int frames) {
    MapGrid grid{.cols = kCells, .rows = kCells, .west_m = 417100.0, .north_m = 4762700.0, .cell_m = 20.0, .crs_wkt = ""};
    grid.crs_wkt = gis::parse_map_crs("EPSG:32616", "benchmark").wkt;
    write_raster(folder / "dem.tif", grid, {{"elevation", "m", {}, {}, {}}}, std::vector<float>(grid.size(), 300.0F));
    std::vector<float> flux;
    std::vector<gis::OutputBand> bands;
    for (int frame = 0; frame < frames; ++frame) {
        bands.push_back({"heat flux", "W m-2", {}, {}, {{"time_s", fmt::format("{}", kStep_s * frame)}}});
        for (int row = 0; row < kCells; ++row)
            for (int col = 0; col < kCells; ++col) flux.push_back(heat_flux_W_m2(row, col, frame));
    }
    write_raster(folder / "heat_flux.tif", grid, std::move(bands), flux);
    const fs::path scenario = folder / "scenario.yaml";
    std::ofstream(scenario) << "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n  heat_flux: {file: heat_flux.tif}\n"
                               "  wind: {speed: 3, from_deg: 270}\nstart: 2000-08-01T18:00:00Z\nacquisitions:\n"
                               "  - {id: last, sensor: wasp, time_s: 1, platform: {altitude_agl_m: 3000}}\n";
    return scenario;
}

bench::Usage prepare(const fs::path& folder, int frames) {
    fs::create_directories(folder);
    // Written by a child as well: the arrays of the input must not count as memory of the run.
    (void)bench::measure([&] {
        (void)write_fire(folder, frames);
        return std::vector<double>{};
    });
    return bench::measure(
        [&] {
            RunReport report;
            pipeline::RunOptions options;
            options.output = folder / "out";
            options.threads = 2;
            pipeline::prepare(scenario::load(folder / "scenario.yaml"), options, report);
            return std::vector<double>{};
        },
        2);
}

}  // namespace

int main() {
    try {
        const bench::TemporaryFolder scratch;
        const auto tenth = prepare(scratch.path / "tenth", 83), whole = prepare(scratch.path / "whole", 830);
        std::cout << fmt::format(
            "| prepare, 830 frames of 140 x 140, 2 threads | {:.1f} s wall, {:.1f} s CPU, {:.0f} MB | 83 frames: {:.1f} s "
            "wall, "
            "{:.0f} MB | {:.2f} x memory | < 60 s; memory independent of the number of frames |  |\n",
            whole.wall_s, whole.cpu_s, whole.peak_MB, tenth.wall_s, tenth.peak_MB, whole.peak_MB / tenth.peak_MB);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "bench_prepare: " << e.what() << '\n';
        return 1;
    }
}
