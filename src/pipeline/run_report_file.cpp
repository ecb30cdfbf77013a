#include "pipeline/run_report_file.h"

#include <sys/resource.h>

#include <chrono>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/files.h"

namespace pyroscene::pipeline {

void write_run_report(const scenario::Scenario& scenario, const RunOptions& options, const RunReport& report,
                      const Fingerprints* fingerprints, const std::string& failure) {
    using Clock = std::chrono::system_clock;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    nlohmann::ordered_json json;
    json["program"] = "pyroscene";
    json["version"] = version();
    json["command"] = options.command_line;
    json["status"] = failure.empty() ? "done" : "failed";
    if (!failure.empty()) json["failure"] = failure;
    const double now_s = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    json["finished"] = UtcTime{std::floor(now_s)}.iso8601();
    json["scenario"] = {{"name", scenario.name},
                        {"file", scenario.path.string()},
                        {"physics", scenario.physics == fire::Physics::Thesis ? "thesis" : "default"},
                        {"start", scenario.start.iso8601()},
                        {"seed", scenario.seed},
                        {"text", read_text_file(scenario.path)}};
    if (fingerprints != nullptr) json["inputs_sha256"] = fingerprints->input_hashes();
    json["threads"] = options.threads;
    json["timings_s"] = report.timings_s();
    json["counters"] = report.counters();
    nlohmann::ordered_json values = nlohmann::ordered_json::object(), energy = nlohmann::ordered_json::object(),
                           fronts = nlohmann::ordered_json::object();
    for (const auto& [name, value] : report.values()) {
        // energy/<acquisition>/<quantity> and fronts/<frame>/<quantity> become nested objects.
        const auto first = name.find('/'), last = name.rfind('/');
        if (name.starts_with("energy/") && last > first)
            energy[name.substr(first + 1, last - first - 1)][name.substr(last + 1)] = value;
        else if (name.starts_with("fronts/") && last > first)
            fronts[name.substr(first + 1, last - first - 1)][name.substr(last + 1)] = value;
        else
            values[name] = value;
    }
    json["energy_budget"] = energy;
    if (!fronts.empty()) json["fronts"] = fronts;
    if (!values.empty()) json["values"] = values;
    json["peak_memory_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
    json["warnings"] = report.warnings();
    write_text_file(options.output / "run.json", json.dump(2) + "\n");
}

void keep_energy(RunReport& report, const std::filesystem::path& output, const std::string& acquisition_id) {
    const auto prefix = "energy/" + acquisition_id + "/";
    const auto values = report.values();
    const auto recorded = values.lower_bound(prefix);
    if (recorded != values.end() && recorded->first.starts_with(prefix)) return;
    std::ifstream in(output / "run.json");
    const auto earlier = nlohmann::json::parse(in, nullptr, false);
    if (!earlier.is_object()) return;
    const auto budgets = earlier.value("energy_budget", nlohmann::json::object());
    const auto budget = budgets.value(acquisition_id, nlohmann::json::object());
    for (const auto& [name, value] : budget.items())
        if (value.is_number()) report.record(prefix + name, value.get<double>());
}

}  // namespace pyroscene::pipeline
