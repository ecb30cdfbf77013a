#include "fire/surface_field.h"

#include <gtest/gtest.h>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::frame;
using test::frame_with_arrival;
using test::kNaN;

const FireParameters kDefaults;  // flaming flux 5e5 W m-2

double scar_celsius(double age_s) { return 578.97 * std::exp(-age_s / 74.88) + 197.50 * std::exp(-age_s / 247.72) + 33.19; }

double celsius(const SurfaceField& field, int row, int col) {
    return field.base_temperature_K[field.index(row, col)] - kZeroCelsius_K;
}

/// Flaming area of one map cell [m2].
double flaming_m2(const SurfaceField& field, int row, int col) {
    double fraction = 0.0;
    for (int r = row * field.refinement; r < (row + 1) * field.refinement; ++r)
        for (int c = col * field.refinement; c < (col + 1) * field.refinement; ++c)
            fraction += field.front_fraction[field.index(r, c)];
    return fraction * field.grid.cell_area_m2();
}

/// Fire that moves east at one cell per 100 s: centres of cells 0, 1, 2 are reached at 0, 100, 200 s. In the middle cell,
/// the four fine columns of refinement 4 are reached at 62.5, 87.5, 112.5 and 137.5 s.
FireState moving_east(double time_s, float middle_flux_W_m2) {
    return advance(nullptr, frame_with_arrival(time_s, {0.0F, middle_flux_W_m2, 0.0F}, {0.0F, 100.0F, 200.0F}), kDefaults);
}

class EveryRefinement : public testing::TestWithParam<int> {};

TEST_P(EveryRefinement, ConservesTheFlamingAreaOfEveryCell) {
    const std::vector<float> flux{1001.0F, 3e4F, 1.5e5F, 4.9e5F, 5.92e6F, 0.0F};
    const double fraction[] = {1001.0 / 5e5, 0.06, 0.3, 0.98, 1.0, 0.0};
    const FrameInputs with_arrival = frame_with_arrival(100.0, flux, {20.0F, 70.0F, 95.0F, 130.0F, kNaN, 160.0F});
    for (const FrameInputs& in : {frame(100.0, flux), with_arrival}) {
        const auto field = surface_at(advance(nullptr, in, kDefaults), 103.0, kDefaults, GetParam());
        for (int col = 0; col < 6; ++col) EXPECT_NEAR(flaming_m2(field, 0, col), fraction[col] * 400.0, 1e-4) << col;
    }
}

TEST_P(EveryRefinement, LiesOnTheMapGrid) {
    const auto field = surface_at(advance(nullptr, frame(0.0, {0.0F, 1e6F}), kDefaults), 0.0, kDefaults, GetParam());
    EXPECT_EQ(field.grid.cols, 2 * GetParam());
    EXPECT_EQ(field.grid.west_m, 1000.0);
    EXPECT_EQ(field.grid.north_m, 5000.0);
    EXPECT_NEAR(field.grid.east_m(), 1040.0, 1e-9);
    const auto cells = static_cast<std::size_t>(GetParam()) * static_cast<std::size_t>(GetParam());
    EXPECT_EQ(field.front_fraction.size(), (SurfaceField::kSharedBlocks + 1) * cells);  // one cell burns
}

INSTANTIATE_TEST_SUITE_P(Fine, EveryRefinement, testing::Values(1, 2, 3, 4, 7));

TEST(FrontStrip, LiesWhereTheFireArrivedLast) {
    const auto field = surface_at(moving_east(100.0, 1.25e5F), 100.0, kDefaults, 4);  // a quarter of the cell
    for (int row = 0; row < 4; ++row) {
        const float* fraction = &field.front_fraction[field.index(row, 4)];
        EXPECT_EQ(fraction[0], 0.0F);
        EXPECT_EQ(fraction[1], 1.0F);  // reached at 87.5 s
        EXPECT_EQ(fraction[2], 0.0F);
        EXPECT_EQ(fraction[3], 0.0F);
        // Behind it a scar of its own age, ahead of it vegetation.
        EXPECT_NEAR(celsius(field, row, 4), scar_celsius(37.5), 1e-3);
        EXPECT_NEAR(celsius(field, row, 6), 34.0, 1e-3);
        EXPECT_EQ(field.burned[field.index(row, 4)], 1);
        EXPECT_EQ(field.burned[field.index(row, 5)], 1);
        EXPECT_EQ(field.burned[field.index(row, 6)], 0);
    }
}

