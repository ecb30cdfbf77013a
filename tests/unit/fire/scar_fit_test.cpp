#include "fire/scar_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/random.h"
#include "source_folder.h"

namespace pyroscene::fire {
namespace {

ScarRecord shipped_record() {
    const auto table = read_csv(source_folder() / "tests/data/burnscar_synthetic.csv");
    ScarRecord record{table.numbers("t_s"), table.numbers("T_C")};
    for (double& T : record.temperature_K) T += kZeroCelsius_K;
    return record;
}

ScarRecord sampled(const ScarCooling& cooling, double last_s, int points, double noise_K = 0.0, std::uint64_t seed = 1) {
    ScarRecord record;
    const RandomKey key{seed, stream_id("scar fit test"), 0};
    for (int i = 0; i < points; ++i) {
        const double t = last_s * i * i / ((points - 1.0) * (points - 1.0));  // denser where it cools fast
        // Sum of 12 uniform deviates: near enough to a Gaussian of sd 1.
        double deviate = -6.0;
        for (std::uint32_t k = 0; k < 12; ++k) deviate += uniform01(key, static_cast<std::uint64_t>(i), k);
        record.time_s.push_back(t);
        record.temperature_K.push_back(scar_temperature_K(cooling, t) + noise_K * deviate);
    }
    return record;
}

class EveryAlgorithm : public testing::TestWithParam<FitAlgorithm> {};
std::string algorithm_name(const testing::TestParamInfo<FitAlgorithm>& info) {
    return info.param == FitAlgorithm::NelderMead ? "NelderMead" : info.param == FitAlgorithm::Powell ? "Powell" : "LM";
}
INSTANTIATE_TEST_SUITE_P(Fit, EveryAlgorithm,
                         testing::Values(FitAlgorithm::NelderMead, FitAlgorithm::Powell, FitAlgorithm::LevenbergMarquardt),
                         algorithm_name);

// Optimum of the shipped record as four independent minimisers found it, from two published starts and from our own guess.
TEST_P(EveryAlgorithm, FindsThePublishedOptimum) {
    const std::optional<ScarCooling> starts[] = {ScarCooling{500, 50, 200, 300, kZeroCelsius_K + 30},
                                                 ScarCooling{700, 30, 50, 600, kZeroCelsius_K + 40}, std::nullopt};
    const auto record = shipped_record();
    for (const auto& start : starts) {
        ScarFitRequest request;
        request.algorithm = GetParam();
        request.start = start;
        const auto fit = fit_scar(record, request);
        EXPECT_TRUE(fit.converged) << fit.verdict;
        EXPECT_NEAR(fit.values[0] / 567.8408, 1.0, 3e-7);
        EXPECT_NEAR(fit.values[1] / 73.87973, 1.0, 2e-7);
        EXPECT_NEAR(fit.values[2] / 209.6091, 1.0, 8e-7);
        EXPECT_NEAR(fit.values[3] / 240.8762, 1.0, 4e-7);
        EXPECT_NEAR(fit.values[4] - kZeroCelsius_K, 32.68126, 1e-5);
        EXPECT_NEAR(fit.sse_K2, 200.1048493, 1e-7);
        EXPECT_NEAR(fit.rms_K, 1.612068, 1e-6);
    }
}

// Statistics: over many noisy records of eq 4.18 the estimates scatter about the truth by the standard errors they state.
TEST_P(EveryAlgorithm, StatesItsOwnScatter) {
    const double truth[] = {578.97, 74.88, 197.50, 247.72, kZeroCelsius_K + 33.19};
    constexpr int kRecords = 60;
    double mean[5] = {}, chi2[5] = {};
    for (int k = 0; k < kRecords; ++k) {
        ScarFitRequest request;
        request.algorithm = GetParam();
        const auto fit = fit_scar(sampled({}, 1800.0, 80, 2.0, static_cast<std::uint64_t>(k) + 1), request);
        ASSERT_TRUE(fit.converged) << fit.verdict;
        for (std::size_t i = 0; i < 5; ++i) {
            const double z = (fit.values[i] - truth[i]) / fit.standard_errors[i];
            mean[i] += z / kRecords;
            chi2[i] += z * z / kRecords;
        }
    }
    for (std::size_t i = 0; i < 5; ++i) {
        SCOPED_TRACE(i);
        EXPECT_LT(std::abs(mean[i]), 0.45);  // 3.5 / sqrt(60)
        EXPECT_GT(chi2[i], 0.5);
        EXPECT_LT(chi2[i], 1.8);
    }
}

TEST_P(EveryAlgorithm, RecoversANoiseFreeCurve) {
    ScarFitRequest request;
    request.algorithm = GetParam();
    const auto fit = fit_scar(sampled({}, 1800.0, 60), request);
    EXPECT_TRUE(fit.converged) << fit.verdict;
    EXPECT_NEAR(fit.cooling.amplitude1_K, 578.97, 1e-3);
    EXPECT_NEAR(fit.cooling.time_constant2_s, 247.72, 1e-3);
    EXPECT_LT(fit.cooling.time_constant1_s, fit.cooling.time_constant2_s);
}

// Closed form: T0 - Ta = 766 K, tau = 100 s over 34 degC.
TEST_P(EveryAlgorithm, FitsASingleExponential) {
    ScarFitRequest request;
    request.model = ScarModel::SingleExponential;
    request.algorithm = GetParam();
    const auto fit = fit_scar(sampled(scar_model(ScarModel::SingleExponential).defaults, 900.0, 40), request);
    ASSERT_TRUE(fit.converged) << fit.verdict;
    ASSERT_EQ(fit.values.size(), 3U);
    EXPECT_NEAR(fit.values[0], 766.0, 1e-4);
    EXPECT_NEAR(fit.values[1], 100.0, 1e-4);
    EXPECT_NEAR(fit.values[2], 307.15, 1e-4);
}

TEST_P(EveryAlgorithm, TellsWhenItMayNotGoOn) {
    ScarFitRequest request;
    request.algorithm = GetParam();
    request.maximum_evaluations = 6;
    const auto fit = fit_scar(shipped_record(), request);
    EXPECT_FALSE(fit.converged);
    EXPECT_NE(fit.verdict.find("limit of evaluations"), std::string::npos) << fit.verdict;
}

// One exponential with noise holds no second one: whatever numbers come out, they are no result.
TEST_P(EveryAlgorithm, TellsWhenTheRecordDoesNotDetermineTheCoefficients) {
    ScarFitRequest request;
    request.algorithm = GetParam();
    const auto single = scar_model(ScarModel::SingleExponential).defaults;
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        if (const auto fit = fit_scar(sampled(single, 900.0, 40, 2.0, seed), request); !fit.converged) ++refused;
    EXPECT_GE(refused, 4);
    // The first 40 s of a curve whose constants are 75 and 248 s.
    EXPECT_FALSE(fit_scar(sampled({}, 40.0, 40, 2.0), request).converged);
}

TEST(ScarFit, CovarianceIsThatOfALineInTheLinearCoefficients) {
    // With a long, even record the amplitude of a single exponential has variance s^2 / sum(exp(-2t/tau)) up to correlations:
    // compared with (J'J)^-1 from normal equations solved by Cramer's rule here.
    const auto record = sampled(scar_model(ScarModel::SingleExponential).defaults, 900.0, 40, 2.0);
    ScarFitRequest request;
    request.model = ScarModel::SingleExponential;
    const auto fit = fit_scar(record, request);
    double m[3][3] = {};
    for (const double t : record.time_s) {
        const double e = std::exp(-t / fit.values[1]);
        const double row[3] = {e, fit.values[0] * e * t / (fit.values[1] * fit.values[1]), 1.0};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] += row[i] * row[j];
    }
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    const double variance = fit.sse_K2 / (40 - 3);
    EXPECT_NEAR(fit.covariance[0] / (variance * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) / det), 1.0, 1e-9);
    EXPECT_NEAR(fit.covariance[4] / (variance * (m[0][0] * m[2][2] - m[0][2] * m[2][0]) / det), 1.0, 1e-9);
    EXPECT_NEAR(fit.covariance[5] / (variance * -(m[0][0] * m[1][2] - m[0][2] * m[1][0]) / det), 1.0, 1e-9);
    EXPECT_DOUBLE_EQ(fit.covariance[5], fit.covariance[7]);
}

TEST(ScarFit, RefusesRecordsThatAreNone) {
    const auto refused = [](const ScarRecord& record) {
        try {
            (void)fit_scar(record, {});
        } catch (const Error& e) {
            return e.kind() == ErrorKind::Input;
        }
        return false;
    };
    EXPECT_TRUE(refused({}));
    EXPECT_TRUE(refused({{0, 1, 2, 3, 4}, {900, 800, 700, 600, 500}}));
    EXPECT_TRUE(refused({{0, 1, 2, 3, 4, 5}, {900, 800, 700, 600, 500}}));
    EXPECT_TRUE(refused({{0, 1, 2, 3, 4, 5}, {900, 900, 900, 900, 900, 900}}));
    EXPECT_TRUE(refused({{-1, 1, 2, 3, 4, 5}, {900, 800, 700, 600, 500, 450}}));
    EXPECT_TRUE(refused({{0, 1, 2, 3, 4, 5}, {900, 800, 700, 600, 500, -4}}));
    EXPECT_TRUE(refused({{0, 1, 2, 3, 4, std::nan("")}, {900, 800, 700, 600, 500, 400}}));
}

}  // namespace
}  // namespace pyroscene::fire
