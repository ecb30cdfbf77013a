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

// On a slope of 20 degrees the angle from its normal is 52.36948 degrees; from the vertical 20 less.
TEST(FlameTiltBuoyantVelocity, LeansUphillOnASlope) {
    TiltInputs in{.wind_m_s = 3.0, .fireline_intensity_W_m = 500e3, .slope_rad = 20.0 * kDegree_rad};
    EXPECT_NEAR(flame_tilt_buoyant_velocity_rad(in) / kDegree_rad, 52.36948 - 20.0, 1e-5);
    in.wind_m_s = 0.0;
    EXPECT_EQ(flame_tilt_buoyant_velocity_rad(in), 0.0);
}

TEST(FlameTiltAgaAndThomas, MatchTheWorkedValues) {
    const struct {
        double wind_m_s, rate_kg_m2_s, diameter_m, aga_deg, thomas_deg, aga_vapour_deg;
    } table[] = {{2.0, 0.02, 2.0, 53.9449, 65.3934, 44.165},
                 {5.0, 0.05, 10.0, 55.4534, 66.3291, 46.279},
                 {10.0, 0.05, 10.0, 66.3603, 73.3894, 60.744}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.wind_m_s);
        TiltInputs in{.wind_m_s = row.wind_m_s,
                      .burning_rate_kg_m_s = row.rate_kg_m2_s * row.diameter_m,
                      .fuel_vapour_density_kg_m3 = 1.18};
        EXPECT_NEAR(flame_tilt_aga_rad(in) / kDegree_rad, row.aga_deg, 1e-4);
        EXPECT_NEAR(flame_tilt_thomas_rad(in) / kDegree_rad, row.thomas_deg, 1e-4);
        in.fuel_vapour_density_kg_m3 = 0.36;
        EXPECT_NEAR(flame_tilt_aga_rad(in) / kDegree_rad, row.aga_vapour_deg, 1e-3);
    }
}

TEST(FlameTiltFroude, MatchesTheWorkedValues) {
    const struct {
        double wind_m_s, height_m, albini_deg, putnam_deg;
    } table[] = {{1.0, 1.0, 21.2817, 24.0840},
                 {2.0, 2.0, 28.8486, 32.2983},
                 {3.0, 2.0, 39.5665, 43.4769},
                 {5.0, 5.0, 41.0553, 44.9854},
                 {8.0, 4.0, 57.3068, 60.7816}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.wind_m_s);
        const TiltInputs in{.wind_m_s = row.wind_m_s, .flame_size_m = row.height_m};
        EXPECT_NEAR(flame_tilt_albini_rad(in) / kDegree_rad, row.albini_deg, 1e-4);
        EXPECT_NEAR(flame_tilt_putnam_rad(in) / kDegree_rad, row.putnam_deg, 1e-4);
    }
}

// Given the length, height and tilt depend on each other.
TEST(FlameTiltFroude, SolvesForTheHeightOfALength) {
    const struct {
        double length_m, wind_m_s, tilt_deg, height_m;
    } table[] = {{2.0, 2.0, 30.71465, 1.719443}, {2.0, 3.0, 44.33325, 1.430575}, {5.0, 5.0, 46.35299, 3.451067}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.wind_m_s);
        const TiltInputs along{.wind_m_s = row.wind_m_s, .flame_size_m = row.length_m, .extent = FlameExtent::Length};
        const double tilt_rad = flame_tilt_albini_rad(along);
        EXPECT_NEAR(tilt_rad / kDegree_rad, row.tilt_deg, 1e-5);
        EXPECT_NEAR(row.length_m * std::cos(tilt_rad), row.height_m, 1e-6);
        const TiltInputs upright{.wind_m_s = row.wind_m_s, .flame_size_m = row.height_m};
        EXPECT_NEAR(flame_tilt_albini_rad(upright) / kDegree_rad, row.tilt_deg, 1e-4);
    }
}

TEST(FlameTiltRuleAndButler, MatchTheWorkedValues) {
    EXPECT_NEAR(flame_tilt_rule_rad({.wind_m_s = 2.0}) / kDegree_rad, 45.0, 1e-12);
    EXPECT_NEAR(flame_tilt_rule_rad({.wind_m_s = 5.0}) / kDegree_rad, 68.19859, 1e-5);
    EXPECT_NEAR(flame_tilt_butler_rad({.wind_m_s = 2.0}) / kDegree_rad, 19.27722, 1e-5);
    EXPECT_NEAR(flame_tilt_butler_rad({.wind_m_s = 5.0}) / kDegree_rad, 54.12082, 1e-5);
    EXPECT_NEAR(flame_tilt_butler_rad({.wind_m_s = 8.0}) / kDegree_rad, 70.33314, 1e-5);
}

