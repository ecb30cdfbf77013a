#include "cli/frp_command.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/frp.h"
#include "base/csv.h"
#include "base/error.h"
#include "imagery/frp_image.h"

namespace pyroscene::cli {
namespace {

/// A name of the literature, a number, or "fit".
std::optional<double> coefficient_of(const std::string& text) {
    if (text == "fit") return std::nullopt;
    std::string names = "fit";
    for (const auto& known : analysis::published_coefficients()) {
        if (known.name == text) return known.a_W_m2_sr_um_K4;
        names += fmt::format(", {}", known.name);
    }
    try {
        if (const double value = parse_number(text, "--coefficient"); value > 0.0) return value;
    } catch (const Error&) {
        // not a number either: told below
    }
    throw std::invalid_argument(fmt::format("--coefficient: '{}' is neither a number above 0 nor one of {}", text, names));
}

}  // namespace

void frp_command(const FrpOptions& o, const std::atomic<bool>& interrupted) {
    imagery::FrpJob job;
    job.image = o.image;
    job.bispectral = o.method == "bispectral";
    if (o.mir_band > 0) job.mir_band = o.mir_band;
    if (o.tir_band > 0) job.tir_band = o.tir_band;
    job.coefficient = coefficient_of(o.coefficient);
    if (!o.sensor.empty()) job.sensor = o.sensor;
    job.mir_transmittance = o.mir_transmittance;
    job.tir_transmittance = o.tir_transmittance;
    job.mir_path = o.mir_path;
    job.tir_path = o.tir_path;
    job.mir_noise = o.mir_noise;
    job.tir_noise = o.tir_noise;
    job.least_temperature_K = o.least_temperature_K;
    job.subtract_background = !o.no_background;
    job.output = o.output.empty() ? job.image.parent_path() / (job.image.stem().string() + "_frp.tif")
                                  : std::filesystem::path(o.output);
    job.cancelled = &interrupted;
    const auto report = imagery::frp_image(job);
    if (o.quiet) return;
    fmt::print("MIR band: {}, a = {:.4g} W m-2 sr-1 um-1 K-4\n", report.mir_band, report.coefficient_W_m2_sr_um_K4);
    if (!report.tir_band.empty()) fmt::print("thermal band: {}\n", report.tir_band);
    fmt::print("{} fire pixels, {} without a solution, {} fires, {:.6g} MW\n", report.fire_pixels, report.unsolved,
               report.fires.size(), report.total_MW);
    fmt::print("{:>5} {:>12} {:>11} {:>8} {:>12} {:>12}\n", "fire", "longitude", "latitude", "pixels", "area ha", "FRP MW");
    constexpr std::size_t kMostRows = 10;
    for (std::size_t f = 0; f < std::min(report.fires.size(), kMostRows); ++f) {
        const auto& fire = report.fires[f];
        fmt::print("{:>5} {:>12.6f} {:>11.6f} {:>8} {:>12.4g} {:>12.6g}\n", f + 1, fire.lon_deg, fire.lat_deg, fire.pixels,
                   fire.area_ha, fire.frp_MW);
    }
    fmt::print("written: {}\n", job.output.string());
}

}  // namespace pyroscene::cli
