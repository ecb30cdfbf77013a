#include <dlfcn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/error.h"
#include "cli/atmosphere_commands.h"
#include "cli/calc.h"
#include "cli/compare_command.h"
#include "cli/detect_command.h"
#include "cli/export_command.h"
#include "cli/fit_scar_command.h"
#include "cli/frp_command.h"
#include "cli/picture_commands.h"
#include "cli/progress.h"
#include "cli/sensors_command.h"
#include "cli/unmix_command.h"
#include "inputs/load_scenario.h"
#include "pipeline/run.h"

namespace {

using namespace pyroscene;

enum ExitCode { kDone = 0, kRunTimeFailure = 1, kWrongCommandLine = 2, kRejected = 3 };

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int) {
    // The first Ctrl-C asks the work to stop between two tiles; a second one does not wait.
    if (interrupted.exchange(true)) std::_Exit(kRunTimeFailure);
}

struct Arguments {
    std::string scenario, output;
    std::vector<std::string> acquisitions, calc_name;
    cli::SensorsOptions sensors;
    cli::FitScarOptions fit_scar;
    cli::UnmixOptions unmix;
    cli::FrpOptions frp;
    cli::CompareOptions compare;
    cli::ExportOptions flame_export;
    int threads = 0;
    bool force = false, quiet = false, print_schema = false;
    int verbose = 0;
};

using Phase = void (*)(const scenario::Scenario&, const pipeline::RunOptions&, RunReport&);

void run_phase(Phase phase, const Arguments& a, const std::string& command_line) {
    const auto scene = inputs::load_scenario(a.scenario);
    cli::Progress progress(a.quiet);
    RunReport report;
    report.on_warning = [&](const std::string& message) {
        progress.finish();
        spdlog::warn(message);
    };
    pipeline::RunOptions options;
    options.output = a.output.empty() ? std::filesystem::path("out") / scene.name : std::filesystem::path(a.output);
    options.output = std::filesystem::absolute(options.output).lexically_normal();
    options.acquisitions = a.acquisitions;
    options.threads = a.threads;
    options.force = a.force;
    options.command_line = command_line;
    options.on_progress = [&](const std::string& step, double fraction) { progress.update(step, fraction); };
    options.cancelled = &interrupted;
    phase(scene, options, report);
    progress.finish();
    for (const auto& [name, seconds] : report.timings_s()) spdlog::debug("{}: {:.3f} s", name, seconds);
    for (const auto& [name, value] : report.values()) spdlog::debug("{} = {:.6g}", name, value);
    for (const auto& [name, count] : report.counters()) spdlog::debug("{}: {}", name, count);
    const auto timings = report.timings_s();
    if (!a.quiet)
        fmt::print("{}: done in {:.1f} s, products in {}\n", scene.name, timings.at("total"), options.output.string());
}

int run_check(const Arguments& a) {
    if (a.print_schema) {
        std::cout << scenario::json_schema() << "\n";
        return kDone;
    }
    if (a.scenario.empty()) throw CLI::RequiredError("SCENARIO");
    const auto result = pipeline::check(inputs::load_scenario(a.scenario));
    for (const auto& warning : result.warnings) spdlog::warn(warning);
    for (const auto& problem : result.problems) fmt::print(stderr, "{}\n", problem);
    if (!result.problems.empty()) return kRejected;
    if (!a.quiet) fmt::print("{}", result.summary);
    return kDone;
}

CLI::App* add_phase(CLI::App& app, Arguments& a, const char* name, const char* help) {
    auto* sub = app.add_subcommand(name, help);
    sub->add_option("SCENARIO", a.scenario, "scenario file (YAML)")->required();
    sub->add_option("-o,--output", a.output, "folder for the outputs (default: out/<scenario name>)");
    sub->add_option("--acquisition", a.acquisitions, "only this acquisition (may be repeated)");
    sub->add_option("--threads", a.threads, "number of threads (default: all cores)")->check(CLI::Range(1, 1024));
    sub->add_flag("--force", a.force, "redo finished outputs");
    sub->footer(fmt::format("Example: pyroscene {} scenarios/minimal/scenario.yaml -o out/minimal", name));
    return sub;
}

