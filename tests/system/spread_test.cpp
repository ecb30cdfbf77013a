// A fire that the program spreads itself: its files are those of any fire model, and it feeds the images.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/constants.h"
#include "fire/burn_out.h"
#include "gis/crs.h"
#include "gis/raster_input.h"
#include "inputs/spread_model.h"
#include "pipeline/run.h"
#include "spread/fuel_model.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kStep_s = 120.0;

/// A slope with grass and a strip of slash, a road across it, and wind that turns.
class SpreadScenario : public testing::Test {
protected:
    void SetUp() override {
        grid_ = {.cols = 60, .rows = 50, .west_m = 500000.0, .north_m = 5170000.0, .cell_m = 20.0, .crs_wkt = ""};
        grid_.crs_wkt = gis::parse_map_crs("EPSG:32611", "test").wkt;
        write_band(scratch / "dem.tif", grid_, "m",
                   [](double x, double y) { return 800.0 + 0.2 * (x - 500000.0) + 0.05 * (y - 5169000.0); });
        write_band(scratch / "fuel.tif", grid_, "",
                   [](double x, double) { return x > 500600.0 && x < 500800.0 ? 11.0 : 1.0; });
        std::ofstream(scratch / "road.geojson")
            << R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32611"}},"features":[)"
               R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[500000,5169205],[501200,5169205]]}}]})";
        std::ofstream(scratch / "moisture.csv")
            << "time_s,m1h_pct,m10h_pct,m100h_pct,mherb_pct,mwoody_pct\n0,7,8,9,60,90\n1200,4,5,6,60,90\n";
    }
    std::filesystem::path write_scenario(const std::string& name, const std::string& inputs) {
        const auto file = scratch / (name + ".yaml");
        std::ofstream(file)
            << "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n"
            << inputs
            << "fire: {flame_height: {method: raster}}\nstart: 2021-08-12T20:00:00Z\natmosphere: {model: none}\n"
               "acquisitions:\n  - {id: camera, sensor: "
            << (source_folder() / "scenarios" / "minimal" / "camera.yaml").string()
            << ", time_s: 1080, platform: {over: centre, altitude_agl_m: 1000}}\n";
        return file;
    }
    std::filesystem::path own_fire() {
        return write_scenario("own",
                              "  wind: {speed: 4, from_deg: 250}\n  spread:\n    fuel: {file: fuel.tif, table: fbfm13}\n"
                              "    ignition: [{point: [500200, 5169300]}]\n    barriers: [{file: road.geojson}]\n"
                              "    moisture: {table: moisture.csv}\n    duration_s: 2400\n"
                              "    frame_step_s: 120\n    mean_over_s: 120\n");
    }
    ScratchFolder scratch;
    MapGrid grid_;
};

using Phase = void (*)(const scenario::Scenario&, const pipeline::RunOptions&, RunReport&);
std::map<std::string, double> run_phase(Phase phase, const std::filesystem::path& scenario,
                                        const std::filesystem::path& output, int threads = 2) {
    pipeline::RunOptions options;
    options.output = output;
    options.threads = threads;
    RunReport report;
    phase(scenario::load(scenario), options, report);
    auto numbers = report.values();
    for (const auto& [name, count] : report.counters()) numbers[name] = static_cast<double>(count);
    return numbers;
}

TEST_F(SpreadScenario, WritesWhatAnotherFireModelWouldGive) {
    run_phase(&pipeline::spread, own_fire(), scratch / "fire");
    run_phase(&pipeline::prepare, own_fire(), scratch / "own");
    const auto files = write_scenario("files",
                                      "  wind: {speed: 4, from_deg: 250, height: 20ft}\n"
                                      "  cover: {file: fuel.tif, table: fbfm13}\n"
                                      "  heat_flux: {file: fire/heat_flux.tif}\n"
                                      "  fuel_load: {file: fire/fuel_load.tif}\n  arrival: {file: fire/arrival.tif}\n"
                                      "  spread_rate: {file: fire/spread_rate.tif}\n"
                                      "  fireline_intensity: {file: fire/fireline_intensity.tif}\n"
                                      "  flame_length: {file: fire/flame_length.tif}\n");
    run_phase(&pipeline::prepare, files, scratch / "from_files");
    for (const char* state : {"state/t000000240.tif", "state/t000001080.tif", "state/t000002400.tif"}) {
        const auto own = gis::read_image(scratch / "own" / state), other = gis::read_image(scratch / "from_files" / state);
        ASSERT_EQ(own.pixels.size(), other.pixels.size());
        std::size_t differ = 0, burning = 0;
        for (std::size_t i = 0; i < own.pixels.size(); ++i) {
            const double a = own.pixels[i], b = other.pixels[i];
            differ += !(a == b || (std::isnan(a) && std::isnan(b))) ? 1 : 0;
        }
        for (std::size_t i = 0; i < grid_.size(); ++i) burning += own.pixels[i] == 1.0 ? 1 : 0;
        EXPECT_EQ(differ, 0U) << state;
        EXPECT_GT(burning, 1U) << state;
    }
}

