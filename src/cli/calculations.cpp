#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "cli/calc.h"
#include "cli/flame_calculations.h"
#include "cli/flame_emissivity_calculation.h"
#include "cli/spread_calculation.h"
#include "drawing/line_plot.h"
#include "fire/scar.h"
#include "gis/netcdf_input.h"
#include "radiometry/atmosphere.h"
#include "radiometry/planck.h"
#include "sensors/sensor.h"

namespace pyroscene::cli {
namespace {

/// Response of a sensor's band, or a boxcar given by lower_um and upper_um.
Spectrum response_of(const Arguments& a) {
    if (a.has("lower_um") && a.has("upper_um")) {
        const double lower = a.number("lower_um"), upper = a.number("upper_um");
        if (!(lower > 0.0 && upper > lower))
            throw input_error("--lower_um, --upper_um",
                              fmt::format("need 0 < lower < upper, found {} and {}", lower, upper));
        return {Quantity::Response, {lower, upper}, {1.0, 1.0}};
    }
    // Thousands of CSV rows ask for the same few sensors.
    static std::map<std::string, sensors::Sensor> cache;
    const auto id = a.text("sensor");
    auto known = cache.find(id);
    if (known == cache.end()) known = cache.emplace(id, sensors::load_sensor(id)).first;
    const int band = known->second.band_index(a.text("band"));
    if (band < 0) throw input_error("--band", fmt::format("sensor '{}' has no band '{}'", id, a.text("band")));
    return known->second.bands[static_cast<std::size_t>(band)].response;
}

/// Tables stay loaded between the rows of a CSV file.
const radiometry::AtmosphereSet& atmosphere_set(const std::string& model, double visibility_km, double elevation_m) {
    static std::map<std::string, radiometry::AtmosphereSet> cache;
    std::string key;
    for (const auto& needed : radiometry::needed_files(model, visibility_km, elevation_m)) key += needed.file + ";";
    auto known = cache.find(key);
    if (known == cache.end())
        known =
            cache
                .emplace(key, radiometry::make_atmosphere_set(
                                  model, visibility_km, elevation_m,
                                  [](const std::string& file, const std::string& variable) {
                                      return gis::read_netcdf_variable(data_folder() / "atmosphere" / file, variable).values;
                                  }))
                .first;
    return known->second;
}

radiometry::AtmospherePoint atmosphere_point(const Arguments& a) {
    radiometry::AtmospherePoint point;
    auto& conditions = point.conditions;
    conditions.sensor_altitude_agl_m = a.not_negative("altitude_m");
    conditions.ground_elevation_m = a.number("ground_elevation_m");
    conditions.visibility_km = a.positive("visibility_km");
    conditions.sun_zenith_rad = a.within("sun_zenith_deg", 0.0, 180.0) * kDegree_rad;
    point.view_zenith_rad = a.within("view_zenith_deg", 0.0, 90.0) * kDegree_rad;
    point.relative_azimuth_rad = a.number("relative_azimuth_deg") * kDegree_rad;
    return point;
}

const radiometry::AtmosphereSet& atmosphere_set(const Arguments& a) {
    return atmosphere_set(a.text("model"), a.number("visibility_km"), a.number("ground_elevation_m"));
}

/// Says, once for all rows of a table, where the tables end before what was asked for.
void warn_beyond_tables(const radiometry::AtmosphereSet& set, const radiometry::AtmospherePoint& point) {
    static std::set<std::string> said;
    for (const auto& warning : radiometry::atmosphere_warnings(set, point))
        if (said.insert(warning).second) std::cerr << "warning: atmosphere: " << warning << '\n';
}

std::vector<double> atmosphere(const Arguments& a) {
    const auto& set = atmosphere_set(a);
    const auto point = atmosphere_point(a);
    warn_beyond_tables(set, point);
    const auto t = radiometry::evaluate_at(set, point, a.positive("wavelength_um"));
    return {t.transmittance[0], t.path_thermal[0], t.path_solar[0],      t.direct_normal[0],
            t.diffuse[0],       t.thermal_sky[0],  t.spherical_albedo[0]};
}

void plot_atmosphere(const Arguments& a, const std::string& file) {
    const auto point = atmosphere_point(a);
    warn_beyond_tables(atmosphere_set(a), point);
    const auto t = radiometry::evaluate(atmosphere_set(a), point);
    const drawing::PlotAxis wavelength{"wavelength / um", true, {}, {}};
    const auto diagram = [&](const char* label, bool logarithmic, double lowest, std::vector<drawing::PlotSeries> series) {
        drawing::LinePlot plot;
        plot.x = wavelength;
        plot.y = {label, logarithmic, lowest, {}};
        plot.series = std::move(series);
        return plot;
    };
    const auto curve = [&](const char* name, const std::vector<double>& y) {
        return drawing::PlotSeries{name, t.wavelength_um, y, false};
    };
    std::vector<drawing::LinePlot> plots{
        diagram("fraction", false, 0.0,
                {curve("transmittance", t.transmittance), curve("spherical albedo", t.spherical_albedo),
                 curve("diffuse transmittance", t.diffuse_transmittance)}),
        diagram("radiance / W m-2 sr-1 um-1", true, 1e-4,
                {curve("path thermal", t.path_thermal), curve("path solar", t.path_solar)}),
        diagram("irradiance / W m-2 um-1", true, 1e-3,
                {curve("direct sun, normal", t.direct_normal), curve("sky, sunlit", t.diffuse),
                 curve("sky, thermal", t.thermal_sky)})};
    plots[0].title =
        fmt::format("{}, {} km visibility, ground {} m; sensor {} m above, view {} deg", a.text("model"),
                    a.text("visibility_km"), a.text("ground_elevation_m"), a.text("altitude_m"), a.text("view_zenith_deg"));
    plots[1].title =
        fmt::format("to the sensor; sun {} deg, azimuth {} deg", a.text("sun_zenith_deg"), a.text("relative_azimuth_deg"));
    plots[2].title = "at the ground";
    drawing::write_line_plots(file, plots);
}

std::vector<double> scar_temperature(const Arguments& a) {
    const fire::ScarModelRow* model = nullptr;
    std::vector<std::string> names;
    for (const auto& row : fire::scar_models()) {
        names.emplace_back(row.name);
        if (a.text("model") == row.name) model = &row;
    }
    if (model == nullptr)
        throw input_error("--model", fmt::format("'{}' is unknown; there are {}", a.text("model"), fmt::join(names, ", ")));
    fire::ScarCooling curve = model->defaults;
    for (const auto& [name, value] : {std::pair{"amplitude1_K", &curve.amplitude1_K},
                                      {"time_constant1_s", &curve.time_constant1_s},
                                      {"amplitude2_K", &curve.amplitude2_K},
                                      {"time_constant2_s", &curve.time_constant2_s},
                                      {"floor_K", &curve.floor_K}})
        if (a.has(name)) *value = a.number(name);
    if (model->terms == 1 && a.has("amplitude2_K")) throw input_error("--amplitude2_K", "single_exponential has one term");
    if (!(curve.time_constant1_s > 0.0 && curve.time_constant2_s > 0.0))
        throw input_error("--time_constant1_s, --time_constant2_s", "must be above 0");
    return {fire::scar_temperature_K(curve, a.not_negative("time_s"))};
}

}  // namespace

const std::vector<Calculation>& calculations() {
    static const std::vector<Calculation> table = {
        {"planck",
         "spectral radiance of a blackbody",
         "--wavelength_um 4 --temperature_K 1100",
         {{"wavelength_um", {}}, {"temperature_K", {}}},
         {"radiance_W_m2_sr_um"},
         [](const Arguments& a) {
             return std::vector{radiometry::planck_radiance(a.positive("wavelength_um"), a.not_negative("temperature_K"))};
         }},
        {"brightness-temperature",
         "temperature of the blackbody with a spectral radiance",
         "--wavelength_um 3.96 --radiance_W_m2_sr_um 0.6726",
         {{"wavelength_um", {}}, {"radiance_W_m2_sr_um", {}}},
         {"temperature_K"},
         [](const Arguments& a) {
             return std::vector{
                 radiometry::brightness_temperature(a.positive("wavelength_um"), a.number("radiance_W_m2_sr_um"))};
         }},
        {"band-radiance",
         "response-weighted mean radiance of a blackbody in a sensor band or a boxcar",
         "--sensor wasp --band MWIR --temperature_K 600",
         {{"sensor", {}, true}, {"band", {}, true}, {"lower_um", {}, true}, {"upper_um", {}, true}, {"temperature_K", {}}},
         {"radiance_W_m2_sr_um"},
         [](const Arguments& a) {
             return std::vector{radiometry::band_mean_radiance(a.not_negative("temperature_K"), response_of(a))};
         }},
        {"band-temperature",
         "temperature of the blackbody with a band radiance",
         "--sensor wasp --band MWIR --radiance_W_m2_sr_um 273.55",
         {{"sensor", {}, true},
          {"band", {}, true},
          {"lower_um", {}, true},
          {"upper_um", {}, true},
          {"radiance_W_m2_sr_um", {}}},
         {"temperature_K"},
         [](const Arguments& a) {
             return std::vector{radiometry::band_brightness_temperature(a.number("radiance_W_m2_sr_um"), response_of(a))};
         }},
        {"atmosphere",
         "terms of the atmosphere look-up table; altitude above the ground, ground of emissivity 1 and albedo 0; models "
         "midlatitude_summer, midlatitude_winter, subarctic_summer, tropical, us_standard_1976",
         "--altitude_m 4200 --wavelength_um 10.5",
         {{"model", "midlatitude_summer"},
          {"visibility_km", "23"},
          {"altitude_m", {}},
          {"view_zenith_deg", "0"},
          {"sun_zenith_deg", "45"},
          {"relative_azimuth_deg", "90"},
          {"wavelength_um", {}},
          {"ground_elevation_m", "0"}},
         {"transmittance", "path_thermal_W_m2_sr_um", "path_solar_W_m2_sr_um", "direct_irradiance_W_m2_um",
          "diffuse_irradiance_W_m2_um", "thermal_irradiance_W_m2_um", "spherical_albedo"},
         atmosphere,
         plot_atmosphere,
         [](const Arguments& a) { return atmosphere_set(a).tables.front().wavelength_um; }},
        flame_emissivity_calculation(),
        flame_height_calculation(),
        flame_tilt_calculation(),
        thesis_potassium_calculation(),
        alkali_width_calculation(),
        spread_calculation(),
        {"scar-temperature",
         "burn scar cooling: double_exponential (thesis eq 4.17, numbers of 4.18) or single_exponential (2.9 with ambient)",
         "--time_s 600",
         {{"time_s", {}},
          {"model", "double_exponential"},
          {"amplitude1_K", {}, true},
          {"time_constant1_s", {}, true},
          {"amplitude2_K", {}, true},
          {"time_constant2_s", {}, true},
          {"floor_K", {}, true}},
         {"temperature_K"},
         scar_temperature},
    };
    return table;
}

}  // namespace pyroscene::cli
