#include "radiometry/planck.h"

#include <cmath>
#include <cstdio>
#include <numeric>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

/// Rows of tests/data/radiometry.csv (scipy 1.10, CODATA 2018, adaptive quadrature): one kind, columns as numbers.
struct Reference {
    std::vector<std::string> name;
    std::map<std::string, std::vector<double>> column;
    [[nodiscard]] std::size_t size() const { return name.size(); }
};

Reference reference(const std::string& kind) {
    const auto table = read_csv(source_folder() / "tests/data/radiometry.csv");
    Reference out;
    for (const auto& row : table.rows) {
        if (row[table.column("kind")] != kind) continue;
        out.name.push_back(row[table.column("name")]);
        for (const auto& name :
             {"lambda_lo_um", "lambda_hi_um", "T_K", "emissivity", "tau", "L_path_up", "L_down", "value", "value2"}) {
            const auto& text = row[table.column(name)];
            out.column[name].push_back(text.empty() ? std::nan("") : parse_number(text, name));
        }
    }
    return out;
}

void expect_relative(double value, double expected, double tolerance) {
    EXPECT_NEAR(value / expected, 1.0, tolerance) << value << " against " << expected;
}

TEST(Planck, MatchesIndependentTable) {
    auto ref = reference("planck");
    ASSERT_GT(ref.size(), 50U);
    for (std::size_t i = 0; i < ref.size(); ++i) {
        const double lambda = ref.column["lambda_lo_um"][i], T = ref.column["T_K"][i], B = planck_radiance(lambda, T);
        SCOPED_TRACE(testing::Message() << lambda << " um, " << T << " K");
        expect_relative(B, ref.column["value"][i], 1e-6);
        expect_relative(kPi * 1e6 * B, ref.column["value2"][i], 1e-6);  // thesis eq 2.4: exitance per metre
        EXPECT_NEAR(brightness_temperature(lambda, B), T, 1e-9 * T);
    }
}

TEST(Planck, BandIntegralsMatchIndependentTable) {
    auto ref = reference("band");
    ASSERT_GT(ref.size(), 50U);
    for (std::size_t i = 0; i < ref.size(); ++i) {
        const double lower = ref.column["lambda_lo_um"][i], upper = ref.column["lambda_hi_um"][i], T = ref.column["T_K"][i];
        SCOPED_TRACE(testing::Message() << lower << " to " << upper << " um, " << T << " K");
        expect_relative(band_radiance(T, lower, upper), ref.column["value"][i], 1e-6);
        expect_relative(band_mean_radiance(T, boxcar(lower, upper)), ref.column["value2"][i], 1e-6);
    }
}

TEST(Planck, BrightnessTemperaturesMatchIndependentTable) {
    auto mono = reference("bt_mono"), band = reference("bt_band");
    ASSERT_GT(mono.size() + band.size(), 50U);
    for (std::size_t i = 0; i < mono.size(); ++i)
        EXPECT_NEAR(brightness_temperature(mono.column["lambda_lo_um"][i], mono.column["value"][i]),
                    mono.column["value2"][i], 1e-4);
    for (std::size_t i = 0; i < band.size(); ++i) {
        const auto response = boxcar(band.column["lambda_lo_um"][i], band.column["lambda_hi_um"][i]);
        const double T = band_brightness_temperature(band.column["value"][i], response);
        EXPECT_NEAR(T, band.column["value2"][i], 1e-4);
        EXPECT_NEAR(BandThermometer(response).temperature_K(band.column["value"][i]), T, 1e-6);
    }
}

TEST(Planck, SensorChainMatchesIndependentTable) {
    auto ref = reference("chain");
    ASSERT_GT(ref.size(), 10U);
    for (std::size_t i = 0; i < ref.size(); ++i) {
        const auto response = boxcar(ref.column["lambda_lo_um"][i], ref.column["lambda_hi_um"][i]);
        const double e = ref.column["emissivity"][i];
        const double L = ref.column["tau"][i] *
                             (e * band_mean_radiance(ref.column["T_K"][i], response) + (1.0 - e) * ref.column["L_down"][i]) +
                         ref.column["L_path_up"][i];
        SCOPED_TRACE(ref.name[i]);
        expect_relative(L, ref.column["value"][i], 1e-6);
        EXPECT_NEAR(band_brightness_temperature(L, response), ref.column["value2"][i], 1e-4);
    }
}

