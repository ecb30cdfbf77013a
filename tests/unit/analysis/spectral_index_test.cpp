#include "analysis/spectral_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "radiometry/planck.h"

namespace pyroscene::analysis {
namespace {

double value(const char* name, const std::vector<float>& bands, std::vector<double> um = {}) {
    const auto* index = find_spectral_index(name);
    EXPECT_NE(index, nullptr) << name;
    if (um.empty())
        for (int b = 0; b < index->bands; ++b) um.push_back(index->band[static_cast<std::size_t>(b)].best_um);
    std::vector<std::span<const float>> planes;
    for (const float& v : bands) planes.emplace_back(&v, 1);
    return static_cast<double>(spectral_index(*index, planes, um)[0]);
}

TEST(SpectralIndex, FollowsItsFormula) {
    EXPECT_NEAR(value("ndvi", {0.5F, 0.1F}), 2.0 / 3.0, 1e-6);
    EXPECT_NEAR(value("nbr", {0.3F, 0.1F}), 0.5, 1e-6);
    EXPECT_NEAR(value("co2", {2.0F, 4.0F, 10.0F}), 2.0 / (0.666 * 4.0 + 0.334 * 10.0), 1e-6);
    EXPECT_NEAR(value("aviris-k", {7.0F, 5.0F}), 1.4, 1e-6);
    EXPECT_NEAR(value("aviris-co2", {3.0F, 1.0F}), 2.0, 1e-6);
    EXPECT_NEAR(value("akbd", {60.0F, 50.0F}), 10.0, 1e-6);
    EXPECT_TRUE(std::isnan(value("ndvi", {0.0F, 0.0F})));
    EXPECT_TRUE(std::isnan(value("nbr", {std::nanf(""), 0.1F})));
    EXPECT_EQ(find_spectral_index("evi"), nullptr);
}

TEST(SpectralIndex, PotassiumStandsOverALineThroughBothSides) {
    // A sloping spectrum without the line has no contrast wherever the bands lie; half of the continuum on top gives 0.5.
    const std::vector<double> um{0.7721, 0.7526, 0.7819};
    const auto slope = [](double w) { return 100.0 - 80.0 * w; };
    const auto f = [](double v) { return static_cast<float>(v); };
    EXPECT_NEAR(value("k-line", {f(slope(um[0])), f(slope(um[1])), f(slope(um[2]))}, um), 0.0, 1e-6);
    EXPECT_NEAR(value("k-line", {f(1.5 * slope(um[0])), f(slope(um[1])), f(slope(um[2]))}, um), 0.5, 1e-6);
}

TEST(SpectralIndex, FireRaisesHfdiAboveSunlitGround) {
    // Black bodies in both bands: 2.429 over 2.061 um falls with temperature; sunlit ground has more at 2.061 um.
    for (const double T_K : {700.0, 1000.0, 1200.0}) {
        const double a = radiometry::planck_radiance(2.429, T_K), b = radiometry::planck_radiance(2.061, T_K);
        EXPECT_NEAR(value("hfdi", {static_cast<float>(a), static_cast<float>(b)}), (a - b) / (a + b), 1e-6);
        EXPECT_GT((a - b) / (a + b), -0.05);
    }
}

TEST(DetectByIndex, FindsWhatStandsOutAndNothingInNoise) {
    const auto& index = *find_spectral_index("hfdi");
    std::mt19937_64 random(3);
    std::normal_distribution<float> normal(-0.4F, 0.02F);
    std::vector<float> values(100000);
    for (float& v : values) v = normal(random);
    const auto quiet = detect_by_index({.values = values}, index, {});
    EXPECT_NEAR(quiet.scene.median, -0.4, 0.001);
    EXPECT_NEAR(quiet.scene.deviation, 0.02, 0.001);
    const auto count = [](const Detection& d) { return std::count_if(d.fire.begin(), d.fire.end(), is_fire); };
    EXPECT_EQ(count(quiet.result), 0);
    values[16] = -0.25F;  // 7.5 deviations, but sunlit char gets there too
    values[17] = -0.12F;  // 14
    values[18] = 0.2F;    // 30
    values[19] = std::nanf("");
    const auto found = detect_by_index({.values = values}, index, {});
    EXPECT_EQ(count(found.result), 2);
    EXPECT_EQ(found.result.fire[17], FireClass::Nominal);
    EXPECT_EQ(found.result.fire[18], FireClass::High);
    EXPECT_EQ(found.result.fire[19], FireClass::NotProcessed);
    EXPECT_EQ(count(detect_by_index({.values = values}, index, {.threshold = 0.0}).result), 1);
    // A scene without any scatter: the least excess keeps rounding from being fire.
    std::vector<float> flat(1000, -0.4F);
    flat[5] = -0.395F;
    flat[6] = -0.1F;
    EXPECT_EQ(count(detect_by_index({.values = flat}, index, {}).result), 1);
    // By night only fires are lit, so that the lit pixels are no background.
    const auto& line = *find_spectral_index("k-line");
    std::vector<float> night(1000, std::nanf(""));
    std::vector<unsigned char> dark(1000, 1);
    for (std::size_t i = 0; i < 10; ++i) {
        night[i] = i < 6 ? 0.5F : -0.05F;  // flames, and glowing ground without potassium
        dark[i] = 0;
    }
    const auto lit = detect_by_index({.values = night, .dark = dark}, line, {.night = true});
    EXPECT_EQ(count(lit.result), 6);
    EXPECT_DOUBLE_EQ(lit.threshold, 0.02);
    EXPECT_EQ(lit.result.fire[500], FireClass::Clear);
}

TEST(DetectByIndex, KnowsNoiseByNightAndDetectorsAtTheirLimit) {
    const auto& line = *find_spectral_index("k-line");
    const std::vector<float> values{0.5F, 0.5F, 0.5F, -0.3F}, noise{0.05F, 0.09F, 0.0F, 0.0F};
    const std::vector<unsigned char> burnt_out{0, 0, 0, 1};
    const IndexScene scene{.values = values, .noise = noise, .burnt_out = burnt_out};
    const auto night = detect_by_index(scene, line, {.night = true}).result.fire;
    EXPECT_EQ(night,
              (std::vector{FireClass::High, FireClass::Clear, FireClass::High, FireClass::High}));  // 10, 5.6 deviations
    const auto told = detect_by_index(scene, line, {.threshold = 0.1, .night = true}).result.fire;
    EXPECT_TRUE(is_fire(told[1]));  // the user's own threshold is the only one
}

TEST(SpectralIndexNoise, IsThatOfRepeatedMeasurements) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const std::array<double, 3> L{0.9, 0.5, 0.7}, sd{0.02, 0.01, 0.015}, um{0.768, 0.7515, 0.7815};
    for (const char* name : {"k-line", "co2", "hfdi", "aviris-co2", "aviris-k"}) {
        const auto& index = *find_spectral_index(name);
        constexpr std::size_t kMany = 40000;
        std::array<std::vector<float>, 3> values;
        for (std::size_t b = 0; b < 3; ++b) {
            for (std::size_t i = 0; i < kMany; ++i) values[b].push_back(static_cast<float>(L[b] + sd[b] * normal(random)));
        }
        const std::array<std::span<const float>, 3> v{values[0], values[1], values[2]};
        const auto measured = spectral_index(index, v, um);
        double mean = 0.0, square = 0.0;
        for (const float x : measured) mean += static_cast<double>(x) / kMany;
        for (const float x : measured) square += std::pow(static_cast<double>(x) - mean, 2.0) / kMany;
        std::array<std::vector<float>, 3> exact, one_sd;
        for (std::size_t b = 0; b < 3; ++b) exact[b] = {static_cast<float>(L[b])}, one_sd[b] = {static_cast<float>(sd[b])};
        const std::array<std::span<const float>, 3> ve{exact[0], exact[1], exact[2]}, se{one_sd[0], one_sd[1], one_sd[2]};
        const double told = static_cast<double>(spectral_index_noise(index, ve, se, um)[0]);
        EXPECT_NEAR(told / std::sqrt(square), 1.0, 0.03) << name;
    }
}

TEST(BurnSeverity, HasTheClassesOfKeyAndBenson) {
    const std::vector<float> dnbr{-0.4F, -0.2F, 0.0F, 0.2F, 0.3F, 0.5F, 0.9F, std::nanf("")};
    const auto classes = burn_severity(dnbr);
    EXPECT_EQ(classes, (std::vector<unsigned char>{1, 2, 3, 4, 5, 6, 7, 0}));
    EXPECT_EQ(severity_classes()[3].name, "low severity");
    const std::vector<float> change{0.4F, 0.4F}, before{0.64F, 0.0F};
    const auto relative = relative_dnbr(change, before);
    EXPECT_FLOAT_EQ(relative[0], 0.5F);
    EXPECT_TRUE(std::isnan(relative[1]));
}

}  // namespace
}  // namespace pyroscene::analysis
