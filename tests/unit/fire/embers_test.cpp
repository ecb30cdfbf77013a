#include "fire/embers.h"

#include <gtest/gtest.h>
#include <cmath>

#include "fire/flame_field.h"
#include "fire/flame_tilt.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::frame;

Ember ember() {
    Ember e;
    e.release_s = 100.0;
    e.x_m = 10.0;
    e.y_m = 20.0;
    e.bottom_m = 2.0;
    e.edge_m = 1.5;
    e.east_m_s = 4.0;
    e.north_m_s = -1.0;
    e.rise_m_s = 3.0;
    return e;
}

// By hand, age 2 s = one cooling time: excess 800 / e, drift 2 u, rise 2 tau w (1 - e^-1/2) = 12 x 0.393469.
TEST(Embers, DriftRiseAndCool) {
    const EmberParameters p;
    const EmberNow now = ember_at(ember(), 102.0, p, 1100.0, 300.0);
    EXPECT_NEAR(now.x_m, 18.0, 1e-12);
    EXPECT_NEAR(now.y_m, 18.0, 1e-12);
    EXPECT_NEAR(now.bottom_m, 2.0 + 12.0 * 0.39346934, 1e-6);
    EXPECT_NEAR(now.temperature_K, 300.0 + 800.0 * 0.36787944, 1e-4);
    const EmberNow born = ember_at(ember(), 100.0, p, 1100.0, 300.0);
    EXPECT_EQ(born.temperature_K, 1100.0);
    EXPECT_EQ(born.bottom_m, 2.0);
}

TEST(Embers, WindGrowsWithHeight) {
    const EmberParameters p;
    EXPECT_EQ(wind_factor(6.1, p), 1.0);
    EXPECT_NEAR(wind_factor(12.2, p), std::pow(2.0, 0.143), 1e-12);
    EXPECT_EQ(wind_factor(0.0, p), wind_factor(1.0, p));
}

/// Two quiet frames, then one whose first cell is far above the statistics; the last one follows 3 s later.
std::vector<FrameInputs> story() {
    return {frame(0.0, {2e6F, 3e6F, 2.5e6F}, 4.0F, 3.0F), frame(6.0, {2e6F, 3e6F, 2.5e6F}, 4.0F, 3.0F),
            frame(12.0, {9e6F, 2e6F, 2.5e6F}, 4.0F, 3.0F), frame(15.0, {2e6F, 8e6F, 2.5e6F}, 4.0F, 3.0F)};
}

FireState run(const FireParameters& p, std::size_t frames) {
    const auto inputs = story();
    FireState state = advance(nullptr, inputs[0], p);
    for (std::size_t i = 1; i < frames; ++i) state = advance(&state, inputs[i], p);
    return state;
}

TEST(Embers, CarryTheVolumeBeyondOneSigma) {
    const FireParameters p;
    const FireState state = run(p, 3);
    ASSERT_GT(state.ember_height_m.at(0, 0), 0.0F);
    double volume_m3 = 0.0;
    for (const Ember& e : state.embers) {
        if (e.release_s <= 6.0) continue;
        volume_m3 += e.edge_m * e.edge_m * e.edge_m;
        EXPECT_LE(e.release_s, 12.0);
        EXPECT_GE(e.release_s, 12.0 - p.embers.cooling_time_s);
        EXPECT_EQ(e.ground_x_m, std::clamp(e.ground_x_m, 1000.0, 1020.0));  // inside the cell that shed it
        EXPECT_EQ(e.ground_y_m, std::clamp(e.ground_y_m, 4980.0, 5000.0));
    }
    EXPECT_NEAR(volume_m3 / (static_cast<double>(state.ember_height_m.at(0, 0)) * 400.0), 1.0, 1e-9);
}

