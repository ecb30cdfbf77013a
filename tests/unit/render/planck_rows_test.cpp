#include "render/planck_rows.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::render {
namespace {

double planck(double lambda_um, double T_K) {
    return kC1L_W_um4_m2_sr / std::pow(lambda_um, 5) / std::expm1(kC2_um_K / (lambda_um * T_K));
}

double interpolated(const PlanckRows& rows, double T_K, std::size_t column) {
    const PlanckRows::Lookup found = rows.at(T_K);
    double sum = 0.0;
    for (int j = 0; j < found.count; ++j) sum += found.weight[static_cast<std::size_t>(j)] * rows.row(found.row + j)[column];
    return sum;
}

TEST(PlanckRows, FollowsPlancksLaw) {
    const std::array<double, 5> lambda_um{0.4, 1.2, 4.0, 11.0, 15.0};
    const std::array<double, 2> exact{300.0, 1073.15};
    const PlanckRows rows(lambda_um, 8, 250.0, 1600.0, exact);
    for (double T_K = 250.0; T_K <= 1600.0; T_K += 0.937) {
        for (std::size_t c = 0; c < lambda_um.size(); ++c) {
            const double expected = planck(lambda_um[c], T_K);
            if (expected < 1e-15) continue;
            EXPECT_NEAR(interpolated(rows, T_K, c) / expected, 1.0, 2e-6) << T_K << " K, " << lambda_um[c] << " um";
        }
    }
}

TEST(PlanckRows, NamedTemperaturesHaveTheirOwnRow) {
    const std::array<double, 1> lambda_um{4.0};
    const std::array<double, 2> exact{300.0, 1073.15};
    const PlanckRows rows(lambda_um, 8, 300.0, 1073.15, exact);
    EXPECT_EQ(rows.at(1073.15).count, 1);
    EXPECT_NEAR(interpolated(rows, 1073.15, 0) / planck(4.0, 1073.15), 1.0, 1e-7);
    EXPECT_EQ(rows.at(700.0).count, 4);
}

TEST(PlanckRows, OneTemperatureNeedsNoNodes) {
    const std::array<double, 1> lambda_um{4.0}, exact{1100.0};
    const PlanckRows rows(lambda_um, 8, 1100.0, 1100.0, exact);
    EXPECT_EQ(rows.row_count(), 1);
    EXPECT_NEAR(interpolated(rows, 1100.0, 0), 4595.5, 0.05);  // CODATA constants, thesis eq 2.4
}

}  // namespace
}  // namespace pyroscene::render
