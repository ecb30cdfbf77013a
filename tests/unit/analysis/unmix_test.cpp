#include "analysis/unmix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace pyroscene::analysis {
namespace {

// Worked example: six bands, fire, scar and grass; every number below was computed with an independent program.
const Endmembers kThree{{"fire", "scar", "grass"},
                        6,
                        {9.0, 7.5, 6.0, 4.0, 2.5, 1.5, 1.5, 2.5, 3.2, 3.0, 2.4, 2.0, 0.4, 0.6, 1.1, 1.6, 1.9, 2.0}};
const std::vector<float> kX1{3.28F, 3.05F, 2.98F, 2.49F, 2.03F, 1.80F};
const std::vector<float> kX2{0.741F, 1.162F, 1.735F, 2.029F, 2.038F, 2.004F};
const std::vector<float> kX3{0.2F, 0.5F, 1.0F, 1.55F, 1.95F, 2.1F};

struct Result {
    std::vector<float> fractions, residual_rms, chosen, unexplained;
};

Result unmix(const Endmembers& library, const UnmixSettings& settings, const std::vector<float>& pixels) {
    const auto n = pixels.size() / static_cast<std::size_t>(library.bands);
    Result r{std::vector<float>(n * static_cast<std::size_t>(library.count())), std::vector<float>(n), std::vector<float>(n),
             std::vector<float>(n)};
    Unmixer(library, settings)
        .unmix(pixels.data(), static_cast<std::ptrdiff_t>(n), static_cast<int>(n),
               {r.fractions, r.residual_rms, r.chosen, r.unexplained});
    return r;
}

void expect_fractions(const Result& r, std::array<double, 3> expected, double tolerance = 1e-6) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(r.fractions[j], expected[j], tolerance) << j;
}

UnmixSettings plain(LeastSquares solver) { return {.stepwise = false, .solver = solver}; }

TEST(FTest, HasTheQuantilesOfTables) {
    EXPECT_NEAR(f_threshold(0.10, 3), 5.538319, 1e-5);
    EXPECT_NEAR(f_threshold(0.05, 3), 10.127964, 1e-5);
    EXPECT_NEAR(f_threshold(0.01, 3), 34.116222, 1e-5);
    EXPECT_NEAR(f_threshold(0.05, 4), 7.708647, 1e-5);
}

TEST(Unmix, LeastSquaresOfTheWorkedExample) {
    const Result r = unmix(kThree, plain(LeastSquares::Unconstrained), kX1);
    expect_fractions(r, {0.31595826, 0.16366940, 0.47387891});
    EXPECT_NEAR(r.residual_rms[0] * r.residual_rms[0] * 6.0, 0.0076609315, 1e-7);
    EXPECT_EQ(r.chosen[0], 7.0F);
}

TEST(Unmix, ConstraintsOfTheWorkedExample) {
    for (const auto solver : {LeastSquares::SumToOne, LeastSquares::FullyConstrained}) {
        const Result r = unmix(kThree, plain(solver), kX1);
        expect_fractions(r, {0.32338778, 0.11117817, 0.56543405});
        EXPECT_NEAR(r.residual_rms[0] * r.residual_rms[0] * 6.0, 0.02196065, 1e-6);
    }
    expect_fractions(unmix(kThree, plain(LeastSquares::Unconstrained), kX3), {-0.02037548, -0.01460233, 1.06974662});
    expect_fractions(unmix(kThree, plain(LeastSquares::SumToOne), kX3), {-0.02593144, 0.02465178, 1.00127967});
    expect_fractions(unmix(kThree, plain(LeastSquares::NonNegative), kX3), {0.0, 0.0, 0.99705882});
    const Result r = unmix(kThree, plain(LeastSquares::FullyConstrained), kX3);
    expect_fractions(r, {0.0, 0.0, 1.0});
    EXPECT_NEAR(r.residual_rms[0] * r.residual_rms[0] * 6.0, 0.075, 1e-6);
    EXPECT_EQ(r.chosen[0], 4.0F);
}

