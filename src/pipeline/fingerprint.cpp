#include "pipeline/fingerprint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/files.h"
#include "inputs/scene_inputs.h"
#include "pipeline/hash.h"
#include "pipeline/run.h"

namespace pyroscene::pipeline {
namespace {

using scenario::RasterSource;
using scenario::Scenario;

std::string text(const RasterSource& s) {
    return fmt::format("b{}t{};", fmt::join(s.bands, ","), fmt::join(s.times_s, ","));
}

/// Relations of the flames and the rasters that only they read.
std::string flames_text(const Scenario& s) {
    const auto& f = s.fire.flames;
    std::string out = fmt::format("{}|{}|{}|{}|{}|{}|", f.height.method, f.height.constant_m, f.height.air_fuel_ratio,
                                  f.height.plume_coefficient_m_kW.value_or(-1.0),
                                  f.height.burning_area_fraction.value_or(-1.0), f.height.stand_height_m);
    out += fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{};", f.tilt.method, f.tilt.slope, f.tilt.fuel_vapour_density_kg_m3,
                       static_cast<int>(f.intensity), static_cast<int>(f.depth), f.residence_time_s.value_or(-1.0),
                       f.heat_of_combustion_J_kg, f.consumed_fraction, f.maximum_spread_rate_m_s);
    const auto& in = s.inputs;
    for (const auto* source : {&in.fuel_load, &in.fireline_intensity, &in.flame_length, &in.spread_rate})
        out += *source ? text(**source) : "-;";
    const bool by_fuel_model = f.depth == fire::DepthRule::ResidenceTime && !f.residence_time_s;
    if (by_fuel_model && in.cover) out += text(in.cover->raster) + in.cover->table;
    return out;
}

std::string text(const std::vector<scenario::ShapesSource>& all) {
    std::string out;
    const auto positions = [&](const std::vector<std::array<double, 2>>& list) {
        for (const auto& p : list) out += fmt::format("{},{} ", p[0], p[1]);
        out += ";";
    };
    for (const auto& shapes : all) {
        out += fmt::format("{}|{}|{}|{}|", shapes.layer, shapes.crs, shapes.time_s, shapes.area);
        for (const auto* list : {&shapes.points, &shapes.line, &shapes.polygon}) positions(*list);
    }
    return out;
}

std::string text(const scenario::QuantitySource& q) {
    return fmt::format("{}|{}|", q.value, q.scale) + (q.raster ? text(*q.raster) : "-;");
}

std::string text(const scenario::CanopySource& c) {
    return text(c.cover) + text(c.height_m) + fmt::format("{};", c.crown_ratio);
}

std::string text(const scenario::WindSource& w) {
    std::string out = fmt::format("{}|{};", w.speed_m_s, w.from_deg) + text(w.canopy);
    if (w.raster) out += text(*w.raster);
    out += w.table ? "table;" : "";
    if (const auto& n = w.windninja)
        out += fmt::format("{}|{}|{}|{};", n->unit, n->crs, n->grid_north, fmt::join(n->times_s, ","));
    if (const auto& l = w.level)
        out += fmt::format("{}|{}|{};", static_cast<int>(l->kind), l->height_m, l->roughness_m.value_or(0.0));
    return out + fmt::format("{};", w.fuel_depth_m.value_or(0.0));
}

std::string text(const scenario::FluxModelSource& s) {
    return fmt::format("{}|{}|{}|{}|{}|{}|{}|{};", s.model, s.crs, s.west_m, s.south_m, s.cols, s.rows, s.cell_m,
                       s.quantity);
}

std::string text(const scenario::FuelSource& s) {
    return text(s.raster) + fmt::format("{}|{};", s.table, fmt::join(s.nonburnable, ","));
}

std::string text(const scenario::ArrivalModelSource& s) {
    std::string out = text(s.arrival.raster) + fmt::format("{}|{}|{};", s.model, s.arrival.unit, s.offset_s) + text(s.fuel);
    out += fmt::format("{}|{}|{}|{}|{}|{}|{}|{};", s.grids, s.period, s.crs, s.west_m.value_or(0.0), s.south_m.value_or(0.0),
                       s.cols, s.rows, s.cell_m);
    for (const auto* raster : {&s.fireline_intensity, &s.flame_length, &s.spread_rate})
        out += *raster ? text((*raster)->raster) + (*raster)->unit : "-;";
    return out + fmt::format("{}|{}|{}|{};", s.fuel_moisture_pct, fmt::join(s.frames.times_s, ","), s.frames.mean_over_s,
                             s.frames.coarse_burn_time_s);
}

std::string spread_text(const scenario::SpreadSource& s) {
    std::string out = text(s.fuel) + text(s.ignition) + text(s.barriers);
    for (const auto& m : s.moisture_pct) out += fmt::format("{}|", m.value_or(-1.0));
    out += s.moisture_raster ? text(*s.moisture_raster) : "-;";
    out += text(s.canopy);
    return out + fmt::format("{}|{}|{}|{}|{};", static_cast<int>(s.rules.curing), s.rules.wind_limit,
                             fmt::join(s.frames.times_s, ","), s.frames.mean_over_s, s.frames.coarse_burn_time_s);
}

std::string fire_text(const Scenario& s) {
    const auto& f = s.fire;
    std::string out =
        fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", static_cast<int>(f.physics),
                    f.front_threshold_W_m2, f.front_temperature_K, f.ambient_temperature_K, f.flaming_heat_flux_W_m2,
                    f.scar.amplitude1_K, f.scar.time_constant1_s, f.scar.amplitude2_K, f.scar.time_constant2_s,
                    f.scar.floor_K, f.height_alpha, f.volumetric_heat_release_W_m3, f.one_sigma_rule, f.air_density_kg_m3,
                    f.air_heat_capacity_J_kg_K, f.air_temperature_K, f.maximum_tilt_rad, f.jitter_m, f.seed);
    const auto& e = f.embers;
    out += fmt::format("|{}|{}|{}|{}|{};", e.drift, e.cooling_time_s, e.lifetime_s, e.wind_height_m, e.wind_exponent);
    for (const auto& [code, c] : f.scar_of_cover)
        out += fmt::format(";{}|{}|{}|{}|{}|{}", code, c.amplitude1_K, c.time_constant1_s, c.amplitude2_K,
                           c.time_constant2_s, c.floor_K);
    if (!f.scar_of_cover.empty() && s.inputs.cover) out += text(s.inputs.cover->raster);
    out += flames_text(s) + text(s.inputs.terrain) + text(s.inputs.heat_flux);
    if (s.inputs.flux_model) out += text(*s.inputs.flux_model);
    if (s.inputs.arrival) out += text(*s.inputs.arrival);
    if (s.inputs.landscape) out += text(s.inputs.landscape->fuel) + s.inputs.landscape->crs;
    if (s.inputs.spread) out += spread_text(*s.inputs.spread);
    if (s.inputs.arrival_model) out += text(*s.inputs.arrival_model);
    if (s.inputs.wind) out += text(*s.inputs.wind);
    return out + fmt::format("{}|{}|{}", s.map_crs.value_or(""), s.map_cell_m.value_or(0.0), s.geoid_undulation_m);
}

