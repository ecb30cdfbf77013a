#include "analysis/frp.h"
#include "analysis/fire_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::analysis {
namespace {

using radiometry::planck_radiance;

double boxcar(double T_K, double lower_um, double upper_um) {
    return radiometry::band_radiance(T_K, lower_um, upper_um) / (upper_um - lower_um);
}

double fitted(double lower_um, double upper_um) {
    std::vector<double> T_K, L;
    for (double T = 650.0; T <= 1350.0; T += 25.0) {
        T_K.push_back(T);
        L.push_back(boxcar(T, lower_um, upper_um));
    }
    return power_law_coefficient(T_K, L);
}

TEST(Frp, PowerLawOfKnownBands) {
    // Boxcar bands, 650 (25) 1350 K, computed with an independent program.
    EXPECT_NEAR(fitted(3.4, 4.2), 3.1497e-9, 1e-13);
    EXPECT_NEAR(fitted(3.929, 3.989), 2.9193e-9, 2e-12);
    EXPECT_NEAR(fitted(3.80, 4.00), 3.0000e-9, 1e-13);
    EXPECT_NEAR(fitted(3.48, 4.36), 2.9867e-9, 1e-13);
    EXPECT_NEAR(fitted(3.74, 3.96), 3.0693e-9, 1e-13);
    EXPECT_NEAR(fitted(3.0, 5.0), 2.9368e-9, 1e-13);
}

TEST(Frp, PureGroundOfTheThesis) {
    EXPECT_NEAR(0.9 * kStefanBoltzmann_W_m2_K4 * std::pow(1100.0, 4.0), 74717.96, 0.01);
    // The same ground seen at 4.0 um with the coefficient of BIRD.
    EXPECT_NEAR(frp_mir_W_m2(0.9 * planck_radiance(4.0, 1100.0), 0.0, 3.3e-9, 1.0), 71068.4, 0.5);
    EXPECT_NEAR(frp_mir_W_m2(4591.8, 0.0, 3.3e-9, 1.0), 7.89e4, 10.0);
    EXPECT_DOUBLE_EQ(frp_mir_W_m2(100.0, 20.0, 3e-9, 0.8), frp_mir_W_m2(100.0, 0.0, 3e-9, 1.0));
}

TEST(Frp, MethodErrorFollowsTheKnownCurve) {
    // B(3.96 um) / (3.0e-9 T^4) - 1
    for (const auto& [T_K, error] : {std::pair{600.0, -0.26},
                                     {700.0, -0.05},
                                     {800.0, 0.07},
                                     {900.0, 0.12},
                                     {1000.0, 0.11},
                                     {1100.0, 0.06},
                                     {1200.0, 0.0},
                                     {1400.0, -0.14}}) {
        const double truth = kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 4.0);
        EXPECT_NEAR(frp_mir_W_m2(planck_radiance(3.96, T_K), 0.0, 3.0e-9, 1.0) / truth - 1.0, error, 0.006) << T_K;
    }
}

BispectralInput two_bands(double mir_um, double tir_um, double p, double fire_K, double background_K) {
    BispectralInput in;
    in.mir_background = planck_radiance(mir_um, background_K);
    in.tir_background = planck_radiance(tir_um, background_K);
    in.mir = p * planck_radiance(mir_um, fire_K) + (1.0 - p) * in.mir_background;
    in.tir = p * planck_radiance(tir_um, fire_K) + (1.0 - p) * in.tir_background;
    in.background_K = background_K;
    return in;
}

Bispectral solve(const BispectralInput& in, double mir_um, double tir_um) {
    return bispectral(
        in, [=](double T) { return planck_radiance(mir_um, T); }, [=](double T) { return planck_radiance(tir_um, T); });
}

TEST(Bispectral, RecoversTheWorkedExample) {
    const BispectralInput in = two_bands(3.959, 11.03, 0.002, 1000.0, 300.0);
    EXPECT_NEAR(in.mir, 7.312697, 1e-6);
    EXPECT_NEAR(in.tir, 10.08202, 1e-5);
    const Bispectral found = solve(in, 3.959, 11.03);
    ASSERT_TRUE(found.solved);
    EXPECT_NEAR(found.fraction, 0.002, 1e-9);
    EXPECT_NEAR(found.temperature_K, 1000.0, 1e-4);
    EXPECT_NEAR(found.frp_W_m2, 112.4889, 1e-4);
    EXPECT_NEAR(frp_mir_W_m2(in.mir, 0.0, 3.0e-9, 1.0) - frp_mir_W_m2(planck_radiance(3.959, 300.0), 0.0, 3.0e-9, 1.0),
                125.5291, 0.03);
}

