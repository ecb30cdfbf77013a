#include "fire/scar.h"

#include <gtest/gtest.h>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

// Thesis eq 4.18 evaluated by hand (independent table, 7 digits) in degrees Celsius.
TEST(ScarTemperature, FollowsTheFittedCurveOfEq418) {
    const struct {
        double time_s, celsius;
    } table[] = {{0, 809.6600},   {30, 596.0099},  {60, 448.0209},   {100, 317.3808},
                 {300, 102.5589}, {600, 50.90711}, {1200, 34.74519}, {3600, 33.19010}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.time_s);
        EXPECT_NEAR(scar_temperature_K({}, row.time_s) - kZeroCelsius_K, row.celsius, 5e-5);
    }
}

double crossing_time_s(double celsius) {
    double early_s = 0.0, late_s = 1e4;
    for (int i = 0; i < 80; ++i) {
        const double middle_s = 0.5 * (early_s + late_s);
        (scar_temperature_K({}, middle_s) > celsius + kZeroCelsius_K ? early_s : late_s) = middle_s;
    }
    return early_s;
}

TEST(ScarTemperature, CrossesRoundTemperaturesWhenTheTableSays) {
    const struct {
        double celsius, time_s;
    } table[] = {{500, 48.18497}, {300, 107.0483}, {200, 163.8792}, {100, 306.9426},
                 {60, 501.3895},  {40, 834.4638},  {35, 1162.419},  {34, 1361.585}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.celsius);
        EXPECT_NEAR(crossing_time_s(row.celsius) / row.time_s, 1.0, 1e-6);
    }
}

// Eq 2.9 with the ambient term: 800 degC at the start, 1/e of the way to 34 degC after 100 s, 34 degC in the end.
TEST(ScarTemperature, SingleExponentialEndsAtTheAmbient) {
    const auto& cooling = scar_model(ScarModel::SingleExponential).defaults;
    EXPECT_NEAR(scar_temperature_K(cooling, 0.0) - kZeroCelsius_K, 800.0, 1e-9);
    EXPECT_NEAR(scar_temperature_K(cooling, 100.0) - kZeroCelsius_K, 34.0 + 766.0 * 0.36787944117144233, 1e-9);
    EXPECT_NEAR(scar_temperature_K(cooling, 600.0) - kZeroCelsius_K, 35.898724167, 1e-6);
    EXPECT_NEAR(scar_temperature_K(cooling, 1e5) - kZeroCelsius_K, 34.0, 1e-9);
}

TEST(ScarTemperature, IsNeverColderThanTheGroundBesideIt) {
    const FireParameters p;  // floor 33.19 degC, ambient 34 degC
    EXPECT_GT(scar_or_ambient_K(p, 1361.0), p.ambient_temperature_K);
    EXPECT_EQ(scar_or_ambient_K(p, 1362.0), p.ambient_temperature_K);
    EXPECT_EQ(scar_or_ambient_K(p, 1e9), p.ambient_temperature_K);
}

TEST(ScarTemperature, DoesNotExtrapolateBeforeTheClockStarts) {
    EXPECT_EQ(scar_temperature_K({}, -5.0), scar_temperature_K({}, 0.0));
}

}  // namespace
}  // namespace pyroscene::fire
