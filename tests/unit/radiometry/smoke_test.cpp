#include "radiometry/smoke.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/alkali_thesis.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

SmokeOptics fine(const std::string& biome) {
    return load_smoke_optics(source_folder() / "data/optical/smoke_optics_fine.csv", biome);
}

TEST(Smoke, ExtinctionRelativeTo550nm) {
    // Printed summary of the fine mode: mee and ssa at 550 nm, extinction at the other wavelengths relative to 550 nm.
    struct Row {
        std::string biome;
        double mee, ssa;
        std::array<double, 6> relative;
    };
    const std::vector<Row> rows{{"savanna", 4.41, 0.886, {0.466, 0.130, 0.060, 0.031, 0.010, 0.013}},
                                {"amazon_forest", 3.96, 0.943, {0.457, 0.121, 0.052, 0.024, 0.008, 0.015}},
                                {"boreal_forest", 4.68, 0.948, {0.490, 0.137, 0.059, 0.027, 0.008, 0.012}}};
    const std::array<double, 6> lambda_um{0.77, 1.24, 1.64, 2.13, 3.96, 10.6};
    for (const auto& row : rows) {
        const auto smoke = fine(row.biome);
        const auto at_550 = smoke_coefficients(smoke, 0.55, 1.0);
        EXPECT_NEAR(at_550.extinction_per_m, row.mee, 0.005);
        EXPECT_NEAR(at_550.single_scattering_albedo, row.ssa, 0.0005);
        for (std::size_t i = 0; i < lambda_um.size(); ++i) {
            const double relative = smoke_coefficients(smoke, lambda_um[i], 1.0).extinction_per_m / at_550.extinction_per_m;
            EXPECT_NEAR(relative, row.relative[i], 0.0011 + 0.01 * row.relative[i]) << row.biome << lambda_um[i];
        }
    }
}

TEST(Smoke, HidesFireInTheGreenNotInTheMediumWave) {
    // Optical depth 3 at 550 nm (savanna): 5 % in the green, 84 % at 1.64 um, 97 % at 3.96 um get through.
    const auto smoke = fine("savanna");
    const double concentration_path_g_m2 = 3.0 / smoke_coefficients(smoke, 0.55, 1.0).extinction_per_m;
    const auto through = [&](double lambda_um) {
        return std::exp(-smoke_coefficients(smoke, lambda_um, concentration_path_g_m2).extinction_per_m);
    };
    EXPECT_NEAR(through(0.55), 0.05, 0.005);
    EXPECT_NEAR(through(1.64), 0.84, 0.006);
    EXPECT_NEAR(through(3.96), 0.97, 0.005);
    const auto c = smoke_coefficients(smoke, 0.55, 0.01);
    EXPECT_NEAR(c.scattering_per_m() + c.absorption_per_m(), c.extinction_per_m, 1e-15);
}

TEST(Smoke, PhaseFunctionIsNormalisedWithItsAsymmetry) {
    for (const double g : {-0.4, 0.0, 0.3, 0.7}) {
        double sum = 0.0, mean = 0.0;
        constexpr int kSteps = 20000;
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = -1.0 + 2.0 * (i + 0.5) / kSteps;
            const double weight = henyey_greenstein_per_sr(cosine, g) * 2.0 * kPi * 2.0 / kSteps;
            sum += weight;
            mean += weight * cosine;
        }
        EXPECT_NEAR(sum, 1.0, 1e-6);
        EXPECT_NEAR(mean, g, 1e-6);
    }
}

TEST(Smoke, UnknownBiomeIsAnInputError) { EXPECT_THROW(fine("tundra"), Error); }

TEST(ThesisPotassium, IonsAreFewAndTheirShareRisesSteeply) {
    // Electrons from potassium alone, 1 ppm at 1100 K: 4e-7 (worked by hand from Saha's equation).
    EXPECT_NEAR(potassium_ionised_fraction(1100.0, 1e-6 * 101325.0 / (kBoltzmann_J_K * 1100.0)), 4.1e-7, 0.1e-7);
    const ThesisPotassium in;
    // Eq A.1: d ln R / dT = 3/(2T) + E/(kT^2), nearly 48 / T at 1100 K.
    const double slope = std::log(thesis_ionised_fraction(in, 1100.5) / thesis_ionised_fraction(in, 1099.5));
    EXPECT_NEAR(slope * 1100.0, 1.5 + 6.92064e-19 / (1.38e-23 * 1100.0), 0.01);
    EXPECT_GT(thesis_ionised_fraction(in, 4000.0), 0.99);
}

TEST(ThesisPotassium, PowerIsLinearInAtomsAndRatioInEmissivity) {
    ThesisPotassium in;
    const double power_W = thesis_potassium_power_W(in, 1100.0),
                 ratio = thesis_potassium_ratio(in, 1100.0, 0.9, 766.4, 766.6);
    in.potassium_density_per_m3 *= 3.0;
    EXPECT_NEAR(thesis_potassium_power_W(in, 1100.0) / power_W, 3.0, 1e-12);
    EXPECT_NEAR(thesis_potassium_ratio(in, 1100.0, 0.45, 766.4, 766.6) / ratio, 6.0, 1e-9);
    EXPECT_GT(thesis_potassium_ratio(in, 1100.0, 0.9, 769.8, 770.0), 0.0);
}

}  // namespace
}  // namespace pyroscene::radiometry
