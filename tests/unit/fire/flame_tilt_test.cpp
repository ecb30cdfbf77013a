#include "fire/flame_tilt.h"

#include <gtest/gtest.h>
#include <cmath>
#include <string>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

// Values computed independently for air of 1.18 kg m-3, 1005 J kg-1 K-1, 300 K.
TEST(FlameTiltBuoyantVelocity, MatchesTheWorkedValues) {
    const struct {
        double intensity_W_m, wind_m_s, buoyant_m_s, tilt_deg, convection_number;
    } table[] = {{500e3, 3.0, 3.021110, 44.79912, 1.021259},
                 {2000e3, 3.0, 4.795713, 32.02839, 4.085037},
                 {5000e3, 5.0, 6.508785, 37.53120, 2.205920}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.intensity_W_m);
        const TiltInputs in{.wind_m_s = row.wind_m_s, .fireline_intensity_W_m = row.intensity_W_m};
        EXPECT_NEAR(buoyant_velocity_m_s(in), row.buoyant_m_s, 1e-6);
        EXPECT_NEAR(flame_tilt_buoyant_velocity_rad(in) / kDegree_rad, row.tilt_deg, 1e-5);
        EXPECT_NEAR(std::pow(buoyant_velocity_m_s(in) / row.wind_m_s, 3), row.convection_number, 1e-6);
    }
    // "2 m/s bends a flame by 45 degrees" holds for a fire of 145.064 kW/m.
    EXPECT_NEAR(flame_tilt_buoyant_velocity_rad({.wind_m_s = 2.0, .fireline_intensity_W_m = 145064.0}) / kDegree_rad, 45.0,
                1e-4);
}

class EveryTiltMethod : public testing::TestWithParam<FlameTiltMethod> {};

TEST_P(EveryTiltMethod, IsUprightInCalmAir) {
    for (const double intensity_W_m : {0.0, 1.0, 1e6}) {
        EXPECT_EQ(GetParam().tilt_rad({.wind_m_s = 0.0, .fireline_intensity_W_m = intensity_W_m}), 0.0);
    }
}

TEST_P(EveryTiltMethod, LeansMoreInMoreWindAndLessOverMoreFire) {
    double less_rad = 0.0;
    for (double wind_m_s = 0.5; wind_m_s < 40.0; wind_m_s *= 1.5) {
        const double tilt_rad = GetParam().tilt_rad({.wind_m_s = wind_m_s, .fireline_intensity_W_m = 1e6});
        EXPECT_GE(tilt_rad, less_rad);
        EXPECT_LT(tilt_rad, kPi / 2.0);
        EXPECT_LE(GetParam().tilt_rad({.wind_m_s = wind_m_s, .fireline_intensity_W_m = 2e6}), tilt_rad);
        less_rad = tilt_rad;
    }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTiltMethod, testing::ValuesIn(kFlameTiltMethods),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(DownwindAzimuth, PointsWhereTheWindBlowsTo) {
    EXPECT_DOUBLE_EQ(downwind_azimuth_rad(0.0, 5.0), 0.0);        // southerly wind blows north
    EXPECT_DOUBLE_EQ(downwind_azimuth_rad(5.0, 0.0), 0.5 * kPi);  // westerly wind blows east
    EXPECT_DOUBLE_EQ(downwind_azimuth_rad(0.0, -5.0), kPi);
    EXPECT_DOUBLE_EQ(downwind_azimuth_rad(-5.0, 0.0), 1.5 * kPi);
    EXPECT_DOUBLE_EQ(downwind_azimuth_rad(-3.0, 3.0), 1.75 * kPi);
    EXPECT_EQ(downwind_azimuth_rad(0.0, 0.0), 0.0);
    EXPECT_FALSE(std::signbit(downwind_azimuth_rad(-0.0, 1.0)));
}

}  // namespace
}  // namespace pyroscene::fire
