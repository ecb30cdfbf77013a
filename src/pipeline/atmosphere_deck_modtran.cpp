#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "pipeline/atmosphere_deck_codes.h"

namespace pyroscene::pipeline {
namespace {

/// Zenith angle of the line of sight at the sensor for a zenith angle at the ground (no refraction).
double zenith_at_sensor_deg(const DeckGeometry& g, double view_zenith_deg) {
    const double top_km = std::min(g.ground_elevation_km + g.sensor_altitude_km, kDeckTop_km);
    const double sine = std::sin(view_zenith_deg * kDegree_rad) * (kModtranEarthRadius_km + g.ground_elevation_km) /
                        (kModtranEarthRadius_km + top_km);
    return 180.0 - std::asin(sine) / kDegree_rad;
}

/// The sun's zenith at the sensor: its vertical leans from that of the target by the angle at the Earth's centre.
double sun_zenith_at_sensor_deg(const DeckGeometry& g, const DeckRun& run) {
    const double lean = (run.view_zenith_deg - (180.0 - zenith_at_sensor_deg(g, run.view_zenith_deg))) * kDegree_rad;
    const double s = g.sun_zenith_deg * kDegree_rad, azimuth = run.relative_azimuth_deg * kDegree_rad;
    return std::acos(std::cos(lean) * std::cos(s) - std::sin(lean) * std::sin(s) * std::cos(azimuth)) / kDegree_rad;
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

}  // namespace

DeckFiles modtran6_files(const DeckGeometry& g, const std::vector<DeckRun>& runs) {
    using Json = nlohmann::ordered_json;
    Json cases = Json::array();
    std::string list = kListHeader;
    const char* model = modtran6_model(deck_model_number(g.model));
    for (const auto& run : runs) {
        Json geometry = {{"ITYPE", 2},
                         {"H1ALT", std::min(g.ground_elevation_km + g.sensor_altitude_km, kDeckTop_km)},
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
              {"CO2MX", kDeckCo2_ppm}}},
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

DeckFiles modtran5_files(const DeckGeometry& g, const std::vector<DeckRun>& runs) {
    std::string tape5;
    const int model = deck_model_number(g.model);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto& run = runs[i];
        tape5 += fmt::format("TM  {}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:8.3f}{:7.2f}\n", model, 2,
                             run.sun ? 2 : 1, 1, model, model, model, model, model, model, 0, 0, 0, 0.0, run.albedo);
        // DISORT, with azimuth dependence where the sun has one (DISAZM): else scattered light is the same at 0, 90 and 180 degrees.
        tape5 += fmt::format("T{}F  8   0{:10.3f}{:10}{:10}     F F F\n", run.sun ? 'T' : 'F', kDeckCo2_ppm, "", "");
        tape5 += fmt::format("{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}\n", 1, 0, 0, 0, 0, 0,
                             g.visibility_km, 0.0, 0.0, 0.0, g.ground_elevation_km);
        tape5 += fmt::format("{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:5d}{:5}{:10.5f}\n",
                             std::min(g.ground_elevation_km + g.sensor_altitude_km, kDeckTop_km), g.ground_elevation_km,
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

}  // namespace pyroscene::pipeline