TEST(FrontStrip, WidensBackwardsThenForwardsAndEndsInAFraction) {
    // 0.8 of 16 fine cells = 12.8: the reached columns, the next to be reached, and 0.8 of one cell of the last.
    const auto field = surface_at(moving_east(100.0, 4e5F), 100.0, kDefaults, 4);
    for (int row = 0; row < 4; ++row)
        for (int col = 4; col < 7; ++col) EXPECT_EQ(field.front_fraction[field.index(row, col)], 1.0F);
    EXPECT_NEAR(field.front_fraction[field.index(0, 7)], 0.8, 1e-6);
    EXPECT_EQ(field.front_fraction[field.index(1, 7)], 0.0F);
    EXPECT_EQ(field.burned[field.index(0, 7)], 1);
    EXPECT_EQ(field.burned[field.index(1, 7)], 0);
}

TEST(FrontStrip, MovesOnWithTheAcquisitionTime) {
    const auto field = surface_at(moving_east(100.0, 1.25e5F), 120.0, kDefaults, 4);
    EXPECT_EQ(field.front_fraction[field.index(2, 5)], 0.0F);
    EXPECT_EQ(field.front_fraction[field.index(2, 6)], 1.0F);  // reached at 112.5 s
    EXPECT_NEAR(celsius(field, 2, 5), scar_celsius(32.5), 1e-3);
}

TEST(FrontStrip, TakesTheCellsOwnTimeBesideCellsThatNeverBurn) {
    const auto state = advance(nullptr, frame_with_arrival(100.0, {0.0F, 1.25e5F, 0.0F}, {kNaN, 90.0F, kNaN}), kDefaults);
    const auto field = surface_at(state, 100.0, kDefaults, 2);
    for (int col = 2; col < 4; ++col) EXPECT_NEAR(celsius(field, 1, col), scar_celsius(10.0), 1e-3);
}

TEST(FrontStrip, LeavesTheUnreachedPartOfAScarCellGreen) {
    // One cell was reached at 50 s, its neighbours will be at 250 s: the fire is still inside the middle third.
    const auto state = advance(nullptr, frame_with_arrival(100.0, {0.0F, 0.0F, 0.0F}, {250.0F, 50.0F, 250.0F}), kDefaults);
    const auto field = surface_at(state, 100.0, kDefaults, 5);
    ASSERT_EQ(state.cell_class.values[1], static_cast<std::uint8_t>(CellClass::Scar));
    EXPECT_NEAR(celsius(field, 2, 7), scar_celsius(50.0), 1e-3);
    EXPECT_NEAR(celsius(field, 2, 5), 34.0, 1e-3);  // interpolated arrival 50 + 0.4 x 200 = 130 s
    EXPECT_EQ(field.burned[field.index(2, 5)], 0);
}

