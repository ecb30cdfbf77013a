#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/files.h"
#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {

using config::Range;

/// Ids of the sensor files that are shipped.
std::vector<std::string> shipped_sensors() {
    std::vector<std::string> ids;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(sensor_folder() / "specs", ignored))
        if (entry.path().extension() == ".yaml") ids.push_back(entry.path().stem().string());
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// A word is the id of a shipped sensor, anything that looks like a path a file beside the scenario.
std::string read_sensor(const config::Node& node, const fs::path& folder) {
    const std::string word = node.as_text("");
    if (!node.is_scalar()) return word;
    const auto extension = fs::path(word).extension();
    if (word.find('/') != std::string::npos || extension == ".yaml" || extension == ".yml")
        return read_file_name(node, folder).string();
    const auto ids = shipped_sensors();
    if (std::find(ids.begin(), ids.end(), word) != ids.end()) return word;
    const std::string guess = config::nearest(word, ids);
    node.report(guess.empty() ? fmt::format("unknown sensor '{}'; 'pyroscene sensors' lists those there are", word)
                              : fmt::format("unknown sensor '{}'; did you mean '{}'?", word, guess));
    return word;
}

void read_place(const config::Node& over, Platform& platform) {
    if (!over.is_map()) {
        const std::string word = over.as_text("centre");
        if (over.present() && !over.is_scalar()) return;  // said by as_text
        platform.over_centre = word == "centre";
        platform.over_fire = word == "fire";
        if (!platform.over_centre && !platform.over_fire)
            over.report(fmt::format("'{}' is none of centre, fire, {{x_m, y_m}} or {{lat_deg, lon_deg}}", word));
        return;
    }
    const auto x = over.optional_number("x_m"), y = over.optional_number("y_m");
    const auto lat = over.optional_number("lat_deg", Range::between(-90.0, 90.0));
    const auto lon = over.optional_number("lon_deg", Range::between(-180.0, 180.0));
    const bool map = over.has("x_m") || over.has("y_m"), geographic = over.has("lat_deg") || over.has("lon_deg");
    const bool complete = map ? over.has("x_m") && over.has("y_m") : over.has("lat_deg") && over.has("lon_deg");
    if (map == geographic || !complete) over.report("expected {x_m, y_m} or {lat_deg, lon_deg}");
    if (x && y) platform.map_xy_m = {*x, *y};
    if (lat && lon) platform.lat_lon_deg = {*lat, *lon};
    over.finish();
}

/// Orbit or measured path, relative file names from the folder of the scenario.
void read_path(const config::Node& node, const fs::path& folder, Platform& platform) {
    const std::string pass = node.choice("pass", "", {"ascending", "descending", "geostationary"});
    platform.pass = pass == "ascending"       ? Platform::Pass::Ascending
                    : pass == "descending"    ? Platform::Pass::Descending
                    : pass == "geostationary" ? Platform::Pass::Geostationary
                                              : Platform::Pass::None;
    platform.scan_angle_deg = node.number("scan_angle_deg", 0.0, Range::between(-90.0, 90.0));
    if (node.is_map() && node.has("scan_angle_deg") && !node.has("pass"))
        node.child("scan_angle_deg").report("says where in a 'pass' the place is seen; a flight line starts over it");
    if (const config::Node file = node.child("trajectory"); file.present())
        platform.trajectory = read_file_name(file, folder);
    if (node.is_map() && node.has("trajectory") && (node.has("pass") || node.has("over")))
        node.child("trajectory").report("says where the platform is; leave 'pass' and 'over' out");
}

