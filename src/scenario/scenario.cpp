#include "scenario/scenario.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

bool is_safe_name(const std::string& name) {
    const auto letter_or_digit = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    const auto safe = [&](char c) { return letter_or_digit(c) || c == '.' || c == '_' || c == '-'; };
    return !name.empty() && name.size() <= 100 && letter_or_digit(name.front()) &&
           std::all_of(name.begin(), name.end(), safe);
}

fs::path read_file_name(const config::Node& node, const fs::path& folder) {
    const std::string name = node.as_text("");
    if (!node.is_scalar()) return {};
    const fs::path path = (folder / name).lexically_normal();
    std::error_code ignored;
    if (name.empty() || fs::is_directory(path, ignored))
        node.report(fmt::format("'{}' is a folder, expected a file", name));
    else if (!fs::exists(path, ignored))
        node.report(fmt::format("file '{}' does not exist ({})", name, path.string()));
    return path;
}

std::vector<std::string> read_words(const config::Node& node) {
    std::vector<std::string> words;
    if (!node.present()) return words;
    if (!node.is_list() || node.items().empty()) {
        node.report("expected a list of names; leave the key out for all");
        return words;
    }
    for (const auto& item : node.items())
        if (std::string word = item.as_text(""); item.is_scalar()) words.push_back(std::move(word));
    return words;
}

namespace {

void check_version(const config::Node& version) {
    const long long found = version.as_integer(1);
    if (found != 1) version.report(fmt::format("format version {} is unknown, this program reads version 1", found));
}

UtcTime read_start(const config::Node& node) {
    if (!node.is_scalar()) {
        if (node.present()) node.report("expected a time like 2017-07-15T22:00:00Z");
        return {};
    }
    const auto time = parse_utc(node.as_text(""));
    if (!time) node.report(fmt::format("expected UTC like 2017-07-15T22:00:00Z, found '{}'", node.as_text("")));
    const auto first = parse_utc("1901-01-01T00:00:00Z"), end = parse_utc("2100-01-01T00:00:00Z");
    if (time && (time->unix_s < first->unix_s || time->unix_s >= end->unix_s))
        node.report(fmt::format("must lie in the years 1901 to 2099, found {}", node.as_text("")));
    return time.value_or(UtcTime{});
}

void read_head(const config::Node& root, Scenario& s) {
    check_version(root.required_child("pyroscene"));
    s.name = root.text("name", s.path.stem().string());
    if (root.has("name") && root.child("name").is_scalar() && !is_safe_name(s.name))
        root.child("name").report(
            fmt::format("'{}' is no plain name; use letters, digits, '.', '_', '-' (text goes to 'title')", s.name));
    s.title = root.text("title", s.name);
    const config::Node map = root.child("map");
    if (const std::string crs = map.text("crs", ""); !crs.empty()) s.map_crs = crs;
    s.map_cell_m = map.optional_number("cell_m", config::Range::between(0.1, 10000.0));
    map.finish();
    s.geoid_undulation_m = root.number("geoid_undulation_m", s.geoid_undulation_m, config::Range::between(-120.0, 120.0));
    s.start = read_start(root.required_child("start"));
    s.seed = static_cast<std::uint64_t>(root.integer("seed", static_cast<long long>(s.seed), config::Range::not_negative()));
}

/// Of the fuel whose heat comes as rasters: WRF-SFIRE and the program's own fires have made theirs with a value of their own.
bool gives_heat_of_combustion(const config::Node& root, const Inputs& inputs) {
    const bool of_rasters = !inputs.spread && !inputs.arrival_model && !inputs.wrf_sfire;
    return of_rasters && root.child("fire").has("heat_of_combustion_J_kg");
}

fire::Physics read_physics(const config::Node& root) {
    const bool thesis = root.choice("physics", "default", {"default", "thesis"}) == "thesis";
    return thesis ? fire::Physics::Thesis : fire::Physics::Default;
}

}  // namespace

Scenario load(const fs::path& path) {
    config::Document document(path);
    const config::Node root = document.root();
    Scenario s;
    s.path = fs::absolute(path).lexically_normal();
    const fs::path folder = s.path.parent_path();
    read_head(root, s);
    s.inputs = read_inputs(root.required_child("inputs"), folder);
    s.physics = read_physics(root);
    s.fire = read_fire(root.child("fire"));
    read_scar(root.child("scar"), folder, s.inputs.cover.has_value(), s.fire);
    s.fire.physics = s.physics;
    s.fire.seed = s.seed;
    check_flame_inputs(root, s);
    s.flame = read_flame(root.child("flame"), s.physics);
    s.flame.parameters.profile.air_K = s.fire.air_temperature_K;
    s.plume = read_plume(root.child("plume"), s.inputs, s.fire, gives_heat_of_combustion(root, s.inputs));
    s.surface = read_surface(root.child("surface"), folder);
    s.atmosphere = read_atmosphere(root.child("atmosphere"), folder);
    s.render = read_render(root.child("render"), s.surface);
    s.acquisitions = read_acquisitions(root.required_child("acquisitions"), folder);
    s.mosaics = read_mosaics(root.child("mosaics"), s.acquisitions);
    s.products = read_products(root.child("products"));
    root.finish();
    document.throw_if_any();
    s.notes = unused_keys(root, s);
    return s;
}

}  // namespace pyroscene::scenario
