#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/flame_optics.h"
#include "radiometry/planck.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

const FlameOptics& shipped() {
    static const FlameOptics optics = load_flame_optics(source_folder() / "data/optical");
    return optics;
}

/// The mixture of the check values: the defaults, fv 1e-7, no alkali.
FlameGas reference_gas(double soot_volume_fraction = 1e-7) {
    FlameGas gas;
    gas.soot_volume_fraction = soot_volume_fraction;
    gas.potassium_ppm = gas.sodium_ppm = 0.0;
    return gas;
}

FlamePath slab(double lambda_um, double T_K, double length_m, const FlameGas& gas) {
    FlamePath path(shipped(), lambda_um);
    path.add(length_m, T_K, gas);
    return path;
}

/// Emissivity of a band, weighted with Planck's law, by sums over wavenumber.
double band_emissivity(double lower_um, double upper_um, double T_K, double length_m, const FlameGas& gas) {
    double emitted = 0.0, black = 0.0;
    for (double wavenumber = 1e4 / upper_um + 0.5; wavenumber < 1e4 / lower_um; wavenumber += 1.0) {
        const double lambda_um = 1e4 / wavenumber;
        const double B = planck_radiance(lambda_um, T_K) * lambda_um * lambda_um;
        black += B;
        emitted -= B * std::expm1(-slab(lambda_um, T_K, length_m, gas).depth());
    }
    return emitted / black;
}

TEST(FlameGas, MatchesEveryCheckValue) {
    const auto table = read_csv(source_folder() / "tests/unit/radiometry/data/flame_check_values.csv");
    const auto T_K = table.numbers("T_K"), length_m = table.numbers("path_m"), lambda_um = table.numbers("wavelength_um"),
               soot = table.numbers("tau_soot"), gas = table.numbers("tau_gas_snb"), weak = table.numbers("tau_gas_weak"),
               emissivity = table.numbers("emissivity"), radiance = table.numbers("radiance_W_m2_sr_um");
    ASSERT_EQ(table.rows.size(), 252U);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        SCOPED_TRACE(table.row_lines[i]);
        const auto path = slab(lambda_um[i], T_K[i], length_m[i], reference_gas());
        double x = 0.0;
        for (const auto species : kGasSpecies)
            x += gas_absorption(shipped().gas, species, lambda_um[i], T_K[i], reference_gas()).per_m * length_m[i];
        EXPECT_NEAR(path.soot_depth(), soot[i], 5e-4 * soot[i]);
        EXPECT_NEAR(path.gas_depth(), gas[i], 5e-4 * gas[i] + 1e-9);
        EXPECT_NEAR(x, weak[i], 5e-4 * weak[i] + 1e-9);
        EXPECT_NEAR(-std::expm1(-path.depth()), emissivity[i], 5e-4 * emissivity[i]);
        EXPECT_NEAR(path.emitted_radiance(), radiance[i], 5e-4 * radiance[i]);
    }
}

TEST(FlameGas, OpticalDepthsOfOneMetreAgreeWithRadcal) {
    const std::vector<std::pair<double, double>> expected{{2.7, 1.752}, {4.3, 17.16},  {6.3, 0.239},
                                                          {8.5, 0.294}, {10.6, 0.142}, {12.0, 0.173}};
    for (const auto& [lambda_um, depth] : expected)
        EXPECT_NEAR(slab(lambda_um, 1100.0, 1.0, reference_gas(0.0)).gas_depth(), depth, 0.004 * depth) << lambda_um;
}

TEST(FlameGas, BandEmissivitiesWithAndWithoutGas) {
    struct Row {
        double lower_um, upper_um;
        std::array<double, 3> with_gas, soot_only;
    };
    const std::vector<Row> rows{{0.9, 1.8, {0.148, 0.273, 0.610}, {0.138, 0.256, 0.587}},
                                {3.93, 3.99, {0.067, 0.129, 0.339}, {0.066, 0.127, 0.335}},
                                {3.0, 5.0, {0.258, 0.339, 0.552}, {0.068, 0.131, 0.343}},
                                {8.0, 11.0, {0.142, 0.242, 0.482}, {0.023, 0.046, 0.130}},
                                {8.0, 14.0, {0.165, 0.271, 0.512}, {0.021, 0.041, 0.117}},
                                {10.78, 11.28, {0.080, 0.149, 0.358}, {0.017, 0.034, 0.100}},
                                {0.6, 16.0, {0.263, 0.377, 0.624}, {0.071, 0.137, 0.347}}};
    const std::array<double, 3> length_m{0.5, 1.0, 3.0};
    FlameGas soot_only = reference_gas();
    soot_only.x_H2O = soot_only.x_CO2 = soot_only.x_CO = 0.0;
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < 3; ++i) {
            SCOPED_TRACE(testing::Message() << row.lower_um << " um, " << length_m[i] << " m");
            // Printed with three decimals: half a unit of the last place.
            EXPECT_NEAR(band_emissivity(row.lower_um, row.upper_um, 1100.0, length_m[i], reference_gas()), row.with_gas[i],
                        0.0011);
            EXPECT_NEAR(band_emissivity(row.lower_um, row.upper_um, 1100.0, length_m[i], soot_only), row.soot_only[i],
                        0.0011);
        }
    }
}

