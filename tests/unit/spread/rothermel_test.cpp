#include "spread/rothermel.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/csv.h"
#include "source_folder.h"

namespace pyroscene::spread {
namespace {

double relative_error(double value, double expected) {
    return expected == 0.0 ? std::abs(value) : std::abs(value / expected - 1.0);
}

/// A row of the reference table by column name.
struct Columns {
    explicit Columns(const CsvTable& table) {
        for (const auto& name : table.columns)
            if (name != "code" && name != "wind_mode") numbers[name] = table.numbers(name);
        const auto mode = table.column("wind_mode");
        for (const auto& row : table.rows) wind_mode.push_back(row[mode]);
    }
    std::map<std::string, std::vector<double>> numbers;
    std::vector<std::string> wind_mode;
};

TEST(Rothermel, MeetsBehaveOnAllRows) {
    const auto table = read_csv(source_folder() / "tests" / "data" / "rothermel_behave.csv");
    const Columns columns(table);
    ASSERT_EQ(table.rows.size(), 1060U);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const auto n = [&](const char* name) { return columns.numbers.at(name)[i]; };
        const auto& model = standard_fuel_models().at(static_cast<int>(n("fuel_model")));
        const Moistures moisture{n("m1h_pct") / 100, n("m10h_pct") / 100, n("m100h_pct") / 100, n("mherb_pct") / 100,
                                 n("mwoody_pct") / 100};
        const auto bed = fuel_bed(model, moisture);
        double wind_m_s = n("wind_m_s");
        if (columns.wind_mode[i] != "midflame")
            wind_m_s *= wind_adjustment(model.depth_m, {n("canopy_cover"), n("canopy_height_m"), n("crown_ratio")});
        if (columns.wind_mode[i] == "10m") wind_m_s /= kTenMetresToTwentyFeet;
        const double aspect_deg = n("aspect_deg");
        const auto head = head_fire(bed, wind_m_s, (n("wind_from_deg") - aspect_deg) * kDegree_rad,
                                    std::tan(n("slope_deg") * kDegree_rad));
        constexpr double kTolerance = 1e-5;
        const double case_id = n("case");
        EXPECT_LT(relative_error(wind_m_s, n("midflame_m_s")), kTolerance) << case_id;
        EXPECT_LT(relative_error(head.rate_m_s, n("ros_m_s")), kTolerance) << case_id;
        EXPECT_LT(relative_error(bed.residence_time_s, n("residence_s")), kTolerance) << case_id;
        if (n("ros_m_s") == 0.0) continue;  // the rest has no meaning
        EXPECT_LT(relative_error(bed.reaction_intensity_W_m2 * 1e-3, n("ir_kW_m2")), kTolerance) << case_id;
        EXPECT_LT(relative_error(bed.heat_J_m2 * 1e-3, n("hpua_kJ_m2")), kTolerance) << case_id;
        EXPECT_LT(relative_error(bed.heat_J_m2 * head.rate_m_s * 1e-3, n("fli_kW_m")), kTolerance) << case_id;
        EXPECT_LT(relative_error(flame_length_m(bed.heat_J_m2 * head.rate_m_s), n("flame_length_m")), kTolerance) << case_id;
        EXPECT_LT(relative_error(bed.surface_to_volume_per_m, n("sigma_1_m")), kTolerance) << case_id;
        EXPECT_LT(relative_error(bed.relative_packing, n("beta_rel")), kTolerance) << case_id;
        EXPECT_LT(relative_error(length_to_width(head.effective_wind_m_s), n("lw_ratio")), kTolerance) << case_id;
        const double direction_deg = aspect_deg + 180.0 + head.from_upslope_rad / kDegree_rad;
        const double off_deg = std::remainder(direction_deg - n("dir_max_deg"), 360.0);
        EXPECT_LT(std::abs(off_deg), n("dir_snapped") != 0.0 ? 0.5 : 0.002) << case_id;
    }
}

TEST(Rothermel, BurnsNothingTooWet) {
    const auto bed = fuel_bed(standard_fuel_models().at(1), {0.13, 0.13, 0.13, 0.6, 0.9});  // extinction at 12 %
    EXPECT_EQ(bed.rate_m_s, 0.0);
    EXPECT_EQ(bed.heat_J_m2, 0.0);
    EXPECT_EQ(head_fire(bed, 5.0, 0.0, 0.3).rate_m_s, 0.0);
}

TEST(Rothermel, AddsWindAndSlopeAsVectors) {
    const auto bed = fuel_bed(standard_fuel_models().at(3), {0.06, 0.07, 0.08, 0.6, 0.9});
    const auto up = head_fire(bed, 2.0, 0.0, 0.4), down = head_fire(bed, 2.0, kPi, 0.4),
               across = head_fire(bed, 2.0, kPi / 2, 0.4);
    const double wind = head_fire(bed, 2.0, 0.0, 0.0).rate_m_s / bed.rate_m_s - 1.0;
    const double slope = head_fire(bed, 0.0, 0.0, 0.4).rate_m_s / bed.rate_m_s - 1.0;
    EXPECT_NEAR(up.rate_m_s / bed.rate_m_s, 1.0 + wind + slope, 1e-9);
    EXPECT_NEAR(down.rate_m_s / bed.rate_m_s, 1.0 + wind - slope, 1e-9);
    EXPECT_NEAR(across.rate_m_s / bed.rate_m_s, 1.0 + std::hypot(wind, slope), 1e-9);
    EXPECT_NEAR(std::tan(across.from_upslope_rad), wind / slope, 1e-9);
    // The effective wind alone gives the same rate on level ground.
    EXPECT_NEAR(head_fire(bed, across.effective_wind_m_s, 0.0, 0.0).rate_m_s, across.rate_m_s, 1e-12);
}

TEST(Rothermel, CuresHerbsByTheChosenRule) {
    const auto& gr2 = standard_fuel_models().at(102);
    const auto rate = [&](double herb, Curing rule) { return fuel_bed(gr2, {0.06, 0.07, 0.08, herb, 0.9}, rule).rate_m_s; };
    // At 0.75 the published line cures one half, BEHAVE 1.333 - 0.8325 = 0.5005 of the herbs; both agree at the ends.
    EXPECT_NEAR(rate(0.75, Curing::Linear) / rate(0.75, Curing::BehavePlus), 1.0, 5e-3);
    EXPECT_NE(rate(0.75, Curing::Linear), rate(0.75, Curing::BehavePlus));
    EXPECT_EQ(rate(0.25, Curing::Linear), rate(0.25, Curing::BehavePlus));
    EXPECT_EQ(rate(1.3, Curing::Linear), rate(1.3, Curing::BehavePlus));
    // A static model does not cure: FM2 has herbs, and its dead load stays.
    const auto& fm2 = standard_fuel_models().at(2);
    EXPECT_EQ(fuel_bed(fm2, {0.06, 0.07, 0.08, 0.6, 0.9}, Curing::Linear).rate_m_s,
              fuel_bed(fm2, {0.06, 0.07, 0.08, 0.6, 0.9}).rate_m_s);
}

TEST(Rothermel, LimitsTheWindOnlyWhenAsked) {
    const auto bed = fuel_bed(standard_fuel_models().at(101), {0.06, 0.07, 0.08, 0.9, 0.9});  // sparse grass, weak reaction
    const auto free = head_fire(bed, 8.0, 0.0, 0.0), limited = head_fire(bed, 8.0, 0.0, 0.0, true);
    EXPECT_FALSE(free.limited);
    EXPECT_NEAR(free.effective_wind_m_s, 8.0, 1e-9);
    ASSERT_TRUE(limited.limited);
    // 0.9 x the reaction intensity in Btu/ft2/min is a speed in ft/min.
    EXPECT_NEAR(limited.effective_wind_m_s / 0.00508, 0.9 * bed.reaction_intensity_W_m2 / 189.2754447, 1e-4);
    EXPECT_LT(limited.rate_m_s, free.rate_m_s);
}

TEST(WindAdjustment, MeetsTheClosedForms) {
    EXPECT_NEAR(wind_adjustment(0.762, {}), 0.439515, 1e-6);
    EXPECT_NEAR(wind_adjustment(0.3048, {}), 0.362104, 1e-6);
    EXPECT_LT(wind_adjustment(0.762, {0.6, 15.0, 0.5}), 0.2);
    EXPECT_EQ(wind_adjustment(0.762, {0.6, 1.5, 0.5}), wind_adjustment(0.762, {}));  // no tree of 6 ft
}

TEST(LengthToWidth, IsRoundInCalmAirAndCappedInStorms) {
    EXPECT_NEAR(length_to_width(0.0), 1.0, 1e-12);
    EXPECT_NEAR(length_to_width(3.0), 1.913743, 1e-6);
    EXPECT_EQ(length_to_width(30.0), 8.0);
}

TEST(FlameLength, FollowsByram) {
    EXPECT_NEAR(flame_length_m(8061.566e3), 4.854233, 2e-6);
    EXPECT_NEAR(flame_length_m(1e3), 0.0775, 3e-5);
    EXPECT_EQ(flame_length_m(0.0), 0.0);
}

}  // namespace
}  // namespace pyroscene::spread
