#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;

std::vector<fs::path> read_several(const config::Node& node, const fs::path& folder) {
    if (!node.present()) return {};
    if (!node.is_list()) return {read_file_name(node, folder)};
    std::vector<fs::path> files;
    for (const auto& item : node.items()) files.push_back(read_file_name(item, folder));
    return files;
}

/// What WindNinja calls the directions that belong to a file of speeds; reports a file that is neither.
fs::path angle_beside(const config::Node& node, const fs::path& speed) {
    auto stem = speed.stem().string();
    if (!stem.ends_with("_vel")) {
        node.report(
            fmt::format("'{}' is no speed of WindNinja, whose names end in _vel; give 'angle' for files of other names",
                        speed.filename().string()));
        return {};
    }
    const auto angle = speed.parent_path() / (stem.replace(stem.size() - 3, 3, "ang") + speed.extension().string());
    if (std::error_code ignored; !fs::exists(angle, ignored))
        node.report(fmt::format("there is no '{}' beside '{}'", angle.filename().string(), speed.filename().string()));
    return angle;
}

WindNinjaSource read_windninja(const config::Node& node, const fs::path& folder) {
    WindNinjaSource wind;
    if (!node.is_map()) {
        node.finish();
        return wind;
    }
    const auto speed = node.required_child("speed"), angle = node.child("angle");
    wind.speed = read_several(speed, folder);
    if (angle.present())
        wind.angle = read_several(angle, folder);
    else
        for (const auto& file : wind.speed) wind.angle.push_back(angle_beside(speed, file));
    if (wind.angle.size() != wind.speed.size())
        angle.report(fmt::format("expected one file for each of {} speeds, found {}", wind.speed.size(), wind.angle.size()));
    (void)node.required_child("unit");
    wind.unit = node.choice("unit", "m/s", kSpeedUnits);
    wind.crs = node.text("crs", "");
    wind.grid_north = node.choice("north", "true", {"true", "grid"}) == "grid";
    wind.times_s = node.numbers("times_s");
    const auto times = node.child("times_s");
    if (wind.times_s.empty() ? wind.speed.size() > 1 : wind.times_s.size() != wind.speed.size())
        (times.present() ? times : node)
            .report(fmt::format("expected one of 'times_s' for each of {} files of speed, found {}", wind.speed.size(),
                                wind.times_s.size()));
    for (std::size_t i = 1; i < wind.times_s.size(); ++i)
        if (wind.times_s[i] <= wind.times_s[i - 1]) {
            times.report(fmt::format("times must ascend, but {} follows {}", wind.times_s[i], wind.times_s[i - 1]));
            break;
        }
    for (const double t : wind.times_s)
        if (t < 0.0) times.report(fmt::format("must be >= 0, found {}", t));
    node.finish();
    return wind;
}

/// Where the wind blows, and what lies below it.
void read_level(const config::Node& node, const fs::path& folder, WindSource& wind) {
    using Kind = spread::WindLevel::Kind;
    const auto name = node.choice("height", "20ft", kWindHeights);
    const auto height_m = node.optional_number("height_m", Range::between(0.5, 500.0));
    const auto roughness_m = node.optional_number("roughness_m", Range::between(1e-5, 5.0));
    wind.fuel_depth_m = node.optional_number("fuel_depth_m", Range{0.0, 10.0, true});
    wind.canopy = read_canopy(node.child("canopy"), folder);
    if (node.has("height") && height_m) node.child("height_m").report("'height' says it; give one of the two");
    if (roughness_m && !height_m) node.child("roughness_m").report("belongs to 'height_m'");
    if (roughness_m && height_m && !(*height_m > 2.0 * *roughness_m))
        node.child("roughness_m")
            .report(fmt::format("of {} m, expected less than half of the height of {} m", *roughness_m, *height_m));
    if (node.has("height") || height_m) {
        wind.level.emplace();
        wind.level->kind = height_m ? Kind::Metres : wind_level_kind(name);
        wind.level->height_m = height_m.value_or(wind.level->height_m);
        wind.level->roughness_m = roughness_m;
        return;
    }
    for (const char* key : {"fuel_depth_m", "canopy"})
        if (node.has(key)) node.child(key).report("is about the wind at a 'height'; give that too");
}

void read_uniform(const config::Node& node, WindSource& wind) {
    constexpr Range kSpeed = Range::between(0.0, 100.0);
    const auto short_name = node.optional_number("speed", kSpeed), speed = node.optional_number("speed_m_s", kSpeed);
    if (short_name && speed) node.report("give 'speed' or 'speed_m_s', not both");
    const auto from_deg = node.optional_number("from_deg", Range::between(-360.0, 360.0));
    wind.speed_given = node.has("speed") || node.has("speed_m_s") || node.has("from_deg");
    if (!wind.speed_given) return;
    if (!node.has("speed") && !node.has("speed_m_s")) node.report("key 'speed' is missing");
    if (!node.has("from_deg")) node.report("key 'from_deg' is missing (where the wind comes from)");
    wind.speed_m_s = speed.value_or(short_name.value_or(0.0));
    wind.from_deg = from_deg.value_or(wind.from_deg);
}

}  // namespace

spread::WindLevel::Kind wind_level_kind(const std::string& height) {
    using Kind = spread::WindLevel::Kind;
    return height == "midflame" ? Kind::Midflame : height == "10m" ? Kind::TenMetres : Kind::TwentyFeet;
}

WindSource read_wind(const config::Node& node, const fs::path& folder, bool beside_model) {
    WindSource wind;
    if (!node.is_map()) {
        node.finish();
        return wind;
    }
    const bool raster = node.has("file") || node.has("files");
    const auto table = node.child("table"), windninja = node.child("windninja");
    read_uniform(node, wind);
    read_level(node, folder, wind);
    for (const char* key : {"file", "files", "bands", "times_s"}) node.ignore(key);
    if (table.present()) wind.table = read_file_name(table, folder);
    if (windninja.present()) wind.windninja = read_windninja(windninja, folder);
    const int given = int{raster} + int{wind.speed_given} + int{table.present()} + int{windninja.present()};
    if (table.present() && given > 1) table.report("stands alone; give it, rasters, or 'speed' and 'from_deg'");
    if (windninja.present() && given > 1) windninja.report("stands alone; give one source of the wind");
    if (raster && wind.speed_given) node.report("give rasters or 'speed' and 'from_deg', not both");
    if (given == 0 && !(beside_model && wind.level))
        node.report("expected 'file' or 'files' with u and v, 'table', 'windninja', or 'speed' and 'from_deg'");
    if (raster && given == 1) wind.raster = read_raster_series(node, folder, 2);
    node.finish();
    return wind;
}

}  // namespace pyroscene::scenario