TEST(FrontPatches, WithoutArrivalTimesAreRandomButReproducible) {
    const auto state = advance(nullptr, frame(100.0, std::vector<float>(20, 1.25e5F)), kDefaults);
    const auto field = surface_at(state, 130.0, kDefaults, 4);
    EXPECT_EQ(field.front_fraction, surface_at(state, 130.0, kDefaults, 4).front_fraction);
    FireParameters other = kDefaults;
    other.seed = 2;
    EXPECT_NE(field.front_fraction, surface_at(state, 130.0, other, 4).front_fraction);
    // The part without flames is vegetation in the first frame of the cell's fire and scar from the second on; the pattern
    // is not the same in all cells.
    const auto second =
        surface_at(advance(&state, frame(130.0, std::vector<float>(20, 1.25e5F)), kDefaults), 130.0, kDefaults, 4);
    int first_fine_cell_flames = 0;
    for (int col = 0; col < 20; ++col) {
        EXPECT_NEAR(celsius(field, 0, 4 * col), 34.0, 1e-3);
        EXPECT_NEAR(celsius(second, 0, 4 * col), scar_celsius(30.0), 1e-3);
        first_fine_cell_flames += field.front_fraction[field.index(0, 4 * col)] > 0.0F ? 1 : 0;
    }
    EXPECT_GT(first_fine_cell_flames, 0);
    EXPECT_LT(first_fine_cell_flames, 20);
}

TEST(Thesis, TheWholeFrontCellBurnsAndScarsHaveOneTemperature) {
    FireParameters p;
    p.physics = Physics::Thesis;
    auto state = advance(nullptr, frame_with_arrival(100.0, {0.0F, 2000.0F, 0.0F}, {0.0F, 100.0F, 200.0F}), p);
    const auto field = surface_at(state, 100.0, p, 4);
    for (int col = 4; col < 8; ++col) EXPECT_EQ(field.front_fraction[field.index(1, col)], 1.0F);
    for (int col = 0; col < 4; ++col) EXPECT_NEAR(celsius(field, 2, col), scar_celsius(100.0), 1e-3);
    EXPECT_FLOAT_EQ(static_cast<float>(field.front_temperature_K), 1073.15F);
}

TEST(Scar, CoolsToTheAcquisitionTime) {
    auto state = advance(nullptr, frame(0.0, {1e5F}), kDefaults);
    state = advance(&state, frame(30.0, {0.0F}), kDefaults);
    for (const double time_s : {30.0, 60.0, 100.0, 600.0}) {
        EXPECT_NEAR(celsius(surface_at(state, time_s, kDefaults, 1), 0, 0), scar_celsius(time_s), 1e-3);
    }
    EXPECT_NEAR(celsius(surface_at(state, 1e6, kDefaults, 1), 0, 0), 34.0, 1e-3);
}

TEST(Scar, VariesInsideACellWithTheInterpolatedArrival) {
    const auto field = surface_at(moving_east(300.0, 0.0F), 300.0, kDefaults, 4);
    const double arrival_s[] = {62.5, 87.5, 112.5, 137.5};
    for (int col = 0; col < 4; ++col) EXPECT_NEAR(celsius(field, 3, 4 + col), scar_celsius(300.0 - arrival_s[col]), 1e-3);
}

TEST(Scar, CoolsFromItsArrivalEvenWhenTheCellWasSeenBurningLater) {
    auto state = moving_east(110.0, 1e5F);
    state = advance(&state, frame(300.0, {0.0F, 0.0F, 0.0F}), kDefaults);
    const auto field = surface_at(state, 300.0, kDefaults, 4);
    const double clock_s[] = {62.5, 87.5, 112.5, 137.5};  // bilinear between cell centres, 100 s apart
    for (int col = 0; col < 4; ++col) EXPECT_NEAR(celsius(field, 0, 4 + col), scar_celsius(300.0 - clock_s[col]), 1e-3);
}

TEST(Scar, PartsThatTheInterpolationHasNotReachedAreVegetation) {
    const auto field = surface_at(moving_east(101.0, 0.0F), 101.0, kDefaults, 4);
    for (const int col : {6, 7}) {
        EXPECT_NEAR(celsius(field, 0, col), 34.0, 1e-3);
        EXPECT_EQ(field.burned[field.index(0, col)], 0);
    }
}

TEST(Unburned, StaysSoWhateverTheArrivalTimeSays) {
    const auto field = surface_at(moving_east(150.0, 0.0F), 250.0, kDefaults, 4);  // cell 2 is reached at 200 s
    for (int col = 8; col < 12; ++col) {
        EXPECT_NEAR(celsius(field, 0, col), 34.0, 1e-3);
        EXPECT_EQ(field.burned[field.index(0, col)], 0);
        EXPECT_EQ(field.front_fraction[field.index(0, col)], 0.0F);
    }
}

