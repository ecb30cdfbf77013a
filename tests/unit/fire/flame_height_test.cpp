#include "fire/flame_height.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>

namespace pyroscene::fire {
namespace {

constexpr double kRelease_W_m3 = 2.0e6;

TEST(FlameHeightHeatFlux, MatchesTheWorkedValues) {
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(1e5, 1.0, kRelease_W_m3), 0.05);
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(1e6, 1.0, kRelease_W_m3), 0.5);
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(5.92e6, 1.0, kRelease_W_m3), 2.96);
    // The 2 m grass flame of the thesis at its highest flux needs alpha = 2 q''' / H.
    EXPECT_NEAR(flame_height_heat_flux_m(5.92e6, 0.6756757, kRelease_W_m3), 2.0, 1e-7);
    // Orloff and de Ris quote 1200 kW m-3 for buoyant pool flames.
    EXPECT_NEAR(flame_height_heat_flux_m(5.92e6, 1.0, 1.2e6), 4.9333333, 1e-7);
}

class EveryHeightMethod : public testing::TestWithParam<FlameHeightMethod> {};

TEST_P(EveryHeightMethod, HasNoFlameWithoutHeat) {
    for (const double flux_W_m2 : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(GetParam().height_m(flux_W_m2, 1.0, kRelease_W_m3), 0.0);
    }
}

TEST_P(EveryHeightMethod, IsMonotoneInHeatFlux) {
    double lower_m = 0.0;
    for (double flux_W_m2 = 1.0; flux_W_m2 < 1e8; flux_W_m2 *= 1.7) {
        const double height_m = GetParam().height_m(flux_W_m2, 1.0, kRelease_W_m3);
        EXPECT_GT(height_m, lower_m) << flux_W_m2;
        lower_m = height_m;
    }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryHeightMethod, testing::ValuesIn(kFlameHeightMethods),
                         [](const auto& test) { return std::string(test.param.name); });

RunningStatistics statistics_of(std::initializer_list<double> values) {
    RunningStatistics out;
    for (const double v : values) out.add(v);
    return out;
}

TEST(RunningStatistics, GivesSampleMeanAndDeviation) {
    // 2 4 4 4 5 5 7 9: mean 5, sum of squares 32, n - 1 = 7.
    const auto s = statistics_of({2, 4, 4, 4, 5, 5, 7, 9});
    EXPECT_EQ(s.count, 8);
    EXPECT_DOUBLE_EQ(s.mean_m, 5.0);
    EXPECT_DOUBLE_EQ(s.standard_deviation_m(), std::sqrt(32.0 / 7.0));
}

TEST(RunningStatistics, SurvivesALargeOffset) {
    // 1e9 + {4, 7, 13, 16}: variance 30 exactly; the sum-of-squares formula loses it.
    const auto s = statistics_of({1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
    EXPECT_NEAR(s.standard_deviation_m(), std::sqrt(30.0), 1e-9);
}

TEST(RunningStatistics, HasNoDeviationBelowTwoValues) {
    EXPECT_EQ(statistics_of({}).standard_deviation_m(), 0.0);
    EXPECT_EQ(statistics_of({3.0}).standard_deviation_m(), 0.0);
}

// Earlier heights 1 and 3 m: mean 2 m, sd sqrt(2) m.
constexpr double kHighest_m = 2.0 + 1.4142135623730951, kLowest_m = 2.0 - 1.4142135623730951;

TEST(OneSigmaRule, CutsTallFlamesAndDetachesTheRest) {
    const auto earlier = statistics_of({1.0, 3.0});
    for (const Physics physics : {Physics::Default, Physics::Thesis}) {
        const auto limited = limit_height(5.0, earlier, physics);
        EXPECT_NEAR(limited.flame_m, kHighest_m, 1e-12);
        EXPECT_NEAR(limited.flame_m + limited.ember_m, 5.0, 1e-12);
        EXPECT_EQ(limit_height(3.0, earlier, physics).flame_m, 3.0);
        EXPECT_EQ(limit_height(3.0, earlier, physics).ember_m, 0.0);
    }
}

TEST(OneSigmaRule, RaisesShortFlamesOnlyAsTheThesisDoes) {
    const auto earlier = statistics_of({1.0, 3.0});
    EXPECT_EQ(limit_height(0.1, earlier, Physics::Default).flame_m, 0.1);
    EXPECT_NEAR(limit_height(0.1, earlier, Physics::Thesis).flame_m, kLowest_m, 1e-12);
    EXPECT_EQ(limit_height(0.1, earlier, Physics::Thesis).ember_m, 0.0);
    // Mean 1, sd 1.73: the lower bound is below the ground and must not matter.
    EXPECT_EQ(limit_height(0.1, statistics_of({0.0, 0.0, 3.0}), Physics::Thesis).flame_m, 0.1);
}

TEST(OneSigmaRule, DoesNotLimitBeforeTwoHeightsAreKnown) {
    EXPECT_EQ(limit_height(50.0, {}, Physics::Thesis).flame_m, 50.0);
    EXPECT_EQ(limit_height(50.0, statistics_of({1.0}), Physics::Default).ember_m, 0.0);
}

}  // namespace
}  // namespace pyroscene::fire
