#include "pipeline/acquisition.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "pipeline/ground_reflectance.h"
#include "pipeline/plume_scene.h"
#include "radiometry/planck.h"
#include "radiometry/soot.h"
#include "radiometry/transport_grid.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Acquisition;
using scenario::Scenario;

std::string subject(const Acquisition& a) { return fmt::format("acquisition '{}'", a.id); }

/// Map place the platform is over.
std::array<double, 2> place(const Acquisition& acquisition, const inputs::SceneInputs& in, const fire::FireState* state,
                            const gis::MapProjection& map) {
    const auto& p = acquisition.platform;
    if (p.map_xy_m) return *p.map_xy_m;
    if (p.lat_lon_deg) return map.to_map((*p.lat_lon_deg)[0], (*p.lat_lon_deg)[1]);
    if (!p.over_fire || state == nullptr) return {in.origin_m.x, in.origin_m.y};
    double x = 0.0, y = 0.0, n = 0.0;
    for (int row = 0; row < in.grid.rows; ++row)
        for (int col = 0; col < in.grid.cols; ++col)
            if (state->cell_class.at(row, col) == static_cast<std::uint8_t>(fire::CellClass::Front)) {
                x += in.grid.x_centre_m(col);
                y += in.grid.y_centre_m(row);
                n += 1.0;
            }
    if (n == 0.0)
        throw input_error(subject(acquisition),
                          fmt::format("platform.over: fire, but nothing burns at {} s", state->time_s));
    return {x / n, y / n};
}

FlameGas flame_gas(const Scenario& scenario, const inputs::SceneInputs& in) {
    FlameGas gas = scenario.flame.gas;
    gas.pressure_Pa = scenario.flame.pressure_Pa.value_or(radiometry::standard_pressure_Pa(in.mean_height_m));
    return gas;
}

/// A table of the user's may be for few wavelengths only, and beyond them it says nothing.
void check_table_covers(const std::filesystem::path& file, const radiometry::AtmosphereTable& table,
                        const radiometry::SpectralGrid& grid) {
    const auto& lambda = table.wavelength_um;
    const double lower = *std::min_element(grid.lambda_um.begin(), grid.lambda_um.end());
    const double upper = *std::max_element(grid.lambda_um.begin(), grid.lambda_um.end());
    if (lambda.front() > lower * 1.005 || lambda.back() < upper * 0.995)
        throw input_error(file.string(), fmt::format("covers {:.4g} to {:.4g} um, the bands need {:.4g} to {:.4g} um",
                                                     lambda.front(), lambda.back(), lower, upper));
}

}  // namespace

sensors::Pose resolve_pose(const Acquisition& acquisition, const inputs::SceneInputs& in, const fire::FireState* state) {
    const gis::MapProjection map(in.grid.crs_wkt);
    const auto [x, y] = place(acquisition, in, state, map);
    const auto& p = acquisition.platform;
    sensors::Pose pose;
    pose.time_s = acquisition.time_s;
    pose.heading_rad = p.heading_deg * kDegree_rad;
    pose.pitch_rad = p.pitch_deg * kDegree_rad;
    pose.roll_rad = p.roll_deg * kDegree_rad;
    const int col = static_cast<int>(std::floor(in.grid.col_at(x))), row = static_cast<int>(std::floor(in.grid.row_at(y)));
    const bool on_map = in.grid.contains(row, col) && !std::isnan(in.terrain_m.at(row, col));
    const double ground_m = on_map ? in.terrain_m.at(row, col) : in.mean_height_m;
    double height_m = 0.0;
    if (p.altitude_m) {
        height_m = *p.altitude_m;
    } else {
        if (!on_map)
            throw input_error(subject(acquisition),
                              "platform.altitude_agl_m needs terrain below the platform, but it is outside "
                              "the map; give altitude_m (above the ellipsoid)");
        height_m = ground_m + *p.altitude_agl_m;
    }
    if (on_map && height_m <= ground_m)
        throw input_error(subject(acquisition),
                          fmt::format("platform is at {:.0f} m, below the terrain there ({:.0f} m)", height_m, ground_m));
    pose.position = map.to_geodetic(x, y, height_m);
    return pose;
}

std::vector<int> wanted_bands(const Acquisition& acquisition, const sensors::Sensor& sensor, const std::string& group) {
    auto bands = sensor.bands_of(group);
    if (acquisition.bands.empty()) return bands;
    std::erase_if(bands, [&](int b) {
        const auto& id = sensor.bands[static_cast<std::size_t>(b)].id;
        return std::find(acquisition.bands.begin(), acquisition.bands.end(), id) == acquisition.bands.end();
    });
    return bands;
}

