#include "fire/flame_height.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace pyroscene::fire {
namespace {

constexpr double kRelease_W_m3 = 2.0e6;

TEST(FlameHeightHeatFlux, MatchesTheWorkedValues) {
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(1e5, 1.0, kRelease_W_m3), 0.05);
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(1e6, 1.0, kRelease_W_m3), 0.5);
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(5.92e6, 1.0, kRelease_W_m3), 2.96);
    // The 2 m grass flame of the thesis: alpha = 2 q''' / H at its highest flux, and at 1e5 W m-2.
    EXPECT_NEAR(flame_height_heat_flux_m(5.92e6, 0.6756757, kRelease_W_m3), 2.0, 1e-7);
    EXPECT_DOUBLE_EQ(flame_height_heat_flux_m(1e5, 40.0, kRelease_W_m3), 2.0);
    // Orloff and de Ris quote 1200 kW m-3 for buoyant pool flames.
    EXPECT_NEAR(flame_height_heat_flux_m(5.92e6, 1.0, 1.2e6), 4.9333333, 1e-7);
}

// 293.15 K, 1.204 kg m-3, 1006 J kg-1 K-1: the published range 0.240 to 0.226 needs rho squared. Wood char, birch and wood of
// the thesis (34.3, 20.934 and 15 MJ kg-1, r = 1.2) with the density as eq 4.24 prints it.
TEST(PlumeCoefficient, MatchesTheWorkedValues) {
    const auto a = [](double heat_per_air_J_kg, Physics physics) {
        return plume_coefficient_m_kW(293.15, 1.204, 1006.0, heat_per_air_J_kg, physics);
    };
    EXPECT_NEAR(a(2.9e6, Physics::Default), 0.23935, 5e-6);
    EXPECT_NEAR(a(3.0e6, Physics::Default), 0.23453, 5e-6);
    EXPECT_NEAR(a(3.1e6, Physics::Default), 0.22996, 5e-6);
    EXPECT_NEAR(a(3.2e6, Physics::Default), 0.22563, 5e-6);
    EXPECT_NEAR(a(2.9e6, Physics::Thesis), 0.24841, 5e-6);
    EXPECT_NEAR(a(3.2e6, Physics::Thesis), 0.23416, 5e-6);
    EXPECT_NEAR(a(34.3e6 / 1.2, Physics::Default), 0.06065, 5e-6);
    EXPECT_NEAR(a(20.934e6 / 1.2, Physics::Default), 0.08156, 5e-6);
    EXPECT_NEAR(a(15.0e6 / 1.2, Physics::Default), 0.09962, 5e-6);
}

FlameHeightInputs pool(double heat_release_kW, double diameter_m) {
    return {.heat_release_W = 1e3 * heat_release_kW, .diameter_m = diameter_m, .plume_coefficient_m_kW = 0.235};
}

TEST(FlameHeightHeskestad, MatchesTheWorkedValues) {
    EXPECT_NEAR(flame_height_heskestad_m(pool(1e3, 1.0)), 2.704499, 5e-6);
    EXPECT_NEAR(flame_height_heskestad_m(pool(1e4, 3.56825)), 5.715904, 5e-6);
    EXPECT_NEAR(flame_height_heskestad_m(pool(1e5, 22.5676)), 0.481048, 5e-6);
    EXPECT_NEAR(flame_height_heskestad_m(pool(4e5, 22.5676)), 17.89692, 5e-5);
}

// Below Q = (1.02 D / A)^(5/2) the formula is negative: there is no standing flame.
TEST(FlameHeightHeskestad, HasNoFlameBelowTheThreshold) {
    const struct {
        double diameter_m, threshold_kW;
    } table[] = {{1.0, 39.249}, {3.56825, 943.99}, {5.0463, 2245.2}, {22.5676, 94960.8}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.diameter_m);
        EXPECT_EQ(flame_height_heskestad_m(pool(row.threshold_kW * 0.9999, row.diameter_m)), 0.0);
        const double above_m = flame_height_heskestad_m(pool(row.threshold_kW * 1.0001, row.diameter_m));
        EXPECT_GT(above_m, 0.0);
        EXPECT_LT(above_m, 1e-3 * row.diameter_m);
    }
}

TEST(FirelineLaws, MatchTheWorkedValues) {
    const struct {
        const char* name;
        double at_100_m, at_1000_m, at_10000_m;
    } table[] = {
        {"byram", 0.64462, 1.85910, 5.36169},     {"weise_biging", 0.40190, 2.01428, 10.0953},
        {"thomas", 0.57308, 2.66000, 12.3466},    {"nelson_adkins", 0.45993, 1.43118, 4.45342},
        {"nelson_lab", 0.30593, 1.42, 6.59106},   {"nelson_field", 0.33394, 1.55, 7.19446},
        {"butler", 0.37703, 1.75000, 8.12278},    {"clark", 0.07004, 0.68982, 6.79418},
        {"fernandes", 0.54855, 1.91519, 6.68671}, {"finney_grumstrup", 0.37120, 2.20599, 13.1100},
    };
    std::size_t laws = 0;
    for (const auto& method : kFlameHeightMethods) laws += method.driver == FlameDriver::FirelineIntensity ? 1 : 0;
    EXPECT_EQ(laws, std::size(table)) << "a law has no check values";
    for (const auto& row : table) {
        SCOPED_TRACE(row.name);
        const auto* method = find_flame_height_method(row.name);
        ASSERT_NE(method, nullptr);
        const auto length_m = [&](double kW_m) {
            return method->size_m({.fireline_intensity_W_m = 1e3 * kW_m, .front_depth_m = 1.0});
        };
        EXPECT_NEAR(length_m(100.0), row.at_100_m, 6e-6);
        EXPECT_NEAR(length_m(1000.0), row.at_1000_m, 6e-6);
        EXPECT_NEAR(length_m(10000.0), row.at_10000_m, 6e-5);
        EXPECT_NE(method->extent, FlameExtent::Height) << "these laws give lengths along the axis";
    }
}

