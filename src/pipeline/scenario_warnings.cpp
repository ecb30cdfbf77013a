#include "pipeline/scenario_warnings.h"

#include <algorithm>

#include <fmt/format.h>

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

}  // namespace

std::vector<std::string> scenario_warnings(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs) {
    Warnings out;
    warn_of_sparse_frames(scenario, inputs, out);
    warn_of_late_images(scenario, inputs, out);
    warn_of_flat_flames(scenario, out);
    if (inputs.modelled) out.insert(out.end(), inputs.modelled->warnings.begin(), inputs.modelled->warnings.end());
    return out;
}

}  // namespace pyroscene::pipeline
