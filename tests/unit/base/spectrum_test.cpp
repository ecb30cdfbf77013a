#include "base/spectrum.h"

#include <gtest/gtest.h>

namespace pyroscene {
namespace {

const Spectrum kTent{.kind = Quantity::Response, .lambda_um = {1.0, 2.0, 4.0}, .value = {0.0, 3.0, 1.0}};

TEST(Spectrum, InterpolatesLinearlyAndHitsItsSamples) {
    EXPECT_DOUBLE_EQ(kTent.at(1.0), 0.0);
    EXPECT_DOUBLE_EQ(kTent.at(1.5), 1.5);
    EXPECT_DOUBLE_EQ(kTent.at(2.0), 3.0);
    EXPECT_DOUBLE_EQ(kTent.at(3.0), 2.0);
    EXPECT_DOUBLE_EQ(kTent.at(4.0), 1.0);
}

TEST(Spectrum, OutsideIsTheEndValueOrZero) {
    EXPECT_DOUBLE_EQ(kTent.at(9.0), 1.0);
    EXPECT_DOUBLE_EQ(kTent.at(9.0, false), 0.0);
    EXPECT_DOUBLE_EQ(kTent.at(0.5), 0.0);
    EXPECT_DOUBLE_EQ(Spectrum{}.at(1.0), 0.0);
}

// Areas of the trapezoids by hand: 1.5 on [1, 2] and 4 on [2, 4].
TEST(MeanOver, IsTheExactIntegralOfThePolyline) {
    EXPECT_DOUBLE_EQ(mean_over(kTent, 1.0, 4.0), 5.5 / 3.0);
    EXPECT_DOUBLE_EQ(mean_over(kTent, 1.0, 2.0), 1.5);
    EXPECT_DOUBLE_EQ(mean_over(kTent, 2.0, 4.0), 2.0);
    // 1.5 -> 2: mean 2.25, length 0.5; 2 -> 3: mean 2.5, length 1.
    EXPECT_DOUBLE_EQ(mean_over(kTent, 1.5, 3.0), (1.125 + 2.5) / 1.5);
    EXPECT_DOUBLE_EQ(mean_over(kTent, 2.25, 2.75), 2.5);
}

TEST(MeanOver, ExtendsTheEnds) {
    EXPECT_DOUBLE_EQ(mean_over(kTent, 5.0, 6.0), 1.0);
    EXPECT_DOUBLE_EQ(mean_over(kTent, 0.0, 6.0), (0.0 + 5.5 + 2.0) / 6.0);
}

TEST(MeanOver, IsAdditiveOverNeighbouringIntervals) {
    const double whole = 2.9 * mean_over(kTent, 0.7, 3.6);
    EXPECT_NEAR(1.1 * mean_over(kTent, 0.7, 1.8) + 1.8 * mean_over(kTent, 1.8, 3.6), whole, 1e-14);
}

TEST(MeanOver, ASingleSampleIsAConstant) {
    const Spectrum flat{.kind = Quantity::Reflectance, .lambda_um = {2.0}, .value = {0.3}};
    EXPECT_DOUBLE_EQ(mean_over(flat, 1.0, 3.0), 0.3);
}

}  // namespace
}  // namespace pyroscene
