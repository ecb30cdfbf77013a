#include "fire/scar_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "fire/scar_minimise.h"

namespace pyroscene::fire {
namespace {

constexpr FitAlgorithmRow kAlgorithms[] = {{FitAlgorithm::NelderMead, "nelder-mead"},
                                           {FitAlgorithm::Powell, "powell"},
                                           {FitAlgorithm::LevenbergMarquardt, "levenberg-marquardt"}};

/// Logarithms of time constants beyond these give the same curve; it keeps wandering searches finite.
constexpr double kShortestLog = -20.0, kLongestLog = 40.0;

/// Smallest 1/condition of the scaled Jacobian at which a covariance still means something.
constexpr double kSingular = 1e-7;
constexpr double kGain = 1e-8;       ///< of SSE
constexpr double kSpanShare = 1e-6;  ///< of the record's temperature span

struct Span {
    double coldest_K, warmest_K, latest_s;
    [[nodiscard]] double range_K() const noexcept { return warmest_K - coldest_K; }
};

Span check(const ScarRecord& record, int coefficients) {
    if (record.time_s.size() != record.temperature_K.size())
        throw input_error("time-temperature record",
                          fmt::format("{} times, but {} temperatures", record.time_s.size(), record.temperature_K.size()));
    if (record.time_s.size() <= static_cast<std::size_t>(coefficients))
        throw input_error("time-temperature record", fmt::format("{} points cannot determine {} coefficients and their "
                                                                 "uncertainty; at least {} are needed",
                                                                 record.time_s.size(), coefficients, coefficients + 1));
    Span span{record.temperature_K.front(), record.temperature_K.front(), record.time_s.front()};
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double t = record.time_s[i], T = record.temperature_K[i];
        if (!(t >= 0.0 && std::isfinite(t)))
            throw input_error(
                "time-temperature record",
                fmt::format("point {}: time {} s; times count from the arrival of the fire, from 0", i + 1, t));
        if (!(T > 0.0 && std::isfinite(T)))
            throw input_error("time-temperature record", fmt::format("point {}: {} K is no temperature", i + 1, T));
        span.coldest_K = std::min(span.coldest_K, T);
        span.warmest_K = std::max(span.warmest_K, T);
        span.latest_s = std::max(span.latest_s, t);
    }
    if (!(span.range_K() > 0.0) || !(span.latest_s > 0.0))
        throw input_error("time-temperature record", "does not change with time; there is nothing to fit");
    return span;
}

/// A guess that needs no insight: the time to fall to 1/e of the span splits into a fast and a slow term.
ScarCooling guess(const ScarRecord& record, const Span& span, ScarModel model) {
    double fallen_s = span.latest_s;
    for (std::size_t i = 0; i < record.time_s.size(); ++i)
        if (record.temperature_K[i] < span.coldest_K + span.range_K() / std::exp(1.0) && record.time_s[i] > 0.0)
            fallen_s = std::min(fallen_s, record.time_s[i]);
    ScarCooling start = scar_model(model).defaults;
    start.floor_K = span.coldest_K;
    start.amplitude1_K = model == ScarModel::DoubleExponential ? 0.7 * span.range_K() : span.range_K();
    start.time_constant1_s = model == ScarModel::DoubleExponential ? 0.7 * fallen_s : fallen_s;
    if (model == ScarModel::DoubleExponential) {
        start.amplitude2_K = 0.3 * span.range_K();
        start.time_constant2_s = 3.0 * fallen_s;
    }
    return start;
}

/// Unknowns of the search: amplitudes and floor over the temperature span, logarithms of time constants.
struct Scaling {
    double range_K, floor_K;
    int terms;

    [[nodiscard]] std::vector<double> unknowns(const ScarCooling& c) const {
        std::vector<double> x{c.amplitude1_K / range_K, std::log(c.time_constant1_s)};
        if (terms == 2) x.insert(x.end(), {c.amplitude2_K / range_K, std::log(c.time_constant2_s)});
        x.push_back((c.floor_K - floor_K) / range_K);
        return x;
    }
    [[nodiscard]] std::vector<double> coefficients(std::span<const double> x) const {
        std::vector<double> values;
        for (int k = 0; k < terms; ++k) {
            values.push_back(x[2 * static_cast<std::size_t>(k)] * range_K);
            values.push_back(std::exp(std::clamp(x[2 * static_cast<std::size_t>(k) + 1], kShortestLog, kLongestLog)));
        }
        values.push_back(x.back() * range_K + floor_K);
        return values;
    }
};

ScarCooling cooling_of(std::span<const double> values, ScarModel model) {
    ScarCooling c = scar_model(model).defaults;
    c.amplitude1_K = values[0];
    c.time_constant1_s = values[1];
    if (values.size() == 5) {
        c.amplitude2_K = values[2];
        c.time_constant2_s = values[3];
    }
    c.floor_K = values.back();
    return c;
}

/// Residuals over the span and their derivatives by the scaled unknowns.
void evaluate(const ScarRecord& record, const Scaling& scaling, std::span<const double> x, std::span<double> residuals,
              std::span<double> jacobian) {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < residuals.size(); ++i) {
        double sum = x[n - 1] + (scaling.floor_K - record.temperature_K[i]) / scaling.range_K;
        double* row = jacobian.empty() ? nullptr : &jacobian[i * n];
        for (std::size_t k = 0; k + 1 < n; k += 2) {
            const double ratio = record.time_s[i] / std::exp(std::clamp(x[k + 1], kShortestLog, kLongestLog));
            const double decay = std::exp(-ratio);
            sum += x[k] * decay;
            if (row == nullptr) continue;
            row[k] = decay;
            row[k + 1] = x[k] * decay * ratio;
        }
        if (row != nullptr) row[n - 1] = 1.0;
        residuals[i] = sum;
    }
}

