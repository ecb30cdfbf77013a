// Flame heights and tilts as a user meets them: calc, and scenarios whose rasters are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "base/csv.h"
#include "fire/flame_height.h"
#include "gis/raster_input.h"
#include "inputs/front_inputs.h"
#include "inputs/scene_inputs.h"
#include "pipeline/run.h"
#include "pipeline/state_file.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

double single_result(const std::string& output) { return std::stod(output.substr(output.find('=') + 1)); }
double calc(const std::string& words) {
    const auto result = pyroscene_cli("calc " + words);
    EXPECT_EQ(result.exit_code, 0) << words << "\n" << result.output;
    return result.exit_code == 0 ? single_result(result.output) : std::nan("");
}

// Worked values of the equations in docs/physics-fire.md, computed independently.
TEST(CalcFlameHeight, KnownValuesOfEveryMethod) {
    const std::pair<const char*, double> laws[] = {
        {"byram", 1.85910},         {"weise_biging", 2.01428}, {"thomas", 2.66},
        {"nelson_adkins", 1.43118}, {"nelson_lab", 1.42},      {"nelson_field", 1.55},
        {"butler", 1.75},           {"clark", 0.68982},        {"fernandes", 1.91519},
    };
    for (const auto& [name, length_m] : laws)
        EXPECT_NEAR(calc(fmt::format("flame-height --method {} --fireline_intensity_kW_m 1000", name)), length_m, 6e-6)
            << name;
    EXPECT_NEAR(calc("flame-height --method finney_grumstrup --fireline_intensity_kW_m 1000 --front_depth_m 5"), 1.70243,
                6e-6);
    EXPECT_NEAR(calc("flame-height --method finney_grumstrup --fireline_intensity_kW_m 1000 --heat_flux_W_m2 2e5"), 1.70243,
                6e-6);
    EXPECT_NEAR(calc("flame-height --method heskestad --plume_coefficient_m_kW 0.235 --heat_release_W 1e6 --diameter_m 1"),
                2.704499, 5e-6);
    EXPECT_NEAR(
        calc("flame-height --method heskestad --plume_coefficient_m_kW 0.235 --heat_flux_W_m2 1e6 --cell_area_m2 400"),
        17.89692, 1e-4);
    EXPECT_EQ(calc("flame-height --method heskestad --plume_coefficient_m_kW 0.235 --heat_release_W 39200 --diameter_m 1"),
              0.0);
    EXPECT_NEAR(calc("flame-height --heat_flux_W_m2 5.92e6 --volumetric_heat_release_W_m3 1.2e6"), 4.9333333, 1e-6);
    EXPECT_EQ(calc("flame-height --method constant --constant_m 3"), 3.0);
    EXPECT_NEAR(calc("flame-height --method raster --flame_length_m 4 --tilt_deg 60"), 2.0, 1e-9);
    EXPECT_NEAR(calc("flame-height --method thomas --fireline_intensity_kW_m 1000 --tilt_deg 60"), 1.33, 1e-6);
    EXPECT_NEAR(calc("flame-height --method heat_flux --heat_flux_W_m2 1e6 --tilt_deg 60"), 0.5, 1e-9);
}

TEST(CalcFlameHeight, ThesisCoefficientHasTheDensityOnce) {
    const std::string wood =
        "flame-height --method heskestad --heat_release_W 1e6 --diameter_m 1 --air_temperature_K 293.15 "
        "--air_density_kg_m3 1.204 --air_heat_capacity_J_kg_K 1006 --heat_of_combustion_J_kg 2.9e6 "
        "--air_fuel_ratio 1 --physics ";
    const double power = std::pow(1e3, 0.4);
    EXPECT_NEAR(calc(wood + "default"), 0.23935 * power - 1.02, 1e-4);
    EXPECT_NEAR(calc(wood + "thesis"), 0.24841 * power - 1.02, 1e-4);
}

