// Front of a cell, and flame heights and tilts of FireState by methods other than the default.
#include "fire/flames.h"

#include <gtest/gtest.h>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "fire/flame_height.h"
#include "fire/flame_tilt.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::frame;
using test::raster;

FireParameters with_height(const std::string& method) {
    FireParameters p;
    p.flames.height.method = method;
    p.one_sigma_rule = false;
    return p;
}

/// Front inputs of one row of cells that all have the same values.
FrontInputs uniform(const FrameInputs& frame, float spread_m_s, float load_kg_m2) {
    const MapGrid& grid = frame.heat_flux_W_m2.grid;
    FrontInputs front;
    front.spread_rate_m_s = Raster<float>(grid, "spread", "m s-1", spread_m_s);
    front.fuel_load_kg_m2 = Raster<float>(grid, "fuel", "kg m-2", load_kg_m2);
    return front;
}

// Thesis eq 4.29 with its numbers: 16515 kJ/kg x 0.5 kg/m2 x 0.5 m/s = 4128.75 kW/m.
TEST(FirelineIntensity, IsLoadTimesHeatTimesSpreadRate) {
    auto in = frame(0.0, {1e5F});
    const auto front = uniform(in, 0.5F, 0.5F);
    in.front = &front;
    FlameCounts counts;
    EXPECT_NEAR(front_of_cell(in, 0, 0.0, with_height("byram"), counts).fireline_intensity_W_m, 4128.75e3, 1e-3);
    auto half = with_height("byram");
    half.flames.consumed_fraction = 0.5;
    EXPECT_NEAR(front_of_cell(in, 0, 0.0, half, counts).fireline_intensity_W_m, 0.5 * 4128.75e3, 1e-3);
    EXPECT_EQ(counts.intensity_by_heat_flux, 0);
}

// Methods that grow with the flux keep the flux for the intensity, unless the scenario says otherwise.
TEST(FirelineIntensity, ComesFromTheFluxWhereTheFluxMakesTheFlames) {
    auto in = frame(0.0, {1e5F});
    const auto front = uniform(in, 0.5F, 0.5F);
    in.front = &front;
    FlameCounts counts;
    FireParameters p;
    EXPECT_DOUBLE_EQ(front_of_cell(in, 0, 0.0, p, counts).fireline_intensity_W_m, 1e5 * 20.0);
    p.flames.intensity = IntensityRule::Fuel;
    EXPECT_NEAR(front_of_cell(in, 0, 0.0, p, counts).fireline_intensity_W_m, 4128.75e3, 1e-3);
    auto flux = with_height("byram");
    flux.flames.intensity = IntensityRule::HeatFlux;
    EXPECT_DOUBLE_EQ(front_of_cell(in, 0, 0.0, flux, counts).fireline_intensity_W_m, 1e5 * 20.0);
}

TEST(FirelineIntensity, FallsBackToTheFluxAndIsCounted) {
    auto in = frame(0.0, {1e5F, 1e5F, 1e5F});
    auto front = uniform(in, 0.5F, 0.5F);
    front.spread_rate_m_s->values[1] = test::kNaN;
    front.fuel_load_kg_m2->values[2] = test::kNaN;
    in.front = &front;
    const auto s = advance(nullptr, in, with_height("byram"));
    EXPECT_EQ(s.flame_counts.intensity_by_heat_flux, 2);
    const double by_flux_m = flame_length_byram_m({.fireline_intensity_W_m = 2e6});
    EXPECT_NEAR(s.flame_height_m.at(0, 1), 0.2 * by_flux_m, 1e-6);  // 1e5 of 5e5 W m-2: a fifth of the cell flames
    EXPECT_NEAR(s.flame_height_m.at(0, 2), 0.2 * by_flux_m, 1e-6);
}

TEST(FirelineIntensity, ARasterGoesFirst) {
    auto in = frame(0.0, {1e5F, 1e5F});
    auto front = uniform(in, 0.5F, 0.5F);
    front.fireline_intensity_W_m = raster(in.heat_flux_W_m2.grid, {1e6F, test::kNaN});
    in.front = &front;
    FlameCounts counts;
    EXPECT_DOUBLE_EQ(front_of_cell(in, 0, 0.0, FireParameters{}, counts).fireline_intensity_W_m, 1e6);
    EXPECT_DOUBLE_EQ(front_of_cell(in, 1, 0.0, FireParameters{}, counts).fireline_intensity_W_m, 2e6);
}