TEST(FirelineLaws, FinneyAndGrumstrupCountTheDepthOfTheFront) {
    const auto length_m = [](double kW_m) {
        return flame_length_finney_grumstrup_m({.fireline_intensity_W_m = 1e3 * kW_m, .front_depth_m = 5.0});
    };
    EXPECT_NEAR(length_m(100.0), 0.28646, 6e-6);
    EXPECT_NEAR(length_m(1000.0), 1.70243, 6e-6);
    EXPECT_NEAR(length_m(10000.0), 10.1174, 6e-5);
    EXPECT_EQ(flame_length_finney_grumstrup_m({.fireline_intensity_W_m = 1e6}), 0.0);
}

// The thesis's fire of 16515 kJ/kg, 0.5 kg/m2 and 0.5 m/s.
TEST(FirelineLaws, ByramOfTheThesisExample) {
    EXPECT_NEAR(flame_length_byram_m({.fireline_intensity_W_m = 4128.75e3}), 0.0775 * std::pow(4128.75, 0.46), 1e-12);
}

class EveryHeightMethod : public testing::TestWithParam<FlameHeightMethod> {
protected:
    /// Size when what the method grows with has this value (W m-2, W, W m-1 or m).
    [[nodiscard]] static double size_m(double driver) {
        FlameHeightInputs in{.diameter_m = 1.0, .front_depth_m = 2.0};
        switch (GetParam().driver) {
            case FlameDriver::HeatFlux:
                in.heat_flux_W_m2 = driver;
                break;
            case FlameDriver::HeatRelease:
                in.heat_release_W = driver;
                break;
            case FlameDriver::FirelineIntensity:
                in.fireline_intensity_W_m = driver;
                break;
            case FlameDriver::Given:
                in.heat_flux_W_m2 = in.given_length_m = in.constant_m = driver;
                break;
        }
        return GetParam().size_m(in);
    }
};

TEST_P(EveryHeightMethod, HasNoFlameWithoutHeat) {
    for (const double driver : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) EXPECT_EQ(size_m(driver), 0.0);
}

TEST_P(EveryHeightMethod, IsFiniteAndMonotoneInItsDriver) {
    double lower_m = 0.0;
    for (double driver = 1.0; driver < 1e12; driver *= 1.7) {
        const double size = size_m(driver);
        EXPECT_TRUE(std::isfinite(size)) << driver;
        EXPECT_GE(size, 0.0) << driver;
        if (size > 0.0 || lower_m > 0.0) {
            EXPECT_GT(size, lower_m) << driver;
        }
        lower_m = size;
    }
    EXPECT_GT(lower_m, 0.0);
}

TEST_P(EveryHeightMethod, IsFoundByItsName) {
    const auto* found = find_flame_height_method(GetParam().name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->size_m, GetParam().size_m);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryHeightMethod, testing::ValuesIn(kFlameHeightMethods),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HeightMethods, HaveDifferentNames) {
    std::set<std::string_view> names;
    for (const auto& method : kFlameHeightMethods) names.insert(method.name);
    EXPECT_EQ(names.size(), kFlameHeightMethods.size());
    EXPECT_EQ(find_flame_height_method("dragon"), nullptr);
}

// Length and height: H = L cos A. 60 degrees halve a length and leave a height alone; a stand is not leaned.
TEST(VerticalHeight, ShrinksLengthsOnceAndHeightsNever) {
    constexpr double kSixty_rad = 1.0471975511965976;
    EXPECT_NEAR(vertical_height_m(FlameExtent::Length, 4.0, kSixty_rad, 9.0), 2.0, 1e-12);
    EXPECT_EQ(vertical_height_m(FlameExtent::Height, 4.0, kSixty_rad, 9.0), 4.0);
    EXPECT_NEAR(vertical_height_m(FlameExtent::LengthAboveStand, 4.0, kSixty_rad, 9.0), 11.0, 1e-12);
    for (const auto extent : {FlameExtent::Height, FlameExtent::Length, FlameExtent::LengthAboveStand}) {
        EXPECT_EQ(vertical_height_m(extent, 0.0, 0.3, 9.0), 0.0);
        EXPECT_EQ(vertical_height_m(extent, std::numeric_limits<double>::quiet_NaN(), 0.3, 9.0), 0.0);
    }
}

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
