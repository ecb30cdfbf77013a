#include "fire/plume.h"

#include <gtest/gtest.h>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

// Briggs' 2/3 law for a point source in a uniform wind: z = 1.6 F^(1/3) x^(2/3) / u; here (3 / (2 0.36))^(1/3) = 1.60915.
TEST(PlumeAxis, FollowsTheTwoThirdsLaw) {
    PlumeParameters p;
    p.wind_exponent = 0.0;
    p.duration_s = 200.0;
    const double Q_W = 1e8, u = 5.0, F = 9.81 * Q_W / (kPi * 1.18 * 1005.0 * 300.0);
    const auto axis = plume_axis(Q_W, 0.1, u, 0.5, p);
    ASSERT_GT(axis.size(), 30U);
    for (const auto& point : axis) {
        if (point.downwind_m < 200.0) continue;
        const double briggs_m = 1.60915 * std::cbrt(F) * std::pow(point.downwind_m, 2.0 / 3.0) / u;
        EXPECT_NEAR(point.height_m / briggs_m, 1.0, 0.04) << point.downwind_m;
    }
}

TEST(PlumeAxis, StrongerWindBendsAndStrongerFireLifts) {
    PlumeParameters p;
    const auto height_at_300m = [&](double heat_W, double wind_m_s) {
        for (const auto& point : plume_axis(heat_W, 5.0, wind_m_s, 1.0, p))
            if (point.downwind_m > 300.0) return point.height_m;
        return -1.0;
    };
    EXPECT_GT(height_at_300m(1e8, 3.0), height_at_300m(1e8, 6.0));
    EXPECT_GT(height_at_300m(4e8, 6.0), height_at_300m(1e8, 6.0));
    EXPECT_GT(height_at_300m(1e8, 6.0), 0.0);
    for (const auto& point : plume_axis(1e9, 5.0, 0.0, 5.0, p)) EXPECT_LE(point.height_m, p.top_m);  // calm: finite
}

/// One burning cell of 20 m in the west of a flat map of 2 km, wind from the west.
FrameInputs one_cell(double heat_flux_W_m2) {
    FrameInputs in;
    const MapGrid grid = test::small_grid(100, 60);
    in.heat_flux_W_m2 = Raster<float>(grid, "H", "W m-2");
    in.heat_flux_W_m2.at(30, 5) = static_cast<float>(heat_flux_W_m2);
    in.wind_east_m_s = Raster<float>(grid, "u", "m s-1", 6.0F);
    in.wind_north_m_s = Raster<float>(grid, "v", "m s-1", 0.0F);
    return in;
}

struct Moments {
    double heat_J = 0.0, mass_g = 0.0, x_m = 0.0, z_m = 0.0;
};
Moments moments(const FlameField& field, const PlumeParameters& p) {
    Moments m;
    const VoxelGrid& g = field.grid;
    for (int k = 0; k < 400; ++k)
        for (int j = 0; j < g.ny; ++j)
            for (int i = 0; i < g.nx; ++i) {
                const FlameVoxel v = voxel_at(field, i, j, k);
                if (!(v.fill > 0.0F)) continue;
                const double volume_m3 = g.dx_m * g.dy_m * g.dz_m;
                const double heat_J = p.air_density_kg_m3 * p.air_heat_capacity_J_kg_K *
                                      (static_cast<double>(v.temperature_K) - p.air_temperature_K) * volume_m3;
                m.heat_J += heat_J;
                m.mass_g += static_cast<double>(v.fill) * volume_m3;
                m.x_m += heat_J * (g.corner_m.x + (i + 0.5) * g.dx_m);
                m.z_m += heat_J * (g.corner_m.z + (k + 0.5) * g.dz_m);
            }
    m.x_m /= m.heat_J;
    m.z_m /= m.heat_J;
    return m;
}

TEST(RisingPlume, KeepsHeatAndSmoke) {
    PlumeParameters p;
    p.duration_s = 100.0;
    p.minimum_excess_K = 0.0;
    const Raster<float> flat(one_cell(0.0).heat_flux_W_m2.grid, "terrain", "m", 250.0F);
    const auto plume = rising_plume(one_cell(4e5), flat, p, {1000.0, 3800.0, 0.0});
    const Moments m = moments(plume, p);
    // 4e5 W m-2 x 400 m2 x 100 s, less the step that would have gone over the end; 10 g per 17.433 MJ.
    EXPECT_NEAR(m.heat_J / (4e5 * 400.0 * 100.0), 1.0, 0.12);
    EXPECT_NEAR(m.mass_g / m.heat_J / (10.0 / 17.433e6), 1.0, 1e-3);
}

