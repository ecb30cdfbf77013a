// The radiant fraction that the scenario asks for is met, by soot or by temperature, and reported.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <regex>

#include "base/files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

double value_of(const std::string& json, const std::string& key) {
    std::smatch found;
    if (!std::regex_search(json, found, std::regex("\"" + key + "\": ([-0-9.eE+]+)"))) return -1.0;
    return std::stod(found[1]);
}

/// run.json of the minimal scenario with more lines.
std::string run_with(const ScratchFolder& folder, const std::string& flame) {
    for (const char* file : {"dem.tif", "heat_flux.tif", "camera.yaml"})
        std::filesystem::copy(source_folder() / "scenarios" / "minimal" / file, folder / file);
    auto text = read_text_file(source_folder() / "scenarios" / "minimal" / "scenario.yaml");
    text += "\nflame: " + flame + "\nproducts: [radiance]\nrender: {flame_light: false}\n";
    std::ofstream(folder / "scenario.yaml") << text;
    const auto result = pyroscene_cli("run " + (folder / "scenario.yaml").string() + " -o " + (folder / "out").string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return read_text_file(folder / "out" / "run.json");
}

TEST(RadiantFraction, IsMetByEitherMeans) {
    for (const std::string flame :
         {"{radiant_fraction: 0.21, adjust: soot}", "{radiant_fraction: 0.21, adjust: temperature}",
          "{radiant_fraction: 0.21, adjust: temperature, absorption_per_m: 0.4}",
          "{radiant_fraction: 0.21, profile: mccaffrey}"}) {
        const ScratchFolder folder;
        const auto json = run_with(folder, flame);
        EXPECT_NEAR(value_of(json, "radiant_fraction") / 0.21, 1.0, 0.01) << flame << json;
        const bool soot = flame.find("temperature") == std::string::npos;
        EXPECT_GT(value_of(json, soot ? "soot_volume_fraction" : "flame_temperature_factor"), 0.0) << flame;
        EXPECT_GT(value_of(json, "heat_released_J"), 0.0);
    }
}

TEST(RadiantFraction, SaysWhenTheFrontAloneRadiatesMore) {
    const ScratchFolder folder;
    EXPECT_NE(run_with(folder, "{radiant_fraction: 0.05}").find("cannot be met: the front alone radiates more"),
              std::string::npos);
}

// What a fire radiates is no matter of who looks: the same camera with one of its bands and with all.
TEST(TruePower, IsTheFiresAndNotTheBands) {
    const ScratchFolder folder;
    for (const char* file : {"dem.tif", "heat_flux.tif", "camera.yaml"})
        std::filesystem::copy(source_folder() / "scenarios" / "minimal" / file, folder / file);
    std::ofstream(folder / "scenario.yaml") << R"(pyroscene: 1
inputs: {terrain: {file: dem.tif}, heat_flux: {file: heat_flux.tif}, wind: {speed: 3, from_deg: 270}}
start: 2021-08-12T20:00:00Z
render: {flame_light: false}
products: [radiance, truth, frp]
acquisitions:
  - {id: all, sensor: camera.yaml, time_s: 150, platform: {over: centre, altitude_agl_m: 300}}
  - {id: one, sensor: camera.yaml, time_s: 150, platform: {over: centre, altitude_agl_m: 300}, bands: [SWIR]}
)";
    const auto result = pyroscene_cli("run " + (folder / "scenario.yaml").string() + " -o " + (folder / "out").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto power_MW = [&](const char* id) {
        double sum = 0.0;
        for (const double v : plane(gis::read_image(folder / "out" / id / "frp.tif"), 1)) sum += std::isnan(v) ? 0.0 : v;
        return sum;
    };
    EXPECT_GT(power_MW("all"), 100.0);
    EXPECT_NEAR(power_MW("one") / power_MW("all"), 1.0, 1e-6);
}

// Voxels of any size carry the same thin emission of soot, and nearly the same of gas, which saturates.
TEST(FlamePower, DoesNotDependOnTheVoxels) {
    double finest_W = 0.0, finest_gas_W = 0.0;
    for (const std::string edge : {"2", "5", "10", "20"}) {
        const ScratchFolder folder;
        const auto json = run_with(folder, "{profile: mccaffrey, voxel_m: [" + edge + ", " + edge + ", " + edge + "]}");
        const double flame_W = value_of(json, "flame_W"), gas_W = value_of(json, "flame_gas_W");
        if (finest_W == 0.0) finest_W = flame_W, finest_gas_W = gas_W;
        std::printf("voxels of %s m: gas %.3f of that of 2 m\n", edge.c_str(), gas_W / finest_gas_W);
        EXPECT_NEAR(flame_W / finest_W, 1.0, 0.01) << edge;
        EXPECT_LT(gas_W / finest_gas_W, edge == "2" || edge == "5" ? 1.2 : edge == "10" ? 1.6 : 2.5) << edge;
    }
}

}  // namespace
}  // namespace pyroscene::test
