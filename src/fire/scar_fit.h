#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fire/scar.h"

namespace pyroscene::fire {

/// How the least-squares problem is minimised. The thesis used IDL's AMOEBA and POWELL, which need no derivatives.
enum class FitAlgorithm {
    NelderMead,          ///< downhill simplex (Nelder and Mead 1965), the thesis's AMOEBA; restarted until it stays
    Powell,              ///< Powell's conjugate directions in Brent's principal-axis form (PRAXIS, 1973); restarted likewise
    LevenbergMarquardt,  ///< damped Gauss-Newton (Marquardt 1963) with the analytic Jacobian; fewest evaluations
};

struct FitAlgorithmRow {
    FitAlgorithm algorithm;
    const char* name;  ///< as users write it
};
std::span<const FitAlgorithmRow> fit_algorithms() noexcept;

/// Temperatures of one place after the fire has arrived there.
struct ScarRecord {
    std::vector<double> time_s;         ///< since arrival, >= 0, in any order
    std::vector<double> temperature_K;  ///< as many
};

/// What is fitted and how.
struct ScarFitRequest {
    ScarModel model = ScarModel::DoubleExponential;
    FitAlgorithm algorithm = FitAlgorithm::LevenbergMarquardt;
    std::optional<ScarCooling> start;  ///< nullopt = estimated from the record
    int maximum_evaluations = 100000;  ///< of the curve at all points of the record
};

/// Result of a least-squares fit of a scar model to a record. Coefficients come in the order of scar_coefficients(model).
struct ScarFit {
    ScarModel model = ScarModel::DoubleExponential;
    ScarCooling cooling;                  ///< time_constant1_s < time_constant2_s
    std::vector<double> values;           ///< K and s
    std::vector<double> standard_errors;  ///< square roots of the covariance's diagonal; NaN when it does not exist
    std::vector<double> covariance;       ///< [n x n] s^2 (J'J)^-1, s^2 = SSE / (points - n); NaN when J'J is singular
    double sse_K2 = 0.0;                  ///< sum of squared residuals
    double rms_K = 0.0;                   ///< sqrt(SSE / points)
    int evaluations = 0;                  ///< of the curve at all points
    bool converged = false;
    std::string verdict;  ///< one sentence: why it counts as converged, or why not
};

/// Names of a model's coefficients, as the scenario writes them: amplitude1_K, time_constant1_s, ...
std::vector<std::string> scar_coefficients(ScarModel model);

/// Least-squares fit (thesis 4.5). The time constants are searched by their logarithm, so they stay positive. It counts as
/// converged when, whatever the algorithm says itself,
///  - it stopped before the limit of evaluations,
///  - the next Gauss-Newton step would lower SSE by less than 1e-8 of itself (or 1e-6 of the record's span, rms),
///  - and the record determines the coefficients: J'J is not singular, and no time constant has a standard error above itself.
/// Throws an input error when the record is too short for the model, holds no numbers, times before 0, temperatures that are
/// none (<= 0 K), or does not change.
ScarFit fit_scar(const ScarRecord& record, const ScarFitRequest& request);

}  // namespace pyroscene::fire