TEST(Planck, GreySlabsMatchIndependentTable) {
    auto ref = reference("slab");
    ASSERT_GT(ref.size(), 10U);
    for (std::size_t i = 0; i < ref.size(); ++i) {
        double k_per_m = 0.0, path_m = 0.0, ground_K = 0.0, ground_emissivity = 0.0;
        ASSERT_EQ(std::sscanf(ref.name[i].c_str(), "k=%lf 1/m; path=%lf m; ground T=%lf K; ground emissivity=%lf", &k_per_m,
                              &path_m, &ground_K, &ground_emissivity),
                  4)
            << ref.name[i];
        const double lambda = ref.column["lambda_lo_um"][i], tau = std::exp(-k_per_m * path_m);
        const double L = tau * ground_emissivity * planck_radiance(lambda, ground_K) +
                         (1.0 - tau) * planck_radiance(lambda, ref.column["T_K"][i]);
        SCOPED_TRACE(ref.name[i]);
        expect_relative(tau, ref.column["tau"][i], 1e-6);
        expect_relative(L, ref.column["value"][i], 1e-6);
        EXPECT_NEAR(brightness_temperature(lambda, L), ref.column["value2"][i], 1e-4);
    }
}

TEST(Planck, IntegratesToStefanBoltzmann) {
    for (double T_K : {250.0, 300.0, 600.0, 1000.0, 1500.0, 3000.0}) {
        SCOPED_TRACE(T_K);
        expect_relative(band_radiance(T_K, 0.1, 1e4), kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 4) / kPi, 1e-6);
        expect_relative(band_radiance(T_K, 0.0, 1e9), kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 4) / kPi, 1e-9);
    }
}

TEST(Planck, PeaksWhereWienSays) {
    // CODATA 2018: b = 2897.771955 um K. The derivative in wavelength changes sign there.
    for (double T_K : {300.0, 1100.0, 1700.0}) {
        const double peak_um = 2897.771955 / T_K;
        EXPECT_GT(planck_radiance(peak_um, T_K), planck_radiance(peak_um * 1.001, T_K));
        EXPECT_GT(planck_radiance(peak_um, T_K), planck_radiance(peak_um * 0.999, T_K));
    }
    EXPECT_NEAR(2897.771955 / 1100.0, 2.63, 0.005);  // thesis T:2.3
}

TEST(Planck, ThesisCheckValues) {
    EXPECT_NEAR(planck_radiance(4.0, 1100.0), 4595.5, 0.05);
    EXPECT_NEAR(planck_radiance(3.96, 300.0), 0.6726, 5e-5);
    EXPECT_NEAR(planck_radiance(11.0, 300.0), 9.573, 5e-4);
    EXPECT_NEAR(planck_radiance(3.96, 1000.0), 3320.0, 0.5);
    EXPECT_NEAR(kPi * band_radiance(1100.0, 0.01, 1e6), 83020.0, 5.0);
    // Band means of an 1100 K blackbody, W cm-2 sr-1 um-1.
    EXPECT_NEAR(band_mean_radiance(1100.0, boxcar(0.9, 1.8)) * 1e-4, 0.186094, 5e-7);
    EXPECT_NEAR(band_mean_radiance(1100.0, boxcar(3.0, 5.0)) * 1e-4, 0.463483, 5e-7);
    EXPECT_NEAR(band_mean_radiance(1100.0, boxcar(8.0, 11.0)) * 1e-4, 0.054658, 5e-7);
    // The thesis LWIR figure (0.117) would need 1728 K, its SWIR figure (0.108) 1034.77 K.
    EXPECT_NEAR(band_brightness_temperature(1170.0, boxcar(8.0, 11.0)), 1728.4, 0.05);
    EXPECT_NEAR(band_brightness_temperature(1080.0, boxcar(0.9, 1.8)), 1034.77, 0.005);
}

