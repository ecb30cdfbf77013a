#include "radiometry/view_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/planck.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

const AtmosphereSet& summer() {
    static const auto set = load_atmosphere("midlatitude_summer");
    return set;
}

AtmosphereConditions conditions(double altitude_m, double sun_deg) {
    AtmosphereConditions c;
    c.sensor_altitude_agl_m = altitude_m;
    c.sun_zenith_rad = sun_deg * kDegree_rad;
    return c;
}

ViewAtmosphere::View view_of(const ViewAtmosphere& atmosphere, double view_deg, double azimuth_deg, double ground_m = 0.0) {
    ViewAtmosphere::View view;
    view.resize(atmosphere.lambda_count());
    atmosphere.at(view_deg * kDegree_rad, azimuth_deg * kDegree_rad, ground_m, view);
    return view;
}

std::vector<double> constant(const SpectralGrid& grid, double value) {
    return std::vector<double>(static_cast<std::size_t>(grid.size()), value);
}

SpectralGrid wasp_grid() {
    return make_spectral_grid(std::vector<Spectrum>{boxcar(0.9, 1.8), boxcar(3.0, 5.0), boxcar(8.0, 11.0)});
}

TEST(ViewAtmosphere, VacuumChangesNothing) {
    const auto air = vacuum(3);
    ASSERT_EQ(air.lambda_count(), 3);
    for (double view_deg : {0.0, 30.0, 89.0}) {
        const auto view = view_of(air, view_deg, 10.0);
        for (std::size_t l = 0; l < 3; ++l) {
            EXPECT_EQ(view.transmittance[l], 1.0F);
            EXPECT_EQ(view.path_thermal[l] + view.path_solar[l] + view.adjacency[l], 0.0F);
            EXPECT_EQ(view.solar_correlation[l], 1.0F);
        }
    }
    EXPECT_EQ(
        air.direct_normal_irradiance_W_m2_um[0] + air.diffuse_irradiance_W_m2_um[1] + air.thermal_irradiance_W_m2_um[2],
        0.0F);
}

TEST(ViewAtmosphere, FollowsTheSchemeBetweenItsNodes) {
    // At single wavelengths there is nothing to average, so evaluate_at is the exact value for every view angle.
    const std::vector<double> lambda_um{0.55, 0.94, 1.6, 2.2, 3.75, 3.96, 4.5, 4.7, 6.7, 8.5, 9.6, 11.0, 13.0};
    const auto grid = monochromatic_grid(lambda_um);
    for (double altitude_m : {500.0, 3000.0, 100e3}) {
        const auto c = conditions(altitude_m, 40.0);
        const auto atmosphere = make_view_atmosphere(summer(), c, grid, constant(grid, 0.0));
        for (double view_deg : {0.0, 3.0, 11.0, 15.0, 22.0, 37.0, 48.0, 57.0, 63.0, 65.0, 71.0, 78.0}) {
            const auto view = view_of(atmosphere, view_deg, 70.0);
            for (std::size_t l = 0; l < lambda_um.size(); ++l) {
                SCOPED_TRACE(testing::Message() << lambda_um[l] << " um, view " << view_deg << ", altitude " << altitude_m);
                const auto exact = evaluate_at(summer(), {c, view_deg * kDegree_rad, 70.0 * kDegree_rad}, lambda_um[l]);
                EXPECT_NEAR(view.transmittance[l], exact.transmittance[0], 1e-3);
                EXPECT_NEAR(view.path_thermal[l], exact.path_thermal[0], 1e-3 * exact.path_thermal[0] + 1e-6);
                EXPECT_NEAR(view.path_solar[l], exact.path_solar[0], 2e-3 * exact.path_solar[0] + 1e-6);
            }
        }
    }
}

// Where almost nothing comes through, what does still follows Beer's law between the nodes: all samples of the table, angles
// between its own, down to a billionth.
TEST(ViewAtmosphere, OpaqueAirFollowsBeersLawBetweenItsNodes) {
    const auto grid = monochromatic_grid(summer().tables.front().wavelength_um);
    const auto c = conditions(3000.0, 40.0);
    const auto atmosphere = make_view_atmosphere(summer(), c, grid, constant(grid, 0.0));
    double largest = 0.0;
    for (double view_deg : {7.0, 21.0, 37.0, 49.0, 58.0, 63.0}) {
        const auto view = view_of(atmosphere, view_deg, 70.0);
        const auto exact = evaluate(summer(), {c, view_deg * kDegree_rad, 70.0 * kDegree_rad});
        for (std::size_t l = 0; l < exact.transmittance.size(); ++l)
            if (exact.transmittance[l] > 1e-9)
                largest =
                    std::max(largest, std::abs(static_cast<double>(view.transmittance[l]) / exact.transmittance[l] - 1.0));
    }
    std::printf("transmittance between view nodes, down to 1e-9: largest relative error %.1e\n", largest);
    EXPECT_LT(largest, 1e-3);
}

