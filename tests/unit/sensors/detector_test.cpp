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

TEST(Detector, WithoutSaturationThereIsNoFullScaleToCount) {
    Band band = mwir();
    band.bits = 4;
    EXPECT_EQ(through(band, {12.345f})[0], 12.345f);
}

}  // namespace
}  // namespace pyroscene::sensors