TEST(Unmix, StepwiseSelectionOfTheWorkedExample) {
    expect_fractions(unmix(kThree, {}, kX1), {0.31595826, 0.16366940, 0.47387891});  // F of scar 18.46 > 10.13
    const Result strict = unmix(kThree, {.alpha_enter = 0.01, .alpha_remove = 0.01}, kX1);
    expect_fractions(strict, {0.34981148, 0.0, 0.65285201});  // 18.46 < 34.12
    EXPECT_NEAR(strict.residual_rms[0] * strict.residual_rms[0] * 6.0, 0.054802201, 1e-6);
    EXPECT_EQ(strict.chosen[0], 5.0F);
    expect_fractions(unmix(kThree, {}, kX2), {0.0, 0.30155011, 0.69792260});  // F of fire 0.19
}

/// Smooth spectra, well apart: k bumps over 40 bands.
Endmembers bumps(int k) {
    Endmembers library{{}, 40, {}};
    for (int j = 0; j < k; ++j) {
        library.names.push_back("bump" + std::to_string(j));
        for (int b = 0; b < 40; ++b)
            library.spectra.push_back(0.3 + std::exp(-std::pow((b - 39.0 * (j + 0.5) / k) / (20.0 / k), 2.0)));
    }
    return library;
}

/// Pixels [band][pixel] that are mixtures with the given fractions plus normal noise.
std::vector<float> mixtures(const Endmembers& library, const std::vector<double>& fractions, double noise,
                            std::uint64_t seed) {
    const auto k = static_cast<std::size_t>(library.count()), n = fractions.size() / k;
    std::vector<float> pixels(static_cast<std::size_t>(library.bands) * n);
    for (std::size_t b = 0; b < static_cast<std::size_t>(library.bands); ++b) {
        for (std::size_t p = 0; p < n; ++p) {
            double sum = 0.0;
            for (std::size_t j = 0; j < k; ++j) sum += fractions[p * k + j] * library.spectrum(static_cast<int>(j))[b];
            const RandomKey key{seed, static_cast<std::uint32_t>(b), 0};
            pixels[b * n + p] = static_cast<float>(sum + (noise > 0.0 ? noise * standard_normal(key, p) : 0.0));
        }
    }
    return pixels;
}

TEST(Unmix, KnownMixturesWithoutNoiseAreExactForAnyNumberOfEndmembers) {
    for (const int k : {2, 5, 10, 12}) {
        const Endmembers library = bumps(k);
        std::vector<double> fractions;
        for (int p = 0; p < 50; ++p) {
            double sum = 0.0;
            for (int j = 0; j < k; ++j) {
                fractions.push_back(j % 3 == p % 3 ? 0.0 : 1.0 + (j * 7 + p * 5) % 11);
                sum += fractions.back();
            }
            for (int j = 0; j < k; ++j) fractions[fractions.size() - 1 - static_cast<std::size_t>(j)] /= sum;
        }
        const auto pixels = mixtures(library, fractions, 0.0, 0);
        for (const bool stepwise : {false, true}) {
            for (const auto solver : {LeastSquares::Unconstrained, LeastSquares::SumToOne, LeastSquares::NonNegative,
                                      LeastSquares::FullyConstrained}) {
                const Result r = unmix(library, {.stepwise = stepwise, .solver = solver}, pixels);
                for (int p = 0; p < 50; ++p)
                    for (int j = 0; j < k; ++j)
                        ASSERT_NEAR(r.fractions[static_cast<std::size_t>(j * 50 + p)],
                                    fractions[static_cast<std::size_t>(p * k + j)], 2e-5)
                            << k << ' ' << stepwise << ' ' << p << ' ' << j;
            }
        }
    }
}

TEST(Unmix, FalseInclusionsHappenAtTheChosenRate) {
    const Endmembers library = bumps(3);
    constexpr int kPixels = 20000;
    std::vector<double> fractions;
    for (int p = 0; p < kPixels; ++p) fractions.insert(fractions.end(), {0.6, 0.4, 0.0});
    const auto pixels = mixtures(library, fractions, 0.02, 3);
    for (const double alpha : {0.05, 0.2}) {
        const Result r = unmix(library, {.alpha_enter = alpha, .alpha_remove = alpha}, pixels);
        int included = 0;
        for (const float chosen : r.chosen) included += (static_cast<int>(chosen) & 4) != 0 ? 1 : 0;
        EXPECT_NEAR(static_cast<double>(included) / kPixels, alpha, 0.01);
    }
}

