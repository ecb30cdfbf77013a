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
    out += s.airborne ? fmt::format(", {:g} m above ground\n", s.altitude_agl_m) : std::string("\n");
    for (const auto& g : s.groups) {
        if (!(g.focal_length_m > 0.0)) continue;
        out += fmt::format("  group {}: {} x {} pixels, focal length {:g} mm, pitch {:g} um, IFOV {:.4g} mrad\n", g.id,
                           g.samples, g.lines, 1e3 * g.focal_length_m, 1e6 * g.pixel_pitch_m,
                           1e3 * g.pixel_pitch_m / g.focal_length_m);
    }
    out += fmt::format("  {:<10} {:<8} {:>10} {:>9}  {:<9} {:<24} {}\n", "band", "group", "centre um", "FWHM um", "response",
                       "noise", "saturation W m-2 sr-1 um-1");
    for (const auto& b : s.bands)
        out +=
            fmt::format("  {:<10} {:<8} {:>10.4f} {:>9.4f}  {:<9} {:<24} {}\n", b.id, b.group, b.centre_um, b.fwhm_um,
                        b.measured_response ? "measured" : "nominal", noise_text(b),
                        b.saturation_radiance_W_m2_sr_um ? fmt::format("{:.5g}", *b.saturation_radiance_W_m2_sr_um) : "-");
    if (!s.confidence.empty())
        out +=
            "  confidence of the numbers (A read at the source, B secondary, L literature, C computed, E assumed, D "
            "definition):\n";
    for (const auto& [path, code] : s.confidence) out += fmt::format("    {:<44} {}\n", path, code);
    for (const auto& [key, text] : s.sources) out += fmt::format("  source {}: {}\n", key, text);
    std::cout << out;
}

/// Reflective and thermal bands each in a diagram, as far as there are any.
void plot_responses(const std::string& id_or_path, const std::filesystem::path& file) {
    constexpr double kThermal_um = 3.0;
    constexpr std::size_t kMostInLegend = 8;
    const auto s = sensors::load_sensor(id_or_path);
    std::vector<drawing::LinePlot> plots;
    for (const bool thermal : {false, true}) {
        drawing::LinePlot plot;
        plot.title = fmt::format("{}: spectral response", s.id);
        plot.x.label = "wavelength, um";
        plot.y = {"response, peak 1", false, 0.0, 1.05};
        for (const auto& band : s.bands)
            if ((band.centre_um >= kThermal_um) == thermal)
                plot.series.push_back({band.id, band.response.lambda_um, band.response.value});
        if (plot.series.size() > kMostInLegend)
            for (auto& series : plot.series) series.label.clear();
        if (!plot.series.empty()) plots.push_back(std::move(plot));
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
