#include "radiometry/atmosphere.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

const AtmosphereSet& summer() {
    static const auto set = load_atmosphere("midlatitude_summer");
    return set;
}

AtmospherePoint point(double altitude_m, double view_deg, double sun_deg, double azimuth_deg) {
    AtmospherePoint p;
    p.conditions.sensor_altitude_agl_m = altitude_m;
    p.conditions.sun_zenith_rad = sun_deg * kDegree_rad;
    p.view_zenith_rad = view_deg * kDegree_rad;
    p.relative_azimuth_rad = azimuth_deg * kDegree_rad;
    return p;
}

double window_mean(const AtmosphericTerms& t, const std::vector<double>& values, double lower_um, double upper_um) {
    return mean_over({Quantity::Dimensionless, t.wavelength_um, values}, lower_um, upper_um);
}

/// Mean of the samples in a window, as the README of the tables quotes transmittances.
double sample_mean(const AtmosphericTerms& t, const std::vector<double>& values, double lower_um, double upper_um) {
    double sum = 0.0;
    int n = 0;
    for (std::size_t l = 0; l < values.size(); ++l)
        if (t.wavelength_um[l] >= lower_um && t.wavelength_um[l] <= upper_um) {
            sum += values[l];
            ++n;
        }
    return sum / n;
}

double vertical_transmittance(const AtmosphereSet& set, double altitude_m, double lower_um, double upper_um,
                              AtmosphereConditions conditions = {}) {
    conditions.sensor_altitude_agl_m = altitude_m;
    const auto terms = evaluate(set, {conditions, 0.0, 0.0});
    return sample_mean(terms, terms.transmittance, lower_um, upper_um);
}

double relative_to(double value, double reference) {
    return reference > 0.0 ? std::abs(value / reference - 1.0) : std::abs(value);
}

TEST(Atmosphere, NodeValuesComeBack) {
    const auto& table = summer().tables.front();
    const std::size_t nl = table.lambda_count(), nv = 7, ns = 5;
    for (const auto& [a, v, s, r] : {std::array<std::size_t, 4>{0, 0, 0, 0}, {3, 2, 1, 1}, {5, 4, 3, 2}, {9, 6, 4, 0}}) {
        const auto terms = evaluate(summer(), point(table.sensor_altitude_km[a] * 1000.0, table.view_zenith_deg[v],
                                                    table.solar_zenith_deg[s], table.relative_azimuth_deg[r]));
        for (std::size_t l = 0; l < nl; l += 3) {
            SCOPED_TRACE(testing::Message() << table.wavelength_um[l] << " um, altitude " << table.sensor_altitude_km[a]);
            const std::size_t path = (a * nv + v) * nl + l;
            ASSERT_NEAR(terms.transmittance[l], table.transmittance[path], 1e-9);
            ASSERT_LT(relative_to(terms.path_thermal[l], table.path_thermal_radiance[path]), 1e-5);
            const double L = table.path_solar_radiance[(((a * nv + v) * ns + s) * 3 + r) * nl + l];
            ASSERT_NEAR(terms.path_solar[l], L, 1e-6 * L + 2e-7);
            ASSERT_NEAR(terms.direct_normal[l], table.direct_solar_irradiance[s * nl + l],
                        1e-9 * table.toa_solar_irradiance[l]);
            ASSERT_NEAR(terms.diffuse[l], table.diffuse_solar_irradiance[s * nl + l], 1e-9 * table.toa_solar_irradiance[l]);
            ASSERT_EQ(terms.thermal_sky[l], table.thermal_sky_irradiance[l]);
            ASSERT_EQ(terms.spherical_albedo[l], table.spherical_albedo[l]);
            ASSERT_NEAR(terms.diffuse_transmittance[l], table.diffuse_upward_transmittance[path], 1e-9);
            ASSERT_LT(
                relative_to(terms.solar_correlation[l], table.solar_path_correlation[((a * nv + v) * ns + s) * nl + l]),
                1e-9);
        }
    }
}

