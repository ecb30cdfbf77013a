#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drawing/html_page.h"
#include "pipeline/run_html.h"

/// The parts of the report page about power and energy.
namespace pyroscene::pipeline {

/// What the tables and curves of power take from an image.
struct ImagePower {
    std::string id, acquisition, instrument;
    double time_s = 0.0;
    std::optional<double> seen_MW;  ///< true fire radiative power in the image
};

/// Four digits and the unit; a dash for what is unknown.
std::string report_number(double value, const char* unit = "");

/// Heat release of all frames as their state files tell it, seen and radiated power of the acquisitions.
void show_power(drawing::HtmlPage& page, const inputs::SceneInputs& inputs, const RunOptions& options,
                const RunReport& report, const std::vector<ImagePower>& images);
void show_energy(drawing::HtmlPage& page, const RunReport& report, const std::vector<ImagePower>& images);

}  // namespace pyroscene::pipeline
