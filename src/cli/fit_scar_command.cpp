#include "cli/fit_scar_command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "fire/scar_fit.h"
#include "pipeline/scar_fit_files.h"

namespace pyroscene::cli {
namespace {

fire::ScarFitRequest request_of(const FitScarOptions& options, bool celsius) {
    fire::ScarFitRequest request;
    for (const auto& row : fire::fit_algorithms())
        if (options.algorithm == row.name) request.algorithm = row.algorithm;
    for (const auto& row : fire::scar_models())
        if (options.model == row.name) request.model = row.model;
    request.maximum_evaluations = options.maximum_evaluations;
    if (options.start.empty()) return request;
    const auto names = fire::scar_coefficients(request.model);
    const auto& s = options.start;
    if (s.size() != names.size())
        throw std::invalid_argument(
            fmt::format("--start: {} takes {} numbers, found {}", options.model, names.size(), s.size()));
    auto start = fire::scar_model(request.model).defaults;
    start.amplitude1_K = s[0];
    start.time_constant1_s = s[1];
    if (s.size() == 5) {
        start.amplitude2_K = s[2];
        start.time_constant2_s = s[3];
    }
    start.floor_K = s.back() + (celsius ? kZeroCelsius_K : 0.0);
    request.start = start;
    return request;
}

}  // namespace

std::vector<std::string> fit_algorithm_names() {
    std::vector<std::string> names;
    for (const auto& row : fire::fit_algorithms()) names.emplace_back(row.name);
    return names;
}

std::vector<std::string> scar_model_names() {
    std::vector<std::string> names;
    for (const auto& row : fire::scar_models()) names.emplace_back(row.name);
    return names;
}

void fit_scar_command(const FitScarOptions& options) {
    const auto file = pipeline::read_scar_record(options.csv);
    fire::ScarFit fit;
    try {
        fit = fire::fit_scar(file.record, request_of(options, file.celsius));
    } catch (const Error& e) {
        throw Error(e.kind(), options.csv, e.what());
    }
    const std::filesystem::path prefix = options.output.empty()
                                             ? std::filesystem::path("out") / std::filesystem::path(options.csv).stem()
                                             : std::filesystem::path(options.output);
    std::cout << pipeline::scar_fit_text(file, fit, options.algorithm);
    const auto written = pipeline::write_scar_fit(prefix, options.csv, file, fit, options.algorithm);
    if (fit.converged) std::cout << pipeline::scar_yaml(fit);
    if (!options.quiet) std::cout << written;
    std::cout.flush();
    if (!fit.converged) throw runtime_error(options.csv, "the fit did not converge: " + fit.verdict);
}

}  // namespace pyroscene::cli
