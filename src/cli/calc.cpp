#include "cli/calc.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace pyroscene::cli {
namespace {

struct CommandLine {
    std::string name, csv, output, plot;
    bool json = false, help = false;
    std::map<std::string, std::string> values;
};

CommandLine parse(const std::vector<std::string>& words) {
    CommandLine line;
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string key = words[i];
        if (i == 0 && !key.starts_with("-")) {
            line.name = key;
            continue;
        }
        if (key == "--json" || key == "--help" || key == "-h") {
            (key == "--json" ? line.json : line.help) = true;
            continue;
        }
        if (key != "-o" && !key.starts_with("--")) throw std::invalid_argument(fmt::format("'{}' is no option", key));
        key = key == "-o" ? "output" : key.substr(2);
        std::string value;
        if (const auto equals = key.find('='); equals != std::string::npos) {
            value = key.substr(equals + 1);
            key = key.substr(0, equals);
        } else {
            if (i + 1 >= words.size()) throw std::invalid_argument(fmt::format("--{} needs a value", key));
            value = words[++i];
        }
        if (key == "csv")
            line.csv = value;
        else if (key == "output")
            line.output = value;
        else if (key == "plot")
            line.plot = value;
        else
            line.values[key] = value;
    }
    return line;
}

const Calculation& find(const std::string& name) {
    for (const auto& c : calculations())
        if (c.name == name) return c;
    std::vector<std::string> names;
    for (const auto& c : calculations()) names.push_back(c.name);
    throw std::invalid_argument(fmt::format("calc: no '{}'; there are {}", name, fmt::join(names, ", ")));
}

Arguments complete(const Calculation& calculation, std::map<std::string, std::string> values, const std::string& where) {
    for (const auto& option : calculation.options) {
        if (const auto it = values.find(option.name); it != values.end() && !it->second.empty()) continue;
        values.erase(option.name);
        if (option.fallback)
            values[option.name] = *option.fallback;
        else if (!option.optional)
            throw input_error(where, fmt::format("'{}' is missing", option.name));
    }
    return Arguments(std::move(values));
}

std::string number_text(double v) { return std::isnan(v) ? "nan" : fmt::format("{:.12g}", v); }

/// Rows of what was asked for, each with its results behind.
struct ResultTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

void append(std::vector<std::string>& row, const std::vector<double>& results) {
    for (const double v : results) row.push_back(number_text(v));
}

ResultTable compute_table(const Calculation& calculation, const CommandLine& line) {
    const auto table = read_csv(line.csv);
    ResultTable out{table.columns, table.rows};
    out.columns.insert(out.columns.end(), calculation.results.begin(), calculation.results.end());
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        auto values = line.values;  // options on the command line hold for rows that do not say otherwise
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            if (!table.rows[r][c].empty()) values[table.columns[c]] = table.rows[r][c];
        const auto where = fmt::format("{}:{}", table.path, table.row_lines[r]);
        append(out.rows[r], calculation.compute(complete(calculation, values, where)));
    }
    return out;
}

/// Without a wavelength, all of them.
ResultTable compute_spectrum(const Calculation& calculation, const CommandLine& line) {
    auto values = line.values;
    values["wavelength_um"] = "1";
    ResultTable out{{"wavelength_um"}, {}};
    out.columns.insert(out.columns.end(), calculation.results.begin(), calculation.results.end());
    for (const double lambda_um : calculation.spectrum_um(complete(calculation, values, "calc " + line.name))) {
        values["wavelength_um"] = fmt::format("{}", lambda_um);
        out.rows.push_back({values["wavelength_um"]});
        append(out.rows.back(), calculation.compute(complete(calculation, values, "calc " + line.name)));
    }
    return out;
}

/// The options that hold, then the results.
ResultTable compute_one(const Calculation& calculation, const CommandLine& line) {
    const auto arguments = complete(calculation, line.values, "calc " + line.name);
    ResultTable out{{}, {{}}};
    for (const auto& option : calculation.options)
        if (arguments.has(option.name)) {
            out.columns.push_back(option.name);
            out.rows[0].push_back(arguments.text(option.name));
        }
    out.columns.insert(out.columns.end(), calculation.results.begin(), calculation.results.end());
    append(out.rows[0], calculation.compute(arguments));
    return out;
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string quoted;
    for (const char c : text) quoted += c == '"' ? std::string(2, c) : std::string(1, c);
    return '"' + quoted + '"';
}

std::string csv_line(const std::vector<std::string>& fields) {
    std::vector<std::string> out;
    for (const auto& field : fields) out.push_back(csv_field(field));
    return fmt::format("{}\n", fmt::join(out, ","));
}

std::string csv_text(const ResultTable& table) {
    std::string out = csv_line(table.columns);
    for (const auto& row : table.rows) out += csv_line(row);
    return out;
}

