// Detectors on planted fires: pixels with a black fire of known area and temperature over ground at 300 K, no air. The areas at
// which a channel reaches a temperature are analytic numbers of an independent program.
#include "analysis/fire_detection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/detection_score.h"
#include "radiometry/planck.h"

namespace pyroscene::analysis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A boxcar channel.
struct Channel {
    double lower_um, upper_um;
    [[nodiscard]] Spectrum response() const { return {Quantity::Response, {lower_um, upper_um}, {1.0, 1.0}}; }
    [[nodiscard]] double black_body(double T_K) const { return radiometry::band_mean_radiance(T_K, response()); }
    [[nodiscard]] double seen_K(double fire_K, double share, double ground_K) const {
        return radiometry::band_brightness_temperature(share * black_body(fire_K) + (1.0 - share) * black_body(ground_K),
                                                       response());
    }
};
constexpr Channel kModis4{3.929, 3.989}, kModis11{10.78, 11.28}, kViirs4{3.55, 3.93}, kViirs11{10.5, 12.4};

/// An image of uniform ground with noise, into which pixels are put by hand.
struct Image {
    int samples, lines;
    std::vector<float> mir_K, tir_K, red, nir, swir, sun, glint;
    std::vector<unsigned char> water;

    Image(int w, int h, double noise4_K, double noise11_K, double sun_deg = 40.0, double ground_K = 300.0)
        : samples(w), lines(h), sun(size(), static_cast<float>(sun_deg)) {
        std::mt19937_64 random(7);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < size(); ++i) {
            mir_K.push_back(static_cast<float>(ground_K + noise4_K * normal(random)));
            tir_K.push_back(static_cast<float>(ground_K + noise11_K * normal(random)));
        }
        red.assign(size(), 0.08F);
        nir.assign(size(), 0.22F);
        swir.assign(size(), 0.15F);
    }
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(samples) * static_cast<std::size_t>(lines); }
    [[nodiscard]] std::size_t at(int sample, int line) const {
        return static_cast<std::size_t>(line) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
    }
    void set(int sample, int line, double mir, double tir) {
        mir_K[at(sample, line)] = static_cast<float>(mir);
        tir_K[at(sample, line)] = static_cast<float>(tir);
    }
    [[nodiscard]] ThermalScene scene() const {
        return {samples, lines, mir_K, tir_K, {}, red, nir, swir, sun, glint, water};
    }
};

int fires(const Detection& d) {
    return static_cast<int>(std::count_if(d.fire.begin(), d.fire.end(), [](FireClass c) { return is_fire(c); }));
}

/// Smallest area [m2] of a fire that a detector finds in a pixel, by bisection over noise-free scenes.
double least_area(const Channel& mir, const Channel& tir, double pixel_m2, double fire_K, double sun_deg,
                  Detection (*detect)(const ThermalScene&)) {
    double missed = 0.0, found = pixel_m2;
    for (int step = 0; step < 40; ++step) {
        const double area = step < 12 ? std::sqrt(std::max(missed, 1.0) * found) : 0.5 * (missed + found);
        Image image(61, 61, 0.0, 0.0, sun_deg);
        image.set(30, 30, mir.seen_K(fire_K, area / pixel_m2, 300.0), tir.seen_K(fire_K, area / pixel_m2, 300.0));
        (is_fire(detect(image.scene()).fire[image.at(30, 30)]) ? found : missed) = area;
    }
    return found;
}

TEST(Mod14, FindsTheSmallestFireOfTheAnalyticTable) {
    // 1000 K in 1 km2 at 300 K: T4 = 310 K from 97 m2 on; difference of 10 K from about 100 m2 on (10.1 K at 100 m2).
    const double day = least_area(kModis4, kModis11, 1e6, 1000.0, 40.0, detect_mod14);
    EXPECT_NEAR(day, 97.0, 0.2 * 97.0);
    const double night = least_area(kModis4, kModis11, 1e6, 1000.0, 120.0, detect_mod14);
    EXPECT_NEAR(night, 97.0, 0.2 * 97.0);
}

