#include "scenario_folder.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

ScenarioFolder::ScenarioFolder() {
    static int count = 0;
    path_ = fs::temp_directory_path() / ("pyroscene_scenario_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(path_);
    for (const char* name : {"dem.tif", "heat.tif", "heat2.tif", "wind.tif", "fuel.tif", "arrival.tif", "classes.tif",
                             "classes.csv", "lut.nc", "camera.yaml"})
        std::ofstream(path_ / name) << "";
}

ScenarioFolder::~ScenarioFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

Scenario ScenarioFolder::load(const std::string& text) const {
    const fs::path file = path_ / "scenario.yaml";
    std::ofstream(file) << text;
    return scenario::load(file);
}

std::vector<std::string> ScenarioFolder::problems(const std::string& text) const {
    std::vector<std::string> lines;
    try {
        (void)load(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        const std::string prefix = (path_ / "scenario.yaml").string() + ":";
        std::istringstream message(error.what());
        for (std::string line; std::getline(message, line);) {
            const bool heading = line.ends_with(" problems");
            if (!heading) lines.push_back(line.starts_with(prefix) ? line.substr(prefix.size()) : line);
        }
    }
    return lines;
}

namespace {

const std::string kHead = "pyroscene: 1\ninputs:\n  terrain: {file: dem.tif}\n";
const std::string kHeatFlux = "  heat_flux: {file: heat.tif}\n";
const std::string kStart = "start: 2017-07-15T22:00:00Z\n";
const std::string kAcquisitions = "acquisitions:\n  - {id: a, sensor: wasp, time_s: 0, platform: {altitude_m: 3000}}\n";

}  // namespace

std::string shortest(const std::string& more) { return kHead + kHeatFlux + kStart + kAcquisitions + more; }
std::string with_inputs(const std::string& more) { return kHead + kHeatFlux + more + kStart + kAcquisitions; }
std::string with_heat_flux(const std::string& value) {
    return kHead + "  heat_flux: " + value + "\n" + kStart + kAcquisitions;
}
std::string with_acquisitions(const std::string& list) { return kHead + kHeatFlux + kStart + "acquisitions:\n" + list; }
std::string with_platform(const std::string& platform) {
    return with_acquisitions("  - {id: a, sensor: wasp, time_s: 0, platform: " + platform + "}\n");
}

}  // namespace pyroscene::scenario
