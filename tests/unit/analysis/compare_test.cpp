#include "analysis/compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pyroscene::analysis {
namespace {

constexpr int kCols = 40, kRows = 30;

std::vector<float> waves(double phase) {
    std::vector<float> out;
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col) out.push_back(static_cast<float>(std::sin(0.3 * col + phase) + 0.02 * row));
    return out;
}

std::vector<unsigned char> square(int col, int row, int size) {
    std::vector<unsigned char> mask(kCols * kRows, 0);
    for (int r = row; r < row + size; ++r)
        for (int c = col; c < col + size; ++c) mask[static_cast<std::size_t>(r * kCols + c)] = 1;
    return mask;
}

TEST(Compare, EqualPlanesAgreePerfectly) {
    const auto a = waves(0.0);
    const auto same = agreement(a, a, kCols, kRows);
    EXPECT_EQ(same.pixels, kCols * kRows);
    EXPECT_EQ(same.rmse, 0.0);
    EXPECT_NEAR(same.correlation, 1.0, 1e-12);
    EXPECT_NEAR(same.ssim, 1.0, 1e-12);
}

TEST(Compare, AKnownOffsetIsTheBias) {
    const auto a = waves(0.0);
    auto b = a;
    for (float& v : b) v -= 0.25F;
    b[7] = std::nanf("");
    const auto moved = agreement(a, b, kCols, kRows);
    EXPECT_EQ(moved.pixels, kCols * kRows - 1);
    EXPECT_NEAR(moved.bias, 0.25, 1e-6);
    EXPECT_NEAR(moved.rmse, 0.25, 1e-6);
    EXPECT_NEAR(moved.mae, 0.25, 1e-6);
    EXPECT_NEAR(moved.correlation, 1.0, 1e-6);
    EXPECT_LT(moved.ssim, 0.99);
}

TEST(Compare, OppositeTexturesAreDissimilar) {
    const auto a = waves(0.0), b = waves(3.14159265);
    const auto opposite = agreement(a, b, kCols, kRows);
    EXPECT_LT(opposite.correlation, -0.5);
    EXPECT_LT(opposite.ssim, 0.5);
    EXPECT_GT(structural_similarity(a, waves(0.2), kCols, kRows), structural_similarity(a, waves(0.6), kCols, kRows));
}

TEST(Compare, DistancesAreExact) {
    std::vector<unsigned char> mask(kCols * kRows, 0);
    mask[3 * kCols + 5] = mask[20 * kCols + 33] = 1;
    const auto distance = distance_from(mask, kCols, kRows);
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col)
            ASSERT_NEAR(distance[static_cast<std::size_t>(row * kCols + col)],
                        std::min(std::hypot(col - 5, row - 3), std::hypot(col - 33, row - 20)), 1e-5);
    EXPECT_TRUE(std::isinf(distance_from(std::vector<unsigned char>(kCols * kRows, 0), kCols, kRows)[0]));
}

TEST(Compare, SquaresThatOverlapByHalf) {
    const auto a = square(10, 10, 8), b = square(14, 10, 8);
    const auto half = mask_agreement(a, b, kCols, kRows);
    EXPECT_EQ(half.both, 32);
    EXPECT_EQ(half.only_a, 32);
    EXPECT_EQ(half.only_b, 32);
    EXPECT_DOUBLE_EQ(half.dice, 0.5);
    EXPECT_GT(half.front_distance_mean, 0.5);
    EXPECT_LE(half.front_distance_95, 4.0);
    const auto inner =
        mask_agreement(square(12, 12, 4), a, kCols, kRows);  // all outlines 2 pixels apart or, at corners, more
    EXPECT_NEAR(inner.front_distance_mean, 2.0, 0.35);
    const auto same = mask_agreement(a, a, kCols, kRows);
    EXPECT_EQ(same.dice, 1.0);
    EXPECT_EQ(same.front_distance_mean, 0.0);
    const std::vector<unsigned char> none(kCols * kRows, 0);
    EXPECT_EQ(mask_agreement(none, none, kCols, kRows).dice, 1.0);
    EXPECT_TRUE(std::isnan(mask_agreement(a, none, kCols, kRows).front_distance_mean));
}

TEST(Compare, ShiftsMoveThePlane) {
    const auto a = waves(0.0);
    const auto b = shifted(a, kCols, kRows, 3.0, -2.0);
    EXPECT_FLOAT_EQ(b[static_cast<std::size_t>(10 * kCols + 20)], a[static_cast<std::size_t>(12 * kCols + 17)]);
    EXPECT_TRUE(std::isnan(b[0]));
    const auto c = shifted(a, kCols, kRows, 0.5, 0.0);
    EXPECT_NEAR(c[25], 0.5 * (a[24] + a[25]), 1e-6);
}

}  // namespace
}  // namespace pyroscene::analysis
