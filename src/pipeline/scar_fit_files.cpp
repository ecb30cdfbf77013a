#include "pipeline/scar_fit_files.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "drawing/line_plot.h"
#include "pipeline/run.h"

namespace pyroscene::pipeline {
namespace {

constexpr const char* kTimeColumns[] = {"time_s", "t_s"};
constexpr const char* kKelvinColumns[] = {"temperature_K", "T_K"};
constexpr const char* kCelsiusColumns[] = {"temperature_C", "T_C", "temperature_degC", "T_degC"};

/// The first of the names that the table has; empty when none.
template <std::size_t N>
std::string find_column(const CsvTable& table, const char* const (&names)[N]) {
    for (const char* name : names)
        if (table.has(name)) return name;
    return {};
}

double zero_K(const ScarRecordFile& file) { return file.celsius ? kZeroCelsius_K : 0.0; }

drawing::LinePlot curve_plot(const ScarRecordFile& file, const fire::ScarFit& fit, const std::string& title, double last_s) {
    constexpr int kSteps = 400;
    drawing::PlotSeries data{"record", file.record.time_s, {}, true}, curve{"fitted curve", {}, {}};
    for (const double T_K : file.record.temperature_K) data.y.push_back(T_K - zero_K(file));
    for (int i = 0; i <= kSteps; ++i) {
        curve.x.push_back(last_s * i / kSteps);
        curve.y.push_back(fire::scar_temperature_K(fit.cooling, curve.x.back()) - zero_K(file));
    }
    drawing::LinePlot plot{title, {"time since arrival of the fire, s", false, {}, {}}, {}, {data, curve}, 900, 460};
    plot.y.label = file.celsius ? "temperature, deg C" : "temperature, K";
    return plot;
}

drawing::LinePlot residual_plot(const ScarRecordFile& file, const fire::ScarFit& fit, double last_s) {
    drawing::PlotSeries zero{"", {0.0, last_s}, {0.0, 0.0}}, residual{"", file.record.time_s, {}, true};
    for (std::size_t i = 0; i < file.record.time_s.size(); ++i)
        residual.y.push_back(file.record.temperature_K[i] - fire::scar_temperature_K(fit.cooling, file.record.time_s[i]));
    return {fmt::format("record minus curve, rms {:.4g} K", fit.rms_K),
            {"time since arrival of the fire, s", false, {}, {}},
            {"residual, K", false, {}, {}},
            {zero, residual},
            900,
            240};
}

nlohmann::ordered_json json_of(const std::filesystem::path& csv, const ScarRecordFile& file, const fire::ScarFit& fit,
                               const std::string& algorithm) {
    using Json = nlohmann::ordered_json;
    const auto names = fire::scar_coefficients(fit.model);
    const std::size_t n = names.size();
    const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
    Json values, errors, covariance = Json::array();
    for (std::size_t i = 0; i < n; ++i) {
        values[names[i]] = fit.values[i];
        errors[names[i]] = number(fit.standard_errors[i]);
        Json row = Json::array();
        for (std::size_t j = 0; j < n; ++j) row.push_back(number(fit.covariance[i * n + j]));
        covariance.push_back(row);
    }
    return {{"program", "pyroscene " + version()},
            {"record", csv.filename().string()},
            {"points", file.record.time_s.size()},
            {"model", fire::scar_model(fit.model).name},
            {"algorithm", algorithm},
            {"converged", fit.converged},
            {"verdict", fit.verdict},
            {"evaluations", fit.evaluations},
            {"sse_K2", fit.sse_K2},
            {"rms_K", fit.rms_K},
            {"coefficients", values},
            {"standard_errors", errors},
            {"covariance_order", names},
            {"covariance", covariance}};
}

}  // namespace

ScarRecordFile read_scar_record(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto time = find_column(table, kTimeColumns), kelvin = find_column(table, kKelvinColumns),
               celsius = find_column(table, kCelsiusColumns);
    if (time.empty())
        throw input_error(table.path, fmt::format("no column of times: expected one of {}; found {}",
                                                  fmt::join(kTimeColumns, ", "), fmt::join(table.columns, ", ")));
    if (kelvin.empty() == celsius.empty())
        throw input_error(
            table.path,
            fmt::format("expected one column of temperatures, {} (kelvin) or {} (degrees Celsius); "
                        "found {}",
                        fmt::join(kKelvinColumns, ", "), fmt::join(kCelsiusColumns, ", "), fmt::join(table.columns, ", ")));
    ScarRecordFile file{{table.numbers(time), table.numbers(kelvin.empty() ? celsius : kelvin)}, kelvin.empty()};
    for (std::size_t i = 0; i < file.record.time_s.size(); ++i) {
        auto& T_K = file.record.temperature_K[i];
        T_K += zero_K(file);
        const auto where = fmt::format("{}:{}", table.path, table.row_lines[i]);
        if (!(file.record.time_s[i] >= 0.0) || !std::isfinite(file.record.time_s[i]))
            throw input_error(where, fmt::format("{} = {}; times count from the arrival of the fire, from 0", time,
                                                 file.record.time_s[i]));
        if (!(T_K > 0.0) || !std::isfinite(T_K))
            throw input_error(where, fmt::format("{} is no temperature: {} K", kelvin.empty() ? celsius : kelvin, T_K));
    }
    return file;
}

std::string scar_yaml(const fire::ScarFit& fit) {
    std::string out = fmt::format("scar:\n  model: {}\n", fire::scar_model(fit.model).name);
    const auto names = fire::scar_coefficients(fit.model);
    for (std::size_t i = 0; i < names.size(); ++i) out += fmt::format("  {}: {:.9g}\n", names[i], fit.values[i]);
    return out;
}

std::string scar_fit_text(const ScarRecordFile& file, const fire::ScarFit& fit, const std::string& algorithm) {
    const auto names = fire::scar_coefficients(fit.model);
    const std::size_t n = names.size();
    std::string out =
        fmt::format("{} by {}, {} points\n", fire::scar_model(fit.model).name, algorithm, file.record.time_s.size());
    for (std::size_t i = 0; i < n; ++i) {
        out += fmt::format("  {:<18} {:>12.7g} +- {:.3g}", names[i], fit.values[i], fit.standard_errors[i]);
        if (file.celsius && i + 1 == n) out += fmt::format("   ({:.7g} degC)", fit.values[i] - kZeroCelsius_K);
        out += "\n";
    }
    out += "  covariance\n";
    for (std::size_t i = 0; i < n; ++i) {
        out += "   ";
        for (std::size_t j = 0; j < n; ++j) out += fmt::format(" {:>12.5g}", fit.covariance[i * n + j]);
        out += "\n";
    }
    out +=
        fmt::format("  sum of squares {:.10g} K2, rms {:.7g} K, {} evaluations\n", fit.sse_K2, fit.rms_K, fit.evaluations);
    return out + fmt::format("  {}: {}\n", fit.converged ? "converged" : "NOT converged", fit.verdict);
}

std::string write_scar_fit(const std::filesystem::path& prefix, const std::filesystem::path& csv, const ScarRecordFile& file,
                           const fire::ScarFit& fit, const std::string& algorithm) {
    std::error_code failure;
    if (prefix.has_parent_path()) std::filesystem::create_directories(prefix.parent_path(), failure);
    if (failure) throw runtime_error(prefix.parent_path().string(), "cannot be made: " + failure.message());
    const auto named = [&](const char* extension) {
        auto path = prefix;
        path += extension;
        return path;
    };
    const double last_s = *std::max_element(file.record.time_s.begin(), file.record.time_s.end());
    const auto title = fmt::format("{}: {} by {}{}", csv.filename().string(), fire::scar_model(fit.model).name, algorithm,
                                   fit.converged ? "" : " - NOT CONVERGED");
    const drawing::LinePlot plots[] = {curve_plot(file, fit, title, last_s), residual_plot(file, fit, last_s)};
    drawing::write_line_plots(named(".png"), plots);
    write_text_file(named(".json"), json_of(csv, file, fit, algorithm).dump(2) + "\n");
    std::string written = named(".png").string() + "\n" + named(".json").string() + "\n";
    if (!fit.converged) return written;
    write_text_file(
        named(".yaml"),
        fmt::format("# fitted to {} by {}: rms {:.4g} K\n", csv.filename().string(), algorithm, fit.rms_K) + scar_yaml(fit));
    return written + named(".yaml").string() + "\n";
}

}  // namespace pyroscene::pipeline