TEST_F(SpreadScenario, ConservesHeatAndMass) {
    const auto report = run_phase(&pipeline::spread, own_fire(), scratch / "fire");
    const auto flux = gis::read_image(scratch / "fire" / "heat_flux.tif"),
               fuel = gis::read_image(scratch / "fire" / "fuel_load.tif");
    const auto arrival = gis::read_image(scratch / "fire" / "arrival.tif");
    ASSERT_EQ(flux.bands.size(), 20U);
    ASSERT_EQ(fuel.bands.size(), 21U);
    // Cell by cell: heat = fuel lost x heat of a kilogram at the moisture of its day, 7 % before 1200 s and 4 % after.
    double released_J = 0.0, lost_J = 0.0, lost_kg = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        const double moisture = arrival.pixels[i] < 1200.0 ? 0.07 : 0.04;
        for (std::size_t b = 0; b < flux.bands.size(); ++b)
            released_J += flux.pixels[b * grid_.size() + i] * kStep_s * grid_.cell_area_m2();
        const double lost_kg_m2 = fuel.pixels[i] - fuel.pixels[20 * grid_.size() + i];
        lost_kg += lost_kg_m2 * grid_.cell_area_m2();
        lost_J += lost_kg_m2 * 17.433e6 / (1.0 + moisture) * grid_.cell_area_m2();
    }
    EXPECT_NEAR(released_J / lost_J, 1.0, 1e-6);
    EXPECT_NEAR(report.at("spread/heat_released_J") / released_J, 1.0, 1e-6);
    EXPECT_NEAR(report.at("spread/fuel_burnt_kg") / lost_kg, 1.0, 1e-6);
    EXPECT_GT(lost_kg, 1e4);
}

TEST_F(SpreadScenario, ComesBackAsTheArrivalTimesOfAnotherProgram) {
    run_phase(&pipeline::spread, own_fire(), scratch / "fire");
    // The arrival raster in minutes without a unit tag, as FlamMap writes it: -9999 where the fire never came.
    const auto arrival = gis::read_image(scratch / "fire" / "arrival.tif");
    write_band(scratch / "toa.tif", grid_, "", [&](double x, double y) {
        const double t = arrival.pixels[grid_.index(static_cast<int>(grid_.row_at(y)), static_cast<int>(grid_.col_at(x)))];
        return std::isnan(t) ? -9999.0 : t / 60.0;
    });
    const auto scenario = [&](const char* unit) {
        return write_scenario(unit,
                              fmt::format("  arrival_model:\n    model: other\n    arrival: {{file: toa.tif, unit: {}}}\n"
                                          "    flame_length: {{file: fire/flame_length.tif, unit: m}}\n"
                                          "    fuel: {{file: fuel.tif, table: fbfm13}}\n    fuel_moisture_pct: 7\n"
                                          "    duration_s: 2400\n    frame_step_s: 120\n    mean_over_s: 120\n",
                                          unit));
    };
    run_phase(&pipeline::spread, scenario("min"), scratch / "back");
    const auto own = gis::read_image(scratch / "fire" / "heat_flux.tif"),
               back = gis::read_image(scratch / "back" / "heat_flux.tif");
    double sum = 0.0, difference = 0.0;
    for (std::size_t b = 0; b < 9; ++b)  // until 1080 s the moisture is 7 % in both
        for (std::size_t i = b * grid_.size(); i < (b + 1) * grid_.size(); ++i) {
            sum += own.pixels[i];
            difference += std::abs(own.pixels[i] - back.pixels[i]);
        }
    EXPECT_GT(sum, 0.0);
    EXPECT_LT(difference, 1e-3 * sum);
    // Hours taken for seconds: the fire flies, and the run says so.
    write_band(scratch / "toa.tif", grid_, "", [&](double x, double y) {
        const double t = arrival.pixels[grid_.index(static_cast<int>(grid_.row_at(y)), static_cast<int>(grid_.col_at(x)))];
        return std::isnan(t) ? -9999.0 : t / 3600.0;
    });
    const auto late = pyroscene_cli("prepare " + scenario("s").string() + " -o " + (scratch / "wrong").string());
    EXPECT_EQ(late.exit_code, 0) << late.output;
    EXPECT_NE(late.output.find("check inputs.arrival_model.arrival.unit"), std::string::npos) << late.output;
}

