// Readers of MODTRAN and libRadtran output, against real files (tests/data/atmosphere) and the definitions of their columns.
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "radiometry/assemble_atmosphere.h"
#include "radiometry/modtran_columns.h"
#include "radiometry/planck.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

Spectrum sun() {
    const auto table = read_csv(source_folder() / "data/optical/solar_irradiance.csv");
    return {Quantity::Irradiance, table.numbers("wavelength_um"), table.numbers("irradiance_W_m2_um")};
}

AtmosphereRun sample(const std::string& name) {
    const auto file = source_folder() / "tests/data/atmosphere" / name;
    const auto runs = read_modtran_table(file.string(), read_text_file(file), {}, sun());
    EXPECT_EQ(runs.size(), 1U);
    return runs.front();
}

std::size_t at_wavenumber(const AtmosphereRun& run, double wavenumber) {
    for (std::size_t l = 0; l < run.wavelength_um.size(); ++l)
        if (std::abs(1e4 / run.wavelength_um[l] - wavenumber) < 1e-6 * wavenumber) return l;
    ADD_FAILURE() << "no row " << wavenumber;
    return 0;
}

TEST(ModtranTable, RadiancesOfARealFileInProductUnits) {
    const auto run = sample("modtran5_tape7_iemsct2_imult1.txt");
    EXPECT_EQ(run.wavelength_um.size(), 51U);
    const auto l = at_wavenumber(run, 2050.0);
    EXPECT_NEAR(run.transmittance[l], 0.74772996, 1e-9);
    EXPECT_NEAR(run.total_radiance[l], 5.2178e-8 * 2050.0 * 2050.0, 1e-9);
    EXPECT_NEAR(run.total_radiance[l], 0.21928, 5e-6);
    EXPECT_NEAR(run.toa_irradiance[l], 4.0486, 5e-5);
    EXPECT_NEAR(run.path_thermal[l] + run.path_solar[l], run.total_radiance[l], 2e-5);
    // The file's own brightness temperature of that row.
    EXPECT_NEAR(brightness_temperature(run.wavelength_um[l], run.total_radiance[l]), 241.979, 0.01);
    EXPECT_TRUE(run.looks_up);
    EXPECT_NEAR(*run.geometry.view_zenith_deg, 20.0, 1e-9);
    EXPECT_NEAR(*run.geometry.sensor_altitude_km, 100.0, 1e-9);
    EXPECT_NEAR(*run.geometry.visibility_km, 23.0, 1e-9);
    for (std::size_t i = 1; i < run.wavelength_um.size(); ++i) ASSERT_GT(run.wavelength_um[i], run.wavelength_um[i - 1]);
}

TEST(ModtranTable, BlankColumnDoesNotShiftTheRest) {
    const auto run = sample("modtran5_tape7_iemsct2_blank_column.txt");
    EXPECT_EQ(run.wavelength_um.size(), 13U);
    const auto l = at_wavenumber(run, 655.0);
    EXPECT_NEAR(run.total_radiance[l], 1.5065e-5 * 655.0 * 655.0, 1e-6);
    EXPECT_NEAR(run.path_thermal[l], run.total_radiance[l], 1e-6);
    EXPECT_NEAR(run.toa_irradiance[l], 1.0775e-7 * 655.0 * 655.0, 1e-8);
    EXPECT_EQ(run.transmittance[l], 0.0);
}

TEST(ModtranTable, TransmittanceModeHasTwoHeaderLines) {
    const auto run = sample("modtran5_tape7_iemsct0.txt");
    EXPECT_EQ(run.transmittance[at_wavenumber(run, 655.0)], 0.0);
    EXPECT_TRUE(run.path_thermal.empty());
    EXPECT_FALSE(run.geometry.view_zenith_deg.has_value());  // a horizontal path
    for (const double tau : run.transmittance) ASSERT_TRUE(tau >= 0.0 && tau <= 1.0);
}

TEST(ModtranTable, DirectSunMode) {
    const auto run = sample("modtran5_tape7_iemsct3.txt");
    const auto l = at_wavenumber(run, 2053.0);
    EXPECT_NEAR(run.direct_normal[l], 2.20e-13 * 2053.0 * 2053.0, 1e-12);
    EXPECT_NEAR(run.toa_irradiance[l], 9.63e-7 * 2053.0 * 2053.0, 1e-9);
}

TEST(ModtranNumbers, FortranSpellings) {
    EXPECT_NEAR(*fortran_number("1.234-101"), 1.234e-101, 1e-113);
    EXPECT_EQ(*fortran_number(" 1.5D+02"), 150.0);
    EXPECT_EQ(*fortran_number("-99.0"), -99.0);
    EXPECT_FALSE(fortran_number("*****").has_value());
    EXPECT_FALSE(fortran_number("   ").has_value());
}

