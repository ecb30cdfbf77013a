// A MODIS pass over a scene of 100 x 100 km in cells of 30 m: rasters in, radiance, geolocation and brightness temperature of all
// bands out. Prints rows of the benchmark table.
//   bench_large_scene [--edge CELLS]      cells along an edge (default 3334)
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "base/files.h"
#include "bench/measure.h"
#include "gis/crs.h"
#include "gis/tiff_writer.h"
#include "inputs/load_scenario.h"
#include "pipeline/run.h"

namespace {

namespace fs = std::filesystem;
using namespace pyroscene;

constexpr double kCell_m = 30.0, kSpread_m_s = 0.5, kTime_s = 14400.0, kEarlier_s = 13800.0, kResidence_s = 120.0;

/// Rows of one raster, made as they are written.
template <class Value>
void write_raster(const fs::path& file, int edge, std::vector<gis::OutputBand> bands, const Value& value) {
    gis::OutputRaster out;
    out.cols = out.rows = edge;
    out.grid = MapGrid{edge, edge, 6.5e5, 5.2e6, kCell_m, gis::parse_map_crs("EPSG:32611", "bench").wkt};
    out.bands = std::move(bands);
    gis::TiffWriter writer(file, out);
    std::vector<float> rows;
    for (int first = 0; first < edge; first += writer.tile_rows()) {
        const int count = std::min(writer.tile_rows(), edge - first);
        rows.clear();
        for (std::size_t b = 0; b < out.bands.size(); ++b)
            for (int row = first; row < first + count; ++row)
                for (int col = 0; col < edge; ++col) rows.push_back(static_cast<float>(value(b, row, col)));
        writer.write({0, out.bands.size(), first, count}, rows);
    }
    writer.finish();
}

/// Hills, and a fire that has spread in a leaning ellipse from the middle: its front is two cells deep.
void write_scene(const fs::path& folder, int edge) {
    const auto arrival_s = [&](int row, int col) {
        const double x = (col - 0.5 * edge) * kCell_m, y = (0.5 * edge - row) * kCell_m;
        const double angle = std::atan2(y, x), uneven = 1.0 + 0.08 * std::sin(9.0 * angle) + 0.05 * std::cos(23.0 * angle);
        return std::hypot(x, 1.6 * y) / (kSpread_m_s * uneven);
    };
    write_raster(folder / "dem.tif", edge, {{"elevation", "m", {}, {}, {}}}, [](std::size_t, int row, int col) {
        return 1500.0 + 350.0 * std::sin(row / 90.0) * std::cos(col / 70.0) + 60.0 * std::sin(row / 11.0 + col / 17.0);
    });
    write_raster(folder / "arrival.tif", edge, {{"arrival", "s", {}, {}, {}}},
                 [&](std::size_t, int row, int col) { return arrival_s(row, col); });
    const auto frame = [](double time_s) {
        return gis::OutputBand{"heat flux", "W m-2", {}, {}, {{"time_s", fmt::format("{}", time_s)}}};
    };
    write_raster(folder / "heat_flux.tif", edge, {frame(kEarlier_s), frame(kTime_s)},
                 [&](std::size_t band, int row, int col) {
                     const double age_s = (band == 0 ? kEarlier_s : kTime_s) - arrival_s(row, col);
                     return age_s >= 0.0 && age_s < kResidence_s ? 8e4 : 0.0;
                 });
    write_text_file(folder / "scenario.yaml", R"(pyroscene: 1
name: large_scene
inputs:
  terrain:   {file: dem.tif}
  heat_flux: {file: heat_flux.tif}
  arrival:   {file: arrival.tif}
  wind:      {speed: 4, from_deg: 250}
start: 2017-07-15T14:00:00Z
atmosphere: {model: midlatitude_summer, visibility_km: 23}
acquisitions:
  - {id: modis, sensor: modis-terra, time_s: 14400, platform: {over: centre, pass: descending, scan_angle_deg: 10}}
products: [radiance, brightness_temperature]
)");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int edge = argc == 3 && std::string(argv[1]) == "--edge" ? std::atoi(argv[2]) : 3334;
        const bench::TemporaryFolder scratch;
        const fs::path& folder = scratch.path;
        (void)bench::measure([&] {
            write_scene(folder, edge);
            return std::vector<double>{};
        });
        const auto usage = bench::measure([&] {
            RunReport report;
            pipeline::RunOptions options;
            options.output = folder / "out";
            options.threads = 1;
            pipeline::run(inputs::load_scenario(folder / "scenario.yaml"), options, report);
            return std::vector<double>{};
        });
        const auto cells = static_cast<double>(edge) * edge;
        std::cout << fmt::format(
            "| MODIS pass over {0} x {0} cells of 30 m, all bands, 1 thread | {1:.1f} s CPU, {2:.0f} MB ({3:.0f} bytes a "
            "cell) |  |  "
            "| 60 s | |\n",
            edge, usage.cpu_s, usage.peak_MB, usage.peak_MB * 1e6 / cells);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "bench_large_scene: " << e.what() << '\n';
        return 1;
    }
}
