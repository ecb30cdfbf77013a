#include <algorithm>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/files.h"
#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {

using config::Range;

void read_air(const config::Node& node, fire::FireParameters& p) {
    p.air_density_kg_m3 = node.number("density_kg_m3", p.air_density_kg_m3, Range::between(0.1, 2.0));
    p.air_heat_capacity_J_kg_K =
        node.number("heat_capacity_J_kg_K", p.air_heat_capacity_J_kg_K, Range::between(500.0, 2000.0));
    p.air_temperature_K = node.number("temperature_K", p.air_temperature_K, Range::between(200.0, 400.0));
    auto& vapour_kg_m3 = p.flames.tilt.fuel_vapour_density_kg_m3;
    vapour_kg_m3 = node.number("fuel_vapour_density_kg_m3", vapour_kg_m3, Range::between(0.05, 5.0));
    node.finish();
}

fire::EmberParameters read_embers(const config::Node& node) {
    fire::EmberParameters embers;
    embers.drift = node.boolean("drift", embers.drift);
    embers.cooling_time_s = node.number("cooling_time_s", embers.cooling_time_s, Range{0.0, 1e4, true});
    embers.lifetime_s = node.number("lifetime_s", embers.lifetime_s, Range::between(0.0, 1e5));
    embers.wind_height_m = node.number("wind_height_m", embers.wind_height_m, Range::between(0.1, 1000.0));
    embers.wind_exponent = node.number("wind_exponent", embers.wind_exponent, Range::between(0.0, 1.0));
    node.finish();
    return embers;
}

/// Names of the shipped surface spectra (the columns of the table after the wavelength) and of the user's.
std::vector<std::string> surface_names(const SurfaceSettings& surface) {
    auto names = read_csv(data_folder() / "optical" / "surface_reflectance.csv").columns;
    names.erase(names.begin());
    for (const auto& [name, file] : surface.spectra)
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    return names;
}

}  // namespace

fire::FireParameters read_fire(const config::Node& node) {
    fire::FireParameters p;
    p.front_threshold_W_m2 = node.number("front_threshold_W_m2", p.front_threshold_W_m2, Range{0.0, 1e8, true});
    p.front_temperature_K = node.number("front_temperature_K", p.front_temperature_K, kTemperature_K);
    p.ambient_temperature_K = node.number("ambient_temperature_K", p.ambient_temperature_K, kTemperature_K);
    p.flaming_heat_flux_W_m2 = node.number("flaming_heat_flux_W_m2", p.flaming_heat_flux_W_m2, Range{0.0, 1e8, true});
    p.one_sigma_rule = node.boolean("one_sigma_rule", p.one_sigma_rule);
    p.jitter_m = node.number("jitter_m", p.jitter_m, Range::between(0.0, 1000.0));
    p.embers = read_embers(node.child("embers"));
    read_flame_relations(node, p);
    read_air(node.child("air"), p);
    node.finish();
    return p;
}

namespace {

constexpr Range kSoot = Range::between(0.0, 1e-4);

FlameGas read_composition(const config::Node& node) {
    FlameGas gas;
    constexpr Range kFraction = Range::between(0.0, 1.0);
    gas.soot_volume_fraction = node.number("soot_volume_fraction", gas.soot_volume_fraction, kSoot);
    gas.x_H2O = node.number("x_H2O", gas.x_H2O, kFraction);
    gas.x_CO2 = node.number("x_CO2", gas.x_CO2, kFraction);
    gas.x_CO = node.number("x_CO", gas.x_CO, kFraction);
    gas.x_CH4 = node.number("x_CH4", gas.x_CH4, kFraction);
    gas.x_O2 = node.number("x_O2", gas.x_O2, kFraction);
    gas.potassium_ppm = node.number("potassium_ppm", gas.potassium_ppm, Range::between(0.0, 1000.0));
    gas.sodium_ppm = node.number("sodium_ppm", gas.sodium_ppm, Range::between(0.0, 1000.0));
    if (gas.x_N2() < -1e-9) node.report(fmt::format("mole fractions sum to {:g}, more than 1", 1.0 - gas.x_N2()));
    node.finish();
    return gas;
}

/// How temperature runs from the base of a flame to its tip.
void read_profile(const config::Node& node, fire::FlameParameters& p) {
    using Shape = fire::TemperatureProfile::Shape;
    const auto& names = fire::kTemperatureProfileNames;
    const std::string name = node.choice("profile", names[0], {std::begin(names), std::end(names)});
    p.profile.shape = static_cast<Shape>(std::find(std::begin(names), std::end(names), name) - std::begin(names));
    p.profile.tip_K = node.number("tip_temperature_K", p.profile.tip_K, kTemperature_K);
}

}  // namespace

