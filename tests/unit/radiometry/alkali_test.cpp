#include "radiometry/alkali.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "radiometry/flame_optics.h"
#include "radiometry/planck.h"
#include "radiometry/soot.h"
#include "radiometry/voigt.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

const AlkaliLines& shipped() {
    static const AlkaliLines lines = load_alkali_lines(source_folder() / "data/optical/alkali_lines.csv");
    return lines;
}

Spectrum gaussian(double centre_nm, double fwhm_nm) {
    Spectrum r{Quantity::Response, {}, {}};
    for (int i = -400; i <= 400; ++i) {
        const double offset_nm = 0.01 * i * fwhm_nm;
        r.lambda_um.push_back(1e-3 * (centre_nm + offset_nm));
        r.value.push_back(std::exp(-4.0 * std::log(2.0) * std::pow(offset_nm / fwhm_nm, 2)));
    }
    return r;
}

TEST(Voigt, MatchesItsIntegralAndItsLimits) {
    // y/pi int exp(-t^2) / (y^2 + (x-t)^2) dt by the trapezium rule, which converges exponentially here.
    for (const double y : {0.3, 1.0, 3.9}) {
        for (const double x : {0.0, 0.5, 2.0, 10.0}) {
            double sum = 0.0;
            for (int i = -4000; i <= 4000; ++i) {
                const double t = i * 0.0025;
                sum += std::exp(-t * t) / (y * y + (x - t) * (x - t)) * 0.0025;
            }
            EXPECT_NEAR(voigt_function(x, y) / (y / kPi * sum), 1.0, 1e-7) << x << " " << y;
        }
    }
    EXPECT_NEAR(voigt_function(1.0, 1e-6), std::exp(-1.0), 1e-5);                               // Doppler core
    EXPECT_NEAR(voigt_function(500.0, 4.0) * 500.0 * 500.0 * std::sqrt(kPi) / 4.0, 1.0, 1e-4);  // Lorentz wing
}

TEST(Alkali, WidthsAndCentresAt1100K) {
    // Doppler 0.00291 nm, Lorentz 0.0137 nm, k at the centres 1042 and 519 1/m at 1 ppm.
    const auto& d2 = shipped().potassium[0];
    const auto& d1 = shipped().potassium[1];
    const auto widths = line_widths(d2, 1100.0, 1.0);
    const double nm_per_Hz = d2.wavelength_um * d2.wavelength_um * 1e-3 / kLightSpeed_m_s;
    EXPECT_NEAR(widths.gauss_Hz * nm_per_Hz, 0.00291, 0.00001);
    EXPECT_NEAR(widths.lorentz_Hz * nm_per_Hz, 0.0137, 0.0001);
    EXPECT_NEAR(line_absorption_per_m(d2, d2.wavelength_um, 1100.0, 1e-6, 1.0), 1042.0, 2.0);
    EXPECT_NEAR(line_absorption_per_m(d1, d1.wavelength_um, 1100.0, 1e-6, 1.0), 519.0, 1.0);
}

TEST(Alkali, EquivalentWidthTableFollowsTheQuadrature) {
    const EquivalentWidthTable table(shipped().potassium, 1.0);
    for (const double x_path_m : {3e-14, 1.3e-9, 4e-8, 1.1e-6, 2.3e-5, 0.7e-3}) {
        for (const double T_K : {800.0, 1033.0, 1490.0, 2000.0}) {
            const double W_um = equivalent_width_um(shipped().potassium, x_path_m, T_K, 1.0);
            EXPECT_NEAR(table.at_um(x_path_m, T_K), W_um, 0.004 * W_um) << x_path_m << " " << T_K;
        }
    }
}

TEST(Alkali, WidthGrowsLinearlyThenWithTheSquareRoot) {
    const auto W = [](double x_path_m) { return equivalent_width_um(shipped().potassium, x_path_m, 1100.0, 1.0); };
    EXPECT_NEAR(W(2e-12) / W(1e-12), 2.0, 1e-3);
    EXPECT_NEAR(W(4e-7) / W(1e-7), 2.0, 0.03);
    // D1 to D2: f ratio 0.498 and lambda^2 when thin, 0.71 on the square-root part.
    const auto one = [](std::size_t line, double x_path_m) {
        return equivalent_width_um(std::span(&shipped().potassium[line], 1), x_path_m, 1100.0, 1.0);
    };
    EXPECT_NEAR(one(1, 1e-12) / one(0, 1e-12), 0.50, 0.01);
    EXPECT_NEAR(one(1, 1e-6) / one(0, 1e-6), 0.72, 0.02);
}

