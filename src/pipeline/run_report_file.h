#pragma once

#include <string>

#include "base/report.h"
#include "pipeline/fingerprint.h"
#include "pipeline/run.h"

namespace pyroscene::pipeline {

/// Writes OUT/run.json. `fingerprints` may be null when the run failed early; `failure` is empty when it did not.
void write_run_report(const scenario::Scenario& scenario, const RunOptions& options, const RunReport& report,
                      const Fingerprints* fingerprints, const std::string& failure);

/// Takes over the energy budget of an acquisition from the OUT/run.json of an earlier run when this one skipped its image.
void keep_energy(RunReport& report, const std::filesystem::path& output, const std::string& acquisition_id);

}  // namespace pyroscene::pipeline