TEST(Mod14, FindsAFireWithoutSurroundingsFromTheAbsoluteTemperatureOn) {
    // 360 K by day: 1322 m2 of 1000 K. Cloud all around leaves nothing to compare with.
    for (const double area : {1300.0, 1340.0}) {
        Image image(31, 31, 0.0, 0.0, 40.0);
        image.red.assign(image.size(), 0.7F);
        image.nir.assign(image.size(), 0.7F);
        image.red[image.at(15, 15)] = image.nir[image.at(15, 15)] = 0.1F;
        image.set(15, 15, kModis4.seen_K(1000.0, area / 1e6, 300.0), kModis11.seen_K(1000.0, area / 1e6, 300.0));
        const auto found = detect_mod14(image.scene());
        EXPECT_EQ(is_fire(found.fire[image.at(15, 15)]), area > 1322.0) << area;
        EXPECT_EQ(found.fire[0], FireClass::Cloud);
        EXPECT_EQ(found.fire[image.at(15, 15)] == FireClass::Unknown, area < 1322.0);
    }
}

TEST(Viirs375, FindsTheSmallestFireOfTheAnalyticTable) {
    // 1000 K in a 375 m pixel: T4 = 325 K from 29 m2 on.
    EXPECT_NEAR(least_area(kViirs4, kViirs11, 375.0 * 375.0, 1000.0, 40.0, detect_viirs375), 29.0, 0.2 * 29.0);
}

TEST(Viirs375, KnowsSaturationAndFoldOver) {
    Image image(61, 61, 0.5, 0.5, 40.0);
    image.set(10, 10, 367.0, 305.0);  // saturated: 163 m2 of 1000 K
    image.set(30, 30, 208.0, 340.0);  // folded over above hot ground
    image.set(50, 50, 345.0, 304.0);
    auto scene = image.scene();
    scene.mir_saturation_K = 367.0;
    const auto found = detect_viirs375(scene);
    EXPECT_EQ(found.fire[image.at(10, 10)], FireClass::High);
    EXPECT_EQ(found.fire[image.at(30, 30)], FireClass::Nominal);
    EXPECT_EQ(found.fire[image.at(50, 50)], FireClass::Nominal);
    EXPECT_EQ(fires(found), 3);
}

TEST(Detectors, RaiseNoFalseAlarmInNoise) {
    // 102 400 pixels with the noise of MODIS 22 and 31, and of VIIRS I4 and I5 (NEdT 2.5 K at 270 K is 0.9 K at 300 K), day and night.
    for (const double sun_deg : {40.0, 120.0}) {
        EXPECT_EQ(fires(detect_mod14(Image(320, 320, 0.07, 0.05, sun_deg).scene())), 0);
        EXPECT_EQ(fires(detect_viirs375(Image(320, 320, 0.9, 0.4, sun_deg).scene())), 0);
    }
}

TEST(Detectors, LeaveHotSoilAlone) {
    // Ground of 330 K, everywhere or in a patch: warm in both bands alike, apart from what 4 um reflects of the sun.
    Image everywhere(120, 120, 0.07, 0.05, 20.0, 330.0), patch(120, 120, 0.07, 0.05, 20.0, 300.0);
    for (int line = 50; line < 70; ++line)
        for (int sample = 50; sample < 70; ++sample) patch.set(sample, line, 333.0, 330.0);
    for (const Image& image : {everywhere, patch}) {
        EXPECT_EQ(fires(detect_mod14(image.scene())), 0);
        EXPECT_EQ(fires(detect_viirs375(image.scene())), 0);
    }
}

TEST(Mod14, RejectsSunGlintButNotAFireBesideIt) {
    Image image(60, 60, 0.07, 0.05, 30.0);
    image.glint.assign(image.size(), 40.0F);
    image.set(20, 20, 345.0, 301.0);
    image.set(40, 40, 345.0, 301.0);
    for (int line = 18; line < 23; ++line)
        for (int sample = 18; sample < 23; ++sample) image.glint[image.at(sample, line)] = 8.0F;
    for (auto* plane : {&image.red, &image.nir, &image.swir}) (*plane)[image.at(20, 20)] = 0.25F;
    const auto found = detect_mod14(image.scene());
    EXPECT_EQ(found.fire[image.at(20, 20)], FireClass::Glint);
    EXPECT_TRUE(is_fire(found.fire[image.at(40, 40)]));
    EXPECT_EQ(fires(found), 1);
}

TEST(Detectors, TakeASmokeEdgeForNoFire) {
    // Smoke that shows 280 K at 11 um over half of the image and lets 4 um through: a step of 20 K in the difference.
    Image image(80, 80, 0.1, 0.1, 40.0);
    for (int line = 0; line < 80; ++line)
        for (int sample = 40; sample < 80; ++sample) {
            image.set(sample, line, 300.0, 280.0);
            image.red[image.at(sample, line)] = image.nir[image.at(sample, line)] = 0.30F;
        }
    EXPECT_EQ(fires(detect_mod14(image.scene())), 0);
    EXPECT_EQ(fires(detect_viirs375(image.scene())), 0);
}