// A sensor 4 km above sea level over ground from 1 to 3 km: at heights between the nodes the path is that of a table made for
// this very ground.
TEST(ViewAtmosphere, FollowsTheHeightOfTheGround) {
    const AtmosphereSet set = load_atmosphere("midlatitude_summer", 23.0, {1000.0, 3000.0});
    const auto grid = wasp_grid();
    auto c = conditions(2000.0, 40.0);
    c.ground_elevation_m = 2000.0;
    std::vector<double> heights_m;
    for (double h = 1000.0; h >= -1000.0; h -= 250.0) heights_m.push_back(h);
    const auto atmosphere = make_view_atmosphere(set, c, grid, constant(grid, 0.2), heights_m);
    double tau = 0.0, thermal = 0.0, solar = 0.0;  // largest errors
    for (const double ground_m : {900.0, 700.0, 330.0, 0.0, -110.0, -500.0, -930.0}) {
        auto there = c;
        there.ground_elevation_m += ground_m;
        there.sensor_altitude_agl_m -= ground_m;
        const auto exact = view_of(make_view_atmosphere(set, there, grid, constant(grid, 0.2)), 20.0, 70.0);
        const auto view = view_of(atmosphere, 20.0, 70.0, ground_m);
        for (std::size_t l = 0; l < view.transmittance.size(); ++l) {
            const double B = planck_radiance(grid.lambda_um[l], 300.0);
            tau = std::max(tau, std::abs(static_cast<double>(view.transmittance[l] - exact.transmittance[l])));
            thermal = std::max(thermal, std::abs(static_cast<double>(view.path_thermal[l] - exact.path_thermal[l])) / B);
            if (grid.lambda_um[l] < 2.5)
                solar = std::max(solar, std::abs(static_cast<double>(view.path_solar[l] / exact.path_solar[l]) - 1.0));
        }
    }
    std::printf(
        "ground between nodes 250 m apart: transmittance %.1e, path thermal %.1e of B(300 K), path solar below 2.5 um "
        "%.1e\n",
        tau, thermal, solar);
    EXPECT_LT(tau, 4e-3);
    EXPECT_LT(thermal, 4e-3);
    EXPECT_LT(solar, 1.5e-2);
    // Outside the heights the nearest holds.
    EXPECT_EQ(view_of(atmosphere, 20.0, 70.0, 5000.0).path_thermal, view_of(atmosphere, 20.0, 70.0, 1000.0).path_thermal);
    EXPECT_THROW((void)make_view_atmosphere(set, c, grid, constant(grid, 0.2), std::vector{0.0, 100.0}), Error);
}

// Sun and sky on ground between the heights are those of a table made for it, and differ from those of the middle.
TEST(ViewAtmosphere, IlluminationFollowsTheHeightOfTheGround) {
    const AtmosphereSet set = load_atmosphere("midlatitude_summer", 23.0, {1000.0, 3000.0});
    const auto grid = monochromatic_grid(std::vector{0.45, 0.65, 1.6, 2.2, 3.9, 8.7, 10.6});
    auto c = conditions(2000.0, 40.0);
    c.ground_elevation_m = 2000.0;
    std::vector<double> heights_m;
    for (double h = 1000.0; h >= -1000.0; h -= 250.0) heights_m.push_back(h);
    const auto atmosphere = make_view_atmosphere(set, c, grid, constant(grid, 0.2), heights_m);
    ASSERT_EQ(atmosphere.illumination.size(), heights_m.size());
    const auto level = make_view_atmosphere(set, c, grid, constant(grid, 0.2));
    EXPECT_TRUE(level.illumination.empty());
    using Light = std::vector<float> GroundIllumination::*;
    for (const auto& [kind, what, allowed] :
         {std::tuple{Light{&GroundIllumination::direct_normal_irradiance_W_m2_um}, "direct", 3e-3},
          std::tuple{Light{&GroundIllumination::diffuse_irradiance_W_m2_um}, "diffuse", 1e-2},
          std::tuple{Light{&GroundIllumination::thermal_irradiance_W_m2_um}, "thermal sky", 1e-2}}) {
        EXPECT_EQ(atmosphere.*kind, level.*kind);
        double between = 0.0, ignored = 0.0;  // largest errors
        for (std::size_t i = 0; i + 1 < heights_m.size(); ++i) {
            auto there = c;
            there.ground_elevation_m += 0.5 * (heights_m[i] + heights_m[i + 1]);
            const auto exact = make_view_atmosphere(set, there, grid, constant(grid, 0.2));
            for (std::size_t l = 0; l < (exact.*kind).size(); ++l) {
                const double expected = (exact.*kind)[l], whole = kPi * planck_radiance(grid.lambda_um[l], 300.0);
                if (expected < 0.01 * whole) continue;
                const double found = 0.5 * static_cast<double>((atmosphere.illumination[i].*kind)[l] +
                                                               (atmosphere.illumination[i + 1].*kind)[l]);
                between = std::max(between, std::abs(found / expected - 1.0));
                ignored = std::max(ignored, std::abs(static_cast<double>((level.*kind)[l]) / expected - 1.0));
            }
        }
        std::printf("%s on ground between heights 250 m apart: %.1e, of the middle height instead: %.1e\n", what, between,
                    ignored);
        EXPECT_LT(between, allowed) << what;
        EXPECT_GT(ignored, 3.0 * allowed) << what;
    }
}