Platform read_platform(const config::Node& node, const fs::path& folder) {
    Platform platform;
    if (!node.present()) return platform;
    read_place(node.child("over"), platform);
    platform.altitude_agl_m = node.optional_number("altitude_agl_m", Range{0.0, 5e7, true});
    platform.altitude_m = node.optional_number("altitude_m", Range::between(-500.0, 5e7));
    platform.ground_speed_m_s = node.optional_number("ground_speed_m_s", Range{0.0, 2e4, true});
    read_path(node, folder, platform);
    const bool elsewhere = node.is_map() && (node.has("pass") || node.has("trajectory"));
    if (node.is_map() && !elsewhere && node.has("altitude_agl_m") == node.has("altitude_m"))
        node.report(node.has("altitude_m") ? "give 'altitude_agl_m' or 'altitude_m', not both"
                                           : "key 'altitude_agl_m' (above the terrain) or 'altitude_m' is missing");
    if (elsewhere &&
        (node.has("altitude_agl_m") || node.has("altitude_m") || node.has("heading_deg") || node.has("ground_speed_m_s")))
        node.report("'pass' and 'trajectory' bring height, heading and speed with them; leave those keys out");
    platform.heading_deg = node.number("heading_deg", 0.0, Range::between(-360.0, 360.0));
    platform.pitch_deg = node.number("pitch_deg", 0.0, Range::between(-180.0, 180.0));
    platform.roll_deg = node.number("roll_deg", 0.0, Range::between(-180.0, 180.0));
    node.finish();
    return platform;
}

std::string read_id(const config::Node& node) {
    std::string id = node.as_text("");
    if (!node.is_scalar()) return id;
    if (!is_safe_name(id))
        node.report(
            fmt::format("'{}' cannot be a folder name; use letters, digits, '.', '_', '-' (first a letter or digit)", id));
    if (id == "state") node.report("'state' is the folder of the fire states; choose another id");
    return id;
}

Acquisition read_acquisition(const config::Node& node, const fs::path& folder) {
    Acquisition acquisition;
    acquisition.line = node.line();
    acquisition.id = read_id(node.required_child("id"));
    acquisition.sensor = read_sensor(node.required_child("sensor"), folder);
    acquisition.time_s = node.required_child("time_s").as_number(0.0, Range::between(0.0, 1e8));
    acquisition.platform = read_platform(node.required_child("platform"), folder);
    acquisition.groups = read_words(node.child("groups"));
    acquisition.bands = read_words(node.child("bands"));
    acquisition.view = node.text("view", "");
    acquisition.whole_lines = node.choice("samples", "scene", {"scene", "all"}) == "all";
    if (const config::Node lines = node.child("lines"); lines.present())
        acquisition.lines = static_cast<int>(lines.as_integer(1, Range::between(2, 100000)));
    node.finish();
    return acquisition;
}

bool* product_flag(Products& products, const std::string& name) {
    const std::map<std::string, bool*> flags{
        {"radiance", &products.radiance},   {"brightness_temperature", &products.brightness_temperature},
        {"ortho", &products.ortho},         {"truth", &products.truth},
        {"fractions", &products.fractions}, {"frp", &products.frp},
        {"quicklook", &products.quicklook}, {"report", &products.report},
        {"native", &products.native}};
    const auto found = flags.find(name);
    return found == flags.end() ? nullptr : found->second;
}

}  // namespace

std::vector<Acquisition> read_acquisitions(const config::Node& node, const fs::path& folder) {
    std::vector<Acquisition> acquisitions;
    if (!node.present()) return acquisitions;
    if (!node.is_list() || node.items().empty()) {
        node.report(
            "expected a list with at least one acquisition ('- {id: ..., sensor: ..., time_s: ..., platform: ...}')");
        return acquisitions;
    }
    std::map<std::string, int> line_of_id;
    for (const auto& item : node.items()) {
        acquisitions.push_back(read_acquisition(item, folder));
        const auto& id = acquisitions.back().id;
        if (id.empty()) continue;
        const auto [first, is_new] = line_of_id.emplace(id, item.line());
        if (!is_new) item.child("id").report(fmt::format("'{}' is used twice (first in line {})", id, first->second));
    }
    return acquisitions;
}

Products read_products(const config::Node& node) {
    if (!node.present()) return {};
    Products products{false, false, false, false, false, false, false, false};
    for (const auto& name : read_words(node)) {
        bool* flag = product_flag(products, name);
        const std::string guess = config::nearest(name, kProductNames);
        if (flag == nullptr && guess.empty())
            node.report(fmt::format("'{}' is none of {}", name, fmt::join(kProductNames, ", ")));
        else if (flag == nullptr)
            node.report(fmt::format("unknown product '{}'; did you mean '{}'?", name, guess));
        else if (*flag)
            node.report(fmt::format("product '{}' is named twice", name));
        else
            *flag = true;
    }
    return products;
}

}  // namespace pyroscene::scenario