TEST(Mod14, RejectsEdgesOfDeserts) {
    // Hot bright soil of T4 = 335 K and 22 K of difference beside cool ground: a strip of it passes the contrast tests.
    Image image(80, 80, 0.05, 0.05, 20.0);
    for (int line = 0; line < 80; ++line)
        for (int sample = 38; sample < 42; ++sample) {
            image.set(sample, line, 335.0 + 0.5 * std::sin(line), 311.0);
            image.nir[image.at(sample, line)] = 0.3F;
        }
    EXPECT_EQ(fires(detect_mod14(image.scene())), 0);
}

TEST(Mod14, MasksWaterAndWhatHasNoData) {
    Image image(40, 40, 0.05, 0.05, 40.0);
    image.water.assign(image.size(), 0);
    image.water[image.at(5, 5)] = 1;
    image.set(5, 5, 400.0, 310.0);
    image.set(9, 9, static_cast<double>(kNaN), 300.0);
    const auto found = detect_mod14(image.scene());
    EXPECT_EQ(found.fire[image.at(5, 5)], FireClass::Water);
    EXPECT_EQ(found.fire[image.at(9, 9)], FireClass::NotProcessed);
    EXPECT_EQ(fires(found), 0);
}

TEST(Mod14, ConfidenceGrowsWithTheFire) {
    double before = -1.0;
    for (const double T4_K : {312.0, 320.0, 330.0, 350.0}) {
        Image image(40, 40, 0.5, 0.3, 40.0);
        image.set(20, 20, T4_K, 300.5);
        const auto found = detect_mod14(image.scene());
        ASSERT_TRUE(is_fire(found.fire[image.at(20, 20)])) << T4_K;
        const double confidence = static_cast<double>(found.confidence_percent[image.at(20, 20)]);
        EXPECT_GT(confidence, before);
        before = confidence;
        EXPECT_NEAR(static_cast<double>(found.background_mir_K[image.at(20, 20)]), 300.0, 0.5);
    }
    EXPECT_DOUBLE_EQ(before, 100.0);
}

TEST(GlintAngle, IsTheAngleToTheMirrorDirection) {
    EXPECT_NEAR(glint_angle_deg(30.0, 250.0, 30.0, 70.0), 0.0, 1e-5);
    EXPECT_NEAR(glint_angle_deg(0.0, 0.0, 30.0, 123.0), 30.0, 1e-9);
    EXPECT_NEAR(glint_angle_deg(30.0, 70.0, 30.0, 70.0), 60.0, 1e-9);  // looking from where the sun stands
}

TEST(DetectionScore, CountsByPixel) {
    //                                      found  missed  false  right  tiny and called  no data
    const std::vector<unsigned char> called{1, 0, 1, 0, 1, 1};
    const std::vector<float> area_m2{2000.0F, 50.0F, 0.0F, 0.0F, 0.5F, kNaN}, power_MW{80.0F, 2.0F, 0.0F, 0.0F, 0.02F, kNaN};
    const auto s = score_detection(called, area_m2, power_MW, 6, 1.0);
    EXPECT_EQ(s.true_pixels, 2);
    EXPECT_EQ(s.found, 1);
    EXPECT_EQ(s.detected, 3);
    EXPECT_EQ(s.false_alarms, 1);
    EXPECT_EQ(s.beside, 1);
    EXPECT_EQ(s.background, 2);
    EXPECT_DOUBLE_EQ(s.omission(), 0.5);
    EXPECT_DOUBLE_EQ(s.commission(), 1.0 / 3.0);
    EXPECT_EQ(score_detection(called, area_m2, power_MW, 1, 1.0).beside, 1);  // two lines below the missed one
    const std::vector<unsigned char> far_off{0, 0, 0, 1};
    const std::vector<float> one_fire{5.0F, 0.0F, 0.0F, 0.0F};
    EXPECT_EQ(score_detection(far_off, one_fire, one_fire, 4, 1.0).beside, 0);
    ASSERT_EQ(s.by_area_m2.size(), 6u);
    EXPECT_EQ(s.by_area_m2[1].true_pixels, 1);  // 10 to 100 m2
    EXPECT_EQ(s.by_area_m2[1].found, 0);
    EXPECT_EQ(s.by_area_m2[3].found, 1);  // 1000 to 10 000 m2
    EXPECT_EQ(s.by_frp_MW[2].true_pixels, 1);
    EXPECT_EQ(s.by_frp_MW[3].found, 1);
}

}  // namespace
}  // namespace pyroscene::analysis
