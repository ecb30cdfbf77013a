#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "sensors/framing.h"

namespace pyroscene::sensors {
namespace {

/// Variance of the points along one axis (0 = sample, 1 = line).
double variance(const PixelSamples& points, std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.offset.size(); ++i)
        sum += points.weight[i] * points.offset[i][axis] * points.offset[i][axis];
    return sum;
}

struct Shape {
    const char* name;
    Psf psf;
    double variance;  ///< of the continuous shape, closed form
};
void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

const Shape kShapes[] = {
    {"none", {Psf::Shape::None}, 1.0 / 12.0},                                          // the pixel itself
    {"box", {Psf::Shape::Box, 1.5}, 2.25 / 12.0},                                      // width^2 / 12
    {"triangle", {Psf::Shape::Triangle, 2.0}, 4.0 / 24.0},                             // base^2 / 24
    {"trapezoid", {Psf::Shape::Trapezoid, 1.362, 1.0}, (1.362 * 1.362 + 1.0) / 12.0},  // sum of the two boxes
    {"gaussian", {Psf::Shape::Gaussian, 1.1}, 1.21 / (8.0 * std::log(2.0))},           // (fwhm / 2.3548)^2
};

class EveryShape : public testing::TestWithParam<Shape> {};

TEST_P(EveryShape, PointsAreSymmetricEquallyWeightedAndSpreadLikeThePsf) {
    const Shape& shape = GetParam();
    for (const int n : {1, 2, 3, 5, 8}) {
        const PixelSamples points = pixel_samples(shape.psf, shape.psf, n);
        ASSERT_EQ(points.offset.size(), static_cast<std::size_t>(n * n));
        double weight = 0.0, mean_sample = 0.0, mean_line = 0.0;
        for (std::size_t i = 0; i < points.offset.size(); ++i) {
            const auto& mirrored = points.offset[points.offset.size() - 1 - i];
            EXPECT_EQ(points.offset[i][0], -mirrored[0]);
            EXPECT_EQ(points.offset[i][1], -mirrored[1]);
            weight += points.weight[i];
            mean_sample += points.weight[i] * points.offset[i][0];
            mean_line += points.weight[i] * points.offset[i][1];
        }
        EXPECT_NEAR(weight, 1.0, 1e-14);
        EXPECT_NEAR(mean_sample, 0.0, 1e-14);
        EXPECT_NEAR(mean_line, 0.0, 1e-14);
        if (n % 2 == 1) {
            EXPECT_EQ(points.offset[points.offset.size() / 2], (std::array{0.0, 0.0}));
        }
    }
    // Centroids lose the spread inside the strata, which shrinks as the strata do.
    double before = 0.0;
    for (const int n : {5, 10, 40, 200}) {
        const PixelSamples points = pixel_samples(shape.psf, shape.psf, n);
        const double ratio = variance(points, 0) / shape.variance;
        EXPECT_NEAR(variance(points, 0), variance(points, 1), 1e-10);
        EXPECT_GT(ratio, std::max(before, 0.87)) << n;
        EXPECT_LT(ratio, 1.0) << n;
        before = ratio;
    }
    EXPECT_GT(before, 0.998);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(kShapes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(EveryShape, SharesAreTheStrataAndTheirHalvesKeepTheCentroid) {
    const Psf& psf = GetParam().psf;
    constexpr int kBase = 3;
    const PsfShares shares(psf, kBase);
    const auto points = pixel_samples(psf, psf, kBase);
    for (int i = 0; i < kBase; ++i)
        EXPECT_NEAR(shares.share(0, i).centre, points.offset[static_cast<std::size_t>(i)][0], 1e-12);
    for (int level = 0; level < PsfShares::kLevels; ++level) {
        double variance = 0.0;
        const int count = kBase << level;
        for (int i = 0; i < count; ++i) {
            const auto whole = shares.share(level, i), left = shares.share(level + 1, 2 * i),
                       right = shares.share(level + 1, 2 * i + 1);
            ASSERT_NEAR(0.5 * (left.centre + right.centre), whole.centre, 1e-10);
            ASSERT_LT(left.centre, right.centre);
            ASSERT_GT(whole.width, 0.0);
            variance += whole.centre * whole.centre / count;
        }
        // Strata's centroids miss the variance inside a stratum, which falls with every level.
        EXPECT_LT(variance, GetParam().variance);
        if (level >= 6) {
            EXPECT_NEAR(variance / GetParam().variance, 1.0, 2e-3);
        }
    }
}

TEST(PixelSamples, ABoxIsCutIntoEqualParts) {
    const PixelSamples points = pixel_samples({Psf::Shape::None}, {Psf::Shape::Box, 2.0}, 4);
    EXPECT_NEAR(points.offset[0][0], -0.375, 1e-14);
    EXPECT_NEAR(points.offset[1][0], -0.125, 1e-14);
    EXPECT_NEAR(points.offset[0][1], -0.75, 1e-14);
    EXPECT_NEAR(points.offset[15][1], 0.75, 1e-14);
}

TEST(PixelSamples, TwoPointsOfEachShapeStandAtTheMeanOfItsHalf) {
    const auto point = [](const Psf& psf) { return pixel_samples(psf, psf, 2).offset[3][0]; };
    EXPECT_NEAR(point({Psf::Shape::Box, 1.0}), 0.25, 1e-14);
    EXPECT_NEAR(point({Psf::Shape::Triangle, 2.0}), 1.0 / 3.0, 1e-14);  // of (1 - x) on 0..1
    const double sigma = 1.1 / std::sqrt(8.0 * std::log(2.0));
    EXPECT_NEAR(point({Psf::Shape::Gaussian, 1.1}), sigma * std::sqrt(2.0 / M_PI), 1e-12);  // half-normal mean
    // Boxes of 2 and 1: flat 1/2 up to 1/2, then a ramp to 3/2: integral of x f over the half, doubled.
    EXPECT_NEAR(point({Psf::Shape::Trapezoid, 2.0, 1.0}), 2.0 * (0.0625 + 5.0 / 24.0), 1e-14);
}

TEST(PixelSamples, RefuseNonsense) {
    EXPECT_THROW(static_cast<void>(pixel_samples({}, {}, 0)), Error);
    EXPECT_THROW(static_cast<void>(pixel_samples({Psf::Shape::Box, 0.0}, {}, 2)), Error);
}

}  // namespace
}  // namespace pyroscene::sensors