FireParameters by_residence(double time_s) {
    FireParameters p;
    p.flames.depth = DepthRule::ResidenceTime;
    p.flames.residence_time_s = time_s;
    return p;
}

// 15.36 s at 0.25 m/s are 3.84 m of a 20 m cell.
TEST(FrontDepth, IsResidenceTimeTimesSpreadRate) {
    auto in = frame(100.0, {1e6F});
    auto front = uniform(in, 0.25F, 0.5F);
    in.front = &front;
    FlameCounts counts;
    auto cell = front_of_cell(in, 0, 100.0, by_residence(15.36), counts);
    EXPECT_NEAR(cell.depth_m, 3.84, 1e-12);
    EXPECT_NEAR(cell.fraction, 0.192, 1e-12);
    // A front deeper than the cell fills it and keeps its depth.
    cell = front_of_cell(in, 0, 100.0, by_residence(100.0), counts);
    EXPECT_NEAR(cell.depth_m, 25.0, 1e-12);
    EXPECT_EQ(cell.fraction, 1.0);
    // The raster of fuel models serves where the scenario gives no number.
    auto p = by_residence(1.0);
    p.flames.residence_time_s.reset();
    front.residence_time_s = raster(in.heat_flux_W_m2.grid, {15.36F});
    EXPECT_NEAR(front_of_cell(in, 0, 100.0, p, counts).depth_m, 3.84, 1e-6);
    EXPECT_EQ(counts.depth_by_heat_flux, 0);
}

// Crossing 20 m at 0.25 m/s takes 80 s; flames leave the cell 40 + 15 s after they reach its middle. What burns later is slow fuel.
TEST(FrontDepth, FollowsTheFluxOnceTheFrontHasPassedOrIsUnknown) {
    auto in = frame(1000.0, {5e4F});
    auto front = uniform(in, 0.25F, 0.5F);
    in.front = &front;
    FlameCounts counts;
    EXPECT_NEAR(front_of_cell(in, 0, 1000.0 - 54.0, by_residence(15.0), counts).fraction, 0.1875, 1e-12);
    EXPECT_EQ(counts.depth_by_heat_flux, 0);
    EXPECT_NEAR(front_of_cell(in, 0, 1000.0 - 56.0, by_residence(15.0), counts).fraction, 0.1, 1e-7);
    EXPECT_EQ(counts.depth_by_heat_flux, 1);
    front.spread_rate_m_s->values[0] = test::kNaN;
    EXPECT_NEAR(front_of_cell(in, 0, 1000.0, by_residence(15.0), counts).fraction, 0.1, 1e-7);
    EXPECT_EQ(counts.depth_by_heat_flux, 2);
    in.front = nullptr;
    EXPECT_NEAR(front_of_cell(in, 0, 1000.0, by_residence(15.0), counts).depth_m, 2.0, 1e-6);
}

// The volume of method 1 is the flux's affair: it does not change with the depth of the front.
TEST(FrontDepth, LeavesTheVolumeOfTheHeatFluxMethodAlone) {
    auto in = frame(100.0, {1e6F});
    const auto front = uniform(in, 0.25F, 0.5F);
    in.front = &front;
    const auto s = advance(nullptr, in, by_residence(15.36));
    EXPECT_NEAR(s.front_fraction.at(0, 0), 0.192, 1e-7);
    EXPECT_FLOAT_EQ(s.flame_height_m.at(0, 0), 0.5F);
}

// Laws of the fireline intensity give the height of the flames that stand there: the mean over the cell is the share of it.
TEST(FlamesOfLaws, StandAtTheirHeightOverTheFlamingShare) {
    for (const auto& method : kFlameHeightMethods) {
        if (method.driver != FlameDriver::FirelineIntensity) continue;
        SCOPED_TRACE(method.name);
        const auto s = advance(nullptr, frame(0.0, {5e4F, 2.5e5F}), with_height(std::string(method.name)));
        for (const int col : {0, 1}) {
            const double fraction = col == 0 ? 0.1 : 0.5, flux_W_m2 = fraction * 5e5;
            const double length_m =
                method.size_m({.fireline_intensity_W_m = flux_W_m2 * 20.0, .front_depth_m = fraction * 20.0});
            EXPECT_NEAR(s.flame_height_m.at(0, col) / s.front_fraction.at(0, col), length_m, 1e-5 * length_m);
        }
    }
}

