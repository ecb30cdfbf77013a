// Flaming fraction, heights and tilt of FireState.
#include <gtest/gtest.h>
#include <cmath>

#include "base/constants.h"
#include "fire/state.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::frame;

FireParameters thesis() {
    FireParameters p;
    p.physics = Physics::Thesis;
    return p;
}

TEST(FrontFraction, IsCellMeanFluxOverTheFluxInsideTheFlamingZone) {
    const auto s = advance(nullptr, frame(0.0, {0.0F, 5e4F, 2.5e5F, 5.92e6F}), FireParameters{});
    EXPECT_EQ(s.front_fraction.at(0, 0), 0.0F);
    EXPECT_FLOAT_EQ(s.front_fraction.at(0, 1), 0.1F);
    EXPECT_FLOAT_EQ(s.front_fraction.at(0, 2), 0.5F);
    EXPECT_EQ(s.front_fraction.at(0, 3), 1.0F);
}

TEST(FrontFraction, IsTheWholeCellInTheThesis) {
    const auto s = advance(nullptr, frame(0.0, {0.0F, 5e4F}), thesis());
    EXPECT_EQ(s.front_fraction.at(0, 0), 0.0F);
    EXPECT_EQ(s.front_fraction.at(0, 1), 1.0F);
}

TEST(Heights, TheFirstFrameIsUnlimited) {
    for (const FireParameters& p : {FireParameters{}, thesis()}) {
        const auto s = advance(nullptr, frame(0.0, {500.0F, 2e3F, 1e6F, 5.92e6F}), p);
        EXPECT_EQ(s.flame_height_m.at(0, 0), 0.0F);  // pre-heat has no flame
        EXPECT_FLOAT_EQ(s.flame_height_m.at(0, 1), 1e-3F);
        EXPECT_FLOAT_EQ(s.flame_height_m.at(0, 2), 0.5F);
        EXPECT_FLOAT_EQ(s.flame_height_m.at(0, 3), 2.96F);
        EXPECT_EQ(test::sum(s.ember_height_m), 0.0);
        EXPECT_EQ(s.height_statistics.count, 3);
    }
}

// First frame 1 and 3 m (2e6 and 6e6 W m-2 over 2e6 W m-3): mean 2 m, sd sqrt(2) m, taken from EARLIER frames only and from
// heights before any limit.
TEST(Heights, LaterFramesAreLimitedByAllEarlierOnes) {
    const double highest_m = 2.0 + std::sqrt(2.0), lowest_m = 2.0 - std::sqrt(2.0);
    for (const FireParameters& p : {FireParameters{}, thesis()}) {
        auto s = advance(nullptr, frame(0.0, {2e6F, 6e6F}), p);
        s = advance(&s, frame(6.0, {1e7F, 2e5F}), p);  // 5 m and 0.1 m
        EXPECT_NEAR(s.flame_height_m.at(0, 0), highest_m, 1e-6);
        EXPECT_NEAR(s.ember_height_m.at(0, 0), 5.0 - highest_m, 1e-6);
        EXPECT_NEAR(s.flame_height_m.at(0, 1), p.physics == Physics::Thesis ? lowest_m : 0.1, 1e-6);
        EXPECT_EQ(s.ember_height_m.at(0, 1), 0.0F);
        // 1, 3, 5, 0.1 m: mean 2.275, sum of squared deviations 1.625625 + 0.525625 + 7.425625 + 4.730625.
        EXPECT_EQ(s.height_statistics.count, 4);
        EXPECT_NEAR(s.height_statistics.mean_m, 2.275, 1e-6);
        EXPECT_NEAR(s.height_statistics.m2_m2, 14.3075, 1e-5);
    }
}

TEST(Heights, TheRuleCanBeSwitchedOff) {
    FireParameters p;
    p.one_sigma_rule = false;
    auto s = advance(nullptr, frame(0.0, {2e6F, 6e6F}), p);
    s = advance(&s, frame(6.0, {1e7F, 2e5F}), p);
    EXPECT_FLOAT_EQ(s.flame_height_m.at(0, 0), 5.0F);
    EXPECT_EQ(s.ember_height_m.at(0, 0), 0.0F);
    EXPECT_EQ(s.height_statistics.count, 4);
}

TEST(Heights, FlamePlusEmberIsWhatTheFluxDelivers) {
    FireState s;
    for (int k = 0; k < 5; ++k) {
        s = advance(k == 0 ? nullptr : &s, frame(6.0 * k, {2e3F, 4e5F * static_cast<float>(k + 1), 3e6F, 7e4F}),
                    FireParameters{});
        const double delivered_m = (2e3 + 4e5 * (k + 1) + 3e6 + 7e4) / 2e6;
        EXPECT_NEAR(test::sum(s.flame_height_m) + test::sum(s.ember_height_m), delivered_m, 1e-6);
    }
}

// Cell of 20 m and 25 kW m-2: I = 500 kW/m; with 3 m/s the buoyant-velocity table gives 44.79912 degrees.
TEST(Tilt, UsesCellMeanFluxTimesCellDepth) {
    const auto s = advance(nullptr, frame(0.0, {2.5e4F, 0.0F}, 3.0F, 0.0F), FireParameters{});
    EXPECT_NEAR(s.flame_tilt_rad.at(0, 0) / kDegree_rad, 44.79912, 1e-4);
    EXPECT_EQ(s.flame_tilt_rad.at(0, 1), 0.0F);  // no flame, no tilt
}

TEST(Tilt, PointsDownwindInAllFourQuarters) {
    const struct {
        float east_m_s, north_m_s;
        double azimuth_deg;
    } winds[] = {{0, 4, 0}, {4, 0, 90}, {0, -4, 180}, {-4, 0, 270}, {-1, 1, 315}};
    for (const auto& w : winds) {
        SCOPED_TRACE(w.azimuth_deg);
        const auto s = advance(nullptr, frame(0.0, {1e5F}, w.east_m_s, w.north_m_s), FireParameters{});
        EXPECT_NEAR(s.flame_azimuth_rad.at(0, 0) / kDegree_rad, w.azimuth_deg, 1e-4);
        EXPECT_GT(s.flame_tilt_rad.at(0, 0), 0.0F);
    }
}

TEST(Tilt, AzimuthStaysBelowTheFullTurn) {
    const auto s = advance(nullptr, frame(0.0, {1e5F}, -1e-9F, 10.0F), FireParameters{});
    EXPECT_LT(static_cast<double>(s.flame_azimuth_rad.at(0, 0)), 2.0 * kPi);
}

TEST(Tilt, IsUprightInCalmOrUnknownWindAndNeverBeyondTheMaximum) {
    EXPECT_EQ(advance(nullptr, frame(0.0, {1e5F}), FireParameters{}).flame_tilt_rad.at(0, 0), 0.0F);
    EXPECT_EQ(advance(nullptr, frame(0.0, {1e5F}, test::kNaN, 1.0F), FireParameters{}).flame_tilt_rad.at(0, 0), 0.0F);
    const auto storm = advance(nullptr, frame(0.0, {1001.0F}, 60.0F, 0.0F), FireParameters{});
    EXPECT_NEAR(storm.flame_tilt_rad.at(0, 0) / kDegree_rad, 85.0, 1e-4);
}

}  // namespace
}  // namespace pyroscene::fire