TEST(Atmosphere, VerticalTransmittancesOfTheTablesReadme) {
    struct Row {
        double lower_um, upper_um;
        std::array<double, 3> to_space_4200_1000;
    };
    for (const auto& [lower, upper, expected] :
         {Row{3.7, 4.0, {0.773, 0.798, 0.879}}, Row{3.93, 3.99, {0.825, 0.859, 0.930}}, Row{4.6, 4.8, {0.50, 0.56, 0.70}},
          Row{8.4, 8.7, {0.59, 0.62, 0.75}}, Row{11.5, 12.5, {0.544, 0.555, 0.704}}, Row{10.5, 11.5, {0.677, 0.686, 0.803}},
          Row{0.85, 0.87, {0.806, 0.833, 0.920}}, Row{0.54, 0.56, {0.637, 0.724, 0.872}},
          Row{4.25, 4.35, {0.0, 0.0, 0.0}}}) {
        SCOPED_TRACE(testing::Message() << lower << " to " << upper);
        const double digits = lower == 4.6 || lower == 8.4 ? 0.011 : 0.0011;  // two or three decimals
        const std::array<double, 3> altitude_m{100e3, 4200.0, 1000.0};
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(vertical_transmittance(summer(), altitude_m[i], lower, upper), expected[i], digits) << altitude_m[i];
    }
    const auto standard = load_atmosphere("us_standard_1976");
    EXPECT_NEAR(vertical_transmittance(standard, 100e3, 3.7, 4.0), 0.822, 0.002);
    EXPECT_NEAR(vertical_transmittance(standard, 4200.0, 10.5, 11.5), 0.862, 0.002);
}

TEST(Atmosphere, TakesTheTableOfTheGroundElevation) {
    // 11 um, 4.2 km above ground: 0.69 over the sea, 0.83 / 0.91 / 0.95 over 1 / 2 / 3 km ground (README of the tables).
    AtmosphereConditions c;
    double last = vertical_transmittance(summer(), 4200.0, 10.9, 11.1);
    EXPECT_NEAR(last, 0.69, 0.006);
    const std::array<double, 3> expected{0.83, 0.91, 0.95};
    for (std::size_t km = 1; km <= 3; ++km) {
        const double upper_m = 1000.0 * static_cast<double>(km);
        c.ground_elevation_m = upper_m;
        const double at_node =
            vertical_transmittance(load_atmosphere("midlatitude_summer", 23.0, upper_m), 4200.0, 10.9, 11.1, c);
        EXPECT_NEAR(at_node, expected[km - 1], 0.006);
        c.ground_elevation_m = upper_m - 500.0;
        const double between =
            vertical_transmittance(load_atmosphere("midlatitude_summer", 23.0, upper_m - 500.0), 4200.0, 10.9, 11.1, c);
        EXPECT_GT(between, last);
        EXPECT_LT(between, at_node);
        last = at_node;
    }
}

TEST(Atmosphere, OpticalDepthIsGeometricBetweenElevations) {
    const auto set = load_atmosphere("us_standard_1976", 23.0, 1250.0);
    const auto tau = [&](double ground_m) {
        auto p = point(3000.0, 30.0, 45.0, 0.0);
        p.conditions.ground_elevation_m = ground_m;
        return evaluate_at(set, p, 10.0).transmittance[0];
    };
    EXPECT_NEAR(std::log(-std::log(tau(1250.0))),
                0.75 * std::log(-std::log(tau(1000.0))) + 0.25 * std::log(-std::log(tau(2000.0))), 1e-9);
}

TEST(Atmosphere, SeaLevelOnlyModelOverMountains) {
    // Opaque bands stay opaque, windows clear up, and the rule reproduces what a model with elevation tables has.
    const auto set = load_atmosphere("tropical", 23.0, 2000.0);
    auto p = point(3000.0, 0.0, 30.0, 0.0);
    const auto sea = evaluate(set, p);
    p.conditions.ground_elevation_m = 2000.0;
    const auto high = evaluate(set, p);
    EXPECT_LT(window_mean(high, high.transmittance, 4.25, 4.35), 1e-3);
    EXPECT_GT(window_mean(high, high.transmittance, 10.5, 11.5), window_mean(sea, sea.transmittance, 10.5, 11.5) + 0.2);
    EXPECT_LT(window_mean(high, high.thermal_sky, 10.5, 11.5), 0.6 * window_mean(sea, sea.thermal_sky, 10.5, 11.5));
    for (std::size_t l = 0; l < high.transmittance.size(); ++l) {
        ASSERT_LE(high.direct_normal[l], summer().tables.front().toa_solar_irradiance[l] * 1.000001);
        ASSERT_TRUE(std::isfinite(high.path_solar[l] + high.path_thermal[l] + high.solar_correlation[l]));
    }
}