/// The fast term first; the two swap freely in the search.
void order_terms(std::vector<double>& x) {
    if (x.size() == 5 && x[1] > x[3]) {
        std::swap(x[0], x[2]);
        std::swap(x[1], x[3]);
    }
}

void set_covariance(ScarFit& fit, const LinearAnalysis& linear, double range_K, std::size_t points) {
    const std::size_t n = fit.values.size();
    const double variance = linear.sse / static_cast<double>(points - n);  // of a residual, in units of the span
    const auto scale = [&](std::size_t i) { return i % 2 == 1 ? fit.values[i] : range_K; };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            fit.covariance.push_back(variance * linear.inverse_normal[i * n + j] * scale(i) * scale(j));
    for (std::size_t i = 0; i < n; ++i) fit.standard_errors.push_back(std::sqrt(fit.covariance[i * n + i]));
}

void judge(ScarFit& fit, const LinearAnalysis& linear, bool limit_reached, std::size_t points) {
    const auto names = scar_coefficients(fit.model);
    const double small_gain = kGain * linear.sse + static_cast<double>(points) * kSpanShare * kSpanShare;
    if (limit_reached) {
        fit.verdict = fmt::format("the limit of evaluations was reached ({})", fit.evaluations);
        return;
    }
    if (!(linear.reciprocal_condition > kSingular)) {
        fit.verdict = "the record does not determine the coefficients (singular normal matrix)";
        return;
    }
    for (std::size_t i = 1; i < fit.values.size(); i += 2)
        if (!(fit.standard_errors[i] <= fit.values[i])) {
            fit.verdict = fmt::format("the record does not determine {}: {:.4g} s with a standard error of {:.4g} s",
                                      names[i], fit.values[i], fit.standard_errors[i]);
            return;
        }
    if (!(linear.predicted_decrease <= small_gain)) {
        fit.verdict = fmt::format("no minimum: another step would lower the sum of squares by {:.2g} of itself",
                                  linear.predicted_decrease / linear.sse);
        return;
    }
    fit.converged = true;
    fit.verdict = fmt::format("another step would lower the sum of squares by {:.1e} of itself",
                              linear.sse > 0.0 ? linear.predicted_decrease / linear.sse : 0.0);
}

}  // namespace

std::span<const FitAlgorithmRow> fit_algorithms() noexcept { return kAlgorithms; }

std::vector<std::string> scar_coefficients(ScarModel model) {
    if (scar_model(model).terms == 1) return {"amplitude1_K", "time_constant1_s", "floor_K"};
    return {"amplitude1_K", "time_constant1_s", "amplitude2_K", "time_constant2_s", "floor_K"};
}

ScarFit fit_scar(const ScarRecord& record, const ScarFitRequest& request) {
    const int terms = scar_model(request.model).terms;
    const Span span = check(record, 2 * terms + 1);
    const ScarCooling start = request.start.value_or(guess(record, span, request.model));
    if (!(start.time_constant1_s > 0.0 && start.time_constant2_s > 0.0))
        throw input_error("start of the fit", "time constants must be above 0");
    const Scaling scaling{span.range_K(), span.coldest_K, terms};

    LeastSquares problem;
    problem.points = static_cast<int>(record.time_s.size());
    problem.unknowns = 2 * terms + 1;
    problem.evaluate = [&](std::span<const double> x, std::span<double> residuals, std::span<double> jacobian) {
        evaluate(record, scaling, x, residuals, jacobian);
    };
    auto minimum = minimise(problem, scaling.unknowns(start), request.algorithm, request.maximum_evaluations);
    order_terms(minimum.x);
    const auto linear = analyse(problem, minimum.x);

    ScarFit fit;
    fit.model = request.model;
    fit.values = scaling.coefficients(minimum.x);
    fit.cooling = cooling_of(fit.values, request.model);
    fit.sse_K2 = linear.sse * scaling.range_K * scaling.range_K;
    fit.rms_K = std::sqrt(fit.sse_K2 / static_cast<double>(problem.points));
    fit.evaluations = minimum.evaluations;
    set_covariance(fit, linear, scaling.range_K, record.time_s.size());
    judge(fit, linear, minimum.limit_reached, record.time_s.size());
    return fit;
}

}  // namespace pyroscene::fire