TEST(ViewAtmosphere, IlluminationAtOneWavelength) {
    const auto grid = monochromatic_grid(std::vector{0.55, 10.0});
    const auto c = conditions(3000.0, 40.0);
    const auto black = make_view_atmosphere(summer(), c, grid, constant(grid, 0.0));
    const auto t = evaluate_at(summer(), {c, 0.0, 0.0}, 0.55);
    EXPECT_NEAR(black.direct_normal_irradiance_W_m2_um[0] / t.direct_normal[0], 1.0, 1e-6);
    EXPECT_NEAR(black.diffuse_irradiance_W_m2_um[0] / t.diffuse[0], 1.0, 1e-6);
    EXPECT_NEAR(black.thermal_irradiance_W_m2_um[1] / evaluate_at(summer(), {c, 0.0, 0.0}, 10.0).thermal_sky[0], 1.0, 1e-6);
    // Bounces and adjacency by the formulae of the tables' README, written out (products of interpolated samples here, samples of
    // products there).
    const double A = 0.3, S = t.spherical_albedo[0], cosine = std::cos(40.0 * kDegree_rad);
    const double bounced = t.diffuse[0] + (t.direct_normal[0] * cosine + t.diffuse[0]) * A * S / (1.0 - A * S);
    const double adjacency =
        A * (t.direct_normal[0] * cosine * t.solar_correlation[0] + bounced) / kPi * t.diffuse_transmittance[0];
    const auto bright = make_view_atmosphere(summer(), c, grid, constant(grid, A));
    EXPECT_NEAR(bright.diffuse_irradiance_W_m2_um[0] / bounced, 1.0, 2e-5);
    EXPECT_NEAR(view_of(bright, 0.0, 0.0).adjacency[0] / adjacency, 1.0, 2e-5);
    EXPECT_EQ(view_of(black, 0.0, 0.0).adjacency[0], 0.0F);
}

/// Mean over a band of a function of wavelength by the midpoint rule, fine against the tables' sampling.
template <class Function>
double fine_mean(double lower_um, double upper_um, const Function& f) {
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) sum += f(lower_um + (upper_um - lower_um) * (i + 0.5) / kSteps);
    return sum / kSteps;
}

TEST(ViewAtmosphere, BandRadiancesMatchAFineIntegration) {
    const auto grid = wasp_grid();
    const auto c = conditions(3000.0, 40.0);
    const auto atmosphere = make_view_atmosphere(summer(), c, grid, constant(grid, 0.0));
    const auto view = view_of(atmosphere, 30.0, 50.0);
    const auto t = evaluate(summer(), {c, 30.0 * kDegree_rad, 50.0 * kDegree_rad});
    const auto spectrum = [&](const std::vector<double>& v) {
        return Spectrum{Quantity::Dimensionless, t.wavelength_um, v};
    };
    const auto tau = spectrum(t.transmittance), thermal = spectrum(t.path_thermal), solar = spectrum(t.path_solar);
    std::vector<double> beam;
    for (std::size_t l = 0; l < t.wavelength_um.size(); ++l)
        beam.push_back(t.direct_normal[l] * t.solar_correlation[l] * t.transmittance[l]);
    const auto reflected = spectrum(beam);

    const std::array<std::array<double, 2>, 3> edges{{{0.9, 1.8}, {3.0, 5.0}, {8.0, 11.0}}};
    for (std::size_t b = 0; b < 3; ++b) {
        const auto [lower, upper] = edges[b];
        const auto [begin, end] = grid.bands[b];
        for (double T_K : {300.0, 700.0, 1100.0, 1500.0}) {
            double sum = 0.0;
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                sum += grid.weight[i] * (planck_radiance(grid.lambda_um[i], T_K) * view.transmittance[i] +
                                         view.path_thermal[i] + view.path_solar[i]);
            const double exact = fine_mean(
                lower, upper, [&](double l) { return planck_radiance(l, T_K) * tau.at(l) + thermal.at(l) + solar.at(l); });
            EXPECT_NEAR(sum / exact, 1.0, 2e-3) << lower << " um, " << T_K << " K";
        }
        double sun = 0.0;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            sun += grid.weight[i] * static_cast<double>(atmosphere.direct_normal_irradiance_W_m2_um[i]) *
                   static_cast<double>(view.solar_correlation[i]) * static_cast<double>(view.transmittance[i]);
        EXPECT_NEAR(sun / fine_mean(lower, upper, [&](double l) { return reflected.at(l); }), 1.0, 2e-3) << lower << " um";
    }
}