std::string scene_text(const Scenario& s) {
    const auto& flame = s.flame;
    const auto& r = s.render;
    std::string out = fmt::format("{}|{}|{}|{}|{}|{};", flame.parameters.temperature_K,
                                  fmt::join(flame.parameters.voxel_m, ","), flame.parameters.ember_gap_m,
                                  flame.gas.soot_volume_fraction, flame.grey_absorption_per_m.value_or(-1.0), flame.off);
    out += fmt::format("{}|{};", flame.radiant_fraction.value_or(-1.0), flame.adjust_temperature);
    out += fmt::format("{}|", flame.hot_gas);
    const auto& gas = flame.gas;
    out += fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{};", static_cast<int>(flame.parameters.profile.shape),
                       flame.parameters.profile.tip_K, gas.x_H2O, gas.x_CO2, gas.x_CO, gas.x_CH4, gas.x_O2,
                       gas.potassium_ppm, s.flame.pressure_Pa.value_or(-1.0), flame.parameters.profile.air_K);
    out += fmt::format("{}|", gas.sodium_ppm);
    out += fmt::format("{}|{}|{};", s.surface.unburned, s.surface.burned, s.surface.emissivity.value_or(-1.0));
    out += fmt::format("{}|{};", s.surface.ash, s.surface.burn_severity);
    for (const auto& [name, file] : s.surface.spectra) out += name + sha256_of_file(file) + ";";
    if (s.inputs.cover) out += text(s.inputs.cover->raster) + s.inputs.cover->table;
    out += fmt::format("{}|{}|{}|{};", s.atmosphere.model, s.atmosphere.visibility_km,
                       s.atmosphere.ground_elevation_m.value_or(-1e9),
                       s.atmosphere.file ? sha256_of_file(*s.atmosphere.file) : "");
    return out + fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", r.samples_per_axis, r.light_directions,
                             r.light_reach_m, r.point_sources, r.point_source_cut, r.light_bounces, r.light_decay,
                             r.flame_light, r.sun, s.start.unix_s, s.seed, s.products.truth, r.background, r.noise);
}

