#include <algorithm>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace pyroscene::scenario {
namespace {

/// Keys of a section that say nothing when `idle` holds.
struct Rule {
    bool idle;
    const char* section;  ///< path of maps from the root, '.' between them
    std::vector<std::string> keys;
    std::string why;
};

config::Node section(const config::Node& root, std::string_view path) {
    const auto dot = path.find('.');
    const auto head = root.child(path.substr(0, dot));
    return dot == std::string_view::npos || !head.is_map() ? head : section(head, path.substr(dot + 1));
}

std::vector<std::string> all_keys_but(const config::Node& node, const std::vector<std::string>& used) {
    auto keys = node.is_map() ? node.keys() : std::vector<std::string>{};
    std::erase_if(keys, [&](const std::string& key) { return std::find(used.begin(), used.end(), key) != used.end(); });
    return keys;
}

std::vector<Rule> rules(const config::Node& root, const Scenario& s) {
    const auto& height = s.fire.flames.height.method;
    const auto of_method = [&](const char* method, std::vector<std::string> keys) {
        return Rule{height != method, "fire.flame_height", std::move(keys), fmt::format("the method is '{}'", height)};
    };
    const bool grey = s.flame.grey_absorption_per_m.has_value();
    const bool plume = s.plume.rise || s.inputs.plume || !s.plume.layers.empty();
    using Shape = fire::TemperatureProfile::Shape;
    return {
        of_method("heat_flux", {"alpha", "volumetric_heat_release_W_m3"}),
        of_method("constant", {"constant_m"}),
        of_method("heskestad", {"air_fuel_ratio", "plume_coefficient_m_kW", "burning_area_fraction"}),
        of_method("butler", {"stand_height_m"}),
        {s.fire.flames.intensity == fire::IntensityRule::HeatFlux,
         "fire.fireline_intensity",
         {"consumed_fraction"},
         "intensity follows the heat flux"},
        {s.fire.flames.depth == fire::DepthRule::HeatFlux,
         "fire.front_depth",
         {"residence_time_s"},
         "the depth follows the heat flux"},
        {!s.fire.embers.drift, "fire.embers", {"cooling_time_s", "lifetime_s"}, "embers do not drift"},
        // Voxels also set how finely the ground inside a map cell is resolved.
        {s.flame.off, "flame", all_keys_but(root.child("flame"), {"enabled", "voxel_m"}), "there are no flames"},
        {!s.flame.off && s.flame.parameters.profile.shape != Shape::Linear,
         "flame",
         {"tip_temperature_K"},
         "the profile is not linear"},
        {!s.flame.off && !s.flame.radiant_fraction, "flame", {"adjust"}, "there is no radiant_fraction to meet"},
        {!s.flame.off && (grey || !s.flame.hot_gas), "flame", {"pressure_Pa"}, "there is no hot gas"},
        {!s.flame.off && (grey || !s.flame.hot_gas),
         "flame.composition",
         {"x_H2O", "x_CO2", "x_CO", "x_CH4", "x_O2", "potassium_ppm", "sodium_ppm"},
         "there is no hot gas"},
        {!plume, "plume", all_keys_but(root.child("plume"), {"model"}), "there is no plume"},
        {plume && !s.plume.rise,
         "plume",
         {"duration_s", "entrainment", "merge_m"},
         "the plume is not one of the rise model"},
        {s.surface.emissivity.has_value(),
         "surface",
         {"unburned", "burned", "ash", "burn_severity", "spectra"},
         "one emissivity stands for all ground"},
        {!s.surface.emissivity && s.surface.burn_severity == 0.0, "surface", {"ash"}, "burn_severity is 0"},
        {s.atmosphere.model == "none" && !s.atmosphere.file,
         "atmosphere",
         {"visibility_km", "ground_elevation_m"},
         "there is no air"},
        {!s.render.flame_light,
         "render",
         {"light_directions", "light_reach_m", "flame_light_model", "point_source_cut", "light_bounces", "light_decay"},
         "flames throw no light on the ground"},
        {s.render.flame_light && !s.render.point_sources, "render", {"point_source_cut"}, "flames are no point sources"},
    };
}

}  // namespace

std::vector<std::string> unused_keys(const config::Node& root, const Scenario& s) {
    std::vector<std::string> out;
    for (const auto& rule : rules(root, s)) {
        const auto node = section(root, rule.section);
        if (!rule.idle || !node.is_map()) continue;
        for (const auto& key : rule.keys)
            if (node.has(key))
                out.push_back(fmt::format("{}:{}: {} has no effect: {}", s.path.filename().string(), node.child(key).line(),
                                          node.child(key).key_path(), rule.why));
    }
    return out;
}

}  // namespace pyroscene::scenario