TEST(ModtranUnits, WavenumberSquaredAndTheOthers) {
    EXPECT_NEAR(to_product_unit(SpectralUnit::PerWavenumber, 1e4 / 2050.0), 2050.0 * 2050.0, 1e-6);
    EXPECT_EQ(to_product_unit(SpectralUnit::PerMicrometre, 4.0), 1e4);
    EXPECT_EQ(to_product_unit(SpectralUnit::PerNanometre, 4.0), 1e7);
    EXPECT_EQ(to_product_unit(SpectralUnit::MicrowattPerNanometre, 4.0), 10.0);
    EXPECT_EQ(to_product_unit(SpectralUnit::MilliwattPerNanometreM2, 4.0), 1.0);
}

TEST(ModtranChannels, RealFileSumsAndCoefficients) {
    const auto file = source_folder() / "tests/data/atmosphere/modtran6_channels.chn";
    RunHints hints;
    hints.geometry.sun_zenith_deg = 32.7;
    const auto runs = read_modtran_channels(file.string(), read_text_file(file), hints, sun());
    ASSERT_EQ(runs.size(), 1U);
    const auto& run = runs.front();
    ASSERT_EQ(run.wavelength_um.size(), 223U);
    const double cosine = std::cos(32.7 * 3.14159265358979 / 180.0);
    for (std::size_t l = 0; l < run.wavelength_um.size(); ++l) {
        if (run.transmittance[l] < 0.05) continue;
        // Sun and sky never exceed what comes in; clear air lets most of it through.
        const double ground = run.direct_normal[l] * cosine + run.diffuse[l];
        ASSERT_LT(ground, 1.001 * run.toa_irradiance[l] * cosine) << run.wavelength_um[l];
        ASSERT_GE(run.diffuse_transmittance[l], 0.0);
    }
    hints.geometry.sun_zenith_deg = 60.0;  // would make the sun 1.7 times as bright
    EXPECT_THROW((void)read_modtran_channels(file.string(), read_text_file(file), hints, sun()), Error);
}

TEST(Uvspec, TwoTemperaturesTellTransmittanceAndPath) {
    // L = tau B(T) + L_path over black ground: made up for tau = 0.6 and L_path = 1.5, in W m-2 nm-1.
    RunHints hints;
    hints.geometry.sensor_altitude_km = 3.0;
    hints.geometry.view_zenith_deg = 0.0;
    const auto run_at = [&](double T) {
        std::string text;
        for (const double nm : {10000.0, 10500.0, 11000.0})
            text += std::to_string(nm) + " " + std::to_string(1e3 * (0.6 * planck_radiance(1e-3 * nm, T) + 1.5)) + "\n";
        hints.geometry.surface_temperature_K = T;
        hints.unit = SpectralUnit::MilliwattPerNanometreM2;
        auto run = read_uvspec("thermal.out", text, {"lambda", "uu"}, true, hints);
        for (double& L : run.total_radiance) L *= 1e-3;
        return run;
    };
    auto first = run_at(260.0), second = run_at(320.0);
    AtmosphereRun levels = read_uvspec("tau.out", "10000 0 0.5\n10000 3 1.0\n11000 0 0.5\n11000 3 1.0\n",
                                       {"lambda", "zout", "edir"}, false, hints);
    EXPECT_EQ(levels.transmittance, (std::vector<double>{0.5, 0.5}));
    const auto made = assemble_atmosphere({first, second, levels}, true);
    for (std::size_t l = 0; l < 3; ++l) {
        EXPECT_NEAR(made.table.transmittance[l], 0.6, 1e-5);
        EXPECT_NEAR(made.table.path_thermal_radiance[l], 1.5, 1e-4);
    }
}

TEST(Assemble, OneViewAngleFollowsBeersLaw) {
    AtmosphereRun run;
    run.source = "made up";
    run.geometry.sensor_altitude_km = 2.0;
    run.geometry.view_zenith_deg = 0.0;
    run.wavelength_um = {10.0, 11.0};
    run.transmittance = {0.7, 0.8};
    run.path_thermal = {2.0, 1.0};
    const auto made = assemble_atmosphere({run}, true);
    ASSERT_EQ(made.table.view_zenith_deg, (std::vector<double>{0.0, 65.0}));
    const double secant = 1.0 / std::cos(65.0 * 3.14159265358979 / 180.0);
    EXPECT_NEAR(made.table.transmittance[2], std::pow(0.7, secant), 1e-6);
    EXPECT_NEAR(made.table.path_thermal_radiance[2], 2.0 / 0.3 * (1.0 - std::pow(0.7, secant)), 1e-5);
    EXPECT_FALSE(made.notes.empty());
}

TEST(Assemble, NamesAMissingNode) {
    AtmosphereRun run;
    run.source = "a";
    run.geometry.sensor_altitude_km = 2.0;
    run.geometry.view_zenith_deg = 0.0;
    run.wavelength_um = {10.0, 11.0};
    run.transmittance = {0.7, 0.8};
    auto other = run;
    other.geometry.sensor_altitude_km = 4.0;
    other.geometry.view_zenith_deg = 40.0;
    try {
        (void)assemble_atmosphere({run, other}, true);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(e.what()).find("sensor 2 km above ground, view zenith 40 deg"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace pyroscene::radiometry