std::string plume_text(const Scenario& s) {
    const auto& p = s.plume.parameters;
    std::string out = fmt::format("plume {}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{};", s.plume.rise, fmt::join(p.voxel_m, ","),
                                  p.top_m, p.duration_s, p.minimum_excess_K, p.entrainment, p.merge_m,
                                  p.emission_factor_g_kg, p.heat_of_combustion_J_kg, p.temperature_K.value_or(-1.0),
                                  s.plume.smoke, s.plume.grey_absorption_per_m.value_or(-1.0), s.plume.multiple_scattering);
    for (const auto& layer : s.plume.layers)
        out += fmt::format("{}|{}|{}|{}|{};", layer.bottom_m, layer.top_m, layer.concentration_g_m3.value_or(-1.0),
                           layer.optical_depth_550nm, layer.temperature_K.value_or(-1.0));
    if (const auto& in = s.inputs.plume)
        out += fmt::format("{}|{}|{}|{};", fmt::join(in->times_s, ","), fmt::join(in->levels_m, ","),
                           static_cast<int>(in->quantity), in->of_wrf ? "wrf" : in->variable);
    return out;
}

std::string sensor_text(const std::string& id_or_path) {
    const auto shipped = sensor_folder() / "specs" / (id_or_path + ".yaml");
    std::error_code ignored;
    return sha256_of_file(std::filesystem::exists(shipped, ignored) ? shipped : std::filesystem::path(id_or_path));
}

}  // namespace

Fingerprints::Fingerprints(const Scenario& scenario) : scenario_(scenario) {
    base_ = version();
    for (const auto& file : inputs::input_files(scenario)) {
        const auto hash = sha256_of_file(file);
        input_hashes_[file.string()] = hash;
        base_ += hash;
    }
}

std::string Fingerprints::state(double time_s) const {
    return sha256(base_ + fire_text(scenario_) + fmt::format("state {}", time_s)).substr(0, 32);
}

std::string Fingerprints::image(const scenario::Acquisition& a) const {
    const auto& p = a.platform;
    std::string pose =
        fmt::format("{}|{}|{}|{}|{}|{}|{}|{}", a.id, a.time_s, p.over_centre, p.over_fire, p.altitude_agl_m.value_or(-1.0),
                    p.altitude_m.value_or(-1e9), fmt::join(a.groups, ","), fmt::join(a.bands, ","));
    pose += fmt::format("|{}|{}|{}", p.heading_deg, p.pitch_deg, p.roll_deg);
    pose +=
        fmt::format("|{}|{}|{}|{}|{}|{}|{}", p.ground_speed_m_s.value_or(-1.0), static_cast<int>(p.pass), p.scan_angle_deg,
                    p.trajectory ? sha256_of_file(*p.trajectory) : "", a.view, a.whole_lines, a.lines.value_or(0));
    if (p.map_xy_m) pose += fmt::format("|{}", fmt::join(*p.map_xy_m, ","));
    if (p.lat_lon_deg) pose += fmt::format("|{}", fmt::join(*p.lat_lon_deg, ","));
    return sha256(base_ + fire_text(scenario_) + scene_text(scenario_) + plume_text(scenario_) + sensor_text(a.sensor) +
                  pose)
        .substr(0, 32);
}

std::string Fingerprints::product(const scenario::Acquisition& a) const {
    const auto& p = scenario_.products;
    return sha256(image(a) + fmt::format("{}{}{}{}{}{}{}", p.brightness_temperature, p.ortho, p.truth, p.fractions, p.frp,
                                         p.quicklook, p.native))
        .substr(0, 32);
}

}  // namespace pyroscene::pipeline
