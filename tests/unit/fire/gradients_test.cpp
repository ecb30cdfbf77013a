#include "fire/gradients.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/constants.h"
#include "fire/residence_time.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

constexpr double kCell_m = 20.0;

/// A raster whose cells hold a function of the distance east and south of the north-western cell's centre [m].
Raster<float> raster_of(int cols, int rows, const std::function<double(double, double)>& value) {
    Raster<float> out(test::small_grid(cols, rows, kCell_m), "test", "s");
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < cols; ++c) out.at(r, c) = static_cast<float>(value(c * kCell_m, r * kCell_m));
    return out;
}

TEST(SpreadRate, OfAStraightFrontIsExactInEveryDirection) {
    for (int degrees = 0; degrees < 360; degrees += 15) {
        SCOPED_TRACE(degrees);
        const double sine = std::sin(degrees * kDegree_rad), cosine = std::cos(degrees * kDegree_rad);
        const auto t_s =
            raster_of(12, 9, [&](double x_m, double y_m) { return 5000.0 + (sine * x_m + cosine * y_m) / 0.7; });
        for (const float rate_m_s : spread_rate_m_s(t_s, 10.0).values) EXPECT_NEAR(rate_m_s, 0.7, 1e-4);
    }
}

// A point ignition: a cone. Away from its top the plane of 3 x 3 cells follows it.
TEST(SpreadRate, OfACircularFireIsItsRadialSpeed) {
    const auto t_s = raster_of(61, 61, [](double x_m, double y_m) { return std::hypot(x_m - 600.0, y_m - 600.0) / 0.5; });
    const auto rate = spread_rate_m_s(t_s, 10.0);
    for (int r = 0; r < 61; ++r) {
        for (int c = 0; c < 61; ++c) {
            const double cells = std::hypot(c - 30, r - 30);
            EXPECT_NEAR(rate.at(r, c), 0.5, cells > 5.0 ? 0.01 : 0.3) << r << " " << c;
            EXPECT_TRUE(std::isfinite(rate.at(r, c)));
        }
    }
}

// Two fires that meet: the crest has no gradient of its own and takes that of its neighbours.
TEST(SpreadRate, OfTwoFrontsThatMeetHasNoHole) {
    const auto t_s = raster_of(21, 9, [](double x_m, double) { return 4000.0 - std::abs(x_m - 200.0) / 0.25; });
    for (const float rate_m_s : spread_rate_m_s(t_s, 10.0).values) EXPECT_NEAR(rate_m_s, 0.25, 1e-5);
}

// Arrival times rounded to output steps of 60 s, three cells each at 1 m/s: plateaus with steps between them.
TEST(SpreadRate, SurvivesPlateausOfRoundedTimes) {
    const auto t_s = raster_of(40, 15, [](double x_m, double) { return 60.0 * std::floor(x_m / 60.0); });
    const auto rate = spread_rate_m_s(t_s, 10.0);
    double sum_m_s = 0.0;
    for (const float rate_m_s : rate.values) {
        EXPECT_NEAR(rate_m_s, 1.0, 0.25);
        sum_m_s += rate_m_s;
    }
    EXPECT_NEAR(sum_m_s / static_cast<double>(rate.values.size()), 1.0, 0.05);
}

TEST(SpreadRate, IsUnknownWhereTheFireNeverCameAndExactBesideIt) {
    const auto t_s = raster_of(20, 20, [](double x_m, double y_m) {
        return x_m < 200.0 && y_m < 250.0 ? x_m / 0.4 : static_cast<double>(test::kNaN);
    });
    const auto rate = spread_rate_m_s(t_s, 10.0);
    for (std::size_t i = 0; i < rate.values.size(); ++i) {
        if (std::isnan(t_s.values[i])) {
            EXPECT_TRUE(std::isnan(rate.values[i]));
        } else {
            EXPECT_NEAR(rate.values[i], 0.4, 1e-5);
        }
    }
}

// A patch that was all lit at once and never spread tells nothing.
TEST(SpreadRate, OfAnIgnitionWithoutSpreadIsUnknown) {
    for (const float rate_m_s : spread_rate_m_s(raster_of(5, 5, [](double, double) { return 0.0; }), 10.0).values)
        EXPECT_TRUE(std::isnan(rate_m_s));
}

// 6 x 6 cells lit at once, then 0.5 m/s outwards as a growing square. Beside the patch windows see part of it and are too fast.
TEST(SpreadRate, OfALitPatchIsThatOfTheFireAroundIt) {
    const auto t_s = raster_of(41, 41, [](double x_m, double y_m) {
        return std::max(0.0, std::max(std::abs(x_m - 400.0), std::abs(y_m - 400.0)) - 50.0) / 0.5;
    });
    const auto rate = spread_rate_m_s(t_s, 10.0);
    for (int r = 0; r < 41; ++r) {
        for (int c = 0; c < 41; ++c) {
            const int along = std::min(std::abs(c - 20), std::abs(r - 20)),
                      out = std::max(std::abs(c - 20), std::abs(r - 20));
            EXPECT_GT(rate.at(r, c), 0.45F);
            EXPECT_LT(rate.at(r, c), 2.0F);
            if (out > 4 && out - along > 4) {
                EXPECT_NEAR(rate.at(r, c), 0.5, 1e-5) << r << " " << c;
            }
        }
    }
}

TEST(SpreadRate, IsCappedAtTheMaximum) {
    const auto t_s = raster_of(10, 10, [](double x_m, double) { return x_m / 50.0; });
    for (const float rate_m_s : spread_rate_m_s(t_s, 6.0).values) EXPECT_EQ(rate_m_s, 6.0F);
}

TEST(TerrainSlope, IsRiseOverRunEastAndNorth) {
    auto terrain_m = raster_of(6, 5, [](double x_m, double y_m) { return 100.0 + 0.3 * x_m - 0.1 * y_m; });
    terrain_m.at(2, 2) = test::kNaN;
    const auto slope = terrain_slope(terrain_m);
    for (int r = 0; r < 5; ++r) {
        for (int c = 0; c < 6; ++c) {
            if (r == 2 && c == 2) continue;
            EXPECT_NEAR(slope.east.at(r, c), 0.3, 1e-5);
            EXPECT_NEAR(slope.north.at(r, c), 0.1, 1e-5);
        }
    }
}

// Tall grass (fuel model 3): 4921.26 1/m -> 15.36 s. Fuel model 4: 1.1230 kg/m2 of 2000, 0.8984 of 109, 0.4492 of 30 and 1.1230 of
// 1500 1/ft -> 13.24718 s.
TEST(ResidenceTime, MatchesTheWorkedValues) {
    EXPECT_NEAR(residence_time_s(4921.2598), 15.36, 1e-5);
    constexpr double kFoot_m = 0.3048;
    const FuelParticles chaparral[] = {
        {0.23, 2000.0 / kFoot_m}, {0.184, 109.0 / kFoot_m}, {0.092, 30.0 / kFoot_m}, {0.23, 1500.0 / kFoot_m}};
    EXPECT_NEAR(residence_time_s(characteristic_surface_to_volume_per_m(chaparral)), 13.24718, 1e-5);
    EXPECT_EQ(residence_time_s(0.0), 0.0);
    EXPECT_EQ(characteristic_surface_to_volume_per_m({}), 0.0);
}

}  // namespace
}  // namespace pyroscene::fire