int dispatch(CLI::App& app, const Arguments& a, const std::string& command_line) {
    if (app.got_subcommand("run"))
        run_phase(&pipeline::run, a, command_line);
    else if (app.got_subcommand("prepare"))
        run_phase(&pipeline::prepare, a, command_line);
    else if (app.got_subcommand("render"))
        run_phase(&pipeline::render, a, command_line);
    else if (app.got_subcommand("products"))
        run_phase(&pipeline::products, a, command_line);
    else if (app.got_subcommand("spread"))
        run_phase(&pipeline::spread, a, command_line);
    else if (app.got_subcommand("check"))
        return run_check(a);
    else if (app.got_subcommand("sensors")) {
        cli::sensors_command(a.sensors);
    } else if (app.got_subcommand("export")) {
        auto options = a.flame_export;
        options.quiet = a.quiet;
        options.cancelled = &interrupted;
        cli::export_command(options);
    } else if (app.got_subcommand("fit-scar")) {
        auto options = a.fit_scar;
        options.quiet = a.quiet;
        cli::fit_scar_command(options);
    } else if (app.got_subcommand("unmix")) {
        auto options = a.unmix;
        options.quiet = a.quiet;
        cli::unmix_command(options, interrupted);
    } else if (app.got_subcommand("frp")) {
        auto options = a.frp;
        options.quiet = a.quiet;
        cli::frp_command(options, interrupted);
    } else if (app.got_subcommand("compare")) {
        auto options = a.compare;
        options.quiet = a.quiet;
        options.has_threshold = app.get_subcommand("compare")->count("--threshold") > 0;
        cli::compare_command(options);
    } else if (app.got_subcommand("calc"))
        cli::run_calc(a.calc_name);
    return kDone;
}

void add_fit_scar(CLI::App& app, cli::FitScarOptions& o) {
    auto* sub = app.add_subcommand("fit-scar", "cooling curve of a burn scar from a time-temperature record");
    sub->add_option("CSV", o.csv, "table with time_s and temperature_K or temperature_C (also t_s, T_K, T_C)")->required();
    sub->add_option("--algorithm", o.algorithm, "how to search")
        ->check(CLI::IsMember(cli::fit_algorithm_names()))
        ->capture_default_str();
    sub->add_option("--model", o.model, "what to fit")->check(CLI::IsMember(cli::scar_model_names()))->capture_default_str();
    sub->add_option("--start", o.start,
                    "first guess: amplitude1 time_constant1 [amplitude2 time_constant2] floor; the floor in the unit of the "
                    "table (default: from the record)")
        ->delimiter(',');
    sub->add_option("--maximum-evaluations", o.maximum_evaluations, "give up after so many")
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str();
    sub->add_option("-o,--output", o.output, "prefix of .png, .json and .yaml (default: out/<name of the table>)");
    sub->footer("Example: pyroscene fit-scar record.csv --algorithm nelder-mead -o out/record");
}

