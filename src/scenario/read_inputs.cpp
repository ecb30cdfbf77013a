#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {

constexpr config::Range kBand = config::Range::between(1, 65535);

/// How many bands make one frame, and whether the raster may change with time at all.
struct SourceShape {
    bool series = false;
    std::size_t bands_per_frame = 1;
};
constexpr SourceShape kStatic{false, 1}, kScalarSeries{true, 1};

bool given_twice(const config::Node& node, const char* one, const char* several) {
    if (!node.has(one) || !node.has(several)) return false;
    node.report(fmt::format("give '{}' or '{}', not both", one, several));
    return true;
}

std::vector<fs::path> read_files(const config::Node& node, const fs::path& folder, bool series) {
    std::vector<fs::path> files;
    const config::Node one = node.child("file");
    const config::Node several = series ? node.child("files") : config::Node{};
    if (series && given_twice(node, "file", "files")) return files;
    if (!one.present() && !several.present()) {
        node.report(series ? "key 'file' (or 'files') is missing" : "key 'file' is missing");
        return files;
    }
    if (one.present()) return {read_file_name(one, folder)};
    if (!several.is_list() || several.items().empty()) {
        several.report("expected a list of files");
        return files;
    }
    for (const auto& item : several.items()) files.push_back(read_file_name(item, folder));
    return files;
}

/// The words [u, v] stand for the order in which wind bands are stored, which is the default.
bool is_u_v(const config::Node& bands) {
    const auto items = bands.items();
    return items.size() == 2 && items[0].is_scalar() && items[1].is_scalar() && items[0].as_text("") == "u" &&
           items[1].as_text("") == "v";
}

std::vector<int> read_bands(const config::Node& node, const SourceShape& shape) {
    const bool vector = shape.bands_per_frame > 1;
    const config::Node one = vector ? config::Node{} : node.child("band");
    const config::Node several = shape.series ? node.child("bands") : config::Node{};
    if (shape.series && !vector && given_twice(node, "band", "bands")) return {};
    if (one.present()) return {static_cast<int>(one.as_integer(1, kBand))};
    if (!several.present() || (vector && is_u_v(several))) return {};
    if (!several.is_list() || several.items().empty()) {
        several.report(vector ? "expected a list of band numbers: u, v of each frame" : "expected a list of band numbers");
        return {};
    }
    std::vector<int> bands;
    for (const auto& item : several.items()) bands.push_back(static_cast<int>(item.as_integer(1, kBand)));
    if (bands.size() % shape.bands_per_frame != 0)
        several.report(
            shape.bands_per_frame == 2
                ? fmt::format("expected pairs of band numbers (u, v of each frame), found {} numbers", bands.size())
                : fmt::format("expected {} band numbers for each frame, found {} numbers", shape.bands_per_frame,
                              bands.size()));
    return bands;
}

void check_ascending(const config::Node& node, const std::vector<double>& times_s) {
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        if (times_s[i] < 0.0) node.report(fmt::format("must be >= 0, found {}", times_s[i]));
        if (i > 0 && times_s[i] <= times_s[i - 1])
            return node.report(fmt::format("times must ascend, but {} follows {}", times_s[i], times_s[i - 1]));
    }
}

/// Frames that files and bands promise; 0 = known only when the file is opened.
std::size_t promised_frames(const RasterSource& source, const SourceShape& shape) {
    if (!source.bands.empty()) return source.files.size() * (source.bands.size() / shape.bands_per_frame);
    return source.files.size() > 1 ? source.files.size() : 0;
}

std::vector<double> read_times(const config::Node& node, const RasterSource& source, const SourceShape& shape) {
    const std::vector<double> times_s = node.numbers("times_s");
    const config::Node key = node.child("times_s");
    check_ascending(key, times_s);
    const std::size_t frames = promised_frames(source, shape);
    if (!times_s.empty() && frames != 0 && frames != times_s.size())
        key.report(fmt::format("expected one time for each of {} frames (files x bands), found {}", frames, times_s.size()));
    return times_s;
}

RasterSource read_source(const config::Node& node, const fs::path& folder, const SourceShape& shape) {
    RasterSource source;
    source.line = node.line();
    if (!node.is_map()) return source;  // what it is instead is said by finish()
    source.files = read_files(node, folder, shape.series);
    source.bands = read_bands(node, shape);
    if (shape.series) source.times_s = read_times(node, source, shape);
    return source;
}

std::optional<RasterSource> read_optional(const config::Node& node, const fs::path& folder, const SourceShape& shape) {
    if (!node.present()) return std::nullopt;
    RasterSource source = read_source(node, folder, shape);
    node.finish();
    return source;
}

CoverSource read_cover(const config::Node& node, const fs::path& folder) {
    CoverSource cover;
    if (!node.is_map()) {
        node.finish();
        return cover;
    }
    cover.raster = read_source(node, folder, kStatic);
    cover.table = read_fuel_table(node.required_child("table"), folder);
    node.finish();
    return cover;
}

}  // namespace

