#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fire/scar_fit.h"

/// The minimisers behind fit_scar(), not for other modules. Only scar_minimise.cpp sees NLopt and Eigen.
namespace pyroscene::fire {

/// Sum of squared residuals as a function of n unknowns that are all of order 1.
struct LeastSquares {
    int unknowns = 0, points = 0;
    /// residuals [points]; jacobian [points x unknowns] row-major, not wanted when empty
    std::function<void(std::span<const double> x, std::span<double> residuals, std::span<double> jacobian)> evaluate;
};

struct Minimum {
    std::vector<double> x;
    int evaluations = 0;
    bool limit_reached = false;
};
Minimum minimise(const LeastSquares& problem, std::vector<double> start, FitAlgorithm algorithm, int maximum_evaluations);

/// How the linearised problem looks at one place.
struct LinearAnalysis {
    double sse = 0.0;
    double predicted_decrease = 0.0;     ///< of SSE by one Gauss-Newton step
    double reciprocal_condition = 0.0;   ///< of the Jacobian with columns scaled to length 1
    std::vector<double> inverse_normal;  ///< (J'J)^-1 [n x n]
};
LinearAnalysis analyse(const LeastSquares& problem, std::span<const double> x);

}  // namespace pyroscene::fire