// 45 degrees by the rule of thumb at 2 m/s: a length loses 1 - cos 45, a height nothing.
TEST(FlamesOfLaws, LeanByTheirLengthOnce) {
    FireParameters p = with_height("byram");
    p.flames.tilt.method = "rule";
    const auto leaning = advance(nullptr, frame(0.0, {5e5F}, 2.0F), p);
    EXPECT_NEAR(leaning.flame_height_m.at(0, 0),
                std::cos(0.25 * kPi) * flame_length_byram_m({.fireline_intensity_W_m = 1e7}), 1e-5);
    p.flames.height.method = "constant";
    EXPECT_FLOAT_EQ(advance(nullptr, frame(0.0, {5e5F}, 2.0F), p).flame_height_m.at(0, 0), 2.0F);
}

// Height and tilt of Albini's relation depend on each other: H = L cos A and tan A = 1.22 U / sqrt(g H) both hold.
TEST(FlamesOfLaws, AgreeWithATiltThatNeedsTheirHeight) {
    FireParameters p = with_height("byram");
    p.flames.tilt.method = "albini";
    const auto s = advance(nullptr, frame(0.0, {5e5F}, 4.0F), p);
    const double height_m = s.flame_height_m.at(0, 0), tilt_rad = s.flame_tilt_rad.at(0, 0);
    EXPECT_NEAR(height_m, std::cos(tilt_rad) * flame_length_byram_m({.fireline_intensity_W_m = 1e7}), 1e-5);
    EXPECT_NEAR(std::tan(tilt_rad), 1.22 * 4.0 / std::sqrt(kGravity_m_s2 * height_m), 1e-5);
}

TEST(FlamesOfLaws, AStandLiftsCrownFlamesUpright) {
    FireParameters p = with_height("butler");
    p.flames.height.stand_height_m = 12.0;
    p.flames.tilt.method = "rule";
    const auto s = advance(nullptr, frame(0.0, {5e5F}, 2.0F), p);
    EXPECT_NEAR(s.flame_height_m.at(0, 0),
                12.0 + std::cos(0.25 * kPi) * flame_length_butler_m({.fireline_intensity_W_m = 1e7}), 1e-4);
}

// 400 m2 x 1 MW/m2: Q = 4e5 kW, D = 22.5676 m gives 17.89692 m; at 100 kW/m2 (4e4 kW) the formula is negative.
TEST(FlamesOfHeskestad, UseTheCellAndCountWhatHasNoFlame) {
    FireParameters p = with_height("heskestad");
    p.flames.height.plume_coefficient_m_kW = 0.235;
    p.flames.height.burning_area_fraction = 1.0;
    const auto s = advance(nullptr, frame(0.0, {1e6F, 1e5F, 0.0F}), p);
    EXPECT_NEAR(s.flame_height_m.at(0, 0), 17.89692, 1e-4);
    EXPECT_EQ(s.flame_height_m.at(0, 1), 0.0F);
    EXPECT_EQ(s.flame_counts.without_height, 1);
    EXPECT_EQ(s.height_statistics.count, 1);
}

// The thesis's fire source of a fortieth of the cell: D = 3.56825 m; 10 MW give 5.715904 m.
TEST(FlamesOfHeskestad, TakeABurningAreaThatTheUserNames) {
    FireParameters p = with_height("heskestad");
    p.physics = Physics::Thesis;
    p.flames.height.plume_coefficient_m_kW = 0.235;
    p.flames.height.burning_area_fraction = 1.0 / 40.0;
    EXPECT_NEAR(advance(nullptr, frame(0.0, {2.5e4F}), p).flame_height_m.at(0, 0), 5.715904, 1e-5);
}

TEST(FlamesOfARaster, AreLengthsWhereThereIsAValue) {
    auto in = frame(0.0, {5e5F, 5e5F}, 2.0F);
    FrontInputs front;
    front.flame_length_m = raster(in.heat_flux_W_m2.grid, {4.0F, test::kNaN});
    in.front = &front;
    FireParameters p = with_height("raster");
    p.flames.tilt.method = "rule";
    const auto s = advance(nullptr, in, p);
    EXPECT_NEAR(s.flame_height_m.at(0, 0), 4.0 * std::cos(0.25 * kPi), 1e-6);
    EXPECT_EQ(s.flame_height_m.at(0, 1), 0.0F);
    EXPECT_EQ(s.flame_counts.without_height, 1);
}

