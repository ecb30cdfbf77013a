#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/report.h"
#include "pipeline/acquisition.h"
#include "pipeline/fingerprint.h"
#include "pipeline/run.h"

namespace pyroscene::pipeline {

/// What the phases of one run share.
struct Session {
    const scenario::Scenario& scenario;
    const RunOptions& options;
    RunReport& report;
    Fingerprints fingerprints;
    inputs::SceneInputs inputs;
    std::optional<OpticalTables> tables;

    Session(const scenario::Scenario& s, const RunOptions& o, RunReport& r)
        : scenario(s), options(o), report(r), fingerprints(s), inputs(inputs::load_scene_inputs(s, [this](double fraction) {
              stop_if_cancelled();
              progress("spread", fraction);
          })) {}

    /// Read when they are first asked for.
    const OpticalTables& optical_tables() {
        if (!tables) tables = load_optical_tables(scenario, inputs);
        return *tables;
    }
    void stop_if_cancelled() const {
        if (options.cancelled != nullptr && options.cancelled->load()) throw Cancelled();
    }
    [[nodiscard]] Monitor monitor(const std::string& step) const {
        Monitor m;
        m.cancelled = options.cancelled;
        if (options.on_progress) m.progress = [this, step](double f) { options.on_progress(step, f); };
        return m;
    }
    void progress(const std::string& step, double fraction) const {
        if (options.on_progress) options.on_progress(step, fraction);
    }
    [[nodiscard]] std::string utc(double time_s) const { return UtcTime{scenario.start.unix_s + time_s}.iso8601(); }
};

/// Whether a finished raster still belongs to the scenario: it carries this fingerprint, and the options do not ask for it anew.
bool is_current(const std::filesystem::path& file, const std::string& fingerprint, const RunOptions& options);

}  // namespace pyroscene::pipeline