TEST(Alkali, MatchesEveryCheckValue) {
    const auto table = read_csv(source_folder() / "tests/unit/radiometry/data/kline_check_values.csv");
    const auto T_K = table.numbers("T_K"), path_m = table.numbers("path_m"), fv = table.numbers("fv"),
               x_K = table.numbers("x_K"), width_nm = table.numbers("W_total_nm"),
               eps_c = table.numbers("eps_continuum_768nm");
    const auto soot = load_soot_optics(source_folder() / "data/optical/soot_optics.csv");
    constexpr double kAir = 766.700922 / 766.48991;  // band centres of the file are air wavelengths
    struct Column {
        std::string name;
        Spectrum band;
    };
    const std::vector<Column> columns{{"ratio_766.5nm_fwhm3", gaussian(kAir * 766.5, 3.0)},
                                      {"ratio_770.0nm_fwhm3", gaussian(kAir * 770.0, 3.0)},
                                      {"ratio_768.67nm_fwhm10", gaussian(kAir * 768.67, 10.0)},
                                      {"ratio_759.12nm_fwhm10", gaussian(kAir * 759.12, 10.0)}};
    ASSERT_EQ(table.rows.size(), 54U);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        SCOPED_TRACE(table.row_lines[i]);
        const double depth = soot_absorption_per_m(soot, 0.768, fv[i]) * path_m[i];
        EXPECT_NEAR(-std::expm1(-depth), eps_c[i], 0.002 * eps_c[i]);
        const double W_nm = 1e3 * equivalent_width_um(shipped().potassium, x_K[i] * path_m[i], T_K[i], 1.0);
        EXPECT_NEAR(W_nm, width_nm[i], 0.01 * width_nm[i]);
        for (const auto& column : columns) {
            const double expected = table.numbers(column.name)[i];
            const double ratio = alkali_band_ratio(shipped().potassium, column.band, depth, x_K[i] * path_m[i], T_K[i], 1.0);
            EXPECT_NEAR(ratio, expected, 0.01 * expected) << column.name;
            // What potassium adds, not only the ratio near 1.
            EXPECT_NEAR(ratio - 1.0, expected - 1.0, 0.02 * (expected - 1.0) + 2e-4) << column.name;
        }
    }
}

// Thin limit in closed form: W = sum over lines of e^2 f lambda^2 / (4 eps0 m_e c^2) N L (1 - exp(-c2 / lambda T)); sodium and
// pressure (which only widens) by themselves.
TEST(Alkali, ThinSodiumHasItsClosedForm) {
    const double T_K = 1200.0, x_path_m = 1e-12, classical_m = 2.8179403e-15 * kPi;  // pi r_e
    for (const double pressure_atm : {1.0, 0.7}) {
        double W_um = 0.0;
        for (const auto& line : shipped().sodium) {
            const double lambda_m = 1e-6 * line.wavelength_um,
                         atoms_m2 = x_path_m * pressure_atm * 101325.0 / (1.380649e-23 * T_K);
            W_um += 1e6 * classical_m * line.oscillator_strength * lambda_m * lambda_m * atoms_m2 *
                    -std::expm1(-14387.77 / (line.wavelength_um * T_K));
        }
        EXPECT_NEAR(equivalent_width_um(shipped().sodium, x_path_m, T_K, pressure_atm) / W_um, 1.0, 0.01) << pressure_atm;
    }
}

TEST(Alkali, SodiumLinesStandAtTheirPlaceInAFlame) {
    const auto optics = load_flame_optics(source_folder() / "data/optical");
    FlameGas gas, with = gas;
    with.sodium_ppm = 1.0;
    const auto depth = [&](const FlameGas& g, double lambda_um) {
        FlamePath path(optics, lambda_um);
        path.add(1.0, 1100.0, g);
        return path.depth();
    };
    EXPECT_GT(depth(with, 0.589158326), 300.0);
    EXPECT_NEAR(depth(with, 0.65), depth(gas, 0.65), 1e-12);
}

// U.S. Standard Atmosphere 1976, table: 1500 m 845.6 hPa, 5000 m 540.5 hPa.
TEST(Pressure, FollowsTheStandardAtmosphere) {
    EXPECT_NEAR(standard_pressure_Pa(0.0), 101325.0, 1e-9);
    EXPECT_NEAR(standard_pressure_Pa(1500.0), 84560.0, 20.0);
    EXPECT_NEAR(standard_pressure_Pa(5000.0), 54048.0, 40.0);
}

}  // namespace
}  // namespace pyroscene::radiometry