void add_unmix(CLI::App& app, cli::UnmixOptions& o) {
    auto* sub = app.add_subcommand("unmix", "fractions of known spectra in each pixel of any raster");
    sub->add_option("IMAGE", o.image, "raster with a band per wavelength")->required();
    sub->add_option("--endmembers", o.endmembers,
                    "table: wavelength_um, wavelength_nm or band, then a column per spectrum; or an ENVI library (.sli)");
    sub->add_option("--sensor", o.sensor,
                    "whose responses average spectra finer than the bands (default: as the image says)");
    sub->add_option("--truth", o.truth, "truth.tif of the image: its pure pixels give endmembers, its fractions the score");
    sub->add_option("--pure", o.pure, "fraction from which on a pixel of the truth counts as pure")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    sub->add_option(
           "--purest", o.purest,
           "classes without such pixels: take their purest ones, if they hold this fraction (default: leave them out)")
        ->check(CLI::Range(0.01, 1.0));
    sub->add_option("--method", o.method, "stepwise selection by F-tests, or least squares with all endmembers")
        ->check(CLI::IsMember(cli::unmix_methods()))
        ->capture_default_str();
    sub->add_option("--solver", o.solver, "least squares on the endmembers that stepwise selection chose")
        ->check(CLI::IsMember(cli::unmix_solvers()))
        ->capture_default_str();
    sub->add_option("--alpha", o.alpha, "probability that an endmember which is not there is chosen")
        ->check(CLI::Range(1e-9, 0.5))
        ->capture_default_str();
    sub->add_option("--noise", o.noise, "table: wavelength_um or band, noise (standard deviation); weights the bands");
    sub->add_option("--threads", o.threads, "number of threads (default: all cores)")->check(CLI::Range(1, 1024));
    sub->add_option("-o,--output", o.output, "GeoTIFF (default: <image>_fractions.tif beside the image)");
    sub->footer("Example: pyroscene unmix radiance.tif --endmembers spectra.csv --method stepwise -o fractions.tif");
}

void add_frp(CLI::App& app, cli::FrpOptions& o) {
    auto* sub = app.add_subcommand("frp", "fire radiative power of any calibrated raster with wavelength metadata");
    sub->add_option("IMAGE", o.image, "radiances, W m-2 sr-1 um-1, on a map or with geolocation arrays")->required();
    sub->add_option("--method", o.method, "MIR radiance, or two bands (Dozier)")
        ->check(CLI::IsMember({"mir", "bispectral"}))
        ->capture_default_str();
    sub->add_option(
           "--coefficient", o.coefficient,
           "a of L = a T^4: fit (to the band's response), bird, modis, seviri, goes, viirs_m13, viirs_i4, or a number")
        ->capture_default_str();
    sub->add_option("--sensor", o.sensor,
                    "whose spectral responses the bands have (default: as the image says, else boxcars)");
    sub->add_option("--mir-band", o.mir_band, "from 1 (default: nearest 3.96 um)")->check(CLI::PositiveNumber);
    sub->add_option("--tir-band", o.tir_band, "from 1 (default: nearest 11 um)")->check(CLI::PositiveNumber);
    sub->add_option("--mir-transmittance", o.mir_transmittance, "of the air")->check(CLI::Range(1e-3, 1.0));
    sub->add_option("--tir-transmittance", o.tir_transmittance, "of the air")->check(CLI::Range(1e-3, 1.0));
    sub->add_option("--mir-path", o.mir_path, "path radiance, W m-2 sr-1 um-1")->check(CLI::NonNegativeNumber);
    sub->add_option("--tir-path", o.tir_path, "path radiance, W m-2 sr-1 um-1")->check(CLI::NonNegativeNumber);
    sub->add_option("--mir-noise", o.mir_noise, "standard deviation of the radiance, for the errors of the two-band method")
        ->check(CLI::NonNegativeNumber);
    sub->add_option("--tir-noise", o.tir_noise, "as --mir-noise")->check(CLI::NonNegativeNumber);
    sub->add_option("--least-temperature", o.least_temperature_K,
                    "MIR brightness temperature [K] below which nothing is a fire")
        ->check(CLI::Range(200.0, 1000.0))
        ->capture_default_str();
    sub->add_flag("--no-background", o.no_background, "do not take the radiance of the surroundings off (thesis eq 6.6)");
    sub->add_option("-o,--output", o.output, "GeoTIFF (default: <image>_frp.tif); the tables go beside it");
    sub->footer("Example: pyroscene frp out/lolo_peak/wasp_thesis_1h/radiance.tif --coefficient modis -o frp.tif");
}