FlameSettings read_flame(const config::Node& node, fire::Physics physics) {
    FlameSettings flame;
    flame.hot_gas = node.boolean("hot_gas", physics == fire::Physics::Default);
    auto& p = flame.parameters;
    flame.off = !node.boolean("enabled", !flame.off);
    p.temperature_K = node.number("temperature_K", p.temperature_K, kTemperature_K);
    flame.gas = read_composition(node.child("composition"));
    flame.gas.soot_volume_fraction = node.number("soot_volume_fraction", flame.gas.soot_volume_fraction, kSoot);
    if (node.has("soot_volume_fraction") && node.child("composition").has("soot_volume_fraction"))
        node.child("soot_volume_fraction").report("is in 'composition' too; give it once");
    flame.pressure_Pa = node.optional_number("pressure_Pa", Range::between(1e4, 1.2e5));
    read_profile(node, p);
    flame.grey_absorption_per_m = node.optional_number("absorption_per_m", Range::between(0.0, 1e4));
    flame.radiant_fraction = node.optional_number("radiant_fraction", Range{0.0, 0.9, true});
    flame.adjust_temperature = node.choice("adjust", "soot", {"soot", "temperature"}) == "temperature";
    if (flame.radiant_fraction && !flame.adjust_temperature && node.has("absorption_per_m"))
        node.child("radiant_fraction").report("a grey flame has no soot to scale; give 'adjust: temperature'");
    if (flame.grey_absorption_per_m && node.has("hot_gas") && flame.hot_gas)
        node.child("hot_gas").report("has no place in a grey flame; drop it or 'absorption_per_m'");
    p.ember_gap_m = node.number("ember_gap_m", p.ember_gap_m, Range::between(0.0, 100.0));
    const bool soot = node.has("soot_volume_fraction") || node.child("composition").has("soot_volume_fraction");
    if (soot && node.has("absorption_per_m"))
        node.child("absorption_per_m").report("replaces soot; give 'soot_volume_fraction' or 'absorption_per_m', not both");
    const auto edges_m = node.numbers("voxel_m", 3);
    const auto items = node.child("voxel_m").items();
    for (std::size_t axis = 0; axis < edges_m.size(); ++axis)
        p.voxel_m[axis] = items[axis].as_number(p.voxel_m[axis], Range::between(0.05, 200.0));
    node.finish();
    return flame;
}

SurfaceSettings read_surface(const config::Node& node, const fs::path& folder) {
    SurfaceSettings surface;
    if (!node.present()) return surface;
    if (const auto spectra = node.child("spectra"); spectra.present() && !spectra.is_map())
        spectra.report("expected names with files: {my_grass: my_grass.csv}");
    else
        for (const auto& name : spectra.keys()) surface.spectra[name] = read_file_name(spectra.child(name), folder);
    const auto names = surface_names(surface);
    surface.unburned = node.choice("unburned", surface.unburned, names);
    surface.burned = node.choice("burned", surface.burned, names);
    surface.ash = node.choice("ash", surface.ash, names);
    surface.burn_severity = node.number("burn_severity", surface.burn_severity, Range::between(0.0, 1.0));
    surface.emissivity = node.optional_number("emissivity", Range{0.0, 1.0, true});
    node.finish();
    return surface;
}

AtmosphereSource read_atmosphere(const config::Node& node, const fs::path& folder) {
    AtmosphereSource atmosphere;
    atmosphere.model = node.choice("model", atmosphere.model, kAtmosphereModels);
    atmosphere.visibility_km = node.number("visibility_km", atmosphere.visibility_km, Range::between(1.0, 300.0));
    atmosphere.ground_elevation_m = node.optional_number("ground_elevation_m", Range::between(-500.0, 6000.0));
    if (const auto file = node.child("file"); file.present()) {
        atmosphere.file = read_file_name(file, folder);
        if (node.has("model") || node.has("visibility_km"))
            node.report("give 'model' and 'visibility_km', or 'file', not both");
    }
    node.finish();
    return atmosphere;
}

RenderSettings read_render(const config::Node& node, const SurfaceSettings& surface) {
    RenderSettings render;
    render.samples_per_axis =
        static_cast<int>(node.integer("samples_per_axis", render.samples_per_axis, Range::between(1, 16)));
    render.light_directions =
        static_cast<int>(node.integer("light_directions", render.light_directions, Range::between(4, 65536)));
    render.light_reach_m = node.number("light_reach_m", render.light_reach_m, Range::between(0.0, 10000.0));
    render.flame_light = node.boolean("flame_light", render.flame_light);
    render.point_sources =
        node.choice("flame_light_model", "hemisphere", {"hemisphere", "point_sources"}) == "point_sources";
    render.point_source_cut = node.number("point_source_cut", render.point_source_cut, Range::between(0.0, 1.0));
    render.light_bounces = static_cast<int>(node.integer("light_bounces", render.light_bounces, Range::between(1, 16)));
    render.light_decay = static_cast<int>(node.integer("light_decay", render.light_decay, Range::between(1, 64)));
    render.sun = node.boolean("sun", render.sun);
    auto grounds = surface_names(surface);
    grounds.insert(grounds.end(), {"cover", "none"});
    render.background = node.choice("background", render.background, grounds);
    render.noise = node.boolean("noise", render.noise);
    node.finish();
    return render;
}

}  // namespace pyroscene::scenario
