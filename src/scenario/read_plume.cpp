#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

using config::Range;

PlumeSource read_plume_source(const config::Node& node, const fs::path& folder) {
    PlumeSource source;
    if (!node.is_map()) {
        node.finish();
        return source;
    }
    const config::Node one = node.child("file"), several = node.child("files");
    if (one.present() == several.present()) node.report("give 'file' or 'files': bands are the levels, files the moments");
    if (one.present()) source.files.push_back(read_file_name(one, folder));
    if (several.present())
        for (const auto& item : several.items()) source.files.push_back(read_file_name(item, folder));
    source.times_s = node.numbers("times_s");
    if (!source.times_s.empty() && source.times_s.size() != source.files.size())
        node.child("times_s").report(
            fmt::format("expected one time for each of {} files, found {}", source.files.size(), source.times_s.size()));
    if (source.times_s.empty() && source.files.size() > 1)
        node.report(fmt::format("{} files need 'times_s'", source.files.size()));
    if (!std::is_sorted(source.times_s.begin(), source.times_s.end())) node.child("times_s").report("times must ascend");
    const auto levels = node.required_child("levels_m");
    source.levels_m = node.numbers("levels_m");
    for (std::size_t i = 0; i < source.levels_m.size(); ++i)
        if (source.levels_m[i] < 0.0 || (i > 0 && source.levels_m[i] <= source.levels_m[i - 1])) {
            levels.report("heights must ascend and not be negative");
            break;
        }
    const std::string quantity = node.choice("quantity", "temperature", {"temperature", "excess", "buoyancy"});
    source.quantity = quantity == "excess"     ? PlumeSource::Quantity::Excess
                      : quantity == "buoyancy" ? PlumeSource::Quantity::Buoyancy
                                               : PlumeSource::Quantity::Temperature;
    source.variable = node.text("variable", "");
    node.finish();
    return source;
}

namespace {

SmokeLayerSettings read_layer(const config::Node& node) {
    SmokeLayerSettings layer;
    if (!node.is_map()) {
        node.report("expected a map with bottom_m, top_m and concentration_g_m3 or optical_depth_550nm");
        return layer;
    }
    (void)node.required_child("bottom_m");
    (void)node.required_child("top_m");
    layer.bottom_m = node.number("bottom_m", 0.0, Range::between(-500.0, 20000.0));
    layer.top_m = node.number("top_m", 1.0, Range::between(-500.0, 20000.0));
    if (!(layer.top_m > layer.bottom_m)) node.child("top_m").report("expected a height above bottom_m");
    layer.concentration_g_m3 = node.optional_number("concentration_g_m3", Range::between(0.0, 10.0));
    const auto depth = node.optional_number("optical_depth_550nm", Range::between(0.0, 100.0));
    layer.optical_depth_550nm = depth.value_or(0.0);
    if (depth.has_value() == layer.concentration_g_m3.has_value())
        node.report("give 'concentration_g_m3' or 'optical_depth_550nm'");
    layer.temperature_K = node.optional_number("temperature_K", kTemperature_K);
    node.finish();
    return layer;
}

}  // namespace

PlumeSettings read_plume(const config::Node& node, const Inputs& inputs, const fire::FireParameters& fire, bool own_fuel) {
    PlumeSettings plume;
    auto& p = plume.parameters;
    p.air_temperature_K = fire.air_temperature_K;
    p.air_density_kg_m3 = fire.air_density_kg_m3;
    p.air_heat_capacity_J_kg_K = fire.air_heat_capacity_J_kg_K;
    p.wind_height_m = fire.embers.wind_height_m;
    p.wind_exponent = fire.embers.wind_exponent;
    plume.rise = node.choice("model", "none", {"none", "rise"}) == "rise";
    if (plume.rise && inputs.plume) node.child("model").report("'rise' and 'inputs.plume' exclude each other");
    p.top_m = node.number("top_m", p.top_m, Range{0.0, 20000.0, true});
    p.duration_s = node.number("duration_s", p.duration_s, Range{0.0, 1e5, true});
    p.minimum_excess_K = node.number("minimum_excess_K", p.minimum_excess_K, Range::between(0.0, 1000.0));
    p.entrainment = node.number("entrainment", p.entrainment, Range::between(0.05, 2.0));
    p.merge_m = node.number("merge_m", p.merge_m, Range::between(0.0, 1e5));
    p.emission_factor_g_kg = node.number("emission_factor_g_kg", p.emission_factor_g_kg, Range::between(0.0, 1000.0));
    if (own_fuel) p.heat_of_combustion_J_kg = fire.flames.heat_of_combustion_J_kg;
    p.heat_of_combustion_J_kg = node.number("heat_of_combustion_J_kg", p.heat_of_combustion_J_kg, Range::between(1e6, 1e8));
    p.temperature_K = node.optional_number("temperature_K", kTemperature_K);
    plume.grey_absorption_per_m = node.optional_number("absorption_per_m", Range::between(0.0, 1e3));
    p.uniform = plume.grey_absorption_per_m.has_value();
    plume.smoke = node.choice("smoke", plume.smoke, {"savanna", "cerrado", "amazon_forest", "boreal_forest"});
    plume.multiple_scattering = node.boolean("multiple_scattering", true);
    if (node.has("multiple_scattering") && plume.grey_absorption_per_m)
        node.child("multiple_scattering").report("a grey plume ('plume.absorption_per_m') absorbs only");
    const auto layers = node.child("layers");
    if (layers.present())
        for (const auto& item : layers.items()) plume.layers.push_back(read_layer(item));
    if (layers.present() && plume.grey_absorption_per_m)
        layers.report("layers are smoke; they exclude 'plume.absorption_per_m'");
    const auto edges_m = node.numbers("voxel_m", 3);
    const auto items = node.child("voxel_m").items();
    for (std::size_t axis = 0; axis < edges_m.size(); ++axis)
        p.voxel_m[axis] = items[axis].as_number(p.voxel_m[axis], Range::between(0.5, 1000.0));
    node.finish();
    return plume;
}

}  // namespace pyroscene::scenario
