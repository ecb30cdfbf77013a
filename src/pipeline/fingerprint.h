#pragma once

#include <map>
#include <string>

#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// Hashes that decide whether a finished output still belongs to the scenario. Each covers the program version, the content of
/// the input files and the settings that the output depends on, and nothing else.
class Fingerprints {
public:
    explicit Fingerprints(const scenario::Scenario& scenario);

    [[nodiscard]] std::string state(double time_s) const;
    [[nodiscard]] std::string image(const scenario::Acquisition& acquisition) const;
    [[nodiscard]] std::string product(const scenario::Acquisition& acquisition) const;
    /// SHA-256 of every input file, by path as the scenario names it.
    [[nodiscard]] const std::map<std::string, std::string>& input_hashes() const noexcept { return input_hashes_; }

private:
    const scenario::Scenario& scenario_;
    std::map<std::string, std::string> input_hashes_;
    std::string base_;
};

}  // namespace pyroscene::pipeline
