#include <gtest/gtest.h>

#include "scenario/scenario.h"
#include "source_folder.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {
Scenario shipped(const std::string& file) { return load(source_folder() / "scenarios" / file); }
}  // namespace

TEST(ShippedScenarios, LoloPeakIsTheMainExample) {
    const Scenario s = shipped("lolo_peak/scenario.yaml");
    EXPECT_EQ(s.name, "lolo_peak");
    EXPECT_EQ(s.start.iso8601(), "2017-07-15T22:00:00Z");
    EXPECT_EQ(s.inputs.cover->table, "fbfm40");
    EXPECT_EQ(s.inputs.cover->raster.bands, std::vector<int>{4});
    ASSERT_EQ(s.acquisitions.size(), 2U);
    EXPECT_EQ(s.acquisitions[0].sensor, "wasp");
    EXPECT_EQ(s.acquisitions[1].sensor, "wasp-thesis");
    for (const auto& a : s.acquisitions) EXPECT_EQ(a.time_s, 3600.0);
}

TEST(ShippedScenarios, ThesisGrassfireComesInBothPhysics) {
    const Scenario a = shipped("thesis_grassfire/scenario.yaml"), b = shipped("thesis_grassfire/scenario_thesis.yaml");
    EXPECT_EQ(a.physics, fire::Physics::Default);
    EXPECT_EQ(b.physics, fire::Physics::Thesis);
    // What figure 6.13 implies: a blackbody at 1100 K seen without air.
    EXPECT_EQ(b.fire.front_temperature_K, 1100.0);
    EXPECT_EQ(b.surface.emissivity, 1.0);
    EXPECT_EQ(b.atmosphere.model, "none");
    EXPECT_EQ(a.acquisitions[0].time_s, b.acquisitions[0].time_s);
    EXPECT_EQ(a.inputs.heat_flux.files, b.inputs.heat_flux.files);
}

TEST(ShippedScenarios, MinimalUsesASensorFileOfItsOwn) {
    const Scenario s = shipped("minimal/scenario.yaml");
    EXPECT_EQ(fs::path(s.acquisitions[0].sensor).filename(), "camera.yaml");
    EXPECT_TRUE(fs::path(s.acquisitions[0].sensor).is_absolute());
}

TEST(ShippedScenarios, FurnaceHasOneTemperature) {
    const Scenario s = shipped("furnace/scenario.yaml");
    EXPECT_EQ(s.fire.front_temperature_K, 1000.0);
    EXPECT_EQ(s.fire.ambient_temperature_K, 1000.0);
    EXPECT_EQ(s.flame.parameters.temperature_K, 1000.0);
    EXPECT_EQ(s.fire.scar.floor_K, 1000.0);
    EXPECT_EQ(s.fire.scar.amplitude1_K + s.fire.scar.amplitude2_K, 0.0);
    EXPECT_EQ(s.surface.emissivity, 1.0);
    EXPECT_EQ(s.atmosphere.model, "none");
}

}  // namespace pyroscene::scenario