std::vector<std::string> wanted_groups(const Acquisition& acquisition, const sensors::Sensor& sensor) {
    for (const auto& id : acquisition.bands)
        if (sensor.band_index(id) < 0) {
            std::vector<std::string> ids;
            for (const auto& band : sensor.bands) ids.push_back(band.id);
            throw input_error(subject(acquisition),
                              fmt::format("sensor '{}' has no band '{}'; it has {}", sensor.id, id, fmt::join(ids, ", ")));
        }
    for (const auto& id : acquisition.groups) (void)sensor.group(id);
    std::vector<std::string> groups;
    for (const auto& group : sensor.groups) {
        const bool asked = acquisition.groups.empty() || std::find(acquisition.groups.begin(), acquisition.groups.end(),
                                                                   group.id) != acquisition.groups.end();
        if (asked && !wanted_bands(acquisition, sensor, group.id).empty()) groups.push_back(group.id);
    }
    if (groups.empty()) throw input_error(subject(acquisition), "no band is left to render");
    return groups;
}

FireScene make_fire_scene(const Scenario& scenario, const inputs::SceneInputs& in, const fire::FireState& state,
                          double time_s) {
    const auto& voxel_m = scenario.flame.parameters.voxel_m;
    // Fine cells about as large as a voxel, so that a front narrower than a map cell is one in the image too.
    const bool fine = scenario.physics == fire::Physics::Default;
    const double fine_m = std::max(voxel_m[0], voxel_m[1]);
    const int refinement = fine ? std::clamp(static_cast<int>(std::lround(in.grid.cell_m / fine_m)), 1, 16) : 1;
    FireScene scene;
    scene.surface = fire::surface_at(state, time_s, scenario.fire, refinement);
    scene.gas = flame_gas(scenario, in);
    scene.burnt_emissivity = burnt_emissivity(scenario);
    scene.plume = make_plume(scenario, in, time_s);
    if (scenario.flame.off) return scene;
    const auto columns = fire::make_columns(state, scene.surface, in.terrain_m, scenario.fire, scenario.flame.parameters,
                                            in.origin_m, time_s);
    const fire::FlameGround ground{in.terrain_m, in.origin_m};
    scene.flame = fire::voxelise(columns, scenario.flame.parameters, &ground);
    return scene;
}

namespace {

radiometry::AtmosphereConditions conditions_of(const Scenario& scenario, const OpticalTables& tables, double sensor_agl_m,
                                               const radiometry::SunPosition& sun) {
    radiometry::AtmosphereConditions conditions;
    conditions.sensor_altitude_agl_m = sensor_agl_m;
    conditions.ground_elevation_m = tables.ground_elevation_m;
    conditions.visibility_km = scenario.atmosphere.visibility_km;
    conditions.sun_zenith_rad = scenario.render.sun ? sun.zenith_rad : kPi;
    conditions.sun_distance_AU = sun.distance_AU;
    return conditions;
}

/// Transport wavelengths; with hot gas they are picked for this scene's air, seen at a few angles.
radiometry::SpectralGrid make_grid(const std::vector<Spectrum>& responses, const OpticalTables& tables, const FlameGas& gas,
                                   const radiometry::AtmosphereConditions& conditions) {
    if (!tables.flame) return radiometry::make_spectral_grid(responses);
    radiometry::SpectralStructure structure{tables.flame.get(), gas, {}};
    if (tables.air) {
        for (const double view_deg : {0.0, 25.0, 50.0})
            structure.air.push_back(radiometry::evaluate(*tables.air, {conditions, view_deg * kDegree_rad, kPi / 2.0}));
    }
    return radiometry::make_spectral_grid(responses, structure);
}

/// The same; a table of the user's has to cover it.
radiometry::SpectralGrid covered_grid(const Scenario& scenario, const std::vector<Spectrum>& responses,
                                      const OpticalTables& tables, const FlameGas& gas,
                                      const radiometry::AtmosphereConditions& conditions) {
    auto grid = make_grid(responses, tables, gas, conditions);
    if (scenario.atmosphere.file) check_table_covers(*scenario.atmosphere.file, tables.air->tables.front(), grid);
    return grid;
}

/// What the ground around the scene is made of: the surface named in the scenario (added to `names` when the map has none
/// of it), else the cover that most of the map has; -1 = nothing is known there.
int surroundings_material(const Scenario& scenario, const inputs::SceneInputs& in, std::vector<std::string>& names) {
    const std::string& wanted = scenario.render.background;
    if (wanted == "none") return -1;
    if (wanted != "cover") {
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (found == names.end()) names.push_back(wanted);
        return static_cast<int>(std::find(names.begin(), names.end(), wanted) - names.begin());
    }
    std::vector<std::size_t> cells(names.size(), 0);
    for (const auto material : in.cover.values) cells[material] += 1;
    return static_cast<int>(std::max_element(cells.begin(), cells.end()) - cells.begin());
}

/// The surroundings that scatter light into the view: share of each material in the area of the map, burnt ground last.
std::vector<double> shares_of_ground(const inputs::SceneInputs& in, const fire::SurfaceField& surface,
                                     std::size_t materials) {
    std::vector<double> share(materials, 0.0);
    const double cell = 1.0 / static_cast<double>(in.grid.size());
    const auto block_size = static_cast<std::size_t>(surface.refinement) * static_cast<std::size_t>(surface.refinement);
    for (int row = 0; row < in.grid.rows; ++row)
        for (int col = 0; col < in.grid.cols; ++col) {
            const std::size_t first = surface.block(row, col) * block_size;
            double burnt = 0.0;
            for (std::size_t i = first; i < first + block_size; ++i)
                burnt += surface.burned[i] != 0 ? 1.0 : std::clamp<double>(surface.front_fraction[i], 0.0, 1.0);
            burnt /= static_cast<double>(block_size);
            share.back() += burnt * cell;
            share[in.cover.at(row, col)] += (1.0 - burnt) * cell;
        }
    return share;
}

/// Temperature of the air near the ground: what 150 m of it radiate at the wavelength where they are least transparent.
double air_temperature_K(const radiometry::AtmosphereSet& set, radiometry::AtmosphereConditions conditions) {
    constexpr double kThermal_um = 4.0;
    conditions.sensor_altitude_agl_m = 150.0;
    const auto air = radiometry::evaluate(set, {conditions, 0.0, 0.0});
    std::size_t opaque = 0;
    for (std::size_t i = 0; i < air.wavelength_um.size(); ++i)
        if (air.wavelength_um[i] > kThermal_um && air.transmittance[i] < air.transmittance[opaque]) opaque = i;
    const double opacity = 1.0 - air.transmittance[opaque];
    if (!(air.wavelength_um[opaque] > kThermal_um && opacity > 0.5)) return 0.0;
    return radiometry::brightness_temperature(air.wavelength_um[opaque], air.path_thermal[opaque] / opacity);
}

}  // namespace