void add_compare(CLI::App& app, cli::CompareOptions& o) {
    auto* sub = app.add_subcommand("compare", "a synthetic against a real image: registration, differences, scores");
    sub->add_option("SYNTHETIC", o.synthetic, "ortho product")->required();
    sub->add_option("REAL", o.real, "georeferenced raster of the same quantity")->required();
    sub->add_option("--threshold", o.threshold,
                    "from which value on a pixel is fire (default: Otsu's of the synthetic image)");
    sub->add_flag("--no-registration", o.no_registration, "trust the georeference of both");
    sub->add_option("--largest-shift", o.largest_shift, "fraction of the shorter side; larger shifts are not believed")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    sub->add_option("-o,--output", o.output, "folder (default: out/<synthetic>_comparison)");
    sub->footer("Example: pyroscene compare out/lolo_peak/wasp_1h/ortho_radiance.tif flight_line.tif -o out/comparison");
}

void add_export(CLI::App& app, cli::ExportOptions& o) {
    auto* sub = app.add_subcommand("export", "the flames of one moment as voxels for other programs, or as a side view");
    sub->add_option("SCENARIO", o.scenario, "scenario file (YAML)")->required();
    sub->add_option("--acquisition", o.acquisitions, "the moment of this acquisition");
    sub->add_option("--time_s", o.time_s, "or any moment, seconds after ignition");
    sub->add_option("--format", o.format, "what to write")->required()->check(CLI::IsMember(cli::export_formats()));
    sub->add_option("-o,--output", o.output, "file (default: out/<scenario name>/export/<acquisition or time>)");
    sub->add_option("--voxel_m", o.voxel_m, "edges east,north,up (default: flame.voxel_m; the thesis: 20,20,5)")
        ->delimiter(',');
    sub->add_option("--layers", o.layers, "height of the lattice in voxels (default: as needed; the thesis: 64)")
        ->check(CLI::Range(1, 100000));
    sub->add_flag("--above-ground", o.above_ground, "heights count from the ground below: a flat scene");
    sub->add_option("--window_m", o.window_m, "side-view: west,east,south,north, metres from the map's centre")
        ->delimiter(',');
    sub->add_option("--material", o.material, "dirsig-grid: material id")->capture_default_str();
    sub->add_option("--concentration_ppm", o.concentration_ppm, "dirsig-grid: of a voxel filled with flame")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    sub->footer("Example: pyroscene export scenarios/minimal/scenario.yaml --time_s 60 --format csv -o out/flames.csv");
}

/// The words after `calc`. Its options are those of the formula, so they are not the parser's business (but --help without a name is).
std::vector<std::string> calc_words(int argc, char** argv) {
    int i = 1;
    while (i < argc && std::string_view(argv[i]).starts_with("-")) ++i;
    if (i >= argc || std::string_view(argv[i]) != "calc") return {};
    std::vector<std::string> words(argv + i + 1, argv + argc);
    if (words.size() == 1 && (words[0] == "--help" || words[0] == "-h")) return {};
    return words;
}

/// GDAL and OpenCV may bring in OpenBLAS, whose threads spin for a tenth of a second from the start of a program on, on cores
/// that the work wants. It starts them again where they are used.
void stop_idle_blas_threads() {
    using Shutdown = int (*)();
    const auto shutdown = reinterpret_cast<Shutdown>(dlsym(RTLD_DEFAULT, "blas_thread_shutdown_"));
    if (shutdown != nullptr) shutdown();
}

}  // namespace