TEST(Planck, BandMeansOfMeasuredResponses) {
    // Response-weighted Planck means at 300, 600, 1000 K as listed in the sensor files (five digits, computed independently).
    const std::map<std::string, std::array<double, 3>> expected{
        {"modis_b20", {0.4872, 272.33, 3500.0}},      {"modis_b21", {0.71267, 289.88, 3286.0}},
        {"modis_b31", {9.5597, 93.942, 273.0}},       {"landsat8_b10", {9.6164, 96.569, 282.74}},
        {"landsat8_b7", {0.0008578, 43.056, 3340.4}}, {"avhrr_3a", {1.2627e-06, 3.6948, 1437.9}}};
    const auto responses = measured_responses();
    for (const auto& [band, means] : expected) {
        SCOPED_TRACE(band);
        const std::array<double, 3> T_K{300.0, 600.0, 1000.0};
        for (std::size_t i = 0; i < 3; ++i) expect_relative(band_mean_radiance(T_K[i], responses.at(band)), means[i], 1e-4);
    }
}

TEST(Planck, PiecewiseLinearResponseIsExact) {
    // A triangle is the difference of linear ramps: compare with a fine midpoint sum, whose error falls with the square.
    const Spectrum triangle{Quantity::Response, {3.0, 3.7, 5.0}, {0.0, 1.0, 0.0}};
    const auto midpoint = [&](int n) {
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            const double rise = 3.0 + 0.7 * (i + 0.5) / n, fall = 3.7 + 1.3 * (i + 0.5) / n;
            sum += 0.7 / n * triangle.at(rise) * planck_radiance(rise, 600.0) +
                   1.3 / n * triangle.at(fall) * planck_radiance(fall, 600.0);
        }
        return sum;
    };
    const double extrapolated = (4.0 * midpoint(4000) - midpoint(2000)) / 3.0;  // Richardson
    expect_relative(band_mean_radiance(600.0, triangle), extrapolated / 1.0, 1e-9);
}

TEST(Planck, EdgesGivenAsDoublePointsChangeNothing) {
    const Spectrum edged{Quantity::Response, {2.0, 3.0, 3.0, 5.0, 5.0, 6.0}, {0.0, 0.0, 2.0, 2.0, 0.0, 0.0}};
    expect_relative(band_mean_radiance(700.0, edged), band_mean_radiance(700.0, boxcar(3.0, 5.0)), 1e-13);
}

TEST(Planck, BandTemperatureInverts) {
    const auto responses = measured_responses();
    std::vector<Spectrum> bands{boxcar(0.9, 1.8), boxcar(3.0, 5.0), boxcar(8.0, 11.0), boxcar(0.4, 14.0)};
    for (const auto& [name, response] : responses) bands.push_back(response);
    for (const auto& band : bands)
        for (double T_K = 150.0; T_K <= 3000.0; T_K *= 1.3)
            EXPECT_NEAR(band_brightness_temperature(band_mean_radiance(T_K, band), band), T_K, 1e-6);
}

TEST(Planck, UnusableArguments) {
    const double nan = std::nan("");
    EXPECT_EQ(planck_radiance(4.0, 0.0), 0.0);
    EXPECT_EQ(planck_radiance(4.0, -5.0), 0.0);
    EXPECT_TRUE(std::isnan(planck_radiance(4.0, nan)));
    EXPECT_EQ(band_radiance(0.0, 3.0, 5.0), 0.0);
    EXPECT_TRUE(std::isnan(band_radiance(nan, 3.0, 5.0)));
    for (double L : {0.0, -1.0, nan}) {
        EXPECT_TRUE(std::isnan(brightness_temperature(4.0, L)));
        EXPECT_TRUE(std::isnan(band_brightness_temperature(L, boxcar(3.0, 5.0))));
        EXPECT_TRUE(std::isnan(BandThermometer(boxcar(3.0, 5.0)).temperature_K(L)));
    }
}

TEST(Planck, RefusesUnusableResponses) {
    const auto refused = [](std::vector<double> lambda_um, std::vector<double> value) {
        EXPECT_THROW((void)band_mean_radiance(300.0, {Quantity::Response, std::move(lambda_um), std::move(value)}), Error);
    };
    refused({}, {});
    refused({3.0}, {1.0});
    refused({3.0, 5.0}, {0.0, 0.0});
    refused({3.0, 5.0}, {1.0, -0.1});
    refused({5.0, 3.0}, {1.0, 1.0});
    refused({0.0, 3.0}, {1.0, 1.0});
    refused({3.0, 5.0}, {1.0});
    refused({3.0, 5.0}, {1.0, std::nan("")});
}

}  // namespace
}  // namespace pyroscene::radiometry