TEST(Bispectral, ErrorsArePropagated) {
    BispectralInput in = two_bands(3.8, 8.9, 0.002, 1000.0, 300.0);
    in.mir_noise = 0.01;
    in.tir_noise = 0.1 * (planck_radiance(8.9, 300.5) - planck_radiance(8.9, 299.5));  // 0.1 K
    const Bispectral found = solve(in, 3.8, 8.9);
    ASSERT_TRUE(found.solved);
    // Against finite differences of the solution itself.
    const auto moved = [&](double mir, double tir) {
        BispectralInput other = in;
        other.mir += mir;
        other.tir += tir;
        return solve(other, 3.8, 8.9);
    };
    const double e = 1e-3;
    const auto sd = [&](auto&& of) {
        const double a = (of(moved(e * in.mir_noise, 0.0)) - of(moved(-e * in.mir_noise, 0.0))) / (2.0 * e);
        const double b = (of(moved(0.0, e * in.tir_noise)) - of(moved(0.0, -e * in.tir_noise))) / (2.0 * e);
        return std::hypot(a, b);
    };
    EXPECT_NEAR(found.temperature_sd_K / sd([](const Bispectral& b) { return b.temperature_K; }), 1.0, 1e-3);
    EXPECT_NEAR(found.fraction_sd / sd([](const Bispectral& b) { return b.fraction; }), 1.0, 1e-3);
    EXPECT_NEAR(found.frp_sd_W_m2 / sd([](const Bispectral& b) { return b.frp_W_m2; }), 1.0, 1e-3);
    EXPECT_GT(found.temperature_sd_K, 5.0);
    EXPECT_LT(found.correlation, -0.9);
}

TEST(Bispectral, RefusesPixelsWithoutASolution) {
    BispectralInput in = two_bands(3.959, 11.03, 0.002, 1000.0, 300.0);
    in.tir = in.tir_background;
    EXPECT_FALSE(solve(in, 3.959, 11.03).solved);
    in = two_bands(3.959, 11.03, 0.002, 1000.0, 300.0);
    in.mir = 0.9 * in.mir_background;
    EXPECT_FALSE(solve(in, 3.959, 11.03).solved);
    EXPECT_FALSE(solve(two_bands(3.959, 11.03, 0.5, 350.0, 300.0), 3.959, 11.03).solved);
}

TEST(FirePixels, FindsContrastAndLeavesWarmGroundAlone) {
    constexpr int kSamples = 60, kLines = 50;
    std::vector<float> T_K;
    for (int i = 0; i < kSamples * kLines; ++i) T_K.push_back(300.0F + static_cast<float>(i * 37 % 11) * 0.1F);
    const auto at = [](int line, int sample) { return static_cast<std::size_t>(line * kSamples + sample); };
    T_K[at(20, 30)] = 340.0F;
    T_K[at(0, 0)] = 450.0F;
    T_K[at(5, 50)] = std::nanf("");
    for (int line = 30; line < 50; ++line)
        for (int sample = 0; sample < 30; ++sample) T_K[at(line, sample)] = 335.0F;  // a warm field, no fire inside
    const auto fire = fire_pixels(T_K, kSamples, kLines, 320.0);
    EXPECT_EQ(fire[at(20, 30)], 1);
    EXPECT_EQ(fire[at(0, 0)], 1);
    EXPECT_EQ(fire[at(40, 10)], 0);
    EXPECT_EQ(fire[at(10, 10)], 0);
    EXPECT_EQ(fire[at(5, 50)], 0);
    const auto around = background_around(T_K, fire, kSamples, kLines, 30, 20);
    EXPECT_EQ(around.pixels, 16);
    EXPECT_NEAR(around.mean, 300.5, 0.3);
}

TEST(FireEnergy, IsTheTimeIntegralOfPower) {
    // 10 MW for 60 s, then falling to nothing in 120 s: 600 + 600 MJ.
    const std::vector<double> time_s{0.0, 60.0, 180.0}, power_MW{10.0, 10.0, 0.0};
    const auto energy = fire_radiative_energy(time_s, power_MW);
    EXPECT_EQ(energy, (std::vector<double>{0.0, 600.0, 1200.0}));
    EnergyMap map;
    const float none = std::nanf("");
    map.add(0.0, std::vector<float>{10.0F, none});
    map.add(60.0, std::vector<float>{10.0F, 4.0F});
    map.add(180.0, std::vector<float>{none, 6.0F});
    EXPECT_DOUBLE_EQ(map.energy()[0], 1200.0);
    EXPECT_DOUBLE_EQ(map.energy()[1], 0.5 * 60.0 * 4.0 + 0.5 * 120.0 * 10.0);
    EXPECT_FLOAT_EQ(map.time_of_peak_s()[0], 0.0F);
    EXPECT_FLOAT_EQ(map.time_of_peak_s()[1], 180.0F);
}

}  // namespace
}  // namespace pyroscene::analysis
