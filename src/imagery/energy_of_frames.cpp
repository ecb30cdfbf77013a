#include "imagery/energy_of_frames.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/fire_energy.h"
#include "base/error.h"
#include "base/files.h"
#include "base/time.h"
#include "gis/image_stream.h"
#include "gis/raster_input.h"
#include "gis/raster_output.h"
#include "imagery/image_channels.h"

namespace pyroscene::imagery {
namespace {

constexpr const char* kPowerBand = "fire radiative power per area";

/// What a frame says of itself.
struct Frame {
    std::filesystem::path file;
    std::string time;
    double unix_s = 0.0;
    int band = 0;
    bool synthetic = false;
};

Frame describe(const std::filesystem::path& file) {
    const gis::ImageStream image(file);
    const auto& info = image.info();
    Frame frame{file, metadata_item(info, "ACQUISITION_DATE"), 0.0, 0, info.metadata.contains("synthetic")};
    if (!info.on_map) throw input_error(file.string(), "is not on a map; take an ortho product, or frp of one");
    const auto time = parse_utc(frame.time);
    if (!time) throw input_error(file.string(), "no metadata item ACQUISITION_DATE (2017-07-15T22:00:00Z)");
    frame.unix_s = time->unix_s;
    for (std::size_t b = 0; b < info.bands.size(); ++b)
        if (info.bands[b].description == kPowerBand) frame.band = static_cast<int>(b) + 1;
    if (frame.band == 0) throw input_error(file.string(), fmt::format("no band named '{}'", kPowerBand));
    return frame;
}

std::vector<Frame> in_order_of_time(const FreJob& job) {
    if (job.frames.size() < 2) throw input_error("fre", "needs two frames or more");
    std::vector<Frame> frames;
    for (const auto& file : job.frames) frames.push_back(describe(file));
    std::sort(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) { return a.unix_s < b.unix_s; });
    for (std::size_t k = 1; k < frames.size(); ++k)
        if (frames[k].unix_s == frames[k - 1].unix_s)
            throw input_error(frames[k].file.string(),
                              fmt::format("is of the same time as {}, {}", frames[k - 1].file.string(), frames[k].time));
    return frames;
}

void write_map(const FreJob& job, const Frame& first, const MapGrid& grid, const analysis::EnergyMap& energy) {
    gis::OutputRaster out;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.grid = grid;
    out.synthetic = first.synthetic;
    out.acquisition_time = first.time;
    out.bands = {{"fire radiative energy per area", "MJ m-2", {}, {}, {}},
                 {"fire radiative energy of the cell", "MJ", {}, {}, {}},
                 {"time of largest power", "s", {}, {}, {}}};
    std::vector<float> pixels;
    for (const double scale : {1e-6, 1e-6 * grid.cell_area_m2()})
        for (const double J_m2 : energy.energy()) pixels.push_back(static_cast<float>(scale * J_m2));
    pixels.insert(pixels.end(), energy.time_of_peak_s().begin(), energy.time_of_peak_s().end());
    gis::write_cog(job.output, out, pixels);
}

}  // namespace

std::vector<FreStep> energy_of_frames(const FreJob& job) {
    const auto frames = in_order_of_time(job);
    const MapGrid grid = gis::make_map_grid(frames.front().file, {}, {});
    analysis::EnergyMap map;
    std::vector<FreStep> steps;
    std::vector<double> times_s, powers_MW;
    for (const Frame& frame : frames) {
        const auto power_W_m2 =
            gis::read_band({frame.file, frame.band, gis::Resampling::Conserve, "fire radiative power", "W m-2"}, grid)
                .values;
        const double time_s = frame.unix_s - frames.front().unix_s;
        map.add(time_s, power_W_m2);
        double sum = 0.0;
        for (const float v : power_W_m2)
            if (v == v) sum += static_cast<double>(v);
        steps.push_back({frame.time, time_s, sum * grid.cell_area_m2() * 1e-6, 0.0});
        times_s.push_back(time_s);
        powers_MW.push_back(steps.back().power_MW);
    }
    const auto energy_MJ = analysis::fire_radiative_energy(times_s, powers_MW);
    std::string text = "time,time_s,frp_MW,fre_MJ\n";
    for (std::size_t k = 0; k < steps.size(); ++k) {
        steps[k].energy_MJ = energy_MJ[k];
        text +=
            fmt::format("{},{:.3f},{:.8g},{:.8g}\n", steps[k].time, steps[k].time_s, steps[k].power_MW, steps[k].energy_MJ);
    }
    write_map(job, frames.front(), grid, map);
    auto table = job.output;
    write_text_file(table.replace_filename(job.output.stem().string() + "_series.csv"), text);
    return steps;
}

}  // namespace pyroscene::imagery
