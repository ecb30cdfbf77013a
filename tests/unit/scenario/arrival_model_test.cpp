#include <gtest/gtest.h>

#include "scenario_folder.h"

namespace pyroscene::scenario {
namespace {

std::string with_model(const std::string& keys, const std::string& more_inputs = "") {
    return "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n  arrival_model: {" + keys +
           ", fuel: {file: fuel.tif, table: fbfm13}, frames_s: [300]}\n" + more_inputs +
           "start: 2017-07-15T22:00:00Z\nacquisitions:\n  - {id: a, sensor: wasp, time_s: 300, platform: {altitude_m: "
           "3000}}\n";
}

TEST(ArrivalModel, KnowsTheUnitsThatAProgramAlwaysWrites) {
    const ScenarioFolder folder;
    const auto inputs =
        folder
            .load(with_model("model: elmfire, arrival: {file: arrival.tif}, flame_length: {file: heat.tif, band: 3}, "
                             "fireline_intensity: {file: heat2.tif}, spread_rate: {file: wind.tif}, offset_s: -60"))
            .inputs;
    ASSERT_TRUE(inputs.arrival_model);
    const auto& m = *inputs.arrival_model;
    EXPECT_EQ(m.arrival.unit, "s");
    EXPECT_EQ(m.flame_length->unit, "ft");
    EXPECT_EQ(m.flame_length->raster.bands, std::vector{3});
    EXPECT_EQ(m.fireline_intensity->unit, "kW/m");
    EXPECT_EQ(m.spread_rate->unit, "ft/min");
    EXPECT_EQ(m.offset_s, -60.0);
    EXPECT_EQ(m.fuel_moisture_pct, 8.0);
    EXPECT_EQ(m.fuel.table, "fbfm13");
    EXPECT_EQ(m.frames.times_s, std::vector{300.0});
}

TEST(ArrivalModel, WantsTheUnitsThatFilesDoNotSay) {
    const ScenarioFolder folder;
    EXPECT_EQ(
        folder.problems(with_model("model: farsite, arrival: {file: arrival.tif}")),
        Lines{"4: inputs.arrival_model.arrival: key 'unit' is missing: files of 'farsite' do not say it; one of s, min, h"});
    EXPECT_EQ(folder.problems(with_model("model: flammap, arrival: {file: arrival.tif}, spread_rate: {file: heat.tif}")),
              Lines{"4: inputs.arrival_model.spread_rate: key 'unit' is missing: files of 'flammap' do not say it; one of "
                    "m/s, m/min, ft/min, chain/h"});
    EXPECT_EQ(
        folder.load(with_model("model: farsite, arrival: {file: arrival.tif, unit: h}")).inputs.arrival_model->arrival.unit,
        "h");
    EXPECT_EQ(folder.problems(with_model("model: other, arrival: {file: arrival.tif, unit: days}")),
              Lines{"4: inputs.arrival_model.arrival.unit: 'days' is none of s, min, h"});
}

TEST(ArrivalModel, TakesTheFilesOfProgramsThatWriteNoRasters) {
    const ScenarioFolder folder;
    const auto model = [&](const std::string& keys) { return *folder.load(with_model(keys)).inputs.arrival_model; };
    const auto messages =
        model("model: cell2fire, arrival: {file: arrival.tif, unit: min}, like: fuel.tif, crs: EPSG:32719");
    EXPECT_FALSE(messages.grids);
    EXPECT_EQ(messages.period, 1.0);
    EXPECT_EQ(messages.like->filename(), "fuel.tif");
    EXPECT_EQ(messages.crs, "EPSG:32719");
    const auto grids =
        model("model: cell2fire, arrival: {files: [arrival.tif, heat.tif], unit: min, period: 60}, like: fuel.tif");
    EXPECT_TRUE(grids.grids);
    EXPECT_EQ(grids.arrival.raster.files.size(), 2U);
    EXPECT_EQ(grids.period, 60.0);
    const auto quic = model(
        "model: quic-fire, arrival: {files: [heat.tif]}, crs: EPSG:32616, west_m: 5, south_m: 6, cols: 7, rows: 8, cell_m: "
        "2");
    EXPECT_EQ(quic.cols, 7);
    EXPECT_EQ(quic.rows, 8);
    EXPECT_EQ(*quic.south_m, 6.0);
    EXPECT_EQ(quic.arrival.unit, "s");
    const auto fds = model(
        "model: fds, arrival: {file: heat.tif}, spread_rate: {file: heat.tif}, crs: EPSG:32616, west_m: 5, south_m: 6");
    EXPECT_EQ(fds.spread_rate->unit, "m/s");
    EXPECT_EQ(folder.problems(with_model("model: fds, arrival: {files: [heat.tif]}, crs: EPSG:32616, west_m: 5, south_m: 6"))
                  .size(),
              2U);
    EXPECT_EQ(folder.problems(with_model("model: elmfire, arrival: {file: arrival.tif}, cols: 7")),
              Lines{"4: inputs.arrival_model.cols: does not belong to model 'elmfire'"});
    EXPECT_EQ(folder.problems(with_model("model: fds, arrival: {file: arrival.tif}")).size(), 3U);
}

std::string with_flux(const std::string& keys) {
    return "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n  heat_flux: {" + keys +
           "}\nstart: 2017-07-15T22:00:00Z\nacquisitions:\n  - {id: a, sensor: wasp, time_s: 300, platform: {altitude_m: "
           "3000}}\n";
}

TEST(FluxModel, TakesTheFilesOfProgramsThatWriteNoRasters) {
    const ScenarioFolder folder;
    const auto place = ", crs: EPSG:32616, west_m: 5, south_m: 6";
    const auto quic = *folder
                           .load(with_flux("model: quic-fire, files: [heat.tif, heat2.tif], cols: 7, rows: 8, cell_m: 2" +
                                           std::string(place)))
                           .inputs.flux_model;
    EXPECT_EQ(quic.files, (std::vector{folder.path() / "heat.tif", folder.path() / "heat2.tif"}));
    EXPECT_EQ(quic.cols, 7);
    EXPECT_EQ(quic.rows, 8);
    EXPECT_EQ(quic.south_m, 6.0);
    const auto inputs =
        folder.load(with_flux("model: fds, file: heat.tif, quantity: HRRPUV, offset_s: -20" + std::string(place))).inputs;
    EXPECT_EQ(inputs.flux_model->quantity, "HRRPUV");
    EXPECT_EQ(inputs.flux_model->offset_s, -20.0);
    EXPECT_TRUE(inputs.heat_flux.files.empty());
    EXPECT_EQ(folder.problems(with_flux("model: fds, file: heat.tif, cols: 7" + std::string(place))),
              Lines{"4: inputs.heat_flux.cols: does not belong to model 'fds'"});
    EXPECT_EQ(folder.problems(with_flux("model: quic-fire, files: [], cols: 7, rows: 8, cell_m: 2" + std::string(place))),
              Lines{"4: inputs.heat_flux.files: expected a list of files"});
    EXPECT_EQ(folder.problems(with_flux("model: fds, file: heat.tif")).size(), 3U);
    EXPECT_EQ(folder.problems(with_flux("model: farsite, file: heat.tif" + std::string(place))),
              Lines{"4: inputs.heat_flux.model: 'farsite' is none of quic-fire, fds"});
}

TEST(ArrivalModel, StandsAlone) {
    const ScenarioFolder folder;
    EXPECT_EQ(folder.problems(with_model("model: elmfire, arrival: {file: arrival.tif}", "  heat_flux: {file: heat.tif}\n")),
              Lines{"5: inputs.heat_flux: comes from 'arrival_model'; give one of the two"});
    const auto raster = "fire: {flame_height: {method: raster}}\n";
    EXPECT_EQ(folder.problems(with_model("model: elmfire, arrival: {file: arrival.tif}") + raster).size(), 1U);
    EXPECT_EQ(
        folder.problems(with_model("model: elmfire, arrival: {file: arrival.tif}, flame_length: {file: heat.tif}") + raster),
        Lines{});
}

}  // namespace
}  // namespace pyroscene::scenario
