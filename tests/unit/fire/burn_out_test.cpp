#include "fire/burn_out.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "base/csv.h"
#include "base/error.h"
#include "source_folder.h"

namespace pyroscene::fire {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kMoisture = 0.08;  // of SFIRE's default

/// Load and weight of an Anderson model as SFIRE has them.
struct SfireFuel {
    double load_kg_m2 = 0.0;
    BurnOut burn;
    [[nodiscard]] double energy_J_m2() const { return load_kg_m2 * sensible_heat_J_kg(kMoisture); }
};

SfireFuel sfire_fuel(int model) {
    const auto table = read_csv(source_folder() / "data" / "fuel" / "sfire_heat_defaults.csv");
    const auto row = static_cast<std::size_t>(model - 1);
    return {table.numbers("fgi_kg_m2")[row], sfire_burn_out(table.numbers("weight")[row])};
}

double mean_flux(const SfireFuel& fuel, double from_s, double to_s) {
    return fuel.energy_J_m2() * (remaining_share(fuel.burn, from_s) - remaining_share(fuel.burn, to_s)) / (to_s - from_s);
}

// Worked by hand from WRF-SFIRE's formulas (module_fr_sfire_phys.F) for 8 % fuel moisture.
struct Worked {
    int model;
    double tau_s, sensible_MJ_m2, latent_MJ_m2, ignition_kW_m2, first_6_s_kW_m2, t90_s, t1kW_s, ceiling_kW_m2;
};

class SfireFormulas : public testing::TestWithParam<Worked> {};

TEST_P(SfireFormulas, GiveTheWorkedNumbers) {
    const auto& w = GetParam();
    const auto fuel = sfire_fuel(w.model);
    const double tau = fuel.burn.fine_time_s;
    EXPECT_NEAR(tau, w.tau_s, 0.05);
    EXPECT_NEAR(fuel.energy_J_m2() * 1e-6, w.sensible_MJ_m2, 6e-4);
    EXPECT_NEAR(fuel.load_kg_m2 * latent_heat_J_kg(kMoisture) * 1e-6, w.latent_MJ_m2, 6e-4);
    EXPECT_NEAR(mean_flux(fuel, 0.0, 1e-5) * 1e-3, w.ignition_kW_m2, 0.06);
    EXPECT_NEAR(mean_flux(fuel, 0.0, 6.0) * 1e-3, w.first_6_s_kW_m2, 0.06);
    EXPECT_NEAR(remaining_share(fuel.burn, w.t90_s), 0.1, 1e-3);
    EXPECT_NEAR(mean_flux(fuel, w.t1kW_s - 0.5, w.t1kW_s + 0.5), 1000.0, 12.0);
    // While a front of 0.3 m/s crosses a cell of 20 m, its mean flux rises towards E R / dx.
    const ArrivalSpan crossing{0.0, 20.0 / 0.3};
    const double end = crossing.last_s;
    const double mean = fuel.energy_J_m2() *
                        (remaining_share(fuel.burn, crossing, end - 1e-3) - remaining_share(fuel.burn, crossing, end)) /
                        1e-3;
    EXPECT_NEAR(mean, w.ceiling_kW_m2 * 1e3 * (1.0 - std::exp(-end / tau)), 1e-3 * mean);
}

INSTANTIATE_TEST_SUITE_P(Anderson, SfireFormulas,
                         testing::Values(Worked{1, 8.24, 2.680, 0.246, 325.4, 231.1, 19.0, 47.6, 40.2},
                                         Worked{3, 8.24, 10.896, 1.000, 1323.0, 939.6, 19.0, 59.2, 163.4},
                                         Worked{4, 211.8, 39.838, 3.656, 188.1, 185.5, 487.6, 1109.0, 597.6}));

TEST(SfireBurnOut, LeavesSixtyPercentOfTheSlowestFuelAfterTenMinutes) {
    EXPECT_NEAR(remaining_share(sfire_burn_out(1000.0), 600.0), 0.60, 2e-3);
}

TEST(BurnOut, OfACellPeaksWhereTheClosedFormSays) {
    // Fuel model 3, 0.6737750 kg m-2, T_f 8.221752 s, 20 m at 0.9561484 m/s: peak of the cell's mean 479.1094 kW m-2.
    const BurnOut burn{.fine_time_s = 8.221752};
    const double energy_J_m2 = 0.6737750 * sensible_heat_J_kg(kMoisture);
    EXPECT_NEAR(energy_J_m2, 1.087585e7, 10.0);
    const ArrivalSpan crossing{0.0, 20.0 / 0.9561484};
    double peak = 0.0;
    for (double t = 0.0; t < 60.0; t += 0.01)
        peak = std::max(
            peak, energy_J_m2 * (remaining_share(burn, crossing, t) - remaining_share(burn, crossing, t + 0.01)) / 0.01);
    EXPECT_NEAR(peak, 4.791094e5, 5e2);
}

TEST(BurnOut, BurnsNinetyPercentOfTheFineFuelWhileTheFlamesStand) {
    const auto burn = residence_burn_out(15.36, 0.25, 300.0);
    EXPECT_NEAR(remaining_share(burn, 15.36), 0.75 * 0.1 + 0.25 * std::exp(-15.36 / 300.0), 1e-12);
    EXPECT_EQ(remaining_share(burn, -1.0), 1.0);
    EXPECT_EQ(remaining_share(burn, 0.0), 1.0);
}

TEST(BurnOut, OfASpanIsTheMeanOverItsPoints) {
    const auto burn = residence_burn_out(12.0, 0.4, 150.0);
    const ArrivalSpan span{10.0, 50.0};
    for (const double time_s : {5.0, 10.0, 20.0, 49.0, 51.0, 400.0, 5000.0}) {
        double sum = 0.0;
        constexpr int kPoints = 20000;
        for (int i = 0; i < kPoints; ++i) sum += remaining_share(burn, time_s - (10.0 + 40.0 * (i + 0.5) / kPoints));
        EXPECT_NEAR(remaining_share(burn, span, time_s), sum / kPoints, 1e-7) << time_s;
    }
    EXPECT_NEAR(remaining_share(burn, ArrivalSpan{10.0, 10.0}, 30.0), remaining_share(burn, 20.0), 1e-14);
    EXPECT_NEAR(remaining_share(burn, ArrivalSpan{10.0, 10.0 + 1e-7}, 30.0), remaining_share(burn, 20.0), 1e-8);
}

/// A front that goes outwards from a corner, with ground it does not reach and two kinds of fuel.
BurningGround fan() {
    const MapGrid grid{.cols = 40, .rows = 30, .west_m = 0.0, .north_m = 0.0, .cell_m = 20.0, .crs_wkt = "map"};
    BurningGround ground{Raster<float>(grid, "arrival_time", "s", kNaN),
                         Raster<float>(grid, "heat", "J m-2", 8e6F),
                         Raster<std::uint8_t>(grid, "kind", "1"),
                         {sfire_burn_out(7.0), residence_burn_out(14.0, 0.5, 300.0)}};
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const double distance_m = std::hypot(grid.x_centre_m(col) - 100.0, grid.y_centre_m(row) + 300.0);
            if (distance_m < 450.0 && row != 12)
                ground.arrival_time_s.at(row, col) = static_cast<float>(60.0 + distance_m / 0.4);
            ground.kind.at(row, col) = col > 15 ? 1 : 0;
            if (col == 20) ground.heat_J_m2.at(row, col) = 3e6F;
        }
    return ground;
}

