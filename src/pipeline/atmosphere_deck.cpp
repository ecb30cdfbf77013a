#include "pipeline/atmosphere_deck.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "inputs/scene_inputs.h"
#include "radiometry/sun.h"
#include "sensors/sensor.h"

namespace pyroscene::pipeline {
namespace {

using Files = std::vector<std::pair<std::string, std::string>>;

constexpr double kEarthRadius_km = 6371.23, kTop_km = 99.9;  // MODTRAN's atmosphere ends at 100 km

/// Zenith angle of the line of sight at the sensor for a zenith angle at the ground (no refraction).
double zenith_at_sensor_deg(const DeckGeometry& g, double view_zenith_deg) {
    const double top_km = std::min(g.ground_elevation_km + g.sensor_altitude_km, kTop_km);
    const double sine =
        std::sin(view_zenith_deg * kDegree_rad) * (kEarthRadius_km + g.ground_elevation_km) / (kEarthRadius_km + top_km);
    return 180.0 - std::asin(sine) / kDegree_rad;
}

/// The sun's zenith at the sensor: its vertical leans from that of the target by the angle at the Earth's centre.
double sun_zenith_at_sensor_deg(const DeckGeometry& g, const DeckRun& run) {
    const double lean = (run.view_zenith_deg - (180.0 - zenith_at_sensor_deg(g, run.view_zenith_deg))) * kDegree_rad;
    const double s = g.sun_zenith_deg * kDegree_rad, azimuth = run.relative_azimuth_deg * kDegree_rad;
    return std::acos(std::cos(lean) * std::cos(s) - std::sin(lean) * std::sin(s) * std::cos(azimuth)) / kDegree_rad;
}

int modtran_model(const std::string& model) {
    constexpr std::array<std::pair<const char*, int>, 5> kNumbers{{{"tropical", 1},
                                                                   {"midlatitude_summer", 2},
                                                                   {"midlatitude_winter", 3},
                                                                   {"subarctic_summer", 4},
                                                                   {"us_standard_1976", 6}}};
    for (const auto& [name, number] : kNumbers)
        if (model == name) return number;
    return 2;
}

const char* modtran6_model(int number) {
    constexpr std::array<const char*, 7> kNames{"",
                                                "ATM_TROPICAL",
                                                "ATM_MIDLAT_SUMMER",
                                                "ATM_MIDLAT_WINTER",
                                                "ATM_SUBARC_SUMMER",
                                                "ATM_SUBARC_WINTER",
                                                "ATM_US_STANDARD_1976"};
    return kNames[static_cast<std::size_t>(number)];
}

const char* libradtran_model(int number) {
    constexpr std::array<const char*, 7> kNames{
        "", "tropics", "midlatitude_summer", "midlatitude_winter", "subarctic_summer", "subarctic_winter", "us-standard"};
    return kNames[static_cast<std::size_t>(number)];
}

double wavenumber_low(const DeckGeometry& g) { return 5.0 * std::floor(1e4 / g.upper_um / 5.0); }
double wavenumber_high(const DeckGeometry& g) { return 5.0 * std::ceil(1e4 / g.lower_um / 5.0); }

/// One line of the list: what the run is, so that nothing depends on how a code prints its geometry.
std::string list_line(const DeckGeometry& g, const DeckRun& run, const std::string& file) {
    return fmt::format("{},{:.6g},{:.6g},{},{},{:.6g},{:.6g},{:.6g},{}\n", file, g.sensor_altitude_km, run.view_zenith_deg,
                       run.sun ? fmt::format("{:.6g}", g.sun_zenith_deg) : "",
                       run.sun ? fmt::format("{:.6g}", run.relative_azimuth_deg) : "", run.albedo, g.ground_elevation_km,
                       g.visibility_km, run.sun ? g.day_of_year : 0);
}
constexpr const char* kListHeader =
    "# runs for import-atmosphere\n"
    "file,sensor_altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg,albedo,ground_elevation_km,visibility_km,"
    "day_of_year\n";

Files modtran6(const DeckGeometry& g, const std::vector<DeckRun>& runs) {
    using Json = nlohmann::ordered_json;
    Json cases = Json::array();
    std::string list = kListHeader;
    const char* model = modtran6_model(modtran_model(g.model));
    for (const auto& run : runs) {
        Json geometry = {{"ITYPE", 2},
                         {"H1ALT", std::min(g.ground_elevation_km + g.sensor_altitude_km, kTop_km)},
                         {"H2ALT", g.ground_elevation_km},
                         {"OBSZEN", zenith_at_sensor_deg(g, run.view_zenith_deg)},
                         {"IDAY", g.day_of_year}};
        if (run.sun) {
            geometry["IPARM"] = 2;
            geometry["PARM1"] = run.relative_azimuth_deg;
            geometry["PARM2"] = sun_zenith_at_sensor_deg(g, run);
        }
        const Json input = {
            {"NAME", run.name},
            {"DESCRIPTION", "Pyroscene"},
            {"CASE", cases.size()},
            {"RTOPTIONS",
             {{"MODTRN", "RT_CORRK_FAST"},
              {"LYMOLC", false},
              {"T_BEST", false},
              {"IEMSCT", run.sun ? "RT_SOLAR_AND_THERMAL" : "RT_THERMAL_ONLY"},
              {"IMULT", "RT_DISORT"},
              {"DISALB", false},
              {"NSTR", 8},
              {"SOLCON", 0.0}}},
            {"ATMOSPHERE",
             {{"MODEL", model},
              {"M1", model},
              {"M2", model},
              {"M3", model},
              {"M4", model},
              {"M5", model},
              {"M6", model},
              {"CO2MX", 420.0}}},
            {"AEROSOLS", {{"IHAZE", "AER_RURAL"}, {"VIS", g.visibility_km}}},
            {"GEOMETRY", geometry},
            {"SURFACE", {{"SURFTYPE", "REFL_CONSTANT"}, {"SURREF", run.albedo}, {"GNDALT", g.ground_elevation_km}}},
            {"SPECTRAL",
             {{"V1", wavenumber_low(g)},
              {"V2", wavenumber_high(g)},
              {"DV", 5.0},
              {"FWHM", 10.0},
              {"YFLAG", "R"},
              {"XFLAG", "W"},
              {"FLAGS", "       "}}},
            {"FILEOPTIONS", {{"NOPRNT", 0}, {"JSONPRNT", run.name + ".json"}, {"JSONOPT", "WRT_INPUT_OUTPUT"}}}};
        cases.push_back({{"MODTRANINPUT", input}});
        list += list_line(g, run, run.name + ".json");
    }
    return {{"modtran6_input.json", Json{{"MODTRAN", cases}}.dump(1) + "\n"}, {"runs.csv", list}};
}

/// Cards 1, 1A, 2, 3, 3A1, 3A2, 4 and 5 of MODTRAN 5, one set per run; card 5 asks for the next one.
Files modtran5(const DeckGeometry& g, const std::vector<DeckRun>& runs) {
    std::string tape5;
    const int model = modtran_model(g.model);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto& run = runs[i];
        tape5 += fmt::format("TM  {}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:8.3f}{:7.2f}\n", model, 2,
                             run.sun ? 2 : 1, 1, model, model, model, model, model, model, 0, 0, 0, 0.0, run.albedo);
        tape5 += fmt::format("TFF  8   0{:10.3f}{:10}{:10}     F F F\n", 420.0, "", "");
        tape5 += fmt::format("{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}\n", 1, 0, 0, 0, 0, 0,
                             g.visibility_km, 0.0, 0.0, 0.0, g.ground_elevation_km);
        tape5 += fmt::format("{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:5d}{:5}{:10.5f}\n",
                             std::min(g.ground_elevation_km + g.sensor_altitude_km, kTop_km), g.ground_elevation_km,
                             zenith_at_sensor_deg(g, run.view_zenith_deg), 0.0, 0.0, 0.0, 0, "", 0.0);
        if (run.sun) {
            tape5 += fmt::format("{:5d}{:5d}{:5d}{:5d}\n", 2, 2, g.day_of_year, 0);
            tape5 += fmt::format("{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}\n",
                                 run.relative_azimuth_deg, sun_zenith_at_sensor_deg(g, run), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        }
        tape5 += fmt::format("{:10.1f}{:10.1f}{:10.1f}{:10.1f}RW\n", wavenumber_low(g), wavenumber_high(g), 5.0, 10.0);
        tape5 += fmt::format("{:5d}\n", i + 1 < runs.size() ? 1 : 0);
    }
    return {{"tape5", tape5}};
}

struct UvspecRun {
    std::string name, source, columns, unit;
    std::vector<std::string> lines;
    double view_zenith_deg = 0.0, relative_azimuth_deg = 0.0, albedo = 0.0, surface_temperature_K = 0.0;
    bool sun = true;
};

/// Solar runs give sun, sky and path; a direct beam at the view zenith gives the transmittance; thermal ones over black ground
/// of two temperatures give transmittance and path emission, and seen from the ground the sky.
std::vector<UvspecRun> uvspec_runs(const DeckGeometry& g) {
    constexpr double kThermalFrom_um = 2.5, kSolarTo_um = 5.0;
    const auto range = [](double low_um, double high_um) {
        return fmt::format("wavelength {:.0f} {:.0f}", std::floor(1e3 * low_um), std::ceil(1e3 * high_um));
    };
    const std::string sensor = fmt::format("zout {:.6g}", std::min(g.sensor_altitude_km, kTop_km));
    const bool day = g.sun_zenith_deg < 89.0 && g.lower_um < kSolarTo_um;
    std::vector<UvspecRun> runs;
    const auto solar_range = range(g.lower_um, std::min(g.upper_um, kSolarTo_um));
    const auto thermal_range = range(std::max(g.lower_um, kThermalFrom_um), g.upper_um);
    for (const double view : g.view_zenith_deg) {
        const std::string umu = fmt::format("umu {:.8f}", std::cos(view * kDegree_rad));
        if (g.lower_um < kSolarTo_um)
            runs.push_back(
                {fmt::format("tau_{:.0f}", view),
                 "solar",
                 "lambda zout edir",
                 "mW_m2_nm",
                 {"source solar", solar_range, fmt::format("sza {:.6g}", view), "albedo 0",
                  fmt::format("zout sur {:.6g}", std::min(g.sensor_altitude_km, kTop_km)), "output_user lambda zout edir"},
                 view,
                 0.0,
                 0.0,
                 0.0,
                 false});
        if (day)
            for (const double azimuth : view > 0.0 ? std::vector<double>{0.0, 90.0, 180.0} : std::vector<double>{0.0})
                runs.push_back({fmt::format("path_solar_{:.0f}_{:.0f}", view, azimuth),
                                "solar",
                                "lambda uu",
                                "mW_m2_nm",
                                {"source solar", solar_range, fmt::format("sza {:.6g}", g.sun_zenith_deg), "phi0 0",
                                 fmt::format("phi {:.6g}", azimuth), umu, "albedo 0", sensor, "output_user lambda uu"},
                                view,
                                azimuth,
                                0.0,
                                0.0,
                                true});
        if (g.upper_um > kThermalFrom_um)
            for (const double T : {260.0, 320.0})
                runs.push_back({fmt::format("path_thermal_{:.0f}_{:.0f}K", view, T),
                                "thermal",
                                "lambda uu",
                                "W_m2_nm",
                                {"source thermal", thermal_range, "output_process per_nm", umu, "phi 0", "albedo 0",
                                 fmt::format("sur_temperature {:.0f}", T), sensor, "output_user lambda uu"},
                                view,
                                0.0,
                                0.0,
                                T,
                                false});
    }
    if (day)
        for (const double albedo : {0.0, 0.5})
            runs.push_back({fmt::format("ground_solar_{:.1f}", albedo),
                            "solar",
                            "lambda edir edn",
                            "mW_m2_nm",
                            {"source solar", solar_range, fmt::format("sza {:.6g}", g.sun_zenith_deg),
                             fmt::format("albedo {:.1f}", albedo), "zout sur", "output_user lambda edir edn"},
                            0.0,
                            0.0,
                            albedo,
                            0.0,
                            true});
    if (g.upper_um > kThermalFrom_um)
        runs.push_back(
            {"ground_thermal",
             "thermal",
             "lambda edn",
             "W_m2_nm",
             {"source thermal", thermal_range, "output_process per_nm", "albedo 0", "zout sur", "output_user lambda edn"},
             0.0,
             0.0,
             0.0,
             0.0,
             false});
    return runs;
}

Files libradtran(const DeckGeometry& g) {
    Files files;
    std::string list =
        "# runs for import-atmosphere\n"
        "file,format,source,columns,unit,sensor_altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg,albedo,"
        "surface_temperature_K,ground_elevation_km,visibility_km,day_of_year\n";
    std::string script = "#!/bin/sh\n# runs every input with uvspec, which must be on the path\nset -e\n";
    for (const auto& run : uvspec_runs(g)) {
        std::string text = fmt::format("# {}\natmosphere_file {}\n", run.name, libradtran_model(modtran_model(g.model)));
        text += fmt::format("aerosol_default\naerosol_visibility {:.6g}\naltitude {:.6g}\nday_of_year {}\n", g.visibility_km,
                            g.ground_elevation_km, g.day_of_year);
        text += "mol_abs_param reptran medium\nrte_solver disort\nnumber_of_streams 16\n";
        for (const auto& line : run.lines) text += line + "\n";
        files.emplace_back(run.name + ".inp", text + "quiet\n");
        script += fmt::format("uvspec < {0}.inp > {0}.out\n", run.name);
        const auto number = [](bool given, double value) { return given ? fmt::format("{:.6g}", value) : std::string(); };
        list +=
            fmt::format("{}.out,uvspec,{},{},{},{:.6g},{:.6g},{},{},{},{},{:.6g},{:.6g},{}\n", run.name, run.source,
                        run.columns, run.unit, g.sensor_altitude_km, run.view_zenith_deg, number(run.sun, g.sun_zenith_deg),
                        number(run.sun, run.relative_azimuth_deg), number(run.source == "solar", run.albedo),
                        number(run.surface_temperature_K > 0.0, run.surface_temperature_K), g.ground_elevation_km,
                        g.visibility_km, run.sun ? g.day_of_year : 0);
    }
    files.emplace_back("run.sh", script);
    files.emplace_back("runs.csv", list);
    return files;
}

const scenario::Acquisition& find(const scenario::Scenario& s, const std::string& id) {
    std::vector<std::string> ids;
    for (const auto& a : s.acquisitions) {
        if (a.id == id) return a;
        ids.push_back(a.id);
    }
    throw input_error("--acquisition", fmt::format("no '{}'; there are {}", id, fmt::join(ids, ", ")));
}

/// Angle from the vertical of the farthest corner of any camera group; the widest tabulated angle for other scanners.
double widest_view_deg(const scenario::Acquisition& a, const sensors::Sensor& sensor) {
    constexpr double kWidest_deg = 65.0;
    double half_rad = 0.0;
    for (const auto& g : sensor.groups) {
        if (!(g.focal_length_m > 0.0)) return kWidest_deg;
        half_rad = std::max(half_rad, std::atan(0.5 * std::hypot(g.samples, g.lines) * g.pixel_pitch_m / g.focal_length_m));
    }
    const double tilt_rad =
        std::acos(std::cos(a.platform.pitch_deg * kDegree_rad) * std::cos(a.platform.roll_deg * kDegree_rad));
    return std::min((tilt_rad + half_rad) / kDegree_rad, kWidest_deg);
}

}  // namespace

DeckGeometry deck_geometry(const scenario::Scenario& s, const std::string& acquisition_id) {
    const auto& a = find(s, acquisition_id);
    const auto in = inputs::load_scene_inputs(s);
    const auto sensor = sensors::load_sensor(a.sensor);
    DeckGeometry g;
    g.model = s.atmosphere.model;
    g.visibility_km = s.atmosphere.visibility_km;
    g.ground_elevation_km = 1e-3 * s.atmosphere.ground_elevation_m.value_or(in.mean_height_m);
    const auto& p = a.platform;
    const double above_mean_m = p.altitude_m ? *p.altitude_m - in.mean_height_m
                                : p.altitude_agl_m
                                    ? *p.altitude_agl_m + in.highest_m - in.mean_height_m  // wherever it flies
                                    : sensor.altitude_agl_m;
    g.sensor_altitude_km = 1e-3 * std::max(above_mean_m, 1.0);
    const double widest_deg = widest_view_deg(a, sensor);
    for (const double node : {0.0, 20.0, 40.0, 55.0, 65.0}) {
        g.view_zenith_deg.push_back(node);
        if (node >= widest_deg) break;
    }
    const double unix_s = s.start.unix_s + a.time_s;
    const auto sun = radiometry::sun_position(unix_s, in.centre.lat_deg, in.centre.lon_deg);
    g.sun_zenith_deg = s.render.sun ? sun.zenith_rad / kDegree_rad : 180.0;
    const std::string date = UtcTime{unix_s}.iso8601();
    const auto year_start = parse_utc(date.substr(0, 4) + "-01-01T00:00:00Z");
    g.day_of_year = 1 + static_cast<int>((unix_s - year_start->unix_s) / 86400.0);
    g.lower_um = 1e3;
    g.upper_um = 0.0;
    for (const auto& band : sensor.bands) {
        if (!a.bands.empty() && std::find(a.bands.begin(), a.bands.end(), band.id) == a.bands.end()) continue;
        g.lower_um = std::min(g.lower_um, 0.99 * band.response.lambda_um.front());
        g.upper_um = std::max(g.upper_um, 1.01 * band.response.lambda_um.back());
    }
    return g;
}

std::vector<DeckRun> deck_runs(const DeckGeometry& g) {
    const bool day = g.sun_zenith_deg < 89.0;
    std::vector<DeckRun> runs;
    const auto add = [&](double view, double azimuth, double albedo, bool sun) {
        runs.push_back({fmt::format("run_{:02d}", runs.size()), view, azimuth, albedo, sun});
    };
    for (const double view : g.view_zenith_deg) {
        if (!day) {
            add(view, 0.0, 0.0, false);
            continue;
        }
        add(view, 0.0, 0.0, true);
        if (view > 0.0) add(view, 90.0, 0.0, true);
        if (view > 0.0) add(view, 180.0, 0.0, true);
        add(view, 0.0, 0.5, true);
    }
    if (day) add(0.0, 0.0, 1.0, true);
    add(0.0, 0.0, 1.0, false);
    return runs;
}

Files deck_files(const DeckGeometry& g, const std::string& code) {
    if (code == "modtran6") return modtran6(g, deck_runs(g));
    if (code == "modtran5") return modtran5(g, deck_runs(g));
    if (code == "libradtran") return libradtran(g);
    throw input_error("--for", fmt::format("'{}' is unknown; there are modtran6, modtran5, libradtran", code));
}

std::vector<std::string> write_atmosphere_deck(const scenario::Scenario& s, const std::string& acquisition_id,
                                               const std::string& code, const std::filesystem::path& folder) {
    const auto files = deck_files(deck_geometry(s, acquisition_id), code);
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw runtime_error(folder.string(), "cannot be made: " + failed.message());
    std::vector<std::string> names;
    for (const auto& [name, text] : files) {
        write_text_file(folder / name, text);
        names.push_back(name);
    }
    return names;
}

}  // namespace pyroscene::pipeline
