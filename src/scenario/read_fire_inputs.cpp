#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;

/// Times of the frames: listed, or every so often until the end.
std::vector<double> read_frames(const config::Node& node) {
    constexpr double kMost = 100000.0;
    const auto list = node.child("frames_s");
    if (list.present()) {
        for (const char* key : {"duration_s", "frame_step_s"})
            if (node.has(key)) node.child(key).report("does not go with 'frames_s'");
        auto times_s = node.numbers("frames_s");
        for (std::size_t i = 0; i < times_s.size(); ++i)
            if (!(times_s[i] > (i > 0 ? times_s[i - 1] : 0.0))) {
                list.report(fmt::format("times must ascend from above 0, found {}", times_s[i]));
                break;
            }
        return times_s;
    }
    const auto duration = node.required_child("duration_s");
    const double duration_s = duration.present() ? duration.as_number(3600.0, Range{0.0, 1e7, true}) : 3600.0;
    const double step_s = node.number("frame_step_s", 300.0, Range{0.0, 1e7, true});
    const double count = std::floor(duration_s / step_s + 1e-9);
    if (count < 1.0 || count > kMost) {
        duration.report(
            fmt::format("{} s in steps of {} s are {} frames, expected 1 to {}", duration_s, step_s, count, kMost));
        return {};
    }
    std::vector<double> times_s;
    for (int i = 1; i <= static_cast<int>(count); ++i) times_s.push_back(i * step_s);
    return times_s;
}

double read_mean_over(const config::Node& node, const std::vector<double>& frames_s) {
    double shortest_s = 1e9, before_s = 0.0;
    for (const double t : frames_s) {
        shortest_s = std::min(shortest_s, t - before_s);
        before_s = t;
    }
    const double mean_s = node.number("mean_over_s", std::min(6.0, shortest_s), Range{0.0, 1e7, true});
    if (mean_s > shortest_s && !frames_s.empty())
        node.child("mean_over_s")
            .report(fmt::format("must not exceed the {} s between two frames, found {}", shortest_s, mean_s));
    return mean_s;
}

}  // namespace

void read_fuel_models(const config::Node& node, const char* table_key, const fs::path& folder, FuelSource& source) {
    const auto table = node.required_child(table_key);
    source.table = table.as_text("");
    if (table.is_scalar() && !is_shipped_fuel_table(source.table)) {
        if (fs::path(source.table).extension() == ".csv")
            source.table = read_file_name(table, folder).string();
        else
            table.report(fmt::format("'{}' is none of fbfm13, fbfm40, fbfm53 or a CSV file", source.table));
    }
    if (const auto custom = node.child("custom"); custom.present()) source.custom = read_file_name(custom, folder);
    const auto codes = node.child("nonburnable");
    if (codes.present() && !codes.is_list()) codes.report("expected a list of codes");
    if (codes.is_list())
        for (const auto& code : codes.items())
            source.nonburnable.push_back(static_cast<int>(code.as_integer(0, Range::between(-32768, 65535))));
}

FuelSource read_fuel(const config::Node& node, const fs::path& folder) {
    FuelSource source;
    if (node.is_map()) {
        source.raster = read_raster(node, folder);
        read_fuel_models(node, "table", folder, source);
    }
    node.finish();
    return source;
}

FireFrames read_fire_frames(const config::Node& node) {
    FireFrames frames;
    frames.times_s = read_frames(node);
    frames.mean_over_s = read_mean_over(node, frames.times_s);
    frames.coarse_burn_time_s = node.number("coarse_burn_time_s", frames.coarse_burn_time_s, Range::between(1.0, 1e5));
    return frames;
}

}  // namespace pyroscene::scenario
