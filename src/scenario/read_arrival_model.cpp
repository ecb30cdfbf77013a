#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;

/// The units in which a program always writes; empty = its user chooses, and the files do not say.
struct ModelUnits {
    const char *name, *time, *intensity, *length, *rate;
};
constexpr std::array<ModelUnits, 6> kModels{{{"farsite", "", "", "", ""},
                                             {"flammap", "min", "", "", ""},
                                             {"elmfire", "s", "kW/m", "ft", "ft/min"},
                                             {"pyretechnics", "min", "kW/m", "m", "m/min"},
                                             {"forefire", "s", "", "", "m/s"},
                                             {"other", "", "", "", ""}}};

/// The raster and its unit: the key's, else what the program always writes.
UnitRaster read_unit_raster(const config::Node& node, const fs::path& folder, const char* model, const char* usual,
                            const std::vector<std::string>& units) {
    UnitRaster source;
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    source.raster = read_raster(node, folder);
    source.unit = node.choice("unit", usual, units);
    if (source.unit.empty() && !node.has("unit"))
        node.report(
            fmt::format("key 'unit' is missing: files of '{}' do not say it; one of {}", model, fmt::join(units, ", ")));
    node.finish();
    return source;
}

}  // namespace

ArrivalModelSource read_arrival_model(const config::Node& node, const fs::path& folder, bool has_landscape) {
    ArrivalModelSource source;
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    std::vector<std::string> names;
    for (const auto& model : kModels) names.emplace_back(model.name);
    (void)node.required_child("model");
    source.model = node.choice("model", "other", names);
    const ModelUnits* usual = &kModels.back();
    for (const auto& model : kModels)
        if (source.model == model.name) usual = &model;
    const auto read = [&](const config::Node& key, const char* unit, const std::vector<std::string>& units) {
        return read_unit_raster(key, folder, usual->name, unit, units);
    };
    source.arrival = read(node.required_child("arrival"), usual->time, kTimeUnits);
    source.offset_s = node.number("offset_s", source.offset_s, Range::between(-1e8, 1e8));
    if (const auto key = node.child("fireline_intensity"); key.present())
        source.fireline_intensity = read(key, usual->intensity, kIntensityUnits);
    if (const auto key = node.child("flame_length"); key.present())
        source.flame_length = read(key, usual->length, kLengthUnits);
    if (const auto key = node.child("spread_rate"); key.present()) source.spread_rate = read(key, usual->rate, kRateUnits);
    if (const auto fuel = node.child("fuel"); fuel.present() || !has_landscape)
        source.fuel = read_fuel(node.required_child("fuel"), folder);
    source.fuel_moisture_pct = node.number("fuel_moisture_pct", source.fuel_moisture_pct, Range::between(0.0, 300.0));
    source.frames = read_fire_frames(node);
    node.finish();
    return source;
}

}  // namespace pyroscene::scenario