std::string read_fuel_table(const config::Node& node, const fs::path& folder) {
    std::string table = node.as_text("");
    if (!node.is_scalar() || is_shipped_fuel_table(table)) return table;
    if (table.find('/') != std::string::npos || fs::path(table).extension() == ".csv")
        return read_file_name(node, folder).string();
    node.report(fmt::format("'{}' is none of fbfm13, fbfm40, fbfm53 or a CSV file", table));
    return table;
}

RasterSource read_raster(const config::Node& node, const fs::path& folder) { return read_source(node, folder, kStatic); }

RasterSource read_raster_series(const config::Node& node, const fs::path& folder, std::size_t bands_per_frame) {
    return read_source(node, folder, {true, bands_per_frame});
}

namespace {

/// Levels from near the ground, where layers are thin, to above most plumes.
PlumeSource plume_of_wrf(const WrfSource& wrf) {
    PlumeSource plume;
    plume.files = wrf.files;
    plume.of_wrf = true;
    plume.quantity = PlumeSource::Quantity::Excess;
    plume.levels_m = {5, 15, 30, 50, 75, 100, 140, 190, 250, 320, 400, 500, 650, 800, 1000, 1250, 1500, 2000};
    return plume;
}

}  // namespace

Inputs read_inputs(const config::Node& node, const fs::path& folder) {
    Inputs inputs;
    if (!node.present()) return inputs;
    const config::Node wrf = node.child("wrf_sfire"), landscape = node.child("landscape"), spread = node.child("spread"),
                       modelled = node.child("arrival_model");
    if (wrf.present()) inputs.wrf_sfire = read_wrf(wrf, folder);
    if (landscape.present()) inputs.landscape = read_landscape(landscape, folder);
    const auto given = [&](const char* key) { return wrf.present() ? node.child(key) : node.required_child(key); };
    if (node.has("terrain") || (!wrf.present() && !landscape.present())) {
        const config::Node terrain = node.required_child("terrain");
        inputs.terrain = read_source(terrain, folder, kStatic);
        terrain.finish();
    }
    if (spread.present() && modelled.present()) modelled.report("'spread' makes a fire of its own; give one of the two");
    for (const auto& fire : {spread, modelled})
        if (wrf.present() && fire.present()) fire.report("'wrf_sfire' brings a fire of its own; give one of the two");
    const auto comes_from = [&](const char* source) {
        for (const char* key : {"heat_flux", "fuel_load", "arrival", "fireline_intensity", "flame_length", "spread_rate"})
            if (node.has(key)) node.child(key).report(fmt::format("comes from '{}'; give one of the two", source));
    };
    if (modelled.present()) {
        inputs.arrival_model = read_arrival_model(modelled, folder, landscape.present());
        comes_from("arrival_model");
    } else if (spread.present()) {
        inputs.spread = read_spread(spread, folder, landscape.present());
        comes_from("spread");
    } else {
        const auto heat_flux = given("heat_flux");
        if (heat_flux.present() || !wrf.present()) read_heat_flux(heat_flux, folder, inputs);
    }
    inputs.fuel_load = read_optional(node.child("fuel_load"), folder, kScalarSeries);
    inputs.arrival = read_optional(node.child("arrival"), folder, kStatic);
    inputs.fireline_intensity = read_optional(node.child("fireline_intensity"), folder, kStatic);
    inputs.flame_length = read_optional(node.child("flame_length"), folder, kStatic);
    inputs.spread_rate = read_optional(node.child("spread_rate"), folder, kStatic);
    if (const auto wind = node.child("wind"); wind.present())
        inputs.wind = read_wind(wind, folder, inputs.wrf_sfire.has_value());
    if (const auto cover = node.child("cover"); cover.present()) inputs.cover = read_cover(cover, folder);
    if (const auto plume = node.child("plume"); plume.present()) {
        inputs.plume = read_plume_source(plume, folder);
        if (inputs.wrf_sfire && inputs.wrf_sfire->plume)
            plume.report("'wrf_sfire' brings a plume of its own; give one of the two");
    } else if (inputs.wrf_sfire && inputs.wrf_sfire->plume) {
        inputs.plume = plume_of_wrf(*inputs.wrf_sfire);
    }
    if (inputs.spread && inputs.spread->says_wind_height && inputs.wind && inputs.wind->level)
        spread.child("wind_height").report("'inputs.wind.height' says it; give one of the two");
    // Flames lean in the wind that spreads the fire, at their own height.
    if (inputs.spread && inputs.wind && !inputs.wind->level) inputs.wind->level = inputs.spread->wind_level;
    if (inputs.landscape) add_landscape(*inputs.landscape, inputs);
    node.finish();
    return inputs;
}

}  // namespace pyroscene::scenario
