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
    if (timed) shapes.area = node.boolean("area", false);
    if (shapes.area && !shapes.file && shapes.line.empty())
        node.child("area").report("is about lines: of a 'file' or 'line'");
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

}  // namespace

CanopySource read_canopy(const config::Node& node, const fs::path& folder) {
    CanopySource canopy;
    canopy.given = node.present();
    canopy.cover = read_quantity(node.child("cover"), folder, 0.0, Range::between(0.0, 1.0));
    canopy.height_m = read_quantity(node.child("height_m"), folder, 0.0, Range::between(0.0, 150.0));
    canopy.crown_ratio = node.number("crown_ratio", canopy.crown_ratio, Range::between(0.0, 1.0));
    node.finish();
    return canopy;
}

SpreadSource read_spread(const config::Node& node, const fs::path& folder, bool has_landscape) {
    SpreadSource source;
    source.line = node.line();
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    if (const auto fuel = node.child("fuel"); fuel.present() || !has_landscape)
        source.fuel = read_fuel(node.required_child("fuel"), folder);
    source.ignition = read_all_shapes(node.required_child("ignition"), folder, true);
    source.barriers = read_all_shapes(node.child("barriers"), folder, false);
    read_moisture(node.required_child("moisture"), folder, source);
    source.canopy = read_canopy(node.child("canopy"), folder);
    source.says_wind_height = node.has("wind_height");
    source.wind_level.kind = wind_level_kind(node.choice("wind_height", "20ft", kWindHeights));
    source.rules.curing = node.choice("curing", "behave", {"behave", "linear"}) == "behave" ? spread::Curing::BehavePlus
                                                                                            : spread::Curing::Linear;
    source.rules.wind_limit = node.boolean("wind_limit", false);
    source.frames = read_fire_frames(node);
    node.finish();
    return source;
}

}  // namespace pyroscene::scenario