TEST(ViewAtmosphere, NightHasNoSolarTerms) {
    const auto grid = wasp_grid();
    const auto atmosphere = make_view_atmosphere(summer(), conditions(3000.0, 180.0), grid, constant(grid, 0.2));
    const auto view = view_of(atmosphere, 20.0, 0.0);
    for (std::size_t l = 0; l < view.transmittance.size(); ++l) {
        ASSERT_EQ(view.path_solar[l] + view.adjacency[l], 0.0F);
        ASSERT_EQ(atmosphere.direct_normal_irradiance_W_m2_um[l] + atmosphere.diffuse_irradiance_W_m2_um[l], 0.0F);
    }
    EXPECT_GT(view.path_thermal.back(), 0.1F);
}

TEST(ViewAtmosphere, StaysPhysical) {
    const auto grid = wasp_grid();
    for (double altitude_m : {0.0, 30.0, 3000.0, 700e3}) {
        const auto atmosphere = make_view_atmosphere(summer(), conditions(altitude_m, 55.0), grid, constant(grid, 0.2));
        EXPECT_TRUE(std::is_sorted(atmosphere.node_secant.begin(), atmosphere.node_secant.end()));
        for (double view_deg : {0.0, 33.0, 65.0, 88.0})
            for (double azimuth_deg : {0.0, 77.0, 180.0}) {
                const auto view = view_of(atmosphere, view_deg, azimuth_deg);
                for (std::size_t l = 0; l < view.transmittance.size(); ++l) {
                    ASSERT_GE(view.transmittance[l], 0.0F);
                    ASSERT_LE(view.transmittance[l], 1.0F);
                    ASSERT_GE(view.path_thermal[l], 0.0F);
                    ASSERT_GE(view.path_solar[l], 0.0F);
                    ASSERT_GE(view.adjacency[l], 0.0F);
                    ASSERT_GT(view.solar_correlation[l], 0.0F);
                    if (altitude_m == 0.0) {
                        ASSERT_EQ(view.transmittance[l], 1.0F);
                        ASSERT_EQ(view.path_thermal[l] + view.path_solar[l] + view.adjacency[l], 0.0F);
                    }
                }
            }
    }
}

TEST(ViewAtmosphere, ClampsTheViewAngle) {
    const auto grid = monochromatic_grid(std::vector{1.6, 10.0});
    const auto atmosphere = make_view_atmosphere(summer(), conditions(3000.0, 30.0), grid, constant(grid, 0.1));
    const auto edge = view_of(atmosphere, 85.0, 0.0);
    for (double view_deg : {86.0, 90.0, 120.0})
        EXPECT_NEAR(view_of(atmosphere, view_deg, 0.0).transmittance[1], edge.transmittance[1], 1e-6);
}

TEST(ViewAtmosphere, AlbedoCountMustMatch) {
    const auto grid = monochromatic_grid(std::vector{1.6, 10.0});
    EXPECT_THROW((void)make_view_atmosphere(summer(), conditions(3000.0, 30.0), grid, std::vector{0.1}), Error);
}

TEST(ViewAtmosphere, WindowsBeyondTheTablesUseTheirEnds) {
    const auto grid = make_spectral_grid(std::vector<Spectrum>{boxcar(15.0, 16.0)});
    const auto atmosphere = make_view_atmosphere(summer(), conditions(3000.0, 30.0), grid, constant(grid, 0.1));
    for (const float tau : view_of(atmosphere, 0.0, 0.0).transmittance) EXPECT_TRUE(tau >= 0.0F && tau <= 1.0F);
}

}  // namespace
}  // namespace pyroscene::radiometry
