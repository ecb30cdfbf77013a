#pragma once

#include <string>
#include <vector>

namespace pyroscene::cli {

/// What `pyroscene fit-scar` was asked for.
struct FitScarOptions {
    std::string csv, algorithm = "levenberg-marquardt", model = "double_exponential";
    std::string output;         ///< prefix of the files; empty = out/<name of the CSV>
    std::vector<double> start;  ///< coefficients in the order of the model, floor in the unit of the file; empty = estimated
    int maximum_evaluations = 100000;
    bool quiet = false;
};

/// Names that the options accept.
std::vector<std::string> fit_algorithm_names();
std::vector<std::string> scar_model_names();

/// Fits, prints and writes. Throws an input error for an unusable record, a runtime error when the fit does not converge (after
/// the plot and the report were written).
void fit_scar_command(const FitScarOptions& options);

}  // namespace pyroscene::cli