/// A number where the text is one; what is not finite has no place in JSON.
nlohmann::ordered_json json_value(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') return text;
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// A row as an object by column name; several as a list.
std::string json_text(const ResultTable& table) {
    auto rows = nlohmann::ordered_json::array();
    for (const auto& fields : table.rows) {
        nlohmann::ordered_json row;
        for (std::size_t c = 0; c < fields.size(); ++c) row[table.columns[c]] = json_value(fields[c]);
        rows.push_back(std::move(row));
    }
    return (rows.size() == 1 ? rows[0] : rows).dump(2) + "\n";
}

std::string lines_text(const Calculation& calculation, const ResultTable& table) {
    std::string out;
    const auto& row = table.rows.front();
    const std::size_t first = row.size() - calculation.results.size();
    for (std::size_t i = 0; i < calculation.results.size(); ++i)
        out += fmt::format("{} = {}\n", calculation.results[i], row[first + i]);
    return out;
}

/// Options, results and one example of a calculation.
std::string help_of(const Calculation& c) {
    std::string help = fmt::format(
        "{}\nUsage: pyroscene calc {} --option value ...\n\nOptions (each is also a column of --csv):\n", c.help, c.name);
    for (const auto& o : c.options)
        help += fmt::format("  --{:<30}{}\n", o.name,
                            o.fallback                                   ? "default " + *o.fallback
                            : o.optional                                 ? "if it matters"
                            : c.spectrum_um && o.name == "wavelength_um" ? "without it: the whole spectrum, as CSV"
                                                                         : "required");
    help += fmt::format("Results:\n  {}\n", fmt::join(c.results, ", "));
    help += "Input and output:\n";
    help += "  --csv FILE                      computes every row of a table and appends the results\n";
    help += "  -o,--output FILE                .csv or .json: options and results as a table; else as printed\n";
    help += "  --json                          prints JSON\n";
    if (c.plot) help += "  --plot FILE                     draws the spectrum (PNG)\n";
    return help + fmt::format("\nExample: pyroscene calc {} {}\n", c.name, c.example);
}

}  // namespace

bool Arguments::has(const std::string& name) const { return values_.contains(name); }
std::string Arguments::text(const std::string& name) const {
    const auto it = values_.find(name);
    if (it == values_.end()) throw input_error("--" + name, "is missing");
    return it->second;
}
double Arguments::number(const std::string& name) const { return parse_number(text(name), "--" + name); }
double Arguments::positive(const std::string& name) const {
    const double value = number(name);
    if (!(value > 0.0) || !std::isfinite(value))
        throw input_error("--" + name, fmt::format("found {}, expected more than 0", value));
    return value;
}
double Arguments::not_negative(const std::string& name) const {
    const double value = number(name);
    if (!(value >= 0.0) || !std::isfinite(value))
        throw input_error("--" + name, fmt::format("found {}, expected at least 0", value));
    return value;
}
double Arguments::within(const std::string& name, double lowest, double highest) const {
    const double value = number(name);
    if (!(value >= lowest && value <= highest))
        throw input_error("--" + name, fmt::format("found {}, expected {} to {}", value, lowest, highest));
    return value;
}

std::string calc_help() {
    std::string help;
    for (const auto& c : calculations()) {
        std::vector<std::string> options;
        for (const auto& o : c.options)
            options.push_back(o.fallback   ? fmt::format("[--{} {}]", o.name, *o.fallback)
                              : o.optional ? fmt::format("[--{} ...]", o.name)
                                           : fmt::format("--{} ...", o.name));
        help += fmt::format("  {}: {}\n      {}\n      -> {}\n", c.name, c.help, fmt::join(options, " "),
                            fmt::join(c.results, ", "));
    }
    return help;
}

void run_calc(const std::vector<std::string>& words) {
    const auto line = parse(words);
    if (line.name.empty()) throw std::invalid_argument("calc: which one?\n" + calc_help());
    const auto& calculation = find(line.name);
    if (line.help) {
        std::cout << help_of(calculation);
        return;
    }
    for (const auto& [key, value] : line.values)
        if (std::none_of(calculation.options.begin(), calculation.options.end(),
                         [&](const auto& o) { return o.name == key; })) {
            std::vector<std::string> names;
            for (const auto& o : calculation.options) names.push_back("--" + o.name);
            throw std::invalid_argument(
                fmt::format("calc {}: no option --{}; there are {}", line.name, key, fmt::join(names, ", ")));
        }
    if (!line.plot.empty()) {
        if (!calculation.plot) throw std::invalid_argument(fmt::format("calc {} has no --plot", line.name));
        auto values = line.values;
        values.emplace("wavelength_um", "1");  // a plot shows all of them
        calculation.plot(complete(calculation, std::move(values), "calc " + line.name), line.plot);
        if (!line.values.contains("wavelength_um") && line.csv.empty() && line.output.empty()) return;
    }
    const bool spectrum = calculation.spectrum_um && line.csv.empty() && !line.values.contains("wavelength_um");
    const auto table = !line.csv.empty() ? compute_table(calculation, line)
                       : spectrum        ? compute_spectrum(calculation, line)
                                         : compute_one(calculation, line);
    const auto text = line.json || line.output.ends_with(".json")                      ? json_text(table)
                      : !line.csv.empty() || spectrum || line.output.ends_with(".csv") ? csv_text(table)
                                                                                       : lines_text(calculation, table);
    if (line.output.empty())
        std::cout << text;
    else
        write_text_file(line.output, text);
}

}  // namespace pyroscene::cli