int main(int argc, char** argv) {
    stop_idle_blas_threads();
    auto logger = spdlog::stderr_color_mt("pyroscene");
    spdlog::set_default_logger(logger);
    spdlog::set_pattern("%^%l%$: %v");

    CLI::App app("Synthetic remote-sensing images of wildland fires from georeferenced rasters.", "pyroscene");
    app.set_version_flag("--version", "pyroscene " + pipeline::version());
    app.require_subcommand(1);
    app.fallthrough();
    Arguments a;
    app.add_flag("-q,--quiet", a.quiet, "print errors and warnings only");
    app.add_flag("-v,--verbose", a.verbose, "print timings, counters and the energy budget");
    add_phase(app, a, "run", "the main job: prepare, render and products");
    add_phase(app, a, "prepare", "fire states of all frames, in order");
    add_phase(app, a, "render", "radiance, geolocation and truth of the acquisitions");
    add_phase(app, a, "products", "brightness temperature, ortho images, maps and pictures");
    auto* spread = add_phase(app, a, "spread", "only the fire of inputs.spread: its rasters, as inputs for other scenarios");
    spread->footer("Example: pyroscene spread scenarios/lolo_peak/from_ignition.yaml -o out/fire");
    auto* check = app.add_subcommand("check", "everything that is wrong with a scenario, and what it would cost");
    check->add_option("SCENARIO", a.scenario, "scenario file (YAML)");
    check->add_flag("--print-schema", a.print_schema, "print the JSON Schema of scenario files");
    check->footer("Example: pyroscene check scenarios/lolo_peak/scenario.yaml");
    add_export(app, a.flame_export);
    add_fit_scar(app, a.fit_scar);
    add_unmix(app, a.unmix);
    add_frp(app, a.frp);
    add_compare(app, a.compare);
    auto* sensor = app.add_subcommand("sensors", "list the sensors, or show one in full");
    sensor->add_option("ID", a.sensors.id, "sensor id, or the path of a sensor file");
    sensor->add_flag("--json", a.sensors.json, "machine-readable output");
    sensor->add_option("--plot", a.sensors.plot, "picture (PNG) of its spectral responses");
    sensor->add_option("--footprint", a.sensors.footprint, "outlines of a scenario's images and some pixels as GeoJSON");
    sensor->add_option("-o,--output", a.sensors.output, "file for --footprint (default: standard output)");
    sensor->footer("Example: pyroscene sensors wasp");
    auto* calc = app.add_subcommand("calc", "one formula or table look-up; with --csv, every row of a table");
    calc->add_option("NAME", a.calc_name, "what to compute, and its options");
    calc->footer(
        "pyroscene calc NAME [--option value ...] | --csv IN.csv [-o OUT.csv|OUT.json] [--json] [--plot OUT.png]\n"
        "pyroscene calc NAME --help: its options one by one, and an example\n" +
        cli::calc_help() + "Example: pyroscene calc planck --wavelength_um 4 --temperature_K 1100");

    std::string command_line;
    cli::add_atmosphere_commands(app, a.quiet, command_line);
    cli::add_picture_commands(app, a.quiet);
    cli::add_detection_commands(app, a.quiet, interrupted);
    for (int i = 0; i < argc; ++i) command_line += (i > 0 ? " " : "") + std::string(argv[i]);
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    try {
        if (const auto words = calc_words(argc, argv); !words.empty()) {
            cli::run_calc(words);
            return kDone;
        }
        app.parse(argc, argv);
        spdlog::set_level(a.quiet ? spdlog::level::warn : a.verbose > 0 ? spdlog::level::debug : spdlog::level::info);
        return dispatch(app, a, command_line);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongCommandLine;
    } catch (const std::invalid_argument& e) {
        fmt::print(stderr, "{}\n", e.what());
        return kWrongCommandLine;
    } catch (const Cancelled&) {
        fmt::print(stderr, "\ninterrupted; finished outputs are kept, run the same command again to go on\n");
        return kRunTimeFailure;
    } catch (const Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return e.kind() == ErrorKind::Input ? kRejected : kRunTimeFailure;
    } catch (const std::exception& e) {
        fmt::print(stderr, "unexpected failure: {}\n", e.what());
        return kRunTimeFailure;
    }
}
