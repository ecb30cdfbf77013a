#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "pipeline/atmosphere_deck_codes.h"

namespace pyroscene::pipeline {
namespace {

const char* libradtran_model(int number) {
    constexpr std::array<const char*, 7> kNames{
        "", "tropics", "midlatitude_summer", "midlatitude_winter", "subarctic_summer", "subarctic_winter", "US-standard"};
    return kNames[static_cast<std::size_t>(number)];
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
    const std::string sensor = fmt::format("zout {:.6g}", std::min(g.sensor_altitude_km, kDeckTop_km));
    const bool day = g.sun_zenith_deg < 89.0 && g.lower_um < kSolarTo_um;
    std::vector<UvspecRun> runs;
    const auto solar_range = range(g.lower_um, std::min(g.upper_um, kSolarTo_um));
    const auto thermal_range = range(std::max(g.lower_um, kThermalFrom_um), g.upper_um);
    for (const double view : g.view_zenith_deg) {
        const std::string umu = fmt::format("umu {:.8f}", std::cos(view * kDegree_rad));
        if (g.lower_um < kSolarTo_um)
            runs.push_back({fmt::format("tau_{:.0f}", view),
                            "solar",
                            "lambda zout edir",
                            "mW_m2_nm",
                            {"source solar", solar_range, fmt::format("sza {:.6g}", view), "albedo 0",
                             fmt::format("zout sur {:.6g}", std::min(g.sensor_altitude_km, kDeckTop_km)),
                             "output_user lambda zout edir"},
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

}  // namespace

DeckFiles libradtran_files(const DeckGeometry& g) {
    DeckFiles files;
    std::string list =
        "# runs for import-atmosphere\n"
        "file,format,source,columns,unit,sensor_altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg,albedo,"
        "surface_temperature_K,ground_elevation_km,visibility_km,day_of_year\n";
    std::string script = "#!/bin/sh\n# runs every input with uvspec, which must be on the path\nset -e\n";
    for (const auto& run : uvspec_runs(g)) {
        std::string text = fmt::format("# {}\natmosphere_file {}\n", run.name, libradtran_model(deck_model_number(g.model)));
        text += fmt::format("aerosol_default\naerosol_visibility {:.6g}\naltitude {:.6g}\nday_of_year {}\n", g.visibility_km,
                            g.ground_elevation_km, g.day_of_year);
        text += fmt::format("mixing_ratio CO2 {:.6g}\n", kDeckCo2_ppm);
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

}  // namespace pyroscene::pipeline