TEST(CalcFlameTilt, KnownValuesOfEveryMethod) {
    EXPECT_NEAR(calc("flame-tilt --wind_m_s 3 --fireline_intensity_kW_m 500"), 44.79912, 1e-5);
    EXPECT_NEAR(calc("flame-tilt --wind_m_s 3 --fireline_intensity_kW_m 500 --slope_deg 20"), 32.36948, 1e-5);
    EXPECT_NEAR(calc("flame-tilt --method aga --wind_m_s 2 --burning_rate_kg_m2_s 0.02 --diameter_m 2"), 44.165, 1e-3);
    EXPECT_NEAR(calc("flame-tilt --method aga --wind_m_s 2 --burning_rate_kg_m2_s 0.02 --diameter_m 2 "
                     "--fuel_vapour_density_kg_m3 1.18"),
                53.9449, 1e-4);
    EXPECT_NEAR(calc("flame-tilt --method thomas --wind_m_s 5 --burning_rate_kg_m2_s 0.05 --diameter_m 10"), 66.3291, 1e-4);
    // m'' D = I / H_c: 0.04 kg/m/s of 16515 kJ/kg are 660.6 kW/m.
    EXPECT_NEAR(calc("flame-tilt --method thomas --wind_m_s 2 --fireline_intensity_kW_m 660.6"), 65.3934, 1e-4);
    EXPECT_NEAR(calc("flame-tilt --method albini --wind_m_s 3 --flame_height_m 2"), 39.5665, 1e-4);
    EXPECT_NEAR(calc("flame-tilt --method albini --wind_m_s 3 --flame_length_m 2"), 44.33325, 1e-5);
    EXPECT_NEAR(calc("flame-tilt --method putnam --wind_m_s 8 --flame_height_m 4"), 60.7816, 1e-4);
    EXPECT_NEAR(calc("flame-tilt --method rule --wind_m_s 2"), 45.0, 1e-9);
    EXPECT_NEAR(calc("flame-tilt --method butler --wind_m_s 8"), 70.33314, 1e-5);
    EXPECT_EQ(calc("flame-tilt --method thesis --wind_m_s 3 --heat_release_W 1e6"), 0.0);
    EXPECT_NEAR(calc("flame-tilt --method thesis --wind_m_s 3 --heat_release_W 1e6 --physics thesis"), 90.0, 1e-9);
    EXPECT_NEAR(calc("flame-tilt --method thesis --wind_m_s 88.9 --heat_release_W 1e6 --air_heat_capacity_J_kg_K 1040"),
                60.0, 1e-3);
}

TEST(CalcFlames, TablesAndMistakes) {
    const ScratchFolder scratch;
    std::ofstream(scratch / "in.csv") << "method,wind_m_s,flame_height_m\nalbini,3,2\nputnam,3,2\nrule,2,\n";
    const auto out =
        pyroscene_cli("calc flame-tilt --csv " + (scratch / "in.csv").string() + " -o " + (scratch / "out.csv").string());
    ASSERT_EQ(out.exit_code, 0) << out.output;
    const auto tilt_deg = read_csv(scratch / "out.csv").numbers("tilt_deg");
    ASSERT_EQ(tilt_deg.size(), 3U);
    EXPECT_NEAR(tilt_deg[0], 39.5665, 1e-4);
    EXPECT_NEAR(tilt_deg[1], 43.4769, 1e-4);
    EXPECT_NEAR(tilt_deg[2], 45.0, 1e-9);
    for (const char* words :
         {"flame-height --method dragon", "flame-height --method byram", "flame-tilt --method albini --wind_m_s 3",
          "flame-tilt --method albini --wind_m_s 3 --flame_height_m 2 --slope_deg 5",
          "flame-height --method byram --fireline_intensity_kW_m 1 --tilt_deg 90",
          "flame-height --method heskestad --heat_release_W 1 --diameter_m 1 --physics magic"})
        EXPECT_EQ(pyroscene_cli(std::string("calc ") + words).exit_code, 3) << words;
}

// Residence times of the fire-behaviour program whose tables are shipped (surface runs of six fuel models).
TEST(FuelModels, HaveTheResidenceTimesOfTheReference) {
    const auto anderson = inputs::fuel_residence_times_s("fbfm13"), scott = inputs::fuel_residence_times_s("fbfm40");
    EXPECT_EQ(anderson.size(), 13U);
    EXPECT_EQ(scott.size(), 40U);
    EXPECT_NEAR(anderson.at(3), 15.36, 1e-5);
    EXPECT_NEAR(anderson.at(4), 13.24718, 1e-5);
    EXPECT_NEAR(anderson.at(10), 13.05877, 1e-5);
    EXPECT_NEAR(scott.at(102), 12.65934, 1e-5);
    EXPECT_NEAR(scott.at(124), 14.12519, 1e-5);
    EXPECT_NEAR(scott.at(145), 18.40705, 1e-5);
}

