#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/report.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// What the command line adds to a scenario.
struct RunOptions {
    std::filesystem::path output;           ///< folder of all products
    std::vector<std::string> acquisitions;  ///< ids; empty = all of the scenario
    int threads = 0;                        ///< 0 = all cores
    bool force = false;                     ///< redo finished outputs
    std::string command_line;               ///< recorded in run.json
    /// Called with the name of each step and, while it runs, its fraction done.
    std::function<void(const std::string& step, double fraction_done)> on_progress;
    const std::atomic<bool>* cancelled = nullptr;
};

/// The three phases, each skipping what is finished and unchanged. They write only whole files and end with run.json, also
/// when they fail. Throw Error (input or runtime) and Cancelled.
void prepare(const scenario::Scenario& scenario, const RunOptions& options, RunReport& report);
void render(const scenario::Scenario& scenario, const RunOptions& options, RunReport& report);
void products(const scenario::Scenario& scenario, const RunOptions& options, RunReport& report);
/// The main job: prepare, render, products.
void run(const scenario::Scenario& scenario, const RunOptions& options, RunReport& report);

/// Only the fire of inputs.spread: its rasters, written as inputs for other scenarios. Throws an input error without that key.
void spread(const scenario::Scenario& scenario, const RunOptions& options, RunReport& report);

/// Everything that is wrong with the rasters and sensors of a scenario, and what a run would compute.
struct CheckResult {
    std::vector<std::string> problems;  ///< one line each; empty = ready to run
    std::vector<std::string> warnings;
    std::string summary;  ///< size and estimated cost, several lines
};
CheckResult check(const scenario::Scenario& scenario);

/// Program version, "0.1.0".
std::string version();

}  // namespace pyroscene::pipeline
