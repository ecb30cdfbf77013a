#include "cli/unmix_command.h"

#include <filesystem>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/progress.h"
#include "imagery/unmix_image.h"

namespace pyroscene::cli {
namespace {

analysis::LeastSquares solver_of(const std::string& name) {
    if (name == "sum-to-one") return analysis::LeastSquares::SumToOne;
    if (name == "nnls") return analysis::LeastSquares::NonNegative;
    if (name == "fcls") return analysis::LeastSquares::FullyConstrained;
    return analysis::LeastSquares::Unconstrained;
}

std::optional<std::filesystem::path> path_or_none(const std::string& text) {
    return text.empty() ? std::nullopt : std::optional<std::filesystem::path>(text);
}

}  // namespace

std::vector<std::string> unmix_methods() { return {"stepwise", "ucls", "sum-to-one", "nnls", "fcls"}; }
std::vector<std::string> unmix_solvers() { return {"ucls", "sum-to-one", "nnls", "fcls"}; }

void unmix_command(const UnmixOptions& options, const std::atomic<bool>& interrupted) {
    if (options.endmembers.empty() && options.truth.empty())
        throw std::invalid_argument("unmix: --endmembers or --truth is required");
    imagery::UnmixJob job;
    job.image = options.image;
    job.endmembers = path_or_none(options.endmembers);
    job.truth = path_or_none(options.truth);
    job.noise = path_or_none(options.noise);
    job.pure_fraction = options.pure;
    if (!options.sensor.empty()) job.sensor = options.sensor;
    if (options.purest > 0.0) job.purest_fraction = options.purest;
    job.settings.stepwise = options.method == "stepwise";
    job.settings.solver = solver_of(job.settings.stepwise ? options.solver : options.method);
    job.settings.alpha_enter = job.settings.alpha_remove = options.alpha;
    job.threads = options.threads;
    job.output = options.output.empty() ? job.image.parent_path() / (job.image.stem().string() + "_fractions.tif")
                                        : std::filesystem::path(options.output);
    job.cancelled = &interrupted;
    Progress progress(options.quiet);
    job.on_progress = [&](double fraction) { progress.update("unmix", fraction); };
    const auto report = imagery::unmix_image(job);
    progress.finish();
    if (options.quiet) return;
    fmt::print("{} pixels, {} of them unexplained\n{:<24} {:>9}\n", report.pixels, report.unexplained, "endmember",
               "chosen %");
    for (std::size_t k = 0; k < report.library.names.size(); ++k)
        fmt::print("{:<24} {:>9.2f}\n", report.library.names[k], report.chosen_percent[k]);
    if (!report.scores.empty())
        fmt::print("{:<24} {:>9} {:>12} {:>12}\n", "against the truth", "pixels", "rms error", "mean error");
    for (const auto& score : report.scores)
        fmt::print("{:<24} {:>9} {:>12.5f} {:>12.5f}\n", score.name, score.pixels, score.rms_error, score.mean_error);
    fmt::print("written: {}\n", job.output.string());
}

}  // namespace pyroscene::cli