// A front of 0.5 m/s in cells of 20 m on a map of 8 m: no steps in time, the edge of the burn where it was, all heat of the fuel.
TEST_F(SpreadScenario, ArrivalTimesOnAFinerMapAreSmoothAndKeepTheHeat) {
    constexpr double kRate_m_s = 0.5, kWest_m = 500000.0, kEdge_m = 500400.0;
    write_band(scratch / "toa.tif", grid_, "",
               [](double x, double) { return x < kEdge_m ? (x - kWest_m) / kRate_m_s / 60.0 : -9999.0; });
    write_band(scratch / "grass.tif", grid_, "", [](double, double) { return 1.0; });
    const auto file =
        write_scenario("fine",
                       "  arrival_model:\n    model: other\n    arrival: {file: toa.tif, unit: min}\n"
                       "    flame_length: {file: grass.tif, unit: m}\n    fuel: {file: grass.tif, table: fbfm13}\n"
                       "    duration_s: 3000\n    frame_step_s: 100\n    mean_over_s: 100\n");
    std::ofstream(file, std::ios::app) << "map: {crs: EPSG:32611, cell_m: 8}\n";
    const auto report = run_phase(&pipeline::spread, file, scratch / "fire");
    const auto arrival = gis::read_image(scratch / "fire" / "arrival.tif");
    int burnt = 0;
    for (int row = 0; row < arrival.rows; ++row)
        for (int col = 0; col < arrival.cols; ++col) {
            const double t = arrival.pixels[static_cast<std::size_t>(row * arrival.cols + col)], x = (col + 0.5) * 8.0;
            ASSERT_EQ(std::isnan(t), x > kEdge_m - kWest_m) << row << ' ' << col;
            burnt += std::isnan(t) ? 0 : 1;
            if (x > 10.0 && x < 390.0) {
                ASSERT_NEAR(t, x / kRate_m_s, 1e-3) << row << ' ' << col;
            }
        }
    // Anderson's model 1 holds 0.74 short tons per acre of dry fuel; 8 % of moisture (SFIRE: 17.433 MJ/kg of the moist mass).
    const double load_kg_m2 = report.at("spread/fuel_burnt_kg") / (burnt * 64.0);
    EXPECT_NEAR(load_kg_m2, 0.74 * 0.224170, 1e-3);
    EXPECT_NEAR(report.at("spread/heat_released_J") / (burnt * 64.0 * load_kg_m2 * 17.433e6 / 1.08), 1.0, 1e-6);
}

// The wind's height said with the wind is that of the spread; one that blows faster higher up spreads the fire as the one below.
TEST_F(SpreadScenario, WindMayBlowAtAnyHeight) {
    const auto arrival = [&](const std::string& name, const std::string& wind, const std::string& rule) {
        const auto file =
            write_scenario(name, "  wind: {" + wind +
                                     ", from_deg: 250}\n  spread:\n    fuel: {file: fuel.tif, table: fbfm13}\n"
                                     "    ignition: [{point: [500200, 5169300]}]\n    moisture: {table: moisture.csv}\n" +
                                     rule + "    frames_s: [1200]\n");
        run_phase(&pipeline::spread, file, scratch / name);
        return gis::read_image(scratch / name / "arrival.tif").pixels;
    };
    const auto expect_same = [](const std::vector<double>& a, const std::vector<double>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (std::isnan(a[i]) && std::isnan(b[i])) continue;
            ASSERT_NEAR(a[i], b[i], 1e-3 * b[i] + 0.01) << i;
        }
    };
    const auto twenty = arrival("20ft", "speed: 4", "");
    EXPECT_EQ(std::count_if(twenty.begin(), twenty.end(), [](double t) { return t > 0.0; }) > 100, true);
    expect_same(arrival("said", "speed: 4, height: 20ft", ""), twenty);
    expect_same(arrival("10m", "speed: 4.6, height: 10m", ""), twenty);
    expect_same(arrival("rule", "speed: 4.6", "    wind_height: 10m\n"), twenty);
    // ln(40 / 0.05) / ln(6.096 / 0.05) = 1.391577
    expect_same(arrival("mast", "speed: 5.566308, height_m: 40, roughness_m: 0.05", ""), twenty);
}