TEST(Unmix, FiveEndmembersAtASignalToNoiseOf200) {
    const Endmembers library = bumps(5);
    std::vector<double> fractions;
    for (int p = 0; p < 2000; ++p) {
        const double a = p % 7 / 7.0;
        fractions.insert(fractions.end(), {0.5 * a, 0.0, 0.5 - 0.5 * a, 0.3, 0.2});
    }
    const Result r = unmix(library, {}, mixtures(library, fractions, 0.6 / 200.0, 4));
    double squares = 0.0;
    for (std::size_t p = 0; p < 2000; ++p)
        for (std::size_t j = 0; j < 5; ++j) squares += std::pow(r.fractions[j * 2000 + p] - fractions[p * 5 + j], 2.0);
    EXPECT_LT(std::sqrt(squares / 10000.0), 0.02);
}

TEST(Unmix, NoiseWeightsTheBands) {
    const Endmembers library = bumps(2);
    auto pixels = mixtures(library, {0.7, 0.3}, 0.0, 0);
    pixels[5] += 10.0F;  // a band gone wrong, known to be noisy
    UnmixSettings settings = plain(LeastSquares::Unconstrained);
    settings.noise.assign(40, 0.01);
    settings.noise[5] = 1e6;
    const Result weighted = unmix(library, settings, pixels);
    EXPECT_NEAR(weighted.fractions[0], 0.7, 1e-4);
    EXPECT_EQ(weighted.unexplained[0], 0.0F);
    const Result even = unmix(library, plain(LeastSquares::Unconstrained), pixels);
    EXPECT_GT(std::abs(even.fractions[0] - 0.7F), 0.05F);
    EXPECT_EQ(even.unexplained[0], 1.0F);
}

TEST(Unmix, PixelsThatAreNoMixtureAreFlaggedAtTheChosenRate) {
    const Endmembers library = bumps(3);
    std::vector<double> fractions;
    for (int p = 0; p < 20000; ++p) fractions.insert(fractions.end(), {0.2, 0.5, 0.3});
    UnmixSettings settings = plain(LeastSquares::Unconstrained);
    settings.noise.assign(40, 0.02);
    settings.unexplained_alpha = 0.02;
    const Result r = unmix(library, settings, mixtures(library, fractions, 0.02, 5));
    double flagged = 0.0;
    for (const float flag : r.unexplained) flagged += static_cast<double>(flag);
    EXPECT_NEAR(flagged / 20000.0, 0.02, 0.004);
}

TEST(Unmix, PixelsWithoutDataStayWithoutData) {
    auto pixels = mixtures(kThree, {0.5, 0.5, 0.0, 0.1, 0.2, 0.7}, 0.0, 0);
    pixels[3] = std::nanf("");  // second band of the second pixel
    const Result r = unmix(kThree, {}, pixels);
    EXPECT_NEAR(r.fractions[0], 0.5, 1e-5);
    EXPECT_TRUE(std::isnan(r.fractions[1]));
    EXPECT_TRUE(std::isnan(r.unexplained[1]));
    const Result dark = unmix(kThree, {}, std::vector<float>(6, 0.0F));
    EXPECT_EQ(dark.fractions[0], 0.0F);
}

TEST(Unmix, RefusesLibrariesThatCannotBeUnmixed) {
    Endmembers twice = kThree;
    for (std::size_t b = 0; b < 6; ++b) twice.spectra[12 + b] = 2.0 * twice.spectra[b] + twice.spectra[6 + b];
    EXPECT_THROW(Unmixer(twice, {}), Error);
    Endmembers wide{{"a", "b", "c"}, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    EXPECT_THROW(Unmixer(wide, {}), Error);
    EXPECT_THROW(Unmixer(kThree, {.alpha_enter = 0.1, .alpha_remove = 0.05}), Error);
    EXPECT_THROW(Unmixer(kThree, {.noise = {1.0, 1.0}}), Error);
}

}  // namespace
}  // namespace pyroscene::analysis