TEST(Atmosphere, ElevationRuleAgreesWithRealTables) {
    // US standard from its sea-level table and the ratios of mid-latitude summer, against its own table for 2 km.
    AtmosphereSet predicted, actual;
    for (const auto* file :
         {"lowtran7_us_standard_1976_rural23_ground0.nc", "lowtran7_midlatitude_summer_rural23_ground0.nc",
          "lowtran7_midlatitude_summer_rural23_ground2.nc"})
        predicted.tables.push_back(load_table(file));
    actual.tables.push_back(load_table("lowtran7_us_standard_1976_rural23_ground2.nc"));
    auto p = point(3000.0, 30.0, 30.0, 90.0);
    p.conditions.ground_elevation_m = 2000.0;
    const auto a = evaluate(predicted, p), b = evaluate(actual, p);
    const auto difference = [&](const std::vector<double>& x, const std::vector<double>& y, double lower, double upper) {
        double sum = 0.0;
        int n = 0;
        for (std::size_t l = 0; l < x.size(); ++l)
            if (a.wavelength_um[l] > lower && a.wavelength_um[l] < upper) {
                sum += std::abs(x[l] - y[l]);
                ++n;
            }
        return sum / n;
    };
    EXPECT_LT(difference(a.transmittance, b.transmittance, 0.4, 0.7), 0.005);
    EXPECT_LT(difference(a.transmittance, b.transmittance, 0.9, 1.8), 0.025);
    EXPECT_LT(difference(a.transmittance, b.transmittance, 3.0, 5.0), 0.025);
    EXPECT_LT(difference(a.transmittance, b.transmittance, 8.0, 12.0), 0.035);
    EXPECT_LT(difference(a.path_thermal, b.path_thermal, 8.0, 12.0), 0.15);
    EXPECT_LT(difference(a.direct_normal, b.direct_normal, 0.9, 1.8), 20.0);
}

TEST(Atmosphere, VisibilityBetweenTables) {
    const auto set = load_atmosphere("midlatitude_summer", 10.0, 0.0);
    const auto tau = [&](double visibility_km) {
        auto p = point(4200.0, 30.0, 45.0, 60.0);
        p.conditions.visibility_km = visibility_km;
        return evaluate_at(set, p, 0.55);
    };
    // ln tau linear in 1/V, ln E_dif linear in ln V; the ends are the tables themselves.
    const auto low = tau(5.0), mid = tau(10.0), high = tau(23.0);
    const double f = (1.0 / 10.0 - 1.0 / 5.0) / (1.0 / 23.0 - 1.0 / 5.0), g = std::log(10.0 / 5.0) / std::log(23.0 / 5.0);
    const auto expected = [&](double a, double b, double fraction) {
        return std::pow(a, 1.0 - fraction) * std::pow(b, fraction);
    };
    EXPECT_NEAR(mid.transmittance[0], expected(low.transmittance[0], high.transmittance[0], f), 2e-4);
    EXPECT_NEAR(mid.diffuse[0] / expected(low.diffuse[0], high.diffuse[0], g), 1.0, 1e-3);
    EXPECT_NEAR(high.transmittance[0], evaluate_at(summer(), point(4200.0, 30.0, 45.0, 60.0), 0.55).transmittance[0], 1e-9);
    EXPECT_LT(low.transmittance[0], mid.transmittance[0]);
    EXPECT_GT(low.path_solar[0], high.path_solar[0]);
    EXPECT_LT(low.direct_normal[0], high.direct_normal[0]);
}

TEST(Atmosphere, VisibilityRatioForModelsWithOneTable) {
    auto p = point(100e3, 0.0, 45.0, 0.0);
    p.conditions.visibility_km = 5.0;
    const auto tropical5 = evaluate_at(load_atmosphere("tropical", 5.0, 0.0), p, 0.86);
    const auto summer5 = evaluate_at(load_atmosphere("midlatitude_summer", 5.0, 0.0), p, 0.86);
    p.conditions.visibility_km = 23.0;
    const auto tropical23 = evaluate_at(load_atmosphere("tropical"), p, 0.86), summer23 = evaluate_at(summer(), p, 0.86);
    EXPECT_NEAR(tropical5.transmittance[0] / tropical23.transmittance[0],
                summer5.transmittance[0] / summer23.transmittance[0], 1e-3);
    EXPECT_NEAR(tropical5.path_solar[0] / tropical23.path_solar[0], summer5.path_solar[0] / summer23.path_solar[0], 0.02);
}