TEST(NoData, HasNoTemperature) {
    const auto field = surface_at(advance(nullptr, frame(0.0, {kNaN, 0.0F}), kDefaults), 0.0, kDefaults, 2);
    EXPECT_TRUE(std::isnan(field.base_temperature_K[field.index(1, 1)]));
    EXPECT_FALSE(std::isnan(field.base_temperature_K[field.index(1, 2)]));
}

TEST(SurfaceAt, RefusesThePastAndNoCells) {
    const auto state = advance(nullptr, frame(10.0, {0.0F}), kDefaults);
    EXPECT_THROW(surface_at(state, 9.0, kDefaults, 1), Error);
    EXPECT_THROW(surface_at(state, kNaN, kDefaults, 1), Error);
    EXPECT_THROW(surface_at(state, 10.0, kDefaults, 0), Error);
}

// Of 100 000 map cells three burn: memory follows them, and every other fine cell is vegetation at ambient temperature.
TEST(SurfaceField, MemoryFollowsTheFire) {
    std::vector<float> flux(100000, 0.0F);
    flux[0] = flux[777] = flux[99999] = 1e5F;
    flux[5] = kNaN;
    const auto field = surface_at(advance(nullptr, frame(0.0, flux), kDefaults), 0.0, kDefaults, 16);
    EXPECT_EQ(field.base_temperature_K.size(), 5U * 256U);
    std::size_t flaming = 0, own = 0;
    field.for_each_own_cell([&](int row, int col, std::size_t i) {
        ++own;
        EXPECT_EQ(i, field.index(row, col));
        flaming += field.front_fraction[i] > 0.0F ? 1 : 0;
    });
    EXPECT_EQ(own, 3U * 256U);
    EXPECT_GT(flaming, 3U * 40U);
    EXPECT_TRUE(std::isnan(field.base_temperature_K[field.index(7, 5 * 16 + 3)]));
    EXPECT_EQ(field.base_temperature_K[field.index(9, 3000)], static_cast<float>(kDefaults.ambient_temperature_K));
    EXPECT_EQ(field.burned[field.index(9, 3000)], 0);
}

// Two burnt cells of different cover, 100 s after arrival: 800 degC e^-1 above its floor in one, eq 4.18 in the other.
TEST(SurfaceField, EachClassOfCoverCoolsByItsOwnCurve) {
    FireParameters p;
    p.scar_of_cover = {{7, {.amplitude1_K = 800.0, .time_constant1_s = 100.0, .amplitude2_K = 0.0, .floor_K = 320.0}}};
    auto first = test::frame_with_arrival(0.0, {5e4F, 5e4F}, {0.0F, 0.0F});
    first.scar_class = Raster<std::uint8_t>(first.heat_flux_W_m2.grid, "scar class", "1");
    first.scar_class.values = {1, 0};
    auto later = test::frame_with_arrival(60.0, {0.0F, 0.0F}, {0.0F, 0.0F});
    later.scar_class = first.scar_class;
    const auto start = advance(nullptr, first, p);
    const auto state = advance(&start, later, p);
    EXPECT_NEAR(state.surface_temperature_K.at(0, 0), 320.0 + 800.0 * 0.5488116361, 1e-3);
    EXPECT_NEAR(state.surface_temperature_K.at(0, 1), 448.0209 + 273.15, 1e-3);
    const auto surface = surface_at(state, 100.0, p, 2);
    EXPECT_NEAR(surface.base_temperature_K[surface.index(0, 0)], 320.0 + 800.0 * 0.3678794412, 1e-3);
    EXPECT_NEAR(surface.base_temperature_K[surface.index(0, 3)], 317.3808 + 273.15, 1e-3);
}

}  // namespace
}  // namespace pyroscene::fire
