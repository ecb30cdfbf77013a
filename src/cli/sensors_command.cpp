#include "cli/sensors_command.h"

#include <iostream>

#include <fmt/format.h>

#include "pipeline/sensor_json.h"
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
        case Kind::SignalToNoise:
            return fmt::format("SNR {:g}", band.noise.value);
        case Kind::SignalToNoiseAtAlbedo:
            return fmt::format("SNR {:g} at albedo {:g}", band.noise.value, band.noise.at_albedo.value_or(0.0));
    }
    return "-";
}

}  // namespace

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

}  // namespace pyroscene::cli