// Wherever the method, nothing is lost by the one-sigma rule: flame and ember together are the height before it.
TEST(Flames, OfEveryMethodKeepTheirVolumeUnderTheOneSigmaRule) {
    for (const auto& method : kFlameHeightMethods) {
        if (method.driver == FlameDriver::Given) continue;
        SCOPED_TRACE(method.name);
        FireParameters p = with_height(std::string(method.name));
        p.one_sigma_rule = true;
        FireParameters free = p;
        free.one_sigma_rule = false;
        const auto first = frame(0.0, {4e5F, 5e5F, 6e5F}), second = frame(6.0, {4e5F, 5e6F, 1e5F});
        const auto before = advance(nullptr, first, p);
        const auto limited = advance(&before, second, p), unlimited = advance(&before, second, free);
        EXPECT_GT(test::sum(limited.ember_height_m), 0.0);
        EXPECT_NEAR(test::sum(limited.flame_height_m) + test::sum(limited.ember_height_m),
                    test::sum(unlimited.flame_height_m), 1e-4);
    }
}

TEST(Flames, OfEveryTiltMethodStayBelowTheMaximum) {
    for (const auto& method : kFlameTiltMethods) {
        SCOPED_TRACE(method.name);
        FireParameters p;
        p.flames.tilt.method = method.name;
        p.maximum_tilt_rad = 0.5;
        for (const Physics physics : {Physics::Default, Physics::Thesis}) {
            p.physics = physics;
            const auto s = advance(nullptr, frame(0.0, {1001.0F, 1e6F}, 0.0F, 80.0F), p);
            for (const float tilt_rad : test::dense(s.flame_tilt_rad)) EXPECT_LE(tilt_rad, 0.5F);
        }
        p.physics = Physics::Default;
        const auto calm = advance(nullptr, frame(0.0, {1001.0F, 1e6F}), p);
        EXPECT_EQ(test::sum(calm.flame_tilt_rad), 0.0);
    }
}

// A wind of 7.5 m/s above that is 3 m/s at the flames: 500 kW/m lean by 44.79912 degrees (Nelson and Adkins 1986).
TEST(Flames, LeanWithTheWindAtTheirHeight) {
    auto in = frame(0.0, {2.5e4F, 2.5e4F}, 7.5F, 0.0F);
    FrontInputs front;
    front.midflame_wind = raster(in.heat_flux_W_m2.grid, {0.4F, 1.0F});
    in.front = &front;
    const auto s = advance(nullptr, in, FireParameters{});
    EXPECT_NEAR(s.flame_tilt_rad.at(0, 0) / kDegree_rad, 44.79912, 1e-4);
    in.front = nullptr;
    EXPECT_EQ(s.flame_tilt_rad.at(0, 1), advance(nullptr, in, FireParameters{}).flame_tilt_rad.at(0, 1));
}

TEST(Flames, CountTheSlopeAlongTheWindWhenAsked) {
    auto in = frame(0.0, {2.5e4F, 2.5e4F, 2.5e4F}, 3.0F, 0.0F);  // 500 kW/m
    const auto rise = static_cast<float>(std::tan(20.0 * kDegree_rad));
    FrontInputs front;
    front.slope_east = raster(in.heat_flux_W_m2.grid, {rise, 0.0F, 0.0F});
    front.slope_north = raster(in.heat_flux_W_m2.grid, {0.0F, rise, 0.0F});
    in.front = &front;
    FireParameters p;
    EXPECT_NEAR(advance(nullptr, in, p).flame_tilt_rad.at(0, 0) / kDegree_rad, 44.79912, 1e-4);
    p.flames.tilt.slope = true;
    const auto s = advance(nullptr, in, p);
    EXPECT_NEAR(s.flame_tilt_rad.at(0, 0) / kDegree_rad, 32.36948, 1e-4);
    EXPECT_NEAR(s.flame_tilt_rad.at(0, 1) / kDegree_rad, 44.79912, 1e-4);  // across the wind
}

TEST(Flames, RefuseUnknownMethodsAndOtherGrids) {
    FireParameters p;
    p.flames.height.method = "dragon";
    EXPECT_THROW(advance(nullptr, frame(0.0, {1e5F}), p), Error);
    p = {};
    p.flames.tilt.method = "dragon";
    EXPECT_THROW(advance(nullptr, frame(0.0, {1e5F}), p), Error);
    p = {};
    p.flames.height.air_fuel_ratio = 0.0;
    EXPECT_THROW(advance(nullptr, frame(0.0, {1e5F}), p), Error);
    auto in = frame(0.0, {1e5F});
    const auto other = uniform(frame(0.0, {1e5F, 1e5F}), 1.0F, 1.0F);
    in.front = &other;
    EXPECT_THROW(advance(nullptr, in, FireParameters{}), Error);
}

}  // namespace
}  // namespace pyroscene::fire
