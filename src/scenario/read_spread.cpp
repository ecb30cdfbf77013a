#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;

constexpr Range kMoisture_pct = Range::between(0.0, 1000.0);
constexpr std::array<const char*, spread::kFuelClasses> kMoistureKeys{"m1h_pct", "m10h_pct", "m100h_pct", "mherb_pct",
                                                                      "mwoody_pct"};

std::optional<std::array<double, 2>> read_position(const config::Node& node) {
    const auto items = node.is_list() ? node.items() : std::vector<config::Node>{};
    if (items.size() != 2) {
        node.report("expected a position [x, y]");
        return std::nullopt;
    }
    return std::array{items[0].as_number(0.0), items[1].as_number(0.0)};
}

std::vector<std::array<double, 2>> read_positions(const config::Node& node, std::size_t least) {
    std::vector<std::array<double, 2>> positions;
    if (!node.present()) return positions;
    if (!node.is_list() || node.items().size() < least) {
        node.report(fmt::format("expected a list of at least {} positions [[x, y], ...]", least));
        return positions;
    }
    for (const auto& item : node.items())
        if (const auto position = read_position(item)) positions.push_back(*position);
    return positions;
}

ShapesSource read_shapes(const config::Node& node, const fs::path& folder, bool timed) {
    ShapesSource shapes;
    shapes.line_number = node.line();
    if (!node.is_map()) {
        node.report("expected one of 'file', 'point', 'points', 'line', 'polygon'");
        return shapes;
    }
    int given = 0;
    for (const char* key : {"file", "point", "points", "line", "polygon"}) given += node.has(key) ? 1 : 0;
    if (given != 1)
        node.report(fmt::format("expected one of 'file', 'point', 'points', 'line', 'polygon', found {}", given));
    if (const auto file = node.child("file"); file.present()) shapes.file = read_file_name(file, folder);
    shapes.layer = node.text("layer", "");
    if (node.has("layer") && !shapes.file) node.child("layer").report("belongs to 'file'");
    if (const auto point = node.child("point"); point.present())
        if (const auto position = read_position(point)) shapes.points = {*position};
    if (const auto points = node.child("points"); points.present()) shapes.points = read_positions(points, 1);
    shapes.line = read_positions(node.child("line"), 2);
    shapes.polygon = read_positions(node.child("polygon"), 3);
    shapes.crs = node.text("crs", "");
    if (timed) shapes.time_s = node.number("time_s", 0.0, Range::between(0.0, 1e8));
    node.finish();
    return shapes;
}

std::vector<ShapesSource> read_all_shapes(const config::Node& node, const fs::path& folder, bool timed) {
    std::vector<ShapesSource> all;
    if (!node.present()) return all;
    if (!node.is_list() || node.items().empty()) {
        node.report("expected a list of places: [{file: ...}] or [{line: [[x, y], [x, y]]}]");
        return all;
    }
    for (const auto& item : node.items()) all.push_back(read_shapes(item, folder, timed));
    return all;
}

QuantitySource read_quantity(const config::Node& node, const fs::path& folder, double fallback, Range range) {
    QuantitySource quantity{fallback, {}, 1.0};
    if (!node.is_map()) {
        quantity.value = node.present() ? node.as_number(fallback, range) : fallback;
        return quantity;
    }
    quantity.raster = read_raster(node, folder);
    quantity.scale = node.number("scale", 1.0, Range{0.0, 1e6, true});
    node.finish();
    return quantity;
}

void read_fuel(const config::Node& node, const fs::path& folder, SpreadSource& source) {
    if (!node.is_map()) return node.finish();
    source.fuel = read_raster(node, folder);
    const auto table = node.required_child("table");
    source.table = table.as_text("");
    const bool shipped = source.table == "fbfm13" || source.table == "fbfm40" || source.table == "fbfm53";
    if (table.is_scalar() && !shipped) {
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
    node.finish();
}

void read_moisture(const config::Node& node, const fs::path& folder, SpreadSource& source) {
    if (!node.present()) return;
    if (!node.is_map()) return node.finish();
    if (const auto table = node.child("table"); table.present()) source.moisture_table = read_file_name(table, folder);
    const bool raster = node.has("file") || node.has("files");
    for (const char* key : {"file", "files", "bands", "times_s"}) node.ignore(key);
    if (raster) source.moisture_raster = read_raster_series(node, folder, kMoistureKeys.size());
    if (raster && source.moisture_table) node.report("give rasters or 'table', not both");
    for (std::size_t i = 0; i < kMoistureKeys.size(); ++i) {
        source.moisture_pct[i] = node.optional_number(kMoistureKeys[i], kMoisture_pct);
        if (!node.has(kMoistureKeys[i]) && !source.moisture_table && !raster)
            node.report(fmt::format("key '{}' is missing", kMoistureKeys[i]));
    }
    node.finish();
}

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

SpreadSource read_spread(const config::Node& node, const fs::path& folder) {
    SpreadSource source;
    source.line = node.line();
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    read_fuel(node.required_child("fuel"), folder, source);
    source.ignition = read_all_shapes(node.required_child("ignition"), folder, true);
    source.barriers = read_all_shapes(node.child("barriers"), folder, false);
    read_moisture(node.required_child("moisture"), folder, source);
    const auto canopy = node.child("canopy");
    source.canopy_cover = read_quantity(canopy.child("cover"), folder, 0.0, Range::between(0.0, 1.0));
    source.canopy_height_m = read_quantity(canopy.child("height_m"), folder, 0.0, Range::between(0.0, 150.0));
    source.crown_ratio = canopy.number("crown_ratio", source.crown_ratio, Range::between(0.0, 1.0));
    canopy.finish();
    const auto height = node.choice("wind_height", "20ft", {"midflame", "20ft", "10m"});
    source.rules.wind_height = height == "midflame" ? spread::WindHeight::Midflame
                               : height == "10m"    ? spread::WindHeight::TenMetres
                                                    : spread::WindHeight::TwentyFeet;
    source.rules.curing = node.choice("curing", "behave", {"behave", "linear"}) == "behave" ? spread::Curing::BehavePlus
                                                                                            : spread::Curing::Linear;
    source.rules.wind_limit = node.boolean("wind_limit", false);
    source.frames_s = read_frames(node);
    source.mean_over_s = read_mean_over(node, source.frames_s);
    source.coarse_burn_time_s = node.number("coarse_burn_time_s", source.coarse_burn_time_s, Range::between(1.0, 1e5));
    node.finish();
    return source;
}

}  // namespace pyroscene::scenario
