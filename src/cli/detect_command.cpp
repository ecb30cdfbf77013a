#include "cli/detect_command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "imagery/detect_image.h"
#include "imagery/energy_of_frames.h"
#include "imagery/index_image.h"

namespace pyroscene::cli {
namespace {

std::filesystem::path output_or_beside(const std::string& output, const std::filesystem::path& image,
                                       const std::string& what) {
    return output.empty() ? image.parent_path() / (image.stem().string() + "_" + what + ".tif")
                          : std::filesystem::path(output);
}

void print_bins(const char* title, const std::vector<analysis::ScoreBin>& bins) {
    for (const auto& bin : bins) {
        if (bin.true_pixels == 0) continue;
        fmt::print("  {} {:>8.3g} to {:<8}: {:>6} of {:>6} found\n", title, bin.lower,
                   std::isfinite(bin.upper) ? fmt::format("{:.3g}", bin.upper) : "any", bin.found, bin.true_pixels);
    }
}

void print(const imagery::DetectJob& job, const imagery::DetectReport& r) {
    fmt::print("{} with {}\n", r.method, r.bands);
    if (r.threshold) fmt::print("threshold {:.5g}\n", *r.threshold);
    fmt::print("{} fire pixels{}; {} unknown, {} sun glint, {} cloud, {} water, {} without fire\n", r.fire_pixels,
               std::isfinite(r.total_MW) ? fmt::format(", {:.6g} MW", r.total_MW) : "", r.unknown, r.glint, r.cloud, r.water,
               r.land);
    if (r.score) {
        const auto& s = *r.score;
        fmt::print(
            "truth: {} of {} fire pixels found (omission {:.3f}); of {} detections {} without fire (commission {:.3f}), {} "
            "of "
            "them within 2 pixels of one; {} pixels without fire\n",
            s.found, s.true_pixels, s.omission(), s.detected, s.false_alarms, s.commission(), s.beside, s.background);
        print_bins("MW", s.by_frp_MW);
        print_bins("m2", s.by_area_m2);
    }
    fmt::print("written: {}\n", job.output.string());
}

/// Command-line text of what may be left out.
struct DetectOptions {
    imagery::DetectJob job;
    std::string output, image;
};

void add_detect(CLI::App& app, const bool& quiet, const std::atomic<bool>& interrupted) {
    auto options = std::make_shared<DetectOptions>();
    auto& job = options->job;
    auto* sub = app.add_subcommand("detect", "fire pixels of any calibrated raster, and how many of the true ones they are");
    sub->add_option("IMAGE", options->image, "radiances (or brightness temperatures) on a map or with geolocation arrays")
        ->required();
    sub->add_option("--method", job.method, fmt::format("{}", fmt::join(imagery::detection_methods(), ", ")))
        ->check(CLI::IsMember(imagery::detection_methods()))
        ->capture_default_str();
    sub->add_option("--sensor", job.sensor, "whose spectral responses the bands have (default: as the image says)");
    sub->add_option("--mir-band", job.mir_band, "from 1 (default: nearest 3.96 um, viirs375 3.74 um)")
        ->check(CLI::PositiveNumber);
    sub->add_option("--tir-band", job.tir_band, "from 1 (default: nearest 11 um)")->check(CLI::PositiveNumber);
    sub->add_option("--reflective", job.reflective, "image with the bands near 0.65, 0.86 and 2.1 um (default: IMAGE)");
    sub->add_option("--water", job.water, "raster of the same size, 1 = water");
    sub->add_option("--sun-zenith", job.sun_zenith_deg, "degrees, for all pixels (default: from time and place)")
        ->check(CLI::Range(0.0, 180.0));
    sub->add_option("--threshold", job.threshold, "of an index (default: median of the scene + --deviations x scatter)");
    sub->add_option("--deviations", job.deviations, "of the scene")->check(CLI::Range(0.0, 1000.0))->capture_default_str();
    sub->add_option("--least-radiance", job.least_radiance, "W m-2 sr-1 um-1; darker pixels have no index")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    sub->add_option("--truth", job.truth, "truth.tif of the image (default: the one beside it, if any)");
    sub->add_option("--least-area", job.least_area_m2, "m2 of fire, from which on a pixel of the truth is one")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    sub->add_option("-o,--output", options->output,
                    "GeoTIFF (default: <image>_<method>.tif); tables and vectors go beside it");
    sub->footer("Example: pyroscene detect out/lolo_peak/modis/radiance.tif --method mod14 -o fires.tif");
    sub->callback([options, &quiet, &interrupted] {
        auto& o = *options;
        o.job.image = o.image;
        o.job.output = output_or_beside(o.output, o.job.image, o.job.method);
        o.job.cancelled = &interrupted;
        const auto report = imagery::detect_image(o.job);
        for (const auto& note : report.notes) spdlog::warn(note);
        if (!quiet) print(o.job, report);
    });
}

struct IndexOptions {
    imagery::IndexJob job;
    std::string output, image;
};

void add_index(CLI::App& app, const bool& quiet) {
    auto options = std::make_shared<IndexOptions>();
    auto& job = options->job;
    auto* sub = app.add_subcommand("index", "spectral indices and burn severity of any raster with wavelength metadata");
    sub->add_option("IMAGE", options->image, "radiances or reflectances; for dnbr, after the fire")->required();
    sub->add_option("--name", job.name, fmt::format("{}", fmt::join(imagery::index_names(), ", ")))
        ->check(CLI::IsMember(imagery::index_names()))
        ->capture_default_str();
    sub->add_option("--before", job.before, "dnbr: image from before the fire");
    sub->add_option("--sensor", job.sensor, "whose spectral responses the bands have (default: as the image says)");
    sub->add_option("--sun-zenith", job.sun_zenith_deg, "degrees, for all pixels (default: from time and place)")
        ->check(CLI::Range(0.0, 85.0));
    sub->add_option("-o,--output", options->output, "GeoTIFF (default: <image>_<name>.tif)");
    sub->footer("Example: pyroscene index after.tif --name dnbr --before before.tif -o severity.tif");
    sub->callback([options, &quiet] {
        auto& o = *options;
        if ((o.job.name == "dnbr") != o.job.before.has_value())
            throw std::invalid_argument("--before belongs to --name dnbr, and dnbr needs it");
        o.job.image = o.image;
        o.job.output = output_or_beside(o.output, o.job.image, o.job.name);
        const auto report = imagery::index_image(o.job);
        if (quiet) return;
        fmt::print("{} of {}: {:.4g} to {:.4g}, median {:.4g}\n", o.job.name, fmt::join(report.bands, ", "), report.minimum,
                   report.maximum, report.median);
        for (const auto& s : report.severity)
            if (s.pixels > 0) fmt::print("  {:<24} {:>9} pixels {:>12.6g} ha\n", s.name, s.pixels, s.area_ha);
        fmt::print("written: {}\n", o.job.output.string());
    });
}

void add_fre(CLI::App& app, const bool& quiet) {
    struct Options {
        std::vector<std::string> frames;
        std::string output;
    };
    auto options = std::make_shared<Options>();
    auto* sub = app.add_subcommand("fre", "fire radiative energy from maps of power at several moments");
    sub->add_option("FRAMES", options->frames, "ortho_frp.tif of several acquisitions, or results of `frp` on maps")
        ->required();
    sub->add_option("-o,--output", options->output, "GeoTIFF; the table goes beside it")->required();
    sub->footer("Example: pyroscene fre out/my_fire/*/ortho_frp.tif -o fre.tif");
    sub->callback([options, &quiet] {
        const auto steps = imagery::energy_of_frames({{options->frames.begin(), options->frames.end()}, options->output});
        if (quiet) return;
        fmt::print("{:>20} {:>10} {:>12} {:>14}\n", "time", "s", "FRP MW", "FRE MJ");
        for (const auto& s : steps)
            fmt::print("{:>20} {:>10.0f} {:>12.6g} {:>14.6g}\n", s.time, s.time_s, s.power_MW, s.energy_MJ);
        fmt::print("written: {}\n", options->output);
    });
}

}  // namespace

void add_detection_commands(CLI::App& app, const bool& quiet, const std::atomic<bool>& interrupted) {
    add_detect(app, quiet, interrupted);
    add_index(app, quiet);
    add_fre(app, quiet);
}

}  // namespace pyroscene::cli
