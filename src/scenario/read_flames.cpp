#include <algorithm>

#include <fmt/format.h>

#include "base/constants.h"
#include "fire/flame_height.h"
#include "fire/flame_tilt.h"
#include "scenario/readers.h"

namespace pyroscene::scenario {

namespace {

using config::Range;

template <class Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& row : table) names.emplace_back(row.name);
    return names;
}

void read_height(const config::Node& node, fire::FireParameters& p) {
    auto& height = p.flames.height;
    height.method = node.choice("method", height.method, names_of(fire::kFlameHeightMethods));
    p.height_alpha = node.number("alpha", p.height_alpha, Range{0.0, 100.0, true});
    p.volumetric_heat_release_W_m3 =
        node.number("volumetric_heat_release_W_m3", p.volumetric_heat_release_W_m3, Range::between(1e4, 1e8));
    height.constant_m = node.number("constant_m", height.constant_m, Range{0.0, 500.0, true});
    height.air_fuel_ratio = node.number("air_fuel_ratio", height.air_fuel_ratio, Range::between(0.5, 50.0));
    height.plume_coefficient_m_kW = node.optional_number("plume_coefficient_m_kW", Range::between(0.01, 1.0));
    height.burning_area_fraction = node.optional_number("burning_area_fraction", Range{0.0, 1.0, true});
    height.stand_height_m = node.number("stand_height_m", height.stand_height_m, Range::between(0.0, 150.0));
    node.finish();
}

void read_tilt(const config::Node& node, fire::FireParameters& p) {
    auto& tilt = p.flames.tilt;
    tilt.method = node.choice("method", tilt.method, names_of(fire::kFlameTiltMethods));
    p.maximum_tilt_rad =
        node.number("maximum_deg", p.maximum_tilt_rad / kDegree_rad, Range::between(0.0, 89.0)) * kDegree_rad;
    tilt.slope = node.boolean("slope", tilt.slope);
    const auto* method = fire::find_flame_tilt_method(tilt.method);
    if (tilt.slope && method != nullptr && !method->has_slope)
        node.child("slope").report(fmt::format("method '{}' knows no slope; buoyant_velocity does", tilt.method));
    node.finish();
}

void read_intensity(const config::Node& node, fire::FlameRelations& flames) {
    const std::string rule = node.choice("method", "auto", {"auto", "fuel", "heat_flux"});
    flames.intensity = rule == "fuel"        ? fire::IntensityRule::Fuel
                       : rule == "heat_flux" ? fire::IntensityRule::HeatFlux
                                             : fire::IntensityRule::Auto;
    flames.consumed_fraction = node.number("consumed_fraction", flames.consumed_fraction, Range{0.0, 1.0, true});
    node.finish();
}

void read_depth(const config::Node& node, fire::FlameRelations& flames) {
    const bool residence = node.choice("method", "heat_flux", {"heat_flux", "residence_time"}) == "residence_time";
    flames.depth = residence ? fire::DepthRule::ResidenceTime : fire::DepthRule::HeatFlux;
    flames.residence_time_s = node.optional_number("residence_time_s", Range{0.0, 1e5, true});
    node.finish();
}

bool has_fuel_models(const Inputs& inputs) { return inputs.cover && is_shipped_fuel_table(inputs.cover->table); }

}  // namespace

void read_flame_relations(const config::Node& node, fire::FireParameters& p) {
    auto& flames = p.flames;
    flames.heat_of_combustion_J_kg =
        node.number("heat_of_combustion_J_kg", flames.heat_of_combustion_J_kg, Range::between(1e6, 5e7));
    flames.maximum_spread_rate_m_s =
        node.number("maximum_spread_rate_m_s", flames.maximum_spread_rate_m_s, Range{0.0, 100.0, true});
    read_height(node.child("flame_height"), p);
    read_tilt(node.child("tilt"), p);
    read_intensity(node.child("fireline_intensity"), flames);
    read_depth(node.child("front_depth"), flames);
}

void check_flame_inputs(const config::Node& root, const Scenario& s) {
    const auto& flames = s.fire.flames;
    const auto inputs = root.child("inputs"), fire = root.child("fire");
    const auto& modelled = s.inputs.arrival_model;
    const bool own_fire = s.inputs.spread.has_value() || modelled;  // knows fuel and spread rate
    const bool own_length = s.inputs.spread || (modelled && modelled->flame_length);
    const bool has_spread = own_fire || s.inputs.arrival.has_value() || s.inputs.spread_rate.has_value();
    if (flames.height.method == "raster" && !s.inputs.flame_length && !own_length)
        inputs.report("key 'flame_length' is missing; 'raster' in fire.flame_height reads it");
    if (s.inputs.flame_length && flames.height.method != "raster")
        inputs.child("flame_length").report("is not used; 'raster' in fire.flame_height.method reads it");
    if (flames.intensity == fire::IntensityRule::Fuel && !own_fire && !(s.inputs.fuel_load && has_spread))
        inputs.report("'fuel_load', and 'arrival' or 'spread_rate', are needed by 'fuel' in fire.fireline_intensity");
    if (flames.depth != fire::DepthRule::ResidenceTime) return;
    if (!has_spread) inputs.report("'arrival' or 'spread_rate' is needed by 'residence_time' in fire.front_depth");
    if (!flames.residence_time_s && !has_fuel_models(s.inputs))
        fire.child("front_depth")
            .report(
                "key 'residence_time_s' is missing; it follows from inputs.cover only where its table is fbfm13 or fbfm40");
}

}  // namespace pyroscene::scenario