TEST(Embers, GoDownwindAtTheWindOfTheirHeight) {
    const FireParameters p;
    const FireState state = run(p, 3);
    ASSERT_FALSE(state.embers.empty());
    for (const Ember& e : state.embers) {
        const double factor = wind_factor(e.bottom_m + 0.5 * e.edge_m, p.embers);
        EXPECT_NEAR(e.east_m_s, 4.0 * factor, 1e-12);
        EXPECT_NEAR(e.north_m_s, 3.0 * factor, 1e-12);
        EXPECT_GT(e.rise_m_s, 0.0);
    }
}

// The history: pockets of an earlier frame live on until their time is over.
TEST(Embers, OutliveTheirFrame) {
    FireParameters p;
    const FireState third = run(p, 3), fourth = run(p, 4);
    ASSERT_FALSE(third.embers.empty());
    ASSERT_GT(fourth.embers.size(), third.embers.size());
    for (std::size_t i = 0; i < third.embers.size(); ++i) EXPECT_EQ(fourth.embers[i], third.embers[i]);
    p.embers.lifetime_s = 2.5;
    for (const Ember& e : run(p, 4).embers) EXPECT_GT(e.release_s, 15.0 - 2.5 - 1e-9);
}

TEST(Embers, AreTheSameForTheSameSeedOnly) {
    FireParameters p;
    const auto a = run(p, 4).embers, b = run(p, 4).embers;
    EXPECT_EQ(a, b);
    p.seed = 2;
    EXPECT_NE(run(p, 4).embers, a);
}

TEST(Embers, AreVoxelsDownwindAndCoolerThanTheFlame) {
    const FireParameters p;
    const FireState state = run(p, 3);
    const SurfaceField surface = surface_at(state, 12.0, p, 1);
    const Raster<float> flat(state.cell_class.grid, "terrain", "m", 100.0F);
    const auto now = make_columns(state, surface, flat, p, {}, {}),
               later = make_columns(state, surface, flat, p, {}, {}, 13.0);
    ASSERT_EQ(now.size(), later.size());
    ASSERT_EQ(now.size(), 3 + state.embers.size());
    for (std::size_t i = 3; i < now.size(); ++i) {
        EXPECT_GT(now[i].bottom_m, now[0].top_m - 1.0);
        EXPECT_LT(now[i].temperature_K, 1100.0);
        EXPECT_GT(later[i].x_m, now[i].x_m + 3.0);
        EXPECT_GT(later[i].y_m, now[i].y_m + 2.0);
        EXPECT_GT(later[i].bottom_m, now[i].bottom_m);
        EXPECT_NEAR((later[i].temperature_K - 300.0) / (now[i].temperature_K - 300.0), std::exp(-0.5), 1e-9);
    }
    // Past their life nothing is left of them.
    EXPECT_EQ(make_columns(state, surface, flat, p, {}, {}, 12.0 + p.embers.lifetime_s).size(), 3U);
}

TEST(Embers, NoneWithoutTheRule) {
    FireParameters p;
    p.one_sigma_rule = false;
    EXPECT_TRUE(run(p, 4).embers.empty());
}

// The place where the front is, if the arrival time says where.
TEST(Embers, LeaveFromWhereTheFrontIs) {
    const FireParameters p;
    const auto with_arrival = [](FrameInputs in) {
        in.arrival_time_s =
            share(test::raster(in.heat_flux_W_m2.grid, {0.0F, 20.0F, 40.0F}));  // 1 m/s eastward from x = 1010
        return in;
    };
    FireState state = advance(nullptr, with_arrival(story()[0]), p);
    state = advance(&state, with_arrival(story()[1]), p);
    state = advance(&state, with_arrival(story()[2]), p);
    double mean_x_m = 0.0, count = 0.0;
    for (const Ember& e : state.embers) {
        if (e.release_s <= 6.0) continue;
        mean_x_m += e.ground_x_m;
        count += 1.0;
    }
    ASSERT_GT(count, 0.0);
    EXPECT_GT(mean_x_m / count, 1012.0);  // the cell spans 1000 to 1020, the front at 12 s has just left it
}

}  // namespace
}  // namespace pyroscene::fire
