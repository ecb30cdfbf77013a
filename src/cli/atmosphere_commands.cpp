#include "cli/atmosphere_commands.h"

#include <CLI/CLI.hpp>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "inputs/load_scenario.h"
#include "pipeline/atmosphere_deck.h"
#include "pipeline/import_atmosphere.h"

namespace pyroscene::cli {
namespace {

void run_import(const pipeline::ImportAtmosphereRequest& request, bool quiet) {
    const auto result = pipeline::import_atmosphere(request);
    for (const auto& note : result.notes) spdlog::warn(note);
    const auto& t = result.table;
    if (!quiet)
        fmt::print(
            "{}: {} runs, {} wavelengths {:.4g} to {:.4g} um, {} sensor altitudes, {} view and {} sun zenith angles\n",
            request.output.string(), result.runs, t.lambda_count(), t.wavelength_um.front(), t.wavelength_um.back(),
            t.sensor_altitude_km.size(), t.view_zenith_deg.size(), t.solar_zenith_deg.size());
}

void add_import(CLI::App& app, const bool& quiet, const std::string& command_line) {
    struct Options {
        pipeline::ImportAtmosphereRequest request;
        std::vector<std::string> files;
        std::string output, unit, source;
    };
    auto options = std::make_shared<Options>();
    auto* sub =
        app.add_subcommand("import-atmosphere", "MODTRAN or libRadtran output to a table for 'atmosphere: {file: ...}'");
    sub->add_option("FILE", options->files, "tape7, .7sc, .csv, .json, .chn, uvspec output, or a CSV list of runs")
        ->required();
    sub->add_option("-o,--output", options->output, "netCDF file to write")->required();
    sub->add_option("--format", options->request.format,
                    "tape7, csv, json, chn, uvspec, table (default: by name and content)");
    auto& g = options->request.hints.geometry;
    const auto number = [&](const char* name, std::optional<double>& value, const char* help, double low, double high) {
        sub->add_option(name, value, help)->check(CLI::Range(low, high));
    };
    number("--sensor-altitude-km", g.sensor_altitude_km, "above the ground, where the files do not say it", 1e-3, 1e5);
    number("--view-zenith-deg", g.view_zenith_deg, "of the sensor, at the ground", 0.0, 89.0);
    number("--sun-zenith-deg", g.sun_zenith_deg, "of the sun, at the ground", 0.0, 89.0);
    number("--relative-azimuth-deg", g.relative_azimuth_deg, "0 = looking towards the sun", 0.0, 180.0);
    number("--albedo", g.albedo, "of the ground in the runs", 0.0, 1.0);
    number("--ground-elevation-km", g.ground_elevation_km, "above sea level", -1.0, 9.0);
    number("--visibility-km", g.visibility_km, "of the aerosol", 0.1, 1000.0);
    number("--day-of-year", g.day_of_year, "of the sun's distance in the runs", 0.0, 366.0);
    sub->add_option("--unit", options->unit, "W_cm2_cm-1, W_cm2_um, W_cm2_nm, uW_cm2_nm, mW_m2_nm, W_m2_nm, W_m2_um");
    sub->add_option("--columns", options->request.uvspec_columns,
                    "columns of a uvspec table: lambda edir edn eup uu zout ...")
        ->delimiter(',');
    sub->add_option("--source", options->source, "of a uvspec table")->check(CLI::IsMember({"solar", "thermal"}));
    sub->add_flag("--no-sun", options->request.without_sun, "leave out all solar terms");
    sub->footer("Example: pyroscene import-atmosphere tape7_dark tape7_bright -o air.nc");
    sub->callback([options, &quiet, &command_line] {
        auto request = options->request;
        request.files.assign(options->files.begin(), options->files.end());
        request.output = options->output;
        if (!options->unit.empty()) request.hints.unit = radiometry::spectral_unit(options->unit);
        request.uvspec_thermal = options->source == "thermal";
        request.command_line = command_line;
        run_import(request, quiet);
    });
}

void add_deck(CLI::App& app, const bool& quiet) {
    struct Options {
        std::string scenario, acquisition, code = "modtran6", output;
    };
    auto options = std::make_shared<Options>();
    auto* sub =
        app.add_subcommand("atmosphere-deck", "input files with which MODTRAN or libRadtran computes a scenario's air");
    sub->add_option("SCENARIO", options->scenario, "scenario file (YAML)")->required();
    sub->add_option("--acquisition", options->acquisition, "whose sensor, height, view angles and sun")->required();
    sub->add_option("--for", options->code, "modtran6 (JSON), modtran5 (tape5) or libradtran")->capture_default_str();
    sub->add_option("-o,--output", options->output, "folder for the files")->required();
    sub->footer(
        "Example: pyroscene atmosphere-deck scenarios/lolo_peak/scenario.yaml --acquisition wasp --for modtran6 -o deck");
    sub->callback([options, &quiet] {
        const auto scene = inputs::load_scenario(options->scenario);
        const auto files = pipeline::write_atmosphere_deck(scene, options->acquisition, options->code, options->output);
        if (!quiet) fmt::print("{}: {} files\n", options->output, files.size());
    });
}

}  // namespace

void add_atmosphere_commands(CLI::App& app, const bool& quiet, const std::string& command_line) {
    add_import(app, quiet, command_line);
    add_deck(app, quiet);
}

}  // namespace pyroscene::cli