/// A front that runs east at 0.5 m/s over 0.5 kg/m2, 16 x 12 cells of 20 m, at 200 s; wind 3 m/s from the west.
class RunningFront : public testing::Test {
protected:
    RunningFront() {
        std::filesystem::create_directories(folder_.path());
        grid_ = gis::make_map_grid(source_folder() / "scenarios/minimal/dem.tif", {}, {});
        grid_.cols = 16, grid_.rows = 12, grid_.cell_m = 20.0;
        const auto arrival = [&](double x_m, double) { return (x_m - grid_.west_m) / 0.5; };
        write_band(folder_ / "dem.tif", grid_, "m", [&](double x_m, double) { return 900.0 + 0.2 * (x_m - grid_.west_m); });
        write_band(folder_ / "arrival.tif", grid_, "s", arrival);
        write_band(folder_ / "fuel.tif", grid_, "kg m-2", [](double, double) { return 0.5; });
        write_band(folder_ / "model.tif", grid_, "", [](double, double) { return 3.0; });
        write_band(folder_ / "length.tif", grid_, "ft", [](double, double) { return 10.0; });
        write_band(folder_ / "intensity.tif", grid_, "Btu ft-1 s-1", [](double, double) { return 100.0; });
        // Cells that the front crosses at 200 s: 15 s of flames leave it for 55 s after it reached the middle.
        for (const double time_s : {200.0, 260.0})
            write_band(folder_ / fmt::format("flux{:.0f}.tif", time_s), grid_, "W m-2",
                       [&](double x_m, double y_m) { return std::abs(arrival(x_m, y_m) - time_s) < 21.0 ? 2.5e5 : 0.0; },
                       {{"time_s", fmt::format("{}", time_s)}});
    }

    /// Prepares the states and returns that of 260 s.
    fire::FireState prepare(const std::string& inputs, const std::string& fire, RunReport& report) {
        const auto file = folder_ / "scenario.yaml";
        std::ofstream(file)
            << "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n  heat_flux: {files: [flux200.tif, flux260.tif]}\n"
            << "  wind: {speed: 3, from_deg: 270}\n" + inputs +
                   "start: 2021-08-12T20:00:00Z\nfire:\n  one_sigma_rule: false\n" + fire
            << "acquisitions:\n  - {id: a, sensor: generic-framing, time_s: 260, platform: {over: centre, "
               "altitude_agl_m: 300}}\n";
        pipeline::RunOptions options;
        options.output = folder_ / "out";
        const auto scenario = scenario::load(file);
        pipeline::prepare(scenario, options, report);
        return pipeline::read_state(pipeline::state_path(folder_ / "out", 260.0), inputs::load_scene_inputs(scenario).grid,
                                    {});
    }
    fire::FireState prepare(const std::string& inputs, const std::string& fire) {
        RunReport report;
        return prepare(inputs, fire, report);
    }

    /// Value of the only kind that burning cells have.
    static double burning(const fire::FireState& state, const SparseRaster<float>& raster) {
        double found = std::nan("");
        int count = 0;
        for (std::size_t i = 0; i < raster.grid.size(); ++i) {
            if (state.cell_class.values[i] != static_cast<std::uint8_t>(fire::CellClass::Front)) continue;
            if (count++ > 0) {
                EXPECT_NEAR(raster[i], found, 1e-4 * std::abs(found));
            }
            found = raster[i];
        }
        EXPECT_GT(count, 10);
        return found;
    }

    const std::string kFuel_ = "  arrival: {file: arrival.tif}\n  fuel_load: {file: fuel.tif}\n";
    ScratchFolder folder_;
    MapGrid grid_;
};

// 16515 kJ/kg x 0.5 kg/m2 x 0.5 m/s = 4128.75 kW/m; half of each cell flames (2.5e5 of 5e5 W m-2).
TEST_F(RunningFront, GetsItsIntensityFromFuelAndArrival) {
    const auto state = prepare(kFuel_, "  flame_height: {method: byram}\n");
    const double tilt_rad = burning(state, state.flame_tilt_rad), length_m = 0.0775 * std::pow(4128.75, 0.46);
    const double buoyant_m_s = std::cbrt(2.0 * 9.81 * 4128.75e3 / (1.18 * 1005.0 * 300.0));
    EXPECT_NEAR(tilt_rad, std::atan(3.0 / buoyant_m_s), 1e-4);
    EXPECT_NEAR(burning(state, state.flame_height_m), 0.5 * length_m * std::cos(tilt_rad), 1e-3);
}

TEST_F(RunningFront, FillsTheDepthOfItsFlames) {
    const auto by_number = prepare(kFuel_, "  front_depth: {method: residence_time, residence_time_s: 20}\n");
    EXPECT_NEAR(burning(by_number, by_number.front_fraction), 0.5, 1e-4);
    const auto by_fuel =
        prepare(kFuel_ + "  cover: {file: model.tif, table: fbfm13}\n", "  front_depth: {method: residence_time}\n");
    EXPECT_NEAR(burning(by_fuel, by_fuel.front_fraction), 15.36 * 0.5 / 20.0, 1e-4);
}

// 100 Btu/ft/s are 346.1469 kW/m, 10 ft 3.048 m.
TEST_F(RunningFront, ReadsIntensityAndLengthInOtherUnits) {
    const auto byram = prepare("  fireline_intensity: {file: intensity.tif}\n", "  flame_height: {method: byram}\n");
    EXPECT_NEAR(burning(byram, byram.flame_height_m),
                0.5 * 0.0775 * std::pow(346.1469333, 0.46) * std::cos(burning(byram, byram.flame_tilt_rad)), 1e-4);
    const auto given =
        prepare("  flame_length: {file: length.tif}\n", "  flame_height: {method: raster}\n  tilt: {method: rule}\n");
    EXPECT_NEAR(burning(given, given.flame_height_m), 0.5 * 3.048 * std::cos(std::atan(1.5)), 1e-4);
}

