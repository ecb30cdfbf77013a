#include "cli/sensors_command.h"

#include <iostream>
#include <stdexcept>

#include <fmt/format.h>

#include "base/files.h"
#include "drawing/line_plot.h"
#include "inputs/load_scenario.h"
#include "pipeline/footprints.h"
#include "pipeline/sensor_json.h"
#include "scenario/scenario.h"
#include "sensors/detector.h"
#include "sensors/sensor.h"

namespace pyroscene::cli {
namespace {

std::string noise_text(const sensors::Band& band) {
    using Kind = sensors::Noise::Kind;
    switch (band.noise.kind) {
        case Kind::None:
            return "-";
        case Kind::NoiseEquivalentTemperature:
            return fmt::format("NEdT {:g} K at {:g} K", band.noise.value, band.noise.at_temperature_K);
        case Kind::NoiseEquivalentRadiance:
            return fmt::format("NEdL {:g}", band.noise.value);
        case Kind::SignalToNoise:
            return fmt::format("SNR {:g}", band.noise.value);
        case Kind::SignalToNoiseAtAlbedo:
            return fmt::format("SNR {:g} at albedo {:g}", band.noise.value, band.noise.at_albedo.value_or(0.0));
    }
    return "-";
}

/// Where a detector ends and how it counts, as far as the file says.
std::string range_text(const sensors::Band& band) {
    if (!band.saturation_radiance_W_m2_sr_um) return "-";
    std::string text = fmt::format("{:.5g}", *band.saturation_radiance_W_m2_sr_um);
    if (band.bits) text += fmt::format(", {} bits", *band.bits);
    if (band.sensitive_range) text += fmt::format(", finer up to {:.5g}", band.sensitive_range->maximum_W_m2_sr_um);
    if (band.fold_over) text += fmt::format(", folds over beyond {:g} times", *band.fold_over);
    return text;
}

/// Pixels and angles of a camera group.
std::string group_text(const sensors::CameraGroup& g) {
    using Kind = sensors::ScanLaw::Kind;
    const sensors::ScanLaw& scan = g.scan;
    std::string text = fmt::format("  group {}: ", g.id);
    if (scan.kind == Kind::Frame)
        text += fmt::format("{} x {} pixels", g.samples, g.lines);
    else if (scan.kind == Kind::Disk)
        text += fmt::format("disk of {} samples", scan.samples());
    else
        text += fmt::format("{} samples a line, {} line{} a scan", scan.samples(), scan.lines_per_scan,
                            scan.lines_per_scan == 1 ? "" : "s");
    if (scan.period_s > 0.0) text += fmt::format(", a scan every {:.6g} s", scan.period_s);
    if (g.focal_length_m > 0.0)
        text += fmt::format(", focal length {:g} mm, pitch {:g} um, IFOV {:.4g} mrad", 1e3 * g.focal_length_m,
                            1e6 * g.pixel_pitch_m, 1e3 * g.pixel_pitch_m / g.focal_length_m);
    else if (scan.step_across_rad > 0.0)
        text += fmt::format(", step {:.4g} mrad across", 1e3 * scan.step_across_rad);
    if (scan.step_along_rad > 0.0) text += fmt::format(", {:.4g} mrad along", 1e3 * scan.step_along_rad);
    if (!g.views.empty()) text += fmt::format(", {} views", g.views.size());
    return text + "\n";
}

void list_sensors(bool json) {
    std::string out;
    for (const auto& id : sensors::sensor_ids()) {
        const auto s = sensors::load_sensor(id);
        if (json)
            out += (out.empty() ? "[\n" : ",\n") + pipeline::sensor_json(s);
        else
            out += fmt::format("{:<20} {:<13} {:>3} bands  {}\n", s.id, pipeline::scan_type_name(s.scan), s.bands.size(),
                               s.name);
    }
    std::cout << out << (json ? "\n]\n" : "");
}

void show_sensor(const std::string& id_or_path, bool json) {
    const auto s = sensors::load_sensor(id_or_path);
    if (json) {
        std::cout << pipeline::sensor_json(s) << "\n";
        return;
    }
    std::string out = fmt::format("{}: {}\n  file {}\n  {} on {}", s.id, s.name, s.source_path,
                                  pipeline::scan_type_name(s.scan), s.platform_name.empty() ? "-" : s.platform_name);
    if (s.airborne)
        out += fmt::format(", {:g} m above ground", s.altitude_agl_m);
    else if (s.orbit)
        out += fmt::format(", orbit at {:.6g} km", 1e-3 * s.orbit->height_m);
    out += "\n";
    for (const auto& g : s.groups) out += group_text(g);
    out += fmt::format("  {:<10} {:<8} {:>10} {:>9}  {:<9} {:<24} {}\n", "band", "group", "centre um", "FWHM um", "response",
                       "noise", "saturation W m-2 sr-1 um-1, counts");
    for (const auto& b : s.bands)
        out += fmt::format("  {:<10} {:<8} {:>10.4f} {:>9.4f}  {:<9} {:<24} {}\n", b.id, b.group, b.centre_um, b.fwhm_um,
                           b.measured_response ? "measured" : "nominal", noise_text(b), range_text(b));
    if (!s.confidence.empty())
        out +=
            "  confidence of the numbers (A read at the source, B secondary, L literature, C computed, E assumed, D "
            "definition):\n";
    for (const auto& [path, code] : s.confidence) out += fmt::format("    {:<44} {}\n", path, code);
    for (const auto& [key, text] : s.sources) out += fmt::format("  source {}: {}\n", key, text);
    std::cout << out;
}

/// Responses of bands; of hundreds, which would cover each other, the width of each at its centre.
drawing::LinePlot response_plot(const sensors::Sensor& s, const std::vector<const sensors::Band*>& bands) {
    constexpr std::size_t kMostInLegend = 8, kMostCurves = 60;
    drawing::LinePlot plot;
    plot.x.label = "wavelength, um";
    if (bands.size() > kMostCurves) {
        plot.title = fmt::format("{}: width of {} channels", s.id, bands.size());
        plot.y = {"full width at half maximum, um", false, 0.0, {}};
        drawing::PlotSeries widths{"", {}, {}, true};
        for (const auto* band : bands) {
            widths.x.push_back(band->centre_um);
            widths.y.push_back(band->fwhm_um);
        }
        plot.series.push_back(std::move(widths));
        return plot;
    }
    plot.title = fmt::format("{}: spectral response", s.id);
    plot.y = {"response, peak 1", false, 0.0, 1.05};
    for (const auto* band : bands)
        plot.series.push_back(
            {bands.size() > kMostInLegend ? "" : band->id, band->response.lambda_um, band->response.value});
    return plot;
}

/// Reflective and thermal bands each in a diagram, as far as there are any.
void plot_responses(const std::string& id_or_path, const std::filesystem::path& file) {
    constexpr double kThermal_um = 3.0;
    const auto s = sensors::load_sensor(id_or_path);
    std::vector<drawing::LinePlot> plots;
    for (const bool thermal : {false, true}) {
        std::vector<const sensors::Band*> bands;
        for (const auto& band : s.bands)
            if ((band.centre_um >= kThermal_um) == thermal) bands.push_back(&band);
        if (!bands.empty()) plots.push_back(response_plot(s, bands));
    }
    drawing::write_line_plots(file, plots);
}

}  // namespace

void sensors_command(const SensorsOptions& options) {
    if (!options.footprint.empty()) {
        if (!options.id.empty() || options.json || !options.plot.empty())
            throw std::invalid_argument(
                "sensors: --footprint takes its sensors from the scenario; leave ID, --json and --plot out");
        const auto text = pipeline::footprints_geojson(inputs::load_scenario(options.footprint));
        if (options.output.empty())
            std::cout << text;
        else
            write_text_file(options.output, text);
        return;
    }
    if (!options.output.empty()) throw std::invalid_argument("sensors: -o goes with --footprint");
    if (!options.plot.empty()) {
        if (options.id.empty()) throw std::invalid_argument("sensors: --plot needs the ID of a sensor");
        return plot_responses(options.id, options.plot);
    }
    if (options.id.empty())
        list_sensors(options.json);
    else
        show_sensor(options.id, options.json);
}

}  // namespace pyroscene::cli