TEST(FlameGas, TotalGasEmissivityOfTheReferenceFlame) {
    // 600 to 9300 1/cm, gas alone, 1100 K, 1 m: 0.267 of sigma T^4 by the narrow-band model.
    const double lower_um = 1e4 / 9300.0, upper_um = 1e4 / 600.0;
    const double share = band_mean_radiance(1100.0, boxcar(lower_um, upper_um)) * (upper_um - lower_um) * kPi /
                         (kStefanBoltzmann_W_m2_K4 * std::pow(1100.0, 4));
    EXPECT_NEAR(share * band_emissivity(lower_um, upper_um, 1100.0, 1.0, reference_gas(0.0)), 0.267, 0.0006);
}

TEST(FlameGas, TotalEmissivityOfSootAndGas) {
    // 0.6 to 16 um: 0.263, 0.377 and 0.624 at 0.5, 1 and 3 m; the wider range adds little.
    for (const auto& [length_m, expected] : std::vector<std::pair<double, double>>{{0.5, 0.263}, {1.0, 0.377}, {3.0, 0.624}})
        EXPECT_NEAR(total_emissivity(shipped(), reference_gas(), 1100.0, length_m), expected, 0.01 * expected);
}

TEST(FlameGas, CuttingAnIsothermalPathChangesNothing) {
    for (const double lambda_um : {1.9, 2.7, 4.3, 4.67, 6.3, 10.6}) {
        FlamePath pieces(shipped(), lambda_um);
        for (const double length_m : {0.1, 1.7, 0.02, 0.18}) pieces.add(length_m, 1234.0, reference_gas());
        const auto whole = slab(lambda_um, 1234.0, 2.0, reference_gas());
        EXPECT_NEAR(pieces.depth(), whole.depth(), 1e-12 * whole.depth());
        EXPECT_NEAR(pieces.emitted_radiance(), whole.emitted_radiance(), 1e-10 * whole.emitted_radiance());
    }
}

TEST(FlameGas, PathTransmitsTheSameBothWays) {
    for (const double lambda_um : {2.7, 4.3, 4.67, 6.3}) {
        FlamePath there(shipped(), lambda_um), back(shipped(), lambda_um);
        const std::vector<std::pair<double, double>> pieces{{0.3, 1500.0}, {1.0, 900.0}, {5.0, 400.0}};
        for (const auto& [length_m, T_K] : pieces) there.add(length_m, T_K, reference_gas());
        for (auto p = pieces.rbegin(); p != pieces.rend(); ++p) back.add(p->first, p->second, reference_gas());
        EXPECT_NEAR(there.depth(), back.depth(), 1e-12 * there.depth());
    }
}

TEST(FlameGas, ThinAndStrongLimits) {
    // Thin: the depth is x. Strong collision-broadened lines: the depth grows with the square root of the path.
    const auto a = gas_absorption(shipped().gas, GasSpecies::H2O, 2.7, 300.0, reference_gas());
    GasColumn thin, strong, longer;
    thin.add(a, 1e-9 / a.per_m);
    EXPECT_NEAR(gas_optical_depth(GasSpecies::H2O, thin) / 1e-9, 1.0, 1e-6);
    const double far_m = 1e7 * a.a_lorentz / a.per_m;
    strong.add(a, far_m);
    longer.add(a, 4.0 * far_m);
    EXPECT_NEAR(gas_optical_depth(GasSpecies::H2O, longer) / gas_optical_depth(GasSpecies::H2O, strong), 2.0, 1e-3);
}

TEST(FlameGas, MethaneFollowsItsOwnBandModel) {
    FlameGas gas = reference_gas();
    gas.x_CH4 = 0.02;
    const auto a = gas_absorption(shipped().gas, GasSpecies::CH4, 3.31, 1000.0, gas);
    ASSERT_GT(a.per_m, 0.0);
    for (const double x : {1e-6, 0.1, 3.0, 40.0}) {
        GasColumn column;
        column.add(a, x / a.per_m);
        const double u = std::sqrt(4.0 * a.a_lorentz) * x / std::sqrt(16.0 * a.a_lorentz / kPi + x);
        EXPECT_NEAR(gas_optical_depth(GasSpecies::CH4, column), -std::log1p(-std::erf(u)), 1e-9 * x + 1e-13);
    }
    EXPECT_EQ(gas_absorption(shipped().gas, GasSpecies::CH4, 5.0, 1000.0, gas).per_m, 0.0);
}

TEST(FlameGas, InterpolatesInTheLogarithmOverTemperature) {
    // Rows of the file: CO2 at 630 1/cm, 33.67 at 300 K and 31.39 at 400 K (1/(atm m)); at 630 and 635 1/cm for 600 K.
    const auto& kappa = shipped().gas[GasSpecies::CO2].kappa_per_atm_m;
    EXPECT_NEAR(kappa.at(630.0, 350.0), std::sqrt(33.67 * 31.39), 1e-9);
    EXPECT_NEAR(kappa.at(632.5, 600.0), 0.5 * (29.12 + 38.22), 1e-9);
    EXPECT_EQ(kappa.at(599.0, 600.0), 0.0);
}

TEST(FlameGas, MissingTablesAreNamed) {
    try {
        load_gas_optics(source_folder() / "data/fuel");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("gas_kappa_h2o.csv"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace pyroscene::radiometry
