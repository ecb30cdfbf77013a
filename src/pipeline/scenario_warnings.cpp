#include "pipeline/scenario_warnings.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/acquisition.h"
#include "radiometry/user_spectra.h"
#include "sensors/sensor.h"

namespace pyroscene::pipeline {
namespace {

using Warnings = std::vector<std::string>;

/// A scar's clock starts at the frame that shows it burning, unless an arrival raster says better.
void warn_of_sparse_frames(const scenario::Scenario& s, const inputs::SceneInputs& in, Warnings& out) {
    if (in.arrival_time_s) return;
    double widest_s = 0.0;
    for (std::size_t i = 1; i < in.frames.size(); ++i)
        widest_s = std::max(widest_s, in.frames[i].time_s - in.frames[i - 1].time_s);
    if (widest_s > s.fire.scar.time_constant1_s)
        out.push_back(
            fmt::format("frames are up to {:.0f} s apart, more than the scar's time constant ({:.0f} s): give "
                        "inputs.arrival to date scars that burned between frames",
                        widest_s, s.fire.scar.time_constant1_s));
}

/// What burns in the last frame burns in all images after it.
void warn_of_late_images(const scenario::Scenario& s, const inputs::SceneInputs& in, Warnings& out) {
    const auto n = in.frames.size();
    const double last_s = in.frames.back().time_s, step_s = n > 1 ? last_s - in.frames[n - 2].time_s : 0.0;
    for (const auto& a : s.acquisitions)
        if (a.time_s - last_s > std::max(step_s, s.fire.scar.time_constant1_s))
            out.push_back(fmt::format(
                "acquisition '{}' is {:.0f} s after the last frame ({:g} s): what burned then still flames in it", a.id,
                a.time_s - last_s, last_s));
}

void warn_of_flat_flames(const scenario::Scenario& s, Warnings& out) {
    if (s.physics == fire::Physics::Thesis && s.fire.flames.tilt.method == "thesis")
        out.push_back(
            "fire.tilt.method: thesis under physics: thesis follows eq 4.31 as printed, which lays flames flat in calm "
            "air; physics: default measures its angle from the ground");
}

/// Bands of the acquisitions that see wavelengths of an interval, as "acquisition: band, band".
std::string bands_within(const scenario::Scenario& s, double lower_um, double upper_um) {
    std::string out;
    for (const auto& a : s.acquisitions) {
        const auto sensor = sensors::load_sensor(a.sensor);
        std::vector<std::string> bands;
        for (const auto& group : wanted_groups(a, sensor))
            for (const int b : wanted_bands(a, sensor, group)) {
                const auto& band = sensor.bands[static_cast<std::size_t>(b)];
                if (band.centre_um > lower_um && band.centre_um < upper_um) bands.push_back(band.id);
            }
        if (bands.empty()) continue;
        constexpr std::size_t kMost = 5;
        const bool more = bands.size() > kMost;
        if (more) bands.resize(kMost);
        out += fmt::format("{}{}: {}{}", out.empty() ? "" : "; ", a.id, fmt::join(bands, ", "), more ? ", ..." : "");
    }
    return out;
}

/// Where the user's spectrum has no samples, a straight line stands for what was not measured.
void warn_of_gaps_in_spectra(const scenario::Scenario& s, Warnings& out) {
    if (s.surface.emissivity) return;
    for (const auto& [name, file] : s.surface.spectra)
        for (const auto& [lower_um, upper_um] : radiometry::gaps_um(radiometry::load_reflectance(file, name)))
            if (const auto bands = bands_within(s, lower_um, upper_um); !bands.empty())
                out.push_back(
                    fmt::format("surface '{}' ({}) has no sample between {:.4g} and {:.4g} um, where bands lie ({}): a "
                                "straight line is used",
                                name, file.filename().string(), lower_um, upper_um, bands));
}

}  // namespace

std::vector<std::string> scenario_warnings(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs) {
    Warnings out;
    warn_of_sparse_frames(scenario, inputs, out);
    warn_of_late_images(scenario, inputs, out);
    warn_of_flat_flames(scenario, out);
    warn_of_gaps_in_spectra(scenario, out);
    if (inputs.modelled) out.insert(out.end(), inputs.modelled->warnings.begin(), inputs.modelled->warnings.end());
    return out;
}

}  // namespace pyroscene::pipeline
