// Rasters: writing an imaging spectrometer's cube (B5), and a swath with bow-tie onto the map (B6), against gdal_translate and
// gdalwarp -geoloc on the same pixels, whole processes alternately, one thread each. Prints rows of the benchmark table.
//   bench_rasters [--pairs N]
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "analysis/ortho.h"
#include "base/constants.h"
#include "base/files.h"
#include "base/random.h"
#include "bench/measure.h"
#include "gis/crs.h"
#include "gis/geodesy.h"
#include "gis/image_stream.h"
#include "gis/pixel_positions.h"
#include "gis/tiff_writer.h"

namespace {

namespace fs = std::filesystem;
using namespace pyroscene;

constexpr int kCubeSamples = 677, kCubeLines = 1000, kCubeBands = 224;
constexpr int kSamples = 1354, kLines = 2030, kBands = 36, kLinesPerScan = 10;
constexpr double kCell_m = 1000.0;

gis::OutputRaster raster(int cols, int rows, int bands) {
    gis::OutputRaster out;
    out.cols = cols;
    out.rows = rows;
    for (int b = 0; b < bands; ++b) out.bands.push_back({fmt::format("band {}", b + 1), "W m-2 sr-1 um-1", {}, {}, {}});
    out.compression = gis::Compression::Zstd;
    return out;
}

gis::OutputRaster cube_raster() {
    auto out = raster(kCubeSamples, kCubeLines, kCubeBands);
    out.grid = MapGrid{kCubeSamples, kCubeLines, 5e5, 4.1e6, 20.0, gis::parse_map_crs("EPSG:32611", "bench").wkt};
    return out;
}

/// The cube as a plain float file with a header, one band after another.
void write_cube(const fs::path& folder) {
    const auto n = static_cast<std::size_t>(kCubeSamples) * kCubeLines;
    std::vector<float> pixels(n * kCubeBands);
    for (int b = 0; b < kCubeBands; ++b)
        for (std::size_t i = 0; i < n; ++i) {
            const auto col = static_cast<double>(i % kCubeSamples), row = static_cast<double>(i / kCubeSamples);
            const double noise = uniform01({5, 1, 0}, i, static_cast<std::uint64_t>(b)) - 0.5;
            pixels[static_cast<std::size_t>(b) * n + i] = static_cast<float>(
                50.0 * std::exp(-4.0 * b / 223.0) * (1.0 + 0.2 * std::sin(col / 40.0 + row / 60.0)) + 0.07 * noise);
        }
    std::FILE* file = std::fopen((folder / "cube.img").c_str(), "wb");
    if (file == nullptr || std::fwrite(pixels.data(), sizeof(float), pixels.size(), file) != pixels.size())
        throw std::runtime_error("cannot write the cube");
    std::fclose(file);
    write_text_file(
        folder / "cube.hdr",
        fmt::format("ENVI\nsamples = {}\nlines = {}\nbands = {}\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
                    "byte order = 0\nmap info = {{UTM, 1, 1, 500000, 4100000, 20, 20, 11, North, WGS-84}}\n",
                    kCubeSamples, kCubeLines, kCubeBands));
}

/// Field that band 1 of the swath is painted with.
double painted(double lon_deg, double lat_deg) { return 300.0 + 20.0 * std::sin(3.0 * lon_deg) * std::cos(5.0 * lat_deg); }

/// A swath of 2330 km: scans of ten lines that grow with the view angle and so overlap; after design of MODIS.
void write_swath(const fs::path& folder) {
    constexpr double kRadius_km = 6371.0, kHeight_km = 705.0, kDegree_km = 111.2, kStep_rad = 0.001415;
    const auto n = static_cast<std::size_t>(kSamples) * kLines;
    std::vector<double> places(2 * n);
    std::vector<float> pixels(n * kBands);
    for (int line = 0; line < kLines; ++line)
        for (int s = 0; s < kSamples; ++s) {
            const double angle = (s - 0.5 * (kSamples - 1)) * kStep_rad;
            const double incidence = std::asin((kRadius_km + kHeight_km) / kRadius_km * std::sin(angle));
            const double across = kRadius_km * (incidence - angle);
            const double growth = std::min(2.0, (1.0 + std::abs(across) / 1165.0) / std::cos(incidence));
            const double along = line / kLinesPerScan * 10.0 + 4.5 + (line % kLinesPerScan - 4.5) * growth;
            const auto i = static_cast<std::size_t>(line) * kSamples + static_cast<std::size_t>(s);
            places[n + i] = 45.0 - along / kDegree_km;
            places[i] = -110.0 + (across + 0.1 * along) / (kDegree_km * std::cos(places[n + i] * kDegree_rad));
            for (int b = 0; b < kBands; ++b)
                pixels[static_cast<std::size_t>(b) * n + i] = static_cast<float>(b + painted(places[i], places[n + i]));
        }
    auto geolocation = raster(kSamples, kLines, 2);
    gis::write_geotiff(folder / "places.tif", geolocation, std::span<const double>(places));
    auto out = raster(kSamples, kLines, kBands);
    out.geolocation = folder / "places.tif";
    gis::write_geotiff(folder / "swath.tif", out, std::span<const float>(pixels));
}

std::vector<double> write_ours(const fs::path& folder, bool cog) {
    gis::ImageStream stream(folder / "cube.img");
    if (cog) {
        gis::CogWriter out(folder / "ours_cog.tif", cube_raster());
        for (int b = 0; b < kCubeBands; ++b) out.write_band(static_cast<std::size_t>(b), stream.read_band(b + 1));
        out.finish();
    } else {
        gis::TiffWriter out(folder / "ours.tif", cube_raster());
        for (int b = 0; b < kCubeBands; ++b)
            out.write({static_cast<std::size_t>(b), 1, 0, kCubeLines}, stream.read_band(b + 1));
        out.finish();
    }
    return {};
}

/// Swath to map by the pixel nearest to each cell.
std::vector<double> map_ours(const fs::path& folder) {
    std::vector<double> x_m, y_m;
    {
        const auto places = gis::read_image(folder / "places.tif");
        const auto n = static_cast<std::ptrdiff_t>(places.pixels.size() / 2);
        x_m.assign(places.pixels.begin(), places.pixels.begin() + n);
        y_m.assign(places.pixels.begin() + n, places.pixels.end());
    }
    const auto crs = gis::parse_map_crs("EPSG:32612", "bench").wkt;
    gis::MapProjection(crs).to_map(x_m, y_m);
    MapGrid like;
    like.crs_wkt = crs;
    const auto grid = analysis::ortho_grid(like, kCell_m, x_m, y_m);
    const std::vector<double> level(x_m.size(), 0.0);
    const auto lookup = analysis::ortho_lookup(grid, kSamples, kLines, x_m, y_m, level, {kLinesPerScan, 0});
    auto out = raster(grid.cols, grid.rows, kBands);
    out.grid = grid;
    gis::TiffWriter map(folder / "map_ours.tif", out);
    gis::ImageStream stream(folder / "swath.tif");
    for (int b = 0; b < kBands; ++b)
        map.write({static_cast<std::size_t>(b), 1, 0, grid.rows},
                  analysis::ortho_resample(lookup, kSamples, kLines, stream.read_band(b + 1), true));
    map.finish();
    return {};
}

std::vector<double> gdal(const std::string& command) {
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    return {};
}

/// Cells with a value, single cells without one between others (stripes), and the rms difference from the painted field, which
/// the nearest pixel misses by what the field changes within half a pixel.
struct Judgement {
    std::int64_t seen = 0, holes = 0;
    double rms = 0.0;
};
Judgement judge(const fs::path& folder, const std::string& file) {
    gis::ImageStream stream(folder / file);
    const int cols = stream.info().cols, rows = stream.info().rows;
    const auto band = stream.read_band(1);
    const auto places = gis::pixel_positions(folder / file);
    Judgement j;
    for (int row = 1; row + 1 < rows; ++row)
        for (int col = 1; col + 1 < cols; ++col) {
            const auto width = static_cast<std::size_t>(cols);
            const auto i = static_cast<std::size_t>(row) * width + static_cast<std::size_t>(col);
            const auto valid = [&](std::size_t k) { return !std::isnan(band[k]); };
            if (valid(i)) {
                ++j.seen;
                j.rms += std::pow(band[i] - painted(places.lon_deg[i], places.lat_deg[i]), 2);
            } else if (valid(i - 1) && valid(i + 1) && valid(i - width) && valid(i + width)) {
                ++j.holes;
            }
        }
    j.rms = std::sqrt(j.rms / static_cast<double>(j.seen));
    return j;
}

void row(const std::string& what, const bench::Pair& runs, const char* peer, const char* limits, const std::string& note) {
    std::cout << fmt::format(
        "| {}, 1 thread | {:.2f} s CPU, {:.0f} MB | {} {:.2f} s CPU, {:.0f} MB | {:.2f} x | {} | {} |\n", what,
        runs.first.cpu_s, runs.first.peak_MB, peer, runs.second.cpu_s, runs.second.peak_MB, runs.cpu_ratio, limits, note);
}

void run(const fs::path& folder, int pairs) {
    // Written by a child: its arrays must not count as memory of the run.
    (void)bench::measure([&] {
        write_cube(folder);
        write_swath(folder);
        return std::vector<double>{};
    });
    const auto path = folder.string();
    row("B5 writing 677 x 1000 x 224 as tiled GeoTIFF",
        bench::measure_alternately([&] { return write_ours(folder, false); },
                                   [&] {
                                       return gdal(
                                           fmt::format("gdal_translate -q -co TILED=YES -co COMPRESS=ZSTD -co "
                                                       "ZSTD_LEVEL=1 -co PREDICTOR=3 -co INTERLEAVE=BAND -co "
                                                       "BIGTIFF=IF_SAFER {0}/cube.img {0}/peer.tif",
                                                       path));
                                   },
                                   pairs),
        "gdal_translate", "P 1.1 x, 512 MB; G 0.6 x", "");
    row("B5 the same as COG",
        bench::measure_alternately([&] { return write_ours(folder, true); },
                                   [&] {
                                       return gdal(
                                           fmt::format("gdal_translate -q -of COG -co COMPRESS=ZSTD -co LEVEL=1 -co "
                                                       "PREDICTOR=YES {0}/cube.img {0}/peer_cog.tif",
                                                       path));
                                   },
                                   pairs),
        "gdal_translate", "P 1.1 x, 512 MB; G 0.6 x", "");
    const auto ours = bench::measure_alternately(
        [&] { return map_ours(folder); },
        [&] {
            return gdal(
                fmt::format("gdalwarp -q -overwrite -geoloc -t_srs EPSG:32612 -tr 1000 1000 -r near -co TILED=YES -co "
                            "COMPRESS=ZSTD -co ZSTD_LEVEL=1 -co PREDICTOR=3 -dstnodata nan {0}/swath.tif "
                            "{0}/map_peer.tif",
                            path));
        },
        pairs);
    const auto a = judge(folder, "map_ours.tif"), b = judge(folder, "map_peer.tif");
    row("B6 swath 1354 x 2030 x 36 to UTM, 1 km, nearest", ours, "gdalwarp -geoloc", "P 1.0 x, 1 GB; G 0.4 x",
        fmt::format("cells {} / {}, single holes {} / {}, rms from the painted field {:.3f} / {:.3f}", a.seen, b.seen,
                    a.holes, b.holes, a.rms, b.rms));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int pairs = argc == 3 && std::string(argv[1]) == "--pairs" ? std::atoi(argv[2]) : 3;
        const bench::TemporaryFolder folder;
        const gis::CompressionThreads limit(1);
        run(folder.path, pairs);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "bench_rasters: " << e.what() << '\n';
        return 1;
    }
}