TEST(RisingPlume, LeansDownwindAboveItsFire) {
    PlumeParameters p;
    const Raster<float> flat(one_cell(0.0).heat_flux_W_m2.grid, "terrain", "m", 250.0F);
    const auto plume = rising_plume(one_cell(4e5), flat, p, {1000.0, 3800.0, 0.0});
    ASSERT_FALSE(plume.empty());
    const Moments m = moments(plume, p);
    EXPECT_GT(m.x_m, 110.0 + 100.0);  // the fire burns at x = 110
    EXPECT_GT(m.z_m, 250.0 + 20.0);
    EXPECT_LT(plume.temperature_range_K()[1], 1100.0);
    EXPECT_GE(plume.z_range_m()[0], 0.0);
    // Nothing upwind of the fire by more than the plume is wide there.
    for (int k = 0; k < 200; ++k)
        for (int j = 0; j < plume.grid.ny; ++j)
            for (int i = 0; plume.grid.corner_m.x + (i + 1) * plume.grid.dx_m < 60.0; ++i)
                EXPECT_EQ(voxel_at(plume, i, j, k).fill, 0.0F);
    EXPECT_TRUE(rising_plume(one_cell(0.0), flat, p, {}).empty());
}

TEST(RisingPlume, OneTemperatureAndFillForTheThesis) {
    PlumeParameters p;
    p.temperature_K = 795.0;
    p.uniform = true;
    const Raster<float> flat(one_cell(0.0).heat_flux_W_m2.grid, "terrain", "m", 250.0F);
    const auto plume = rising_plume(one_cell(4e5), flat, p, {});
    ASSERT_FALSE(plume.empty());
    EXPECT_EQ(plume.temperature_range_K()[0], 795.0);
    EXPECT_EQ(plume.temperature_range_K()[1], 795.0);
}

TEST(PlumeOfLevels, InterpolatesBetweenHeights) {
    const MapGrid grid = test::small_grid(5, 5, 40.0);
    const Raster<float> ground(grid, "terrain", "m", 100.0F);
    const std::vector<Raster<float>> levels{Raster<float>(grid, "T", "K", 10.0F), Raster<float>(grid, "T", "K", 30.0F)};
    PlumeParameters p;
    p.voxel_m = {20.0, 20.0, 10.0};
    const double heights[]{15.0, 55.0};
    const auto plume = plume_of_levels(levels, heights, ground, p, {1000.0, 4800.0, 0.0});
    // Voxel centres 5, 15, ... 55 m above the ground: the lowest level below 15 m, then a straight line, none above 55 m.
    const double expected_K[]{10.0, 10.0, 15.0, 20.0, 25.0, 30.0};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(voxel_at(plume, 3, 3, k).temperature_K, 300.0 + expected_K[k], 1e-3) << k;
    EXPECT_EQ(voxel_at(plume, 3, 3, 6).fill, 0.0F);
    p.minimum_excess_K = 18.0;
    EXPECT_EQ(voxel_at(plume_of_levels(levels, heights, ground, p, {1000.0, 4800.0, 0.0}), 3, 3, 2).fill, 0.0F);
}

TEST(PlumeOfLevels, ReadsBuoyancyAndRefusesWrongHeights) {
    EXPECT_NEAR(excess_of_buoyancy_K(0.981, 300.0), 30.0, 1e-12);
    const MapGrid grid = test::small_grid(5, 5, 40.0);
    const Raster<float> ground(grid, "terrain", "m", 100.0F);
    const std::vector<Raster<float>> levels(2, Raster<float>(grid, "T", "K", 10.0F));
    const double one[]{15.0};
    EXPECT_THROW(plume_of_levels(levels, one, ground, {}, {}), Error);
    PlumeParameters p;
    p.voxel_m = {0.5, 0.5, 0.1};
    const double two[]{15.0, 1000.0};
    EXPECT_THROW(plume_of_levels(levels, two, ground, p, {}), Error);
}

}  // namespace
}  // namespace pyroscene::fire