TEST_F(SpreadScenario, IsTheSameForAnyNumberOfThreads) {
    run_phase(&pipeline::spread, own_fire(), scratch / "one", 1);
    run_phase(&pipeline::spread, own_fire(), scratch / "three", 3);
    for (const char* file : {"arrival.tif", "spread_rate.tif", "flame_length.tif", "heat_flux.tif", "fuel_load.tif"})
        EXPECT_EQ(file_bytes(scratch / "one" / file), file_bytes(scratch / "three" / file)) << file;
}

TEST_F(SpreadScenario, StopsAtARoadAndFeedsTheImages) {
    const auto result = pyroscene_cli("-q run " + own_fire().string() + " -o " + (scratch / "out").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto arrival = gis::read_image(scratch / "out" / "spread" / "arrival.tif");
    const int road = static_cast<int>(grid_.row_at(5169205.0));
    int north = 0, beside = 0, south = 0;
    for (int row = 0; row < grid_.rows; ++row)
        for (int col = 0; col < grid_.cols; ++col) {
            if (std::isnan(arrival.pixels[grid_.index(row, col)])) continue;
            (row < road ? north : south) += 1;
            beside += row == road - 1 ? 1 : 0;
        }
    EXPECT_GT(north, 300);
    EXPECT_GT(beside, 10);
    EXPECT_EQ(south, 0);
    const auto image = gis::read_image(scratch / "out" / "camera" / "radiance.tif");
    const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
    EXPECT_GT(*high, 5.0 * *low);  // a fire before warm ground
    // A second run has nothing to do.
    const auto again = run_phase(&pipeline::prepare, own_fire(), scratch / "out");
    EXPECT_EQ(again.at("states_skipped"), 20.0);
}

TEST(Spread, NeedsAFireToSpread) {
    const auto result = pyroscene_cli("spread " + (source_folder() / "scenarios" / "minimal" / "scenario.yaml").string());
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.output.find("has no inputs.spread"), std::string::npos) << result.output;
}

TEST(Spread, LightsTheLoloPeakLandscapeFromALine) {
    const ScratchFolder scratch;
    const auto report =
        run_phase(&pipeline::spread, source_folder() / "scenarios" / "lolo_peak" / "from_ignition.yaml", scratch / "fire");
    EXPECT_GT(report.at("spread/burnt_area_ha"), 300.0);
    EXPECT_LT(report.at("spread/burnt_area_ha"), 3000.0);
    EXPECT_LT(report.at("spread/largest_flame_length_m"), 15.0);
}

TEST(CalcSpread, GivesTheColumnsOfTheContract) {
    const ScratchFolder scratch;
    const auto result =
        pyroscene_cli("calc spread --csv " + (source_folder() / "tests" / "data" / "rothermel_behave.csv").string() +
                      " -o " + (scratch / "out.csv").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    std::ifstream in(scratch / "out.csv");
    std::string header;
    std::getline(in, header);
    EXPECT_TRUE(header.ends_with("ros_m_s,dir_max_deg,fli_kW_m,flame_length_m,hpua_kJ_m2")) << header;
    // Tall grass with a midflame wind of 3 m/s (BEHAVE: 0.9561484 m/s, 8061.566 kW/m, 4.854233 m, 8431.291 kJ/m2).
    const auto one = pyroscene_cli(
        "calc spread --fuel_model 3 --m1h_pct 6 --m10h_pct 7 --m100h_pct 8 --mherb_pct 60 --mwoody_pct 90 "
        "--wind_m_s 3 --wind_from_deg 270");
    for (const char* text : {"ros_m_s = 0.956148", "dir_max_deg = 90\n", "fli_kW_m = 8061.5", "flame_length_m = 4.85423",
                             "hpua_kJ_m2 = 8431.29"})
        EXPECT_NE(one.output.find(text), std::string::npos) << one.output;
    EXPECT_EQ(
        pyroscene_cli(
            "calc spread --fuel_model 3 --m1h_pct -6 --m10h_pct 7 --m100h_pct 8 --mherb_pct 60 --mwoody_pct 90 --wind_m_s 3")
            .exit_code,
        3);
}

}  // namespace
}  // namespace pyroscene::test
