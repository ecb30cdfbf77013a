#include "sensors/detector.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "radiometry/planck.h"

namespace pyroscene::sensors {
namespace {

Band mwir() {
    Band band;
    band.id = "MWIR";
    band.response = {Quantity::Response, {3.0, 5.0}, {1.0, 1.0}};
    return band;
}

std::vector<float> through(const Band& band, std::vector<float> plane, std::vector<std::uint8_t>* flags = nullptr,
                           const RandomKey& key = {.seed = 7}) {
    std::vector<std::uint8_t> saturated(plane.size(), 9);
    apply_detector(band, key, plane, saturated);
    if (flags != nullptr) *flags = saturated;
    return plane;
}

TEST(Noise, SnrKindsAreRatiosToTheirReference) {
    Band band = mwir();
    EXPECT_EQ(noise_radiance(band, 50.0), 0.0);
    band.noise = {.kind = Noise::Kind::SignalToNoise, .value = 100.0};
    EXPECT_DOUBLE_EQ(noise_radiance(band, 50.0), 0.5);
    EXPECT_DOUBLE_EQ(noise_radiance(band, -50.0), 0.5);
    band.noise.at_radiance = 30.0;
    EXPECT_DOUBLE_EQ(noise_radiance(band, 50.0), 0.3);
}

TEST(Noise, AlbedoReferenceIsSunlight) {
    Band band = mwir();
    band.response = {Quantity::Response, {0.58, 0.68}, {1.0, 1.0}};
    band.noise = {.kind = Noise::Kind::SignalToNoiseAtAlbedo, .value = 9.0, .at_albedo = 0.005};
    // AVHRR channel 1: solar irradiance 1633.5 W m-2 um-1 (NOAA KLM guide); a black-body sun is within 5 % of it here.
    EXPECT_NEAR(noise_radiance(band, 3.0) / (0.005 * 1633.5 / M_PI / 9.0), 1.0, 0.05);
}

TEST(Detector, NoiseHasTheStatedSpreadAndDoesNotDependOnOrder) {
    Band band = mwir();
    band.noise = {.kind = Noise::Kind::SignalToNoise, .value = 20.0, .at_radiance = 10.0};  // sigma 0.5
    constexpr std::size_t kPixels = 100000;
    const auto out = through(band, std::vector<float>(kPixels, 40.0f));
    double mean = 0.0, square = 0.0;
    for (const float v : out) mean += v / kPixels;
    for (const float v : out) square += (v - mean) * (v - mean) / kPixels;
    EXPECT_NEAR(mean, 40.0, 5.0 * 0.5 / std::sqrt(kPixels));  // five standard errors
    EXPECT_NEAR(std::sqrt(square), 0.5, 5.0 * 0.5 / std::sqrt(2.0 * kPixels));
    // Element i draws number i whatever comes before it.
    const auto first = through(band, {40.0f, 40.0f, 40.0f}), shorter = through(band, {1.0f, 40.0f});
    EXPECT_EQ(first[1], shorter[1]);
    EXPECT_NE(first[0], first[1]);
    EXPECT_NE(through(band, {40.0f}, nullptr, {.seed = 8})[0], first[0]);
}

TEST(Detector, APlaneInPartsDrawsTheSameNoise) {
    Band band = mwir();
    band.noise = {.kind = Noise::Kind::SignalToNoise, .value = 20.0, .at_radiance = 10.0};
    std::vector<float> whole(100, 3.0F), parts = whole;
    std::vector<std::uint8_t> flags(100);
    const RandomKey key{7, 8, 9};
    apply_detector(band, key, whole, flags);
    for (const std::size_t first : {60U, 0U, 30U})
        apply_detector(band, key, std::span(parts).subspan(first, first == 60 ? 40 : 30),
                       std::span(flags).subspan(first, first == 60 ? 40 : 30), first);
    EXPECT_EQ(whole, parts);
    EXPECT_NE(whole[0], whole[60]);
}

TEST(Detector, ClipsCountsAndFlags) {
    Band band = mwir();
    band.saturation_radiance_W_m2_sr_um = 64.0;
    std::vector<std::uint8_t> flags;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto clipped = through(band, {10.3f, 64.0f, 64.5f, -1.0f, nan}, &flags);
    EXPECT_EQ(flags, (std::vector<std::uint8_t>{0, 0, 1, 0, 0}));
    EXPECT_EQ(clipped[0], 10.3f);
    EXPECT_EQ(clipped[2], 64.0f);
    EXPECT_EQ(clipped[3], -1.0f);
    EXPECT_TRUE(std::isnan(clipped[4]));
    band.bits = 6;  // steps of 1
    const auto counted = through(band, {10.3f, 10.7f, 70.0f, -1.0f, nan}, &flags);
    EXPECT_EQ(counted[0], 10.0f);
    EXPECT_EQ(counted[1], 11.0f);
    EXPECT_EQ(counted[2], 64.0f);
    EXPECT_EQ(counted[3], 0.0f);
    EXPECT_TRUE(std::isnan(counted[4]));
    std::vector<float> plane{70.0f, 71.0f, 3.0f};
    std::vector<std::uint8_t> three(3);
    EXPECT_EQ(apply_detector(band, {}, plane, three), 2);
}

TEST(Detector, NoiseComesBeforeSaturation) {
    Band band = mwir();
    band.noise = {.kind = Noise::Kind::SignalToNoise, .value = 1.0, .at_radiance = 5.0};
    band.saturation_radiance_W_m2_sr_um = 40.0;
    std::vector<std::uint8_t> flags;
    const auto out = through(band, std::vector<float>(10000, 40.0f), &flags);
    std::size_t clipped = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        EXPECT_LE(out[i], 40.0f);
        clipped += flags[i];
    }
    EXPECT_NEAR(static_cast<double>(clipped), 5000.0, 250.0);  // half of a symmetric noise; five standard deviations
}

TEST(Noise, OfRadianceGrowsWithTheRootOfTheSignal) {
    Band band = mwir();
    band.noise = {.kind = Noise::Kind::NoiseEquivalentRadiance, .value = 0.3, .shot = 0.04};
    EXPECT_DOUBLE_EQ(noise_radiance(band, 0.0), 0.3);
    EXPECT_DOUBLE_EQ(noise_radiance(band, 4.0), 0.5);  // sqrt(0.09 + 0.16)
}

TEST(Detector, ADualSlopeSharesItsCounts) {
    Band band = mwir();
    band.noise = {};
    band.saturation_radiance_W_m2_sr_um = 640.0;
    band.bits = 6;  // 32 counts of 5 up to 160, 32 counts of 15 up to 640
    band.sensitive_range = Band::SensitiveRange{160.0, {}, 0.5};
    std::vector<float> L{7.0F, 157.0F, 162.0F, 180.0F, 400.0F, 700.0F};
    std::vector<std::uint8_t> flags(L.size());
    apply_detector(band, {}, L, flags);
    EXPECT_EQ(L, (std::vector<float>{5.0F, 155.0F, 160.0F, 175.0F, 400.0F, 640.0F}));
    EXPECT_EQ(flags.back(), kClipped);
}

TEST(Detector, ASensitiveRangeCountsFinerAndIsQuieter) {
    Band band = mwir();
    band.saturation_radiance_W_m2_sr_um = 640.0;
    band.bits = 6;  // steps of 10, and of 1 in the sensitive range
    band.sensitive_range = Band::SensitiveRange{64.0, {}};
    EXPECT_EQ(through(band, {10.3f, 63.6f, 94.0f, 700.0f}), (std::vector<float>{10.0f, 64.0f, 90.0f, 640.0f}));
    band.bits.reset();
    band.noise = {.kind = Noise::Kind::SignalToNoise, .value = 1.0, .at_radiance = 2.0};
    band.noise_factor = 3.0;
    band.sensitive_range->noise = {.kind = Noise::Kind::SignalToNoise, .value = 1.0, .at_radiance = 0.1};
    const auto spread = [&](float level) {
        double square = 0.0;
        for (const float v : through(band, std::vector<float>(20000, level))) square += (v - level) * (v - level) / 20000.0;
        return std::sqrt(square);
    };
    EXPECT_NEAR(spread(30.0f), 0.1, 0.003);
    EXPECT_NEAR(spread(300.0f), 6.0, 0.18);
}

TEST(Detector, FoldsOverFarAboveSaturation) {
    Band band = mwir();
    band.saturation_radiance_W_m2_sr_um = 5.0;
    band.fold_over = 8.0;
    std::vector<std::uint8_t> flags;
    const auto out = through(band, {4.0f, 6.0f, 39.9f, 40.5f, 47.0f}, &flags);
    EXPECT_EQ(out, (std::vector<float>{4.0f, 5.0f, 5.0f, 0.5f, 2.0f}));
    EXPECT_EQ(flags, (std::vector<std::uint8_t>{0, 1, 1, 2, 2}));
}

TEST(StrayLight, SpreadsItsShareAndKeepsTheSum) {
    constexpr int kEdge = 61;
    std::vector<float> plane(kEdge * kEdge, 0.0f);
    const std::size_t middle = plane.size() / 2;
    plane[middle] = 1000.0f;
    add_stray_light({.share = 0.1, .fwhm_samples = 6.0}, kEdge, plane);
    double sum = 0.0;
    for (const float v : plane) sum += v;
    EXPECT_NEAR(sum, 1000.0, 0.05);
    EXPECT_NEAR(plane[middle], 900.0 + 100.0 * 4.0 * std::log(2.0) / (M_PI * 36.0), 0.05);  // peak of the 2-D Gaussian
    EXPECT_NEAR(plane[middle + 3] / (plane[middle] - 900.0f), 0.5, 1e-3);                   // half at half the width
    // An even scene stays even, up to its rim and around missing data.
    std::vector<float> even(kEdge * kEdge, 7.0f);
    even[100] = std::numeric_limits<float>::quiet_NaN();
    add_stray_light({.share = 0.3, .fwhm_samples = 9.0}, kEdge, even);
    for (std::size_t i = 0; i < even.size(); ++i)
        if (i != 100) {
            ASSERT_NEAR(even[i], 7.0, 1e-5);
        }
    EXPECT_TRUE(std::isnan(even[100]));
}

TEST(Detector, WithoutSaturationThereIsNoFullScaleToCount) {
    Band band = mwir();
    band.bits = 4;
    EXPECT_EQ(through(band, {12.345f})[0], 12.345f);
}

}  // namespace
}  // namespace pyroscene::sensors
