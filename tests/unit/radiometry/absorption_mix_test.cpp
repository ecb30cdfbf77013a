#include "radiometry/absorption_mix.h"

#include <cmath>

#include <gtest/gtest.h>

#include "radiometry/nonnegative_fit.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

TEST(NonnegativeFit, FindsAMixtureThatExists) {
    FitColumns columns{30, {}};
    for (const double k : {0.1, 0.3, 1.0, 3.0, 10.0})
        for (int i = 0; i < 30; ++i) columns.values.push_back(std::exp(-k * 0.1 * i));
    std::vector<double> target;
    for (std::size_t i = 0; i < 30; ++i) target.push_back(0.25 * columns[1][i] + 0.75 * columns[3][i]);
    const auto fit = nonnegative_fit(columns, target, 1e-9, 5);
    EXPECT_LT(fit.largest_residual, 1e-9);
    double sum = 0.0;
    for (std::size_t j = 0; j < fit.weight.size(); ++j) {
        EXPECT_GT(fit.weight[j], 0.0);
        sum += fit.weight[j];
    }
    EXPECT_NEAR(sum, 1.0, 1e-8);
}

TEST(NonnegativeFit, NeverGoesNegative) {
    // The unconstrained solution of this target is {2, -1}.
    FitColumns columns{3, {1.0, 1.0, 1.0, 0.0, 1.0, 2.0}};
    const std::vector<double> target{2.0, 1.0, 0.0};
    const auto fit = nonnegative_fit(columns, target, 1e-9, 2);
    ASSERT_EQ(fit.column.size(), 1U);
    EXPECT_EQ(fit.column[0], 0U);
    EXPECT_NEAR(fit.weight[0], 1.0, 1e-12);
}

TEST(AbsorptionMix, TransmittanceOfEveryPathIsTheBandModels) {
    const auto optics = load_flame_optics(source_folder() / "data/optical");
    FlameGas gas;
    double worst = 0.0;
    for (double wavenumber = 620.0; wavenumber < 9500.0; wavenumber += 73.0) {
        const double lambda_um = 1e4 / wavenumber;
        for (const double T_K : {400.0, 1100.0, 1500.0}) {
            const auto parts = absorption_mix(optics, gas, lambda_um, T_K);
            double sum = 0.0;
            for (const auto& part : parts) {
                EXPECT_GT(part.weight, 0.0);
                sum += part.weight;
            }
            EXPECT_NEAR(sum, 1.0, 1e-12);
            for (const double length_m : {0.02, 0.3, 1.0, 4.0, 30.0, 150.0}) {
                FlamePath path(optics, lambda_um);
                path.add(length_m, T_K, gas);
                double through = 0.0;
                for (const auto& part : parts) through += part.weight * std::exp(-part.k_per_m * length_m);
                worst = std::max(worst, std::abs(through - std::exp(-path.depth())));
            }
        }
    }
    EXPECT_LT(worst, 3e-3);
}

}  // namespace
}  // namespace pyroscene::radiometry
