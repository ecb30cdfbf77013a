#include <gtest/gtest.h>
#include <cmath>

#include "fire/flame_field.h"
#include "fire/temperature_profile.h"

namespace pyroscene::fire {
namespace {

using Shape = TemperatureProfile::Shape;

// McCaffrey (1979) as tabulated by Drysdale: excess 800 K in the flame (6.8 / 0.9)^2 / 2g T0 = 2.9095 T0, 320 K where the
// intermittent flame ends (1.9^2 / 0.81 / 2g / 0.2 = 1.1358 T0), for T0 = 293 K.
TEST(McCaffrey, ReproducesTheThreeRegimes) {
    EXPECT_NEAR(mccaffrey_excess_K(0.5, 100.0, 293.0), 2.90956 * 293.0, 0.1);
    EXPECT_NEAR(mccaffrey_excess_K(0.199999 * std::pow(100.0, 0.4), 100.0, 293.0), 1.13579 * 293.0, 0.1);
    EXPECT_NEAR(mccaffrey_excess_K(2.0 * std::pow(100.0, 0.4), 100.0, 293.0), 0.0239886 * 293.0, 0.01);
    EXPECT_EQ(mccaffrey_excess_K(1.0, 0.0, 293.0), 0.0);
}

// The regimes join within 3 % although each has its own fitted constant.
TEST(McCaffrey, RegimesJoin) {
    for (const double at : {0.08, 0.20})
        EXPECT_NEAR(mccaffrey_excess_K(at * 0.99999, 1.0, 300.0) / mccaffrey_excess_K(at * 1.00001, 1.0, 300.0), 1.0, 0.03);
}

TEST(TemperatureProfile, RunsFromBaseToTip) {
    const TemperatureProfile constant{}, linear{Shape::Linear, 800.0, 300.0}, plume{Shape::McCaffrey, 0.0, 300.0};
    EXPECT_EQ(constant.at(1100.0, 0.7), 1100.0);
    EXPECT_NEAR(linear.at(1100.0, 0.25), 1025.0, 1e-9);
    EXPECT_NEAR(linear.at(1100.0, 2.0), 800.0, 1e-9);
    EXPECT_NEAR(plume.at(1100.0, 0.4), 1100.0, 1e-9);
    EXPECT_NEAR(plume.at(1100.0, 0.8), 700.0, 1e-9);
    EXPECT_NEAR(plume.at(1100.0, 1.0), 620.0, 1e-9);  // excess 0.4 of that at the base, as 0.08 / 0.20
}

// Integral of T^5 of a straight line: (T2^6 - T1^6) / (6 (T2 - T1)).
TEST(TemperatureProfile, MeanKeepsTheEmission) {
    const TemperatureProfile linear{Shape::Linear, 600.0, 300.0};
    const double T5 = (std::pow(1200.0, 6) - std::pow(600.0, 6)) / (6.0 * 600.0);
    EXPECT_NEAR(std::pow(linear.emission_mean_K(1200.0, 0.0, 1.0), 5) / T5, 1.0, 1e-9);
    // Any cut of the flame adds up to the whole, also across McCaffrey's kink.
    const TemperatureProfile plume{Shape::McCaffrey, 0.0, 300.0};
    const auto T5_of = [&](double s0, double s1) { return (s1 - s0) * std::pow(plume.emission_mean_K(1100.0, s0, s1), 5); };
    double sum = 0.0;
    for (int i = 0; i < 40; ++i) sum += T5_of(i / 40.0, (i + 1) / 40.0);
    EXPECT_NEAR(T5_of(0.0, 1.0) / sum, 1.0, 5e-4);
}

/// Sum of fill x volume x T^5: what thin soot emits.
double emission(const FlameField& field) {
    double sum = 0.0;
    for (const auto& brick : field.bricks)
        for (std::size_t v = 0; v < brick.fill.size(); ++v) sum += brick.fill[v] * std::pow(brick.temperature_K[v], 5);
    return sum * field.grid.dx_m * field.grid.dy_m * field.grid.dz_m;
}

// A flame smaller than its voxels radiates like the finely cut one.
TEST(TemperatureProfile, EmissionDoesNotDependOnTheVoxels) {
    const FlameColumn column{.x_m = 12.3,
                             .y_m = 7.7,
                             .z_m = 3.2,
                             .width_m = 5.0,
                             .area_fraction = 0.6,
                             .top_m = 4.0,
                             .tilt_rad = 0.6,
                             .azimuth_rad = 1.0,
                             .temperature_K = 1200.0,
                             .flame_m = 4.0};
    for (const Shape shape : {Shape::Linear, Shape::McCaffrey}) {
        FlameParameters flame;
        flame.profile = {shape, 700.0, 300.0};
        flame.voxel_m = {0.5, 0.5, 0.1};
        const double fine = emission(voxelise({&column, 1}, flame));
        for (const double edge_m : {1.0, 2.0, 5.0, 20.0}) {
            flame.voxel_m = {edge_m, edge_m, edge_m};
            EXPECT_NEAR(emission(voxelise({&column, 1}, flame)) / fine, 1.0, 1e-3) << edge_m;
        }
    }
}

TEST(TemperatureProfile, ColdTipAndHotBaseLieWhereTheyShould) {
    const FlameColumn column{.x_m = 0.5, .y_m = 0.5, .width_m = 1.0, .top_m = 4.0, .temperature_K = 1200.0, .flame_m = 4.0};
    FlameParameters flame;
    flame.profile = {Shape::Linear, 800.0, 300.0};
    flame.voxel_m = {1.0, 1.0, 1.0};
    const auto field = voxelise({&column, 1}, flame);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(voxel_at(field, 0, 0, k).temperature_K, 1150.0 - 100.0 * k, 2.0);
}

}  // namespace
}  // namespace pyroscene::fire
