// Labels, clocks and ground temperature of FireState.
#include "fire/state.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstring>

#include "base/constants.h"
#include "base/error.h"
#include "small_fires.h"

namespace pyroscene::fire {
namespace {

using test::class_of;
using test::frame;
using test::frame_with_arrival;
using test::kNaN;

const FireParameters kDefaults;

TEST(Labels, FrontIsStrictlyAboveTheThreshold) {
    const auto s = advance(nullptr, frame(6.0, {0.0F, 1000.0F, 1000.1F, 5e6F}), kDefaults);
    EXPECT_EQ(class_of(s, 0), CellClass::Unburned);
    EXPECT_EQ(class_of(s, 1), CellClass::Unburned);
    EXPECT_EQ(class_of(s, 2), CellClass::Front);
    EXPECT_EQ(class_of(s, 3), CellClass::Front);
}

TEST(Labels, PreheatIsNotScar) {
    auto s = advance(nullptr, frame(6.0, {500.0F}), kDefaults);
    s = advance(&s, frame(12.0, {900.0F}), kDefaults);
    EXPECT_EQ(class_of(s, 0), CellClass::Unburned);
    EXPECT_TRUE(std::isnan(s.arrival_time_s.at(0, 0)));
    EXPECT_FLOAT_EQ(s.surface_temperature_K.at(0, 0), 307.15F);
}

TEST(Labels, BurntOutCellsStayScarWithAndWithoutFlux) {
    auto s = advance(nullptr, frame(0.0, {2000.0F, 2000.0F}), kDefaults);
    for (const double time_s : {6.0, 12.0, 5000.0}) {
        s = advance(&s, frame(time_s, {0.0F, 700.0F}), kDefaults);
        EXPECT_EQ(class_of(s, 0), CellClass::Scar) << time_s;
        EXPECT_EQ(class_of(s, 1), CellClass::Scar) << time_s;
    }
}

TEST(Labels, RoundingNoiseIsNoFireEvenWithoutThreshold) {
    FireParameters p;
    p.front_threshold_W_m2 = 0.0;
    const auto s = advance(nullptr, frame(0.0, {5e-4F, 0.1F}), p);
    EXPECT_EQ(class_of(s, 0), CellClass::Unburned);
    EXPECT_EQ(class_of(s, 1), CellClass::Front);
}

TEST(Labels, UnknownFluxIsNoDataOnlyWithoutHistory) {
    auto s = advance(nullptr, frame_with_arrival(0.0, {2000.0F, kNaN, kNaN, kNaN}, {kNaN, kNaN, 0.0F, 50.0F}), kDefaults);
    EXPECT_EQ(class_of(s, 1), CellClass::NoData);
    EXPECT_TRUE(std::isnan(s.surface_temperature_K.at(0, 1)));
    EXPECT_EQ(class_of(s, 2), CellClass::Scar);    // the arrival raster knows it burned
    EXPECT_EQ(class_of(s, 3), CellClass::NoData);  // it will burn later
    s = advance(&s, frame(6.0, {kNaN, 0.0F, kNaN, kNaN}), kDefaults);
    EXPECT_EQ(class_of(s, 0), CellClass::Scar);      // it was seen burning
    EXPECT_EQ(class_of(s, 1), CellClass::Unburned);  // data have come
}

TEST(Clocks, WithoutArrivalRasterTheFirstAndLastBurningFramesCount) {
    auto s = advance(nullptr, frame(10.0, {0.0F}), kDefaults);
    s = advance(&s, frame(20.0, {2000.0F}), kDefaults);
    s = advance(&s, frame(30.0, {3000.0F}), kDefaults);
    s = advance(&s, frame(40.0, {0.0F}), kDefaults);
    EXPECT_EQ(s.arrival_time_s.at(0, 0), 20.0F);
    EXPECT_EQ(s.last_burning_time_s.at(0, 0), 30.0F);
    // Eq 4.18 by hand, 578.97 exp(-t/74.88) + 197.50 exp(-t/247.72) + 33.19 degC: 20 s after the first burning frame.
    const auto by_hand_K = [](double t_s) {
        return 578.97 * std::exp(-t_s / 74.88) + 197.50 * std::exp(-t_s / 247.72) + 33.19 + 273.15;
    };
    EXPECT_NEAR(s.surface_temperature_K.at(0, 0), by_hand_K(20.0), 1e-3);
    // The thesis holds the whole cell at the front temperature while it burns; its clock starts with the last burning frame.
    FireParameters thesis = kDefaults;
    thesis.physics = Physics::Thesis;
    auto t = advance(nullptr, frame(20.0, {2000.0F}), thesis);
    t = advance(&t, frame(30.0, {3000.0F}), thesis);
    t = advance(&t, frame(40.0, {0.0F}), thesis);
    EXPECT_NEAR(t.surface_temperature_K.at(0, 0), by_hand_K(10.0), 1e-3);
}

TEST(Clocks, ReburnIsFrontAgainAndStartsTheScarAnew) {
    auto s = advance(nullptr, frame(0.0, {2000.0F}), kDefaults);
    s = advance(&s, frame(600.0, {0.0F}), kDefaults);
    EXPECT_NEAR(s.surface_temperature_K.at(0, 0) - kZeroCelsius_K, 50.90711, 1e-3);
    s = advance(&s, frame(660.0, {5000.0F}), kDefaults);
    EXPECT_EQ(class_of(s, 0), CellClass::Front);
    EXPECT_FLOAT_EQ(s.surface_temperature_K.at(0, 0), 1073.15F);
    s = advance(&s, frame(720.0, {0.0F}), kDefaults);
    EXPECT_EQ(s.arrival_time_s.at(0, 0), 660.0F);
    EXPECT_EQ(s.last_burning_time_s.at(0, 0), 660.0F);
    EXPECT_NEAR(s.surface_temperature_K.at(0, 0) - kZeroCelsius_K, 448.0209, 1e-3);  // 60 s
}

// Two frames 3600 s apart: all that happened between them is known from the arrival raster alone.
TEST(Clocks, SparseFramesAreDatedByTheArrivalRaster) {
    auto s =
        advance(nullptr, frame_with_arrival(0.0, {2000.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 3300.0F, 3601.0F, kNaN}), kDefaults);
    EXPECT_EQ(class_of(s, 1), CellClass::Unburned);
    s = advance(&s, frame_with_arrival(3600.0, {0.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 3300.0F, 3601.0F, kNaN}), kDefaults);
    EXPECT_EQ(class_of(s, 1), CellClass::Scar);
    EXPECT_EQ(s.arrival_time_s.at(0, 1), 3300.0F);
    EXPECT_NEAR(s.surface_temperature_K.at(0, 1) - kZeroCelsius_K, 102.5589, 1e-3);  // 300 s
    EXPECT_EQ(class_of(s, 2), CellClass::Unburned);
    EXPECT_TRUE(std::isnan(s.arrival_time_s.at(0, 2)));
    EXPECT_EQ(s.predicted_arrival_time_s->at(0, 2), 3601.0F);
    EXPECT_EQ(class_of(s, 3), CellClass::Unburned);
}

TEST(Clocks, ACellSeenBurningBeforeItsArrivalTimeKeepsTheFirstFrameUntilThen) {
    auto s = advance(nullptr, frame_with_arrival(100.0, {2000.0F}, {103.0F}), kDefaults);
    EXPECT_EQ(s.arrival_time_s.at(0, 0), 100.0F);
    s = advance(&s, frame_with_arrival(106.0, {0.0F}, {103.0F}), kDefaults);
    EXPECT_EQ(s.arrival_time_s.at(0, 0), 103.0F);
    EXPECT_EQ(s.last_burning_time_s.at(0, 0), 103.0F);
}

TEST(Clocks, TheArrivalRasterIsCarriedOn) {
    auto s = advance(nullptr, frame_with_arrival(0.0, {2000.0F, 0.0F}, {0.0F, 50.0F}), kDefaults);
    s = advance(&s, frame(60.0, {0.0F, 0.0F}), kDefaults);
    EXPECT_EQ(class_of(s, 1), CellClass::Scar);
    EXPECT_EQ(s.last_burning_time_s.at(0, 1), 50.0F);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// What the comment of FireState lists as needed to continue is enough, and the size does not grow.
TEST(State, ContinuesFromTheStoredFieldsToTheBit) {
    FireState straight, resumed;
    for (int k = 0; k < 12; ++k) {
        std::vector<float> flux(7);
        for (int i = 0; i < 7; ++i)
            flux[static_cast<std::size_t>(i)] = std::max(0.0F, 1e5F * std::sin(0.9F * static_cast<float>(i - k)));
        FrameInputs in = frame(6.0 * k + 0.1, flux, 2.0F, 1.0F);
        if (k == 0) in.arrival_time_s = share(test::raster(in.heat_flux_W_m2.grid, {0, 5, 10, 20, 30, kNaN, 50}));
        straight = advance(k == 0 ? nullptr : &straight, in, kDefaults);

        FireState stored;
        stored.time_s = resumed.time_s;
        stored.arrival_time_s = resumed.arrival_time_s;
        stored.cell_class = resumed.cell_class;
        stored.last_burning_time_s = resumed.last_burning_time_s;
        stored.predicted_arrival_time_s = resumed.predicted_arrival_time_s;
        stored.height_statistics = resumed.height_statistics;
        resumed = advance(k == 0 ? nullptr : &stored, in, kDefaults);
    }
    EXPECT_EQ(straight.cell_class.values, resumed.cell_class.values);
    for (const auto field : {&FireState::arrival_time_s, &FireState::last_burning_time_s, &FireState::surface_temperature_K,
                             &FireState::front_fraction, &FireState::flame_height_m, &FireState::ember_height_m,
                             &FireState::flame_tilt_rad, &FireState::flame_azimuth_rad}) {
        EXPECT_TRUE(same_bits(test::dense(straight.*field), test::dense(resumed.*field)));
        EXPECT_EQ((straight.*field).grid.size(), 7U);
    }
    EXPECT_EQ(straight.height_statistics.count, resumed.height_statistics.count);
    EXPECT_EQ(straight.height_statistics.m2_m2, resumed.height_statistics.m2_m2);
}

void expect_refused(const FireState* previous, const FrameInputs& in, const FireParameters& p, const char* part_of_message) {
    try {
        advance(previous, in, p);
        ADD_FAILURE() << "accepted: " << part_of_message;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(e.what()).find(part_of_message), std::string::npos) << e.what();
    }
}

TEST(State, RefusesInputsThatDoNotFit) {
    const auto s = advance(nullptr, frame(6.0, {0.0F, 0.0F}), kDefaults);
    expect_refused(&s, frame(6.0, {0.0F, 0.0F}), kDefaults, "6 s does not come after the previous frame at 6 s");
    expect_refused(&s, frame(12.0, {0.0F}), kDefaults, "previous state");
    auto in = frame(12.0, {0.0F, 0.0F});
    in.wind_east_m_s = Raster<float>(test::small_grid(2, 1, 30.0), "u", "m s-1");
    expect_refused(&s, in, kDefaults, "wind east: its grid of 2 x 1 cells of 30 m");
    in = frame(12.0, {0.0F, 0.0F});
    in.arrival_time_s = share(Raster<float>(test::small_grid(3, 1), "arrival", "s"));
    expect_refused(&s, in, kDefaults, "arrival time");
    expect_refused(nullptr, frame(kNaN, {0.0F}), kDefaults, "frame time");
}

TEST(State, RefusesParametersThatMakeTheFormulasMeaningless) {
    const auto in = frame(0.0, {0.0F});
    FireParameters p;
    p.volumetric_heat_release_W_m3 = 0.0;
    expect_refused(nullptr, in, p, "volumetric_heat_release_W_m3: is 0, must be above 0");
    p = {};
    p.flaming_heat_flux_W_m2 = -1.0;
    expect_refused(nullptr, in, p, "flaming_heat_flux_W_m2");
    p = {};
    p.maximum_tilt_rad = 90.0 * kDegree_rad;
    expect_refused(nullptr, in, p, "maximum_tilt: is 90 degrees");
    p = {};
    p.front_threshold_W_m2 = -1.0;
    expect_refused(nullptr, in, p, "front_threshold_W_m2");
}

}  // namespace
}  // namespace pyroscene::fire