SpectralScene make_spectral_scene(const Scenario& scenario, const inputs::SceneInputs& in, const OpticalTables& tables,
                                  const FireScene& fire, const std::vector<Spectrum>& responses, double sensor_agl_m,
                                  double largest_view_zenith_rad, const radiometry::SunPosition& sun, RunReport& report) {
    SpectralScene out;
    auto& optics = out.optics;
    const auto conditions = conditions_of(scenario, tables, sensor_agl_m, sun);
    optics.flame_tables = tables.flame;
    if (optics.flame_tables) optics.flame_gas = fire.gas;
    out.grid = covered_grid(scenario, responses, tables, fire.gas, conditions);
    const int n = out.grid.size();
    optics.lambda_count = n;
    optics.lambda_um = out.grid.lambda_um;

    optics.gas = fire.gas;
    if (!fire.plume.empty()) set_plume_optics(scenario, out.grid, optics);
    optics.grey = scenario.flame.grey_absorption_per_m.has_value();
    for (const double lambda_um : optics.lambda_um)
        optics.flame_absorption_per_m.push_back(static_cast<float>(
            optics.grey ? *scenario.flame.grey_absorption_per_m
                        : radiometry::soot_absorption_per_m(tables.soot, lambda_um, fire.gas.soot_volume_fraction)));

    auto names = in.cover_names;
    out.surroundings_material = surroundings_material(scenario, in, names);
    optics.reflectance = ground_reflectance(scenario, names, out.grid);
    names.push_back(scenario.surface.burned);
    optics.material_count = static_cast<int>(names.size());
    optics.burnt_material = optics.material_count - 1;
    optics.burnt_emissivity = fire.burnt_emissivity;
    if (!tables.air) {
        out.atmosphere = radiometry::vacuum(n);
        return out;
    }
    std::vector<double> albedo(static_cast<std::size_t>(n), 0.0);
    const auto share = shares_of_ground(in, fire.surface, names.size());
    for (std::size_t m = 0; m < names.size(); ++m)
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            albedo[i] += share[m] * static_cast<double>(optics.reflectance[m * static_cast<std::size_t>(n) + i]);

    out.atmosphere = radiometry::make_view_atmosphere(*tables.air, conditions, out.grid, albedo, tables.ground_heights_m);
    out.air_K = air_temperature_K(*tables.air, conditions);
    for (const auto& warning : air_warnings(scenario, tables, sensor_agl_m, largest_view_zenith_rad, sun))
        report.warn(warning);
    return out;
}

radiometry::SpectralGrid transport_grid(const Scenario& scenario, const inputs::SceneInputs& in, const OpticalTables& tables,
                                        const std::vector<Spectrum>& responses, double sensor_agl_m,
                                        const radiometry::SunPosition& sun) {
    return covered_grid(scenario, responses, tables, flame_gas(scenario, in),
                        conditions_of(scenario, tables, sensor_agl_m, sun));
}

std::vector<std::string> air_warnings(const Scenario& scenario, const OpticalTables& tables, double sensor_agl_m,
                                      double largest_view_zenith_rad, const radiometry::SunPosition& sun) {
    if (!tables.air) return {};
    auto out = radiometry::atmosphere_warnings(
        *tables.air, {conditions_of(scenario, tables, sensor_agl_m, sun), largest_view_zenith_rad, 0.0});
    for (auto& warning : out) warning.insert(0, "atmosphere: ");
    return out;
}

}  // namespace pyroscene::pipeline