TEST(Atmosphere, VanishesTowardsTheGround) {
    for (double altitude_m : {0.0, 1e-3, 1.0}) {
        const auto t = evaluate(summer(), point(altitude_m, 45.0, 30.0, 30.0));
        for (std::size_t l = 0; l < t.wavelength_um.size(); ++l) {
            // Emissivity of 1 m of air: well below 0.3 even in the strongest band at 20 cm-1.
            ASSERT_GE(t.transmittance[l], altitude_m == 0.0 ? 1.0 : 1.0 - 0.3 * altitude_m);
            ASSERT_LE(t.path_thermal[l], 3.0 * altitude_m);
            ASSERT_LE(t.path_solar[l], 0.2 * altitude_m);
            ASSERT_LE(t.solar_correlation[l], 1.0 + 5.0 * altitude_m);
            ASSERT_LE(t.diffuse_transmittance[l], 0.01 * altitude_m);
        }
    }
}

TEST(Atmosphere, LongerPathsTransmitLess) {
    AtmosphericTerms last;
    for (double altitude_m : {0.0, 50.0, 150.0, 700.0, 3000.0, 15e3, 80e3, 100e3, 400e3, 800e3}) {
        const auto t = evaluate(summer(), point(altitude_m, 20.0, 30.0, 0.0));
        for (std::size_t l = 0; l < t.transmittance.size(); ++l) {
            ASSERT_GE(t.transmittance[l], 0.0);
            ASSERT_LE(t.transmittance[l], 1.0);
            if (!last.transmittance.empty()) {
                ASSERT_LE(t.transmittance[l], last.transmittance[l] + 2e-3)
                    << altitude_m << " m, " << t.wavelength_um[l] << " um";
            }
        }
        last = t;
    }
    const auto nadir = evaluate(summer(), point(3000.0, 0.0, 30.0, 0.0)),
               slant = evaluate(summer(), point(3000.0, 60.0, 30.0, 0.0));
    for (std::size_t l = 0; l < nadir.transmittance.size(); ++l)
        ASSERT_LE(slant.transmittance[l], nadir.transmittance[l] + 1e-4);
}

TEST(Atmosphere, AboveTheTablesNothingChanges) {
    const auto top = evaluate(summer(), point(100e3, 30.0, 30.0, 0.0)),
               orbit = evaluate(summer(), point(705e3, 30.0, 30.0, 0.0));
    EXPECT_EQ(top.transmittance, orbit.transmittance);
    EXPECT_EQ(top.path_solar, orbit.path_solar);
}

TEST(Atmosphere, NightHasNoSolarTerms) {
    for (double sun_deg : {90.0, 120.0, 180.0}) {
        const auto t = evaluate(summer(), point(3000.0, 30.0, sun_deg, 0.0));
        for (std::size_t l = 0; l < t.wavelength_um.size(); ++l)
            ASSERT_EQ(std::abs(t.path_solar[l]) + t.direct_normal[l] + t.diffuse[l] + std::abs(t.path_solar_series[1][l]),
                      0.0);
        EXPECT_GT(window_mean(t, t.path_thermal, 8.0, 12.0), 0.1);
        EXPECT_GT(window_mean(t, t.thermal_sky, 8.0, 12.0), 1.0);
    }
}

TEST(Atmosphere, LowSunFadesToTheHorizon) {
    const auto direct = [&](double sun_deg) {
        return evaluate_at(summer(), point(3000.0, 0.0, sun_deg, 0.0), 0.86).direct_normal[0];
    };
    EXPECT_NEAR(direct(75.0 + 1e-9), direct(75.0), 1e-6 * direct(75.0));
    EXPECT_NEAR(direct(85.0) / direct(75.0), std::cos(85.0 * kDegree_rad) / std::cos(75.0 * kDegree_rad), 1e-9);
    EXPECT_LT(direct(89.99), 1e-3 * direct(75.0));
}

TEST(Atmosphere, SunDistanceDimsSolarTermsOnly) {
    auto p = point(3000.0, 30.0, 45.0, 0.0);
    const auto near = evaluate_at(summer(), p, 1.6);
    p.conditions.sun_distance_AU = 1.0167;
    const auto far = evaluate_at(summer(), p, 1.6);
    const double factor = 1.0 / (1.0167 * 1.0167);
    EXPECT_NEAR(far.direct_normal[0] / near.direct_normal[0], factor, 1e-12);
    EXPECT_NEAR(far.diffuse[0] / near.diffuse[0], factor, 1e-12);
    EXPECT_NEAR(far.path_solar[0] / near.path_solar[0], factor, 1e-12);
    EXPECT_EQ(far.transmittance, near.transmittance);
    EXPECT_EQ(far.thermal_sky, near.thermal_sky);
}

