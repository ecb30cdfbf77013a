#include "spread/wind_profile.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pyroscene::spread {
namespace {

using Kind = WindLevel::Kind;

constexpr double kFoot_m = 0.3048;

struct Published {
    double depth_ft, factor;
};

// Andrews 2012 (RMRS-GTR-266), factors of fuel models 8, 1, 5, 12, 3, 13 and 4 to two digits.
TEST(WindProfile, MidflameOverOpenFuelIsAsPublished) {
    for (const auto& [depth_ft, factor] :
         {Published{0.2, 0.28}, {1.0, 0.36}, {2.0, 0.42}, {2.3, 0.43}, {2.5, 0.44}, {3.0, 0.46}, {6.0, 0.55}}) {
        EXPECT_NEAR(wind_adjustment(depth_ft * kFoot_m, {}), factor, 0.005) << depth_ft;
        EXPECT_NEAR(
            to_twenty_feet({.kind = Kind::Midflame}, depth_ft * kFoot_m, {}) * wind_adjustment(depth_ft * kFoot_m, {}), 1.0,
            1e-12);
    }
}

TEST(WindProfile, TreesShelterWhereTheyAreDenseAndHigh) {
    // 0.555 / (sqrt(f H) ln((20 + 0.36 H) / (0.13 H))) for H = 60 ft, f = 0.5 x 0.5 / 3.
    const Canopy trees{.cover = 0.5, .height_m = 60.0 * kFoot_m, .crown_ratio = 0.5};
    EXPECT_NEAR(wind_adjustment(0.3, trees), 0.555 / (std::sqrt(5.0) * std::log(41.6 / 7.8)), 1e-9);
    EXPECT_TRUE(shelters(trees));
    EXPECT_FALSE(shelters({.cover = 0.2, .height_m = 60.0 * kFoot_m, .crown_ratio = 0.5}));  // fills 3 %
    EXPECT_FALSE(shelters({.cover = 0.9, .height_m = 5.9 * kFoot_m, .crown_ratio = 0.9}));
    EXPECT_EQ(wind_adjustment(0.3, {.cover = 0.2, .height_m = 18.0, .crown_ratio = 0.5}), wind_adjustment(0.3, {}));
}

TEST(WindProfile, HeightsConvertByTheLogarithmOfHeightOverRoughness) {
    EXPECT_EQ(to_twenty_feet({.kind = Kind::TwentyFeet}, 0.5, {}), 1.0);
    EXPECT_NEAR(to_twenty_feet({.kind = Kind::TenMetres}, 0.5, {}), 1.0 / 1.15, 1e-12);
    // z0 = 0.03 m: ln(203.2) / ln(333.33).
    EXPECT_NEAR(to_twenty_feet({.kind = Kind::Metres, .height_m = 10.0, .roughness_m = 0.03}, 0.5, {}), 5.314190 / 5.809143,
                1e-6);
    // Over a bed of h = 1 m: ln((6.096 + 0.36) / 0.13) / ln((z + 0.36) / 0.13).
    EXPECT_NEAR(to_twenty_feet({.kind = Kind::Metres, .height_m = 10.0}, 1.0, {}),
                std::log(6.456 / 0.13) / std::log(10.36 / 0.13), 1e-12);
    // The customary factor 1.15 lies between that of grass and that of a forest.
    EXPECT_GT(to_twenty_feet({.kind = Kind::Metres, .height_m = 10.0}, 0.3, {}), 1.0 / 1.15);
    EXPECT_LT(
        to_twenty_feet({.kind = Kind::Metres, .height_m = 10.0}, 0.3, {.cover = 0.8, .height_m = 20.0, .crown_ratio = 0.6}),
        1.0 / 1.10);
    for (const double h_m : {0.06, 0.3, 2.0})
        EXPECT_NEAR(to_twenty_feet({.kind = Kind::Metres, .height_m = 6.096}, h_m, {}), 1.0, 1e-12);
}

}  // namespace
}  // namespace pyroscene::spread
