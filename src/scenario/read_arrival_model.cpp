#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;

/// What the arrival times of a program are: rasters, Cell2Fire's messages or grids, QUIC-Fire's burnt mass, the index of an FDS run.
enum class Form { Raster, Cell2Fire, QuicFire, Fds };

/// The units in which a program always writes; empty = its user chooses, and the files do not say.
struct ModelUnits {
    const char *name, *time, *intensity, *length, *rate;
    Form form = Form::Raster;
};
constexpr std::array<ModelUnits, 9> kModels{{{"farsite", "", "", "", ""},
                                             {"flammap", "min", "", "", ""},
                                             {"elmfire", "s", "kW/m", "ft", "ft/min"},
                                             {"pyretechnics", "min", "kW/m", "m", "m/min"},
                                             {"cell2fire", "", "", "", "", Form::Cell2Fire},
                                             {"forefire", "s", "", "", "m/s"},
                                             {"quic-fire", "s", "", "", "", Form::QuicFire},
                                             {"fds", "s", "", "", "m/s", Form::Fds},
                                             {"other", "", "", "", ""}}};

/// The raster and its unit: the key's, else what the program always writes.
UnitRaster read_unit_raster(const config::Node& node, const fs::path& folder, const ModelUnits& model, const char* usual,
                            const std::vector<std::string>& units, bool several = false) {
    UnitRaster source;
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    if (several && node.has("files"))
        for (const auto& file : node.child("files").items()) source.raster.files.push_back(read_file_name(file, folder));
    if (several && node.has("file") == !source.raster.files.empty()) node.report("expected 'file' or 'files'");
    if (source.raster.files.empty()) source.raster = read_raster(node, folder);
    source.raster.line = node.line();
    source.unit = node.choice("unit", usual, units);
    if (source.unit.empty() && !node.has("unit"))
        node.report(fmt::format("key 'unit' is missing: files of '{}' do not say it; one of {}", model.name,
                                fmt::join(units, ", ")));
    return source;
}

/// Keys that only some programs' files need.
void read_place(const config::Node& node, const fs::path& folder, const ModelUnits& model, ArrivalModelSource& source) {
    constexpr Range kPlace = Range::between(-1e8, 1e8), kCells = Range::between(1, 100000);
    if (const auto like = node.child("like"); like.present()) source.like = read_file_name(like, folder);
    source.crs = node.text("crs", "");
    source.west_m = node.optional_number("west_m", kPlace);
    source.south_m = node.optional_number("south_m", kPlace);
    source.cols = static_cast<int>(node.integer("cols", 0, kCells));
    source.rows = static_cast<int>(node.integer("rows", 0, kCells));
    source.cell_m = node.number("cell_m", source.cell_m, Range::between(0.1, 10000.0));
    const auto takes = [&](const char* key, bool wanted) {
        if (node.has(key) && !wanted) node.child(key).report(fmt::format("does not belong to model '{}'", model.name));
        if (!node.has(key) && wanted)
            node.report(fmt::format("key '{}' is missing: files of '{}' do not say it", key, model.name));
    };
    const bool local = model.form == Form::QuicFire || model.form == Form::Fds, quic = model.form == Form::QuicFire;
    takes("like", model.form == Form::Cell2Fire);
    for (const char* key : {"west_m", "south_m"}) takes(key, local);
    for (const char* key : {"cols", "rows", "cell_m"}) takes(key, quic);
    if (local) takes("crs", true);
}

/// Arrival times: a raster or, of programs that write none, one file or several.
void read_arrival(const config::Node& node, const fs::path& folder, const ModelUnits& model, ArrivalModelSource& source) {
    const bool several = model.form == Form::Cell2Fire || model.form == Form::QuicFire;
    source.arrival = read_unit_raster(node, folder, model, model.time, kTimeUnits, several);
    source.grids = model.form == Form::Cell2Fire && node.has("files");
    source.period = node.number("period", source.period, Range{0.0, 1e5, true});
    const auto files = node.child("files"), period = node.child("period");
    if (files.present() && !several) files.report(fmt::format("does not belong to model '{}'", model.name));
    if (period.present() && model.form != Form::Cell2Fire)
        period.report(fmt::format("does not belong to model '{}'", model.name));
    if (source.grids && !period.present())
        node.report("key 'period' is missing: files of 'cell2fire' do not say how long a period of the weather is");
    node.finish();
}

}  // namespace

ArrivalModelSource read_arrival_model(const config::Node& node, const fs::path& folder, bool has_landscape) {
    ArrivalModelSource source;
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    std::vector<std::string> names;
    names.reserve(kModels.size());
    for (const auto& model : kModels) names.emplace_back(model.name);
    (void)node.required_child("model");
    source.model = node.choice("model", "other", names);
    const ModelUnits* usual = &kModels.back();
    for (const auto& model : kModels)
        if (source.model == model.name) usual = &model;
    const auto read = [&](const config::Node& key, const char* unit, const std::vector<std::string>& units) {
        auto raster = read_unit_raster(key, folder, *usual, unit, units);
        key.finish();
        return raster;
    };
    read_arrival(node.required_child("arrival"), folder, *usual, source);
    read_place(node, folder, *usual, source);
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
