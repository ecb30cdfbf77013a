#include "fire/scar_minimise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <unsupported/Eigen/NonLinearOptimization>

namespace pyroscene::fire {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Relative changes below this are rounding: the search ends there.
constexpr double kTolerance = 1e-13;
/// A simplex may collapse and a direction set degenerate before the minimum; both are started anew from where they stopped.
constexpr int kMostRestarts = 40;

std::span<const double> view(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
std::span<double> view(Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

struct CountedSse {
    const LeastSquares& problem;
    std::vector<double> residuals;
    int evaluations = 0;

    explicit CountedSse(const LeastSquares& p) : problem(p), residuals(static_cast<std::size_t>(p.points)) {}
    double operator()(const std::vector<double>& x) {
        ++evaluations;
        problem.evaluate(x, residuals, {});
        double sum = 0.0;
        for (const double r : residuals) sum += r * r;
        return std::isfinite(sum) ? sum : 1e300;
    }
};

double nlopt_objective(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* sse) {
    return (*static_cast<CountedSse*>(sse))(x);
}

Minimum minimise_without_derivatives(const LeastSquares& problem, std::vector<double> x, nlopt::algorithm algorithm,
                                     int maximum_evaluations) {
    nlopt::srand(1);  // PRAXIS leaves degenerate directions by random steps
    CountedSse sse(problem);
    double best = sse(x), step = 0.2;
    Minimum out;
    for (int restart = 0; restart < kMostRestarts; ++restart) {
        nlopt::opt search(algorithm, static_cast<unsigned>(problem.unknowns));
        search.set_min_objective(&nlopt_objective, &sse);
        search.set_initial_step(step);
        search.set_xtol_rel(kTolerance);
        search.set_ftol_rel(kTolerance);
        search.set_maxeval(std::max(1, maximum_evaluations - sse.evaluations));
        double found = best;
        std::vector<double> place = x;
        try {
            search.optimize(place, found);
        } catch (const nlopt::roundoff_limited&) {
            // As good as it gets; `place` holds the best so far.
        }
        const double gain = best - found;
        if (found <= best) {
            best = found;
            x = place;
        }
        out.limit_reached = sse.evaluations >= maximum_evaluations;
        if (out.limit_reached || !(gain > 1e-15 * best)) break;
        step = std::max(0.5 * step, 1e-3);
    }
    out.x = std::move(x);
    out.evaluations = sse.evaluations;
    return out;
}

/// What Eigen's port of MINPACK's lmder asks for.
struct LmFunctor {
    using Scalar = double;
    using Index = Eigen::Index;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;

    const LeastSquares& problem;
    Matrix rows;

    explicit LmFunctor(const LeastSquares& p) : problem(p), rows(p.points, p.unknowns) {}
    [[nodiscard]] int inputs() const { return problem.unknowns; }
    [[nodiscard]] int values() const { return problem.points; }
    int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) {
        problem.evaluate(view(x), view(residuals), {});
        return 0;
    }
    int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) {
        Eigen::VectorXd residuals(problem.points);
        problem.evaluate(view(x), view(residuals), {rows.data(), static_cast<std::size_t>(rows.size())});
        jacobian = rows;
        return 0;
    }
};

Minimum minimise_levenberg_marquardt(const LeastSquares& problem, const std::vector<double>& start,
                                     int maximum_evaluations) {
    LmFunctor functor(problem);
    Eigen::LevenbergMarquardt<LmFunctor> search(functor);
    search.parameters.ftol = search.parameters.xtol = kTolerance;
    search.parameters.maxfev = maximum_evaluations;
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(start.data(), problem.unknowns);
    const auto status = search.minimize(x);
    Minimum out;
    out.x.assign(x.data(), x.data() + x.size());
    out.evaluations = static_cast<int>(search.nfev + search.njev);
    out.limit_reached = status == Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation;
    return out;
}

}  // namespace

Minimum minimise(const LeastSquares& problem, std::vector<double> start, FitAlgorithm algorithm, int maximum_evaluations) {
    switch (algorithm) {
        case FitAlgorithm::NelderMead:
            return minimise_without_derivatives(problem, std::move(start), nlopt::LN_NELDERMEAD, maximum_evaluations);
        case FitAlgorithm::Powell:
            return minimise_without_derivatives(problem, std::move(start), nlopt::LN_PRAXIS, maximum_evaluations);
        case FitAlgorithm::LevenbergMarquardt:
            break;
    }
    return minimise_levenberg_marquardt(problem, start, maximum_evaluations);
}

LinearAnalysis analyse(const LeastSquares& problem, std::span<const double> x) {
    const Eigen::Index n = problem.unknowns;
    Eigen::VectorXd residuals(problem.points);
    Matrix jacobian(problem.points, n);
    problem.evaluate(x, view(residuals), {jacobian.data(), static_cast<std::size_t>(jacobian.size())});
    LinearAnalysis out;
    out.sse = residuals.squaredNorm();
    out.inverse_normal.assign(static_cast<std::size_t>(n * n), std::nan(""));
    if (!jacobian.allFinite() || !residuals.allFinite()) return out;

    const Eigen::VectorXd length = jacobian.colwise().norm().cwiseMax(1e-300).transpose();
    const Eigen::MatrixXd scaled = jacobian * length.cwiseInverse().asDiagonal();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
    out.predicted_decrease = (svd.matrixU().transpose() * residuals).squaredNorm();
    const auto& s = svd.singularValues();
    out.reciprocal_condition = s(n - 1) / s(0);
    if (!(s(n - 1) > 0.0)) return out;
    const Eigen::MatrixXd v = length.cwiseInverse().asDiagonal() * svd.matrixV() * s.cwiseInverse().asDiagonal();
    Eigen::Map<Matrix>(out.inverse_normal.data(), n, n) = v * v.transpose();
    return out;
}

}  // namespace pyroscene::fire
