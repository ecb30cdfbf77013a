#pragma once

#include <string>
#include <vector>

#include "base/report.h"
#include "inputs/scene_inputs.h"
#include "pipeline/output_names.h"
#include "pipeline/run.h"

namespace pyroscene::pipeline {

/// One rendered camera group that the report shows.
struct ReportImage {
    const scenario::Acquisition* acquisition = nullptr;
    std::string sensor, group;
    AcquisitionFiles files;
    std::string fingerprint;  ///< of its products
};

/// Writes OUT/report.html: the run as one page that opens without a server. Map, power over time, energy budget, warnings, and for
/// each image its quick-look, spectra of picked pixels, histogram and truth fractions. Made from the files of the run; images
/// beyond the first 24 appear in the tables and curves only. Does nothing when the page is there and shows the same images.
void write_html_report(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                       const std::vector<ReportImage>& images, const RunOptions& options, const RunReport& report);

}  // namespace pyroscene::pipeline
