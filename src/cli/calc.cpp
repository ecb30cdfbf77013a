#include "cli/calc.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace pyroscene::cli {
namespace {

struct CommandLine {
    std::string name, csv, output, plot;
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

std::string compute_table(const Calculation& calculation, const CommandLine& line) {
    const auto table = read_csv(line.csv);
    std::ostringstream out;
    out << fmt::format("{},{}\n", fmt::join(table.columns, ","), fmt::join(calculation.results, ","));
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        auto values = line.values;  // options on the command line hold for rows that do not say otherwise
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            if (!table.rows[r][c].empty()) values[table.columns[c]] = table.rows[r][c];
        const auto where = fmt::format("{}:{}", table.path, table.row_lines[r]);
        std::vector<std::string> results;
        for (const double v : calculation.compute(complete(calculation, values, where))) results.push_back(number_text(v));
        out << fmt::format("{},{}\n", fmt::join(table.rows[r], ","), fmt::join(results, ","));
    }
    return out.str();
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
        if (!line.values.contains("wavelength_um") && line.csv.empty()) return;
    }
    std::string text;
    if (!line.csv.empty()) {
        text = compute_table(calculation, line);
    } else {
        const auto results = calculation.compute(complete(calculation, line.values, "calc " + line.name));
        for (std::size_t i = 0; i < results.size(); ++i)
            text += fmt::format("{} = {}\n", calculation.results[i], number_text(results[i]));
    }
    if (line.output.empty())
        std::cout << text;
    else
        write_text_file(line.output, text);
}

}  // namespace pyroscene::cli