// Air of the thesis (1040 J kg-1 K-1): V' reaches 1 at these winds over fires of these powers.
TEST(FlameTiltThesis, TiltsOnlyInWindsThatNoFireSees) {
    const struct {
        double heat_release_kW, wind_m_s;
    } table[] = {{1.0, 5.58267}, {10.0, 8.84793}, {100.0, 14.0230}, {1e3, 22.2250},
                 {1e4, 35.2242}, {4e4, 46.4787},  {4e5, 73.6637},   {2.368e6, 105.128}};
    for (const auto& row : table) {
        SCOPED_TRACE(row.heat_release_kW);
        TiltInputs in{.air_heat_capacity_J_kg_K = 1040.0, .heat_release_W = 1e3 * row.heat_release_kW};
        in.wind_m_s = row.wind_m_s * (1.0 - 1e-5);
        EXPECT_EQ(flame_tilt_thesis_rad(in), 0.0);
        in.wind_m_s = row.wind_m_s * (1.0 + 1e-5);
        EXPECT_GT(flame_tilt_thesis_rad(in), 0.0);
        in.wind_m_s = 4.0 * row.wind_m_s;  // V' = 4: cos A = 1/2
        EXPECT_NEAR(flame_tilt_thesis_rad(in) / kDegree_rad, 60.0, 1e-3);
    }
}

// As printed, sin theta = 1 in weak wind with theta from the vertical.
TEST(FlameTiltThesis, LiesFlatInCalmAirAsPrinted) {
    TiltInputs in{.heat_release_W = 1e6, .physics = Physics::Thesis};
    for (const double wind_m_s : {0.0, 3.0, 20.0}) {
        in.wind_m_s = wind_m_s;
        EXPECT_NEAR(flame_tilt_thesis_rad(in), 0.5 * kPi, 1e-12);
    }
    in.air_heat_capacity_J_kg_K = 1040.0;
    in.wind_m_s = 4.0 * 22.2250;
    EXPECT_NEAR(flame_tilt_thesis_rad(in) / kDegree_rad, 30.0, 1e-3);
}

class EveryTiltMethod : public testing::TestWithParam<FlameTiltMethod> {
protected:
    /// A fire that releases this much per metre of front, 20 m wide; flames grow with the square root of it.
    [[nodiscard]] static TiltInputs fire(double intensity_W_m, double wind_m_s) {
        TiltInputs in{.wind_m_s = wind_m_s, .fireline_intensity_W_m = intensity_W_m};
        in.burning_rate_kg_m_s = intensity_W_m / in.heat_of_combustion_J_kg;
        in.heat_release_W = 20.0 * intensity_W_m;
        in.flame_size_m = 2e-3 * std::sqrt(intensity_W_m);
        return in;
    }
};

TEST_P(EveryTiltMethod, IsUprightInCalmAir) {
    for (const double intensity_W_m : {0.0, 1.0, 1e6, 1e9})
        for (const auto extent : {FlameExtent::Height, FlameExtent::Length}) {
            TiltInputs in = fire(intensity_W_m, 0.0);
            in.extent = extent;
            EXPECT_EQ(GetParam().tilt_rad(in), 0.0);
        }
}

TEST_P(EveryTiltMethod, LeansMoreInMoreWindAndLessOverMoreFire) {
    for (const auto extent : {FlameExtent::Height, FlameExtent::Length}) {
        double less_rad = 0.0;
        for (double wind_m_s = 1e-3; wind_m_s < 200.0; wind_m_s *= 1.5) {
            TiltInputs weak = fire(1e6, wind_m_s), strong = fire(2e6, wind_m_s);
            weak.extent = strong.extent = extent;
            const double tilt_rad = GetParam().tilt_rad(weak);
            EXPECT_TRUE(std::isfinite(tilt_rad));
            EXPECT_GE(tilt_rad, less_rad) << wind_m_s;
            EXPECT_LT(tilt_rad, kPi / 2.0);
            EXPECT_LE(GetParam().tilt_rad(strong), tilt_rad) << wind_m_s;
            less_rad = tilt_rad;
        }
        EXPECT_GT(less_rad, 0.0) << "never leans";
    }
}

TEST_P(EveryTiltMethod, IsFiniteWithoutFire) {
    for (const auto extent : {FlameExtent::Height, FlameExtent::Length}) {
        TiltInputs in = fire(0.0, 3.0);
        in.extent = extent;
        const double tilt_rad = GetParam().tilt_rad(in);
        EXPECT_GE(tilt_rad, 0.0);
        EXPECT_LE(tilt_rad, kPi / 2.0);
    }
}

TEST_P(EveryTiltMethod, LeansFromTheVerticalOnSlopesWhereDefined) {
    for (const double slope_deg : {-30.0, -5.0, 5.0, 30.0}) {
        double less_rad = 0.0;
        for (double wind_m_s = 0.1; wind_m_s < 50.0; wind_m_s *= 1.7) {
            TiltInputs in = fire(1e6, wind_m_s);
            const double level_rad = GetParam().tilt_rad(in);
            in.slope_rad = slope_deg * kDegree_rad;
            const double tilt_rad = GetParam().tilt_rad(in);
            EXPECT_GE(tilt_rad, less_rad);
            if (!GetParam().has_slope) {
                EXPECT_EQ(tilt_rad, level_rad);
            }
            less_rad = tilt_rad;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTiltMethod, testing::ValuesIn(kFlameTiltMethods),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TiltMethods, AreFoundByTheirNames) {
    for (const auto& method : kFlameTiltMethods) {
        const auto* found = find_flame_tilt_method(method.name);
        ASSERT_NE(found, nullptr);
        EXPECT_EQ(found->tilt_rad, method.tilt_rad);
    }
    EXPECT_EQ(find_flame_tilt_method("dragon"), nullptr);
}

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
