#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "radiometry/planck.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

double worst_error(const PlanckTable& table, const std::vector<double>& lambda_um, double T_min_K, double T_max_K) {
    std::vector<float> B(lambda_um.size());
    double worst = 0.0;
    for (double T_K = T_min_K; T_K <= T_max_K; T_K += 0.737) {
        table.evaluate(T_K, B);
        for (std::size_t l = 0; l < lambda_um.size(); ++l) {
            const double exact = planck_radiance(lambda_um[l], T_K);
            if (exact > 1e-28) worst = std::max(worst, std::abs(static_cast<double>(B[l]) / exact - 1.0));
        }
    }
    return worst;
}

TEST(PlanckTable, DefaultStepKeepsTwoPartsInAMillion) {
    for (const auto& lambda_um :
         {std::vector{0.4, 0.77, 2.2, 15.0}, std::vector{0.9, 1.3, 1.8}, std::vector{3.0, 4.0, 5.0, 8.0, 11.0}}) {
        const PlanckTable table(lambda_um, 250.0, 2000.0);
        EXPECT_LE(worst_error(table, lambda_um, 250.0, 2000.0), 2e-6) << "shortest " << lambda_um.front();
        EXPECT_LT(table.row_count(), PlanckTable::kMaximumRows);
    }
}

TEST(PlanckTable, StepSetsTheErrorQuadratically) {
    const std::vector<double> lambda_um{3.0, 5.0};
    const double fine = worst_error(PlanckTable(lambda_um, 250.0, 2000.0, 4.0), lambda_um, 250.0, 2000.0);
    const double coarse = worst_error(PlanckTable(lambda_um, 250.0, 2000.0, 16.0), lambda_um, 250.0, 2000.0);
    EXPECT_NEAR(coarse / fine, 16.0, 1.0);
}

TEST(PlanckTable, NodesAreExactAndOrdered) {
    const std::vector<double> lambda_um{1.0, 4.0, 10.0};
    const PlanckTable table(lambda_um, 300.0, 1500.0);
    EXPECT_FLOAT_EQ(table.row(0)[1], static_cast<float>(planck_radiance(4.0, 300.0)));
    EXPECT_FLOAT_EQ(table.row(table.row_count() - 1)[2], static_cast<float>(planck_radiance(10.0, 1500.0)));
    for (int i = 1; i < table.row_count(); ++i)
        for (std::size_t l = 0; l < 3; ++l) ASSERT_GE(table.row(i)[l], table.row(i - 1)[l]);
}

TEST(PlanckTable, ClampsToItsRange) {
    const std::vector<double> lambda_um{4.0};
    const PlanckTable table(lambda_um, 300.0, 1500.0);
    int i = -1;
    float f = -1.0F;
    for (double T_K : {-10.0, 0.0, 299.0, std::nan("")}) {
        table.locate(T_K, i, f);
        EXPECT_EQ(i, 0);
        EXPECT_EQ(f, 0.0F);
    }
    for (double T_K : {1500.0, 1e9}) {
        table.locate(T_K, i, f);
        EXPECT_EQ(i, table.row_count() - 2);
        EXPECT_FLOAT_EQ(f, 1.0F);
    }
}

TEST(PlanckTable, HoldsNoDenormals) {
    const PlanckTable table(std::vector{0.4, 0.5}, 200.0, 400.0);
    for (int i = 0; i < table.row_count(); ++i)
        for (int l = 0; l < 2; ++l) ASSERT_TRUE(table.row(i)[l] == 0.0F || table.row(i)[l] >= 1e-30F);
}

TEST(BandThermometer, AgreesWithTheExactInverse) {
    std::vector<Spectrum> bands{boxcar(0.9, 1.8), boxcar(3.0, 5.0), boxcar(8.0, 11.0), boxcar(0.4, 14.0)};
    for (const auto& [name, response] : measured_responses()) bands.push_back(response);
    for (const auto& band : bands) {
        const BandThermometer thermometer(band);
        for (double T_K = 100.0; T_K <= 5000.0; T_K *= 1.0237)  // beyond both ends of its table too
            ASSERT_NEAR(thermometer.temperature_K(band_mean_radiance(T_K, band)), T_K, 1e-4);
    }
}

}  // namespace
}  // namespace pyroscene::radiometry