TEST(Atmosphere, AzimuthFollowsTheCosineSeries) {
    const auto at = [&](double azimuth_deg) {
        return evaluate_at(summer(), point(4200.0, 45.0, 45.0, azimuth_deg), 0.55).path_solar[0];
    };
    const double a0 = (at(0) + 2.0 * at(90) + at(180)) / 4.0, a1 = (at(0) - at(180)) / 2.0,
                 a2 = (at(0) - 2.0 * at(90) + at(180)) / 4.0;
    EXPECT_NEAR(at(60), a0 + a1 * std::cos(kPi / 3.0) + a2 * std::cos(2.0 * kPi / 3.0), 1e-9);
    EXPECT_NEAR(at(-60), at(60), 1e-9);
    EXPECT_GT(at(0), at(90));  // aerosol scatters forwards
}

TEST(Atmosphere, CorrelationFactorsOfTheReadme) {
    // C = 1.14 at 3.75 um, 1.33 at 0.94 um, 1.5 at 2.0 um for sun 45 deg, nadir, 4.2 km; 1.000 in clear windows.
    const auto C = [&](double lambda_um) {
        return evaluate_at(summer(), point(4200.0, 0.0, 45.0, 0.0), lambda_um).solar_correlation[0];
    };
    EXPECT_NEAR(C(3.75), 1.14, 0.02);
    EXPECT_NEAR(C(0.94), 1.33, 0.04);
    EXPECT_NEAR(C(2.0), 1.5, 0.1);
    EXPECT_NEAR(C(0.55), 1.0, 0.002);
}

TEST(Atmosphere, OneWavelengthIsTheSpectrumInterpolated) {
    const auto p = point(2500.0, 25.0, 50.0, 120.0);
    const auto all = evaluate(summer(), p);
    for (double lambda_um : {0.36, 0.77, 1.234, 3.959, 4.3, 10.6, 15.3}) {
        const auto one = evaluate_at(summer(), p, lambda_um);
        ASSERT_EQ(one.transmittance.size(), 1U);
        const auto expected = [&](const std::vector<double>& values) {
            return Spectrum{Quantity::Dimensionless, all.wavelength_um, values}.at(lambda_um);
        };
        EXPECT_NEAR(one.transmittance[0], expected(all.transmittance), 1e-12);
        EXPECT_NEAR(one.path_thermal[0], expected(all.path_thermal), 1e-12);
        EXPECT_NEAR(one.path_solar[0], expected(all.path_solar), 1e-9);
        EXPECT_NEAR(one.direct_normal[0], expected(all.direct_normal), 1e-9);
    }
}

TEST(Atmosphere, WarnsWhatItClamps) {
    EXPECT_TRUE(atmosphere_warnings(summer(), point(3000.0, 65.0, 75.0, 0.0)).empty());
    EXPECT_TRUE(atmosphere_warnings(summer(), point(800e3, 65.0, 120.0, 0.0)).empty());
    EXPECT_EQ(atmosphere_warnings(summer(), point(3000.0, 70.0, 80.0, 0.0)).size(), 2U);
    auto p = point(3000.0, 0.0, 30.0, 0.0);
    p.conditions.visibility_km = 3.0;
    p.conditions.ground_elevation_m = 4000.0;
    const auto set = load_atmosphere("midlatitude_summer", 3.0, 4000.0);
    const auto warnings = atmosphere_warnings(set, p);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE(warnings[0].find("visibility 3 km"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("3000 m"), std::string::npos) << warnings[1];
    const auto clamped = evaluate_at(set, p, 10.0);
    p.conditions.visibility_km = 5.0;
    p.conditions.ground_elevation_m = 3000.0;
    EXPECT_NEAR(clamped.transmittance[0], evaluate_at(set, p, 10.0).transmittance[0], 1e-12);
}

TEST(Atmosphere, RefusesWhatItCannotUse) {
    auto p = point(3000.0, 30.0, 45.0, 0.0);
    EXPECT_THROW((void)evaluate(AtmosphereSet{}, p), Error);
    EXPECT_THROW((void)evaluate_at(summer(), p, 20.0), Error);
    EXPECT_THROW((void)evaluate_at(summer(), p, std::nan("")), Error);
    p.conditions.sun_zenith_rad = std::nan("");
    EXPECT_THROW((void)evaluate(summer(), p), Error);
    p.conditions.sun_zenith_rad = 0.3;
    p.conditions.visibility_km = 0.0;
    EXPECT_THROW((void)evaluate(summer(), p), Error);
    AtmosphereSet mixed{{summer().tables.front(), summer().tables.front()}};
    mixed.tables[1].wavelength_um[0] *= 0.999;
    EXPECT_THROW((void)evaluate(mixed, point(3000.0, 30.0, 45.0, 0.0)), Error);
}

}  // namespace
}  // namespace pyroscene::radiometry
