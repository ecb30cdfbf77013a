#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace pyroscene::scenario {

/// A temporary folder with empty files that scenarios can name: dem.tif, heat.tif, heat2.tif, wind.tif, fuel.tif, arrival.tif,
/// classes.tif, classes.csv, lut.nc, camera.yaml. load() only asks whether they are there.
class ScenarioFolder {
public:
    ScenarioFolder();
    ScenarioFolder(const ScenarioFolder&) = delete;
    ScenarioFolder& operator=(const ScenarioFolder&) = delete;
    ~ScenarioFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Loads a scenario of this text (written as scenario.yaml).
    [[nodiscard]] Scenario load(const std::string& text) const;
    /// What load() refuses: "line: key.path: message" each, in order; empty when it loads.
    [[nodiscard]] std::vector<std::string> problems(const std::string& text) const;

private:
    std::filesystem::path path_;
};

using Lines = std::vector<std::string>;

/// The shortest scenario that loads (7 lines), with more text after it.
std::string shortest(const std::string& more = "");
/// The same with more keys under `inputs` (from line 5 on).
std::string with_inputs(const std::string& more);
/// The same with another value for the heat flux (line 4).
std::string with_heat_flux(const std::string& value);
/// The same with another list of acquisitions (from line 7 on).
std::string with_acquisitions(const std::string& list);
/// The same with one acquisition of another platform (line 7).
std::string with_platform(const std::string& platform);

}  // namespace pyroscene::scenario