TEST_F(RunningFront, LeansWithTheTerrainWhenAsked) {
    const auto state = prepare("", "  tilt: {slope: true}\n");
    const double s = std::atan(0.2), buoyant_m_s = std::cbrt(2.0 * 9.81 * 5e6 / (1.18 * 1005.0 * 300.0));
    EXPECT_NEAR(burning(state, state.flame_tilt_rad), std::atan(0.2 + 3.0 * std::cos(s) / buoyant_m_s) - s, 1e-3);
}

TEST_F(RunningFront, CountsWhatCannotBeDerived) {
    RunReport report;
    prepare("", "  flame_height: {method: byram}\n", report);
    EXPECT_GT(report.counters().at("front_cells_with_intensity_by_heat_flux"), 10);
    RunReport negative;
    prepare("", "  flame_height: {method: heskestad, burning_area_fraction: 1}\n", negative);
    EXPECT_FALSE(negative.counters().contains("front_cells_without_flame_height"));  // 1e8 W over 20 m
    RunReport none;
    prepare("", "  flame_height: {method: heskestad, plume_coefficient_m_kW: 0.1, burning_area_fraction: 1}\n", none);
    EXPECT_GT(none.counters().at("front_cells_without_flame_height"), 10);
}

// The last frame's front and scar have burnt 0.5 kg/m2 of the fuel that the flames burn, whatever the smoke is reckoned from.
TEST_F(RunningFront, BudgetsTheHeatOfTheFuelThatItsFlamesBurn) {
    const auto fuel_heat_J = [&](const std::string& fire, double& burnt_m2) {
        RunReport report;
        const auto state = prepare(kFuel_, fire, report);
        const auto& cells = state.cell_class.values;
        burnt_m2 =
            state.cell_class.grid.cell_area_m2() * static_cast<double>(std::count_if(cells.begin(), cells.end(), [](auto c) {
                return c == static_cast<std::uint8_t>(fire::CellClass::Front) ||
                       c == static_cast<std::uint8_t>(fire::CellClass::Scar);
            }));
        return report.values().at("energy/inputs/fuel_heat_J");
    };
    double burnt_m2 = 0.0;
    EXPECT_NEAR(fuel_heat_J("", burnt_m2) / (0.5 * burnt_m2 * 16.515e6), 1.0, 1e-6);
    EXPECT_GT(burnt_m2, 1000.0);
    EXPECT_NEAR(fuel_heat_J("  heat_of_combustion_J_kg: 1.8e7\n", burnt_m2) / (0.5 * burnt_m2 * 1.8e7), 1.0, 1e-6);
    EXPECT_NEAR(fuel_heat_J("plume: {model: rise, heat_of_combustion_J_kg: 1e7}\n", burnt_m2) / (0.5 * burnt_m2 * 16.515e6),
                1.0, 1e-6);
}

// The state after a break is that of a run in one go, also with methods that read more rasters; a new method is not skipped.
TEST_F(RunningFront, ResumesAndNoticesOtherMethods) {
    const std::string fire =
        "  flame_height: {method: byram}\n  front_depth: {method: residence_time, residence_time_s: 20}\n";
    const auto whole = prepare(kFuel_, fire);
    std::filesystem::remove(pipeline::state_path(folder_ / "out", 260.0));
    RunReport report;
    const auto resumed = prepare(kFuel_, fire, report);
    EXPECT_EQ(report.counters().at("states_skipped"), 1);
    EXPECT_EQ(report.counters().at("states_made"), 1);
    for (const auto field :
         {&fire::FireState::flame_height_m, &fire::FireState::flame_tilt_rad, &fire::FireState::front_fraction})
        for (std::size_t i = 0; i < whole.cell_class.values.size(); ++i) EXPECT_EQ((whole.*field)[i], (resumed.*field)[i]);
    for (const auto& changed :
         {"  flame_height: {method: thomas}\n  front_depth: {method: residence_time, residence_time_s: 20}\n",
          "  flame_height: {method: byram}\n  front_depth: {method: residence_time, residence_time_s: 21}\n",
          "  flame_height: {method: byram}\n  tilt: {method: albini}\n", "  heat_of_combustion_J_kg: 1.8e7\n"}) {
        RunReport again;
        prepare(kFuel_, changed, again);
        EXPECT_EQ(again.counters().at("states_skipped"), 0) << changed;
    }
}

}  // namespace
}  // namespace pyroscene::test