double sum_of(const Raster<float>& raster) { return std::accumulate(raster.values.begin(), raster.values.end(), 0.0); }

TEST(HeatFlux, SumsToTheHeatForAnyStep) {
    const auto ground = fan();
    double released = 0.0;
    for (std::size_t i = 0; i < ground.heat_J_m2.values.size(); ++i)
        if (std::isfinite(ground.arrival_time_s.values[i])) released += ground.heat_J_m2.values[i];
    for (const double step_s : {20.0, 97.0, 20000.0}) {
        double sum = 0.0, time_s = 0.0;
        for (; time_s < 14000.0; time_s += step_s)
            sum += step_s * sum_of(mean_heat_flux_W_m2(ground, time_s, time_s + step_s));
        EXPECT_NEAR(sum, released, 1e-6 * released) << step_s;
    }
}

TEST(HeatFlux, IsTheLossOfRemainingFuel) {
    const auto ground = fan();
    const auto flux = mean_heat_flux_W_m2(ground, 600.0, 630.0);
    const auto before = remaining_share(ground, 600.0), after = remaining_share(ground, 630.0);
    for (std::size_t i = 0; i < flux.values.size(); ++i) {
        const double lost = (before.values[i] - after.values[i]) * ground.heat_J_m2.values[i];
        EXPECT_NEAR(flux.values[i] * 30.0, lost, 2.0) << i;
        EXPECT_GE(flux.values[i], 0.0F);
        EXPECT_GE(before.values[i], after.values[i]);
        if (!std::isfinite(ground.arrival_time_s.values[i])) {
            EXPECT_EQ(after.values[i], 1.0F);
        }
    }
}

TEST(HeatFlux, OfAStraightFrontIsThatOfEvenlySpreadArrivals) {
    const MapGrid grid{.cols = 9, .rows = 5, .west_m = 0.0, .north_m = 0.0, .cell_m = 20.0, .crs_wkt = "map"};
    BurningGround ground{Raster<float>(grid, "arrival_time", "s"),
                         Raster<float>(grid, "heat", "J m-2", 1e7F),
                         Raster<std::uint8_t>(grid, "kind", "1"),
                         {sfire_burn_out(7.0)}};
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) ground.arrival_time_s.at(row, col) = 40.0F * static_cast<float>(col);
    for (const double time_s : {130.0, 142.0, 160.0, 178.0, 190.0, 230.0}) {
        const auto flux = mean_heat_flux_W_m2(ground, time_s, time_s + 6.0);
        const ArrivalSpan crossing{140.0, 180.0};  // of column 4
        const double burnt = remaining_share(ground.burn_out[0], crossing, time_s) -
                             remaining_share(ground.burn_out[0], crossing, time_s + 6.0);
        EXPECT_NEAR(flux.at(2, 4), 1e7 * burnt / 6.0, 1.0) << time_s;
    }
    // The last column is continued outwards: it burns no faster than the others.
    EXPECT_NEAR(mean_heat_flux_W_m2(ground, 338.0, 340.0).at(2, 8), mean_heat_flux_W_m2(ground, 178.0, 180.0).at(2, 4), 1.0);
}

TEST(HeatFlux, RefusesATimeThatDoesNotPassAndGridsThatDiffer) {
    auto ground = fan();
    EXPECT_THROW(mean_heat_flux_W_m2(ground, 5.0, 5.0), Error);
    ground.kind.at(3, 3) = 7;
    ground.arrival_time_s.at(3, 3) = 0.0F;
    EXPECT_THROW(mean_heat_flux_W_m2(ground, 0.0, 6.0), Error);
    ground.kind = Raster<std::uint8_t>(MapGrid{}, "kind", "1");
    EXPECT_THROW(mean_heat_flux_W_m2(ground, 0.0, 6.0), Error);
}

}  // namespace
}  // namespace pyroscene::fire
