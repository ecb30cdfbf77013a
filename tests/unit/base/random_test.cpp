#include "base/random.h"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace pyroscene {
namespace {

using Words = std::array<std::uint32_t, 4>;

// Known-answer vectors of the generator's authors: Random123, examples/kat_vectors, "philox4x32 10".
TEST(Philox4x32, GivesThePublishedVectors) {
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    // Digits of pi as counter and key.
    EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// FNV-1a, 32 bits: vectors of the authors (Noll's fnv test suite).
TEST(StreamId, IsFnv1a) {
    EXPECT_EQ(stream_id(""), 0x811c9dc5u);
    EXPECT_EQ(stream_id("a"), 0xe40c292cu);
    EXPECT_EQ(stream_id("foobar"), 0xbf9cf968u);
}

struct Moments {
    double mean = 0.0, variance = 0.0, fourth = 0.0;
};

template <class Draw>
Moments moments(int count, Draw draw) {
    double sum = 0.0, squares = 0.0, fourths = 0.0;
    for (int i = 0; i < count; ++i) {
        const double x = draw(static_cast<std::uint64_t>(i));
        sum += x, squares += x * x, fourths += x * x * x * x;
    }
    return {sum / count, squares / count - (sum / count) * (sum / count), fourths / count};
}

// Means within four standard errors of the exact moments; the draws are fixed, so this passes always or never.
TEST(Uniform01, HasTheMomentsOfTheUniformDistribution) {
    constexpr int kCount = 200000;
    const RandomKey key{.seed = 7, .stream = stream_id("test"), .frame = 3};
    const Moments m = moments(kCount, [&](std::uint64_t i) { return uniform01(key, i); });
    EXPECT_NEAR(m.mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kCount));
    EXPECT_NEAR(m.variance, 1.0 / 12.0, 4.0 * std::sqrt(1.0 / 180.0 / kCount));
}

TEST(StandardNormal, HasTheMomentsOfTheNormalDistribution) {
    constexpr int kCount = 200000;
    const RandomKey key{.seed = 7, .stream = stream_id("test"), .frame = 3};
    const Moments m = moments(kCount, [&](std::uint64_t i) { return standard_normal(key, i); });
    EXPECT_NEAR(m.mean, 0.0, 4.0 * std::sqrt(1.0 / kCount));
    EXPECT_NEAR(m.variance, 1.0, 4.0 * std::sqrt(2.0 / kCount));
    EXPECT_NEAR(m.fourth, 3.0, 4.0 * std::sqrt(96.0 / kCount));
}

TEST(Uniform01, LiesInTheOpenInterval) {
    const RandomKey key{.seed = 1, .stream = 2, .frame = 3};
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const double u = uniform01(key, i);
        ASSERT_GT(u, 0.0);
        ASSERT_LT(u, 1.0);
    }
}

TEST(Uniform01, EveryPartOfTheKeyChangesTheDraw) {
    const RandomKey base{.seed = 1, .stream = 2, .frame = 3};
    RandomKey low = base, high = base, stream = base, frame = base;
    low.seed = 2, high.seed = 1 + (std::uint64_t{1} << 32), stream.stream = 3, frame.frame = 4;
    const std::set<double> draws{
        uniform01(base, 5),  uniform01(low, 5),  uniform01(high, 5),    uniform01(stream, 5),
        uniform01(frame, 5), uniform01(base, 6), uniform01(base, 5, 1), uniform01(base, 5 + (std::uint64_t{1} << 32))};
    EXPECT_EQ(draws.size(), 8u);
}

}  // namespace
}  // namespace pyroscene
