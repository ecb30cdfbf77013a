#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pyroscene::cli {

/// The values of one computation, by option name, as the user wrote them.
class Arguments {
public:
    explicit Arguments(std::map<std::string, std::string> values) : values_(std::move(values)) {}
    [[nodiscard]] bool has(const std::string& name) const;
    /// Throws an input error naming the option when it is missing or no number.
    [[nodiscard]] double number(const std::string& name) const;
    /// The same, and refuses what is not finite and above 0 (at least 0; within a range).
    [[nodiscard]] double positive(const std::string& name) const;
    [[nodiscard]] double not_negative(const std::string& name) const;
    [[nodiscard]] double within(const std::string& name, double lowest, double highest) const;
    [[nodiscard]] std::string text(const std::string& name) const;

private:
    std::map<std::string, std::string> values_;
};

struct CalcOption {
    std::string name;
    std::optional<std::string> fallback;  ///< nullopt = required unless `optional`
    bool optional = false;
};

/// One formula or table look-up of `pyroscene calc`.
struct Calculation {
    std::string name, help;
    std::string example;  ///< options that give a result, for --help
    std::vector<CalcOption> options;
    std::vector<std::string> results;
    std::function<std::vector<double>(const Arguments&)> compute;
    /// Draws the spectrum into a PNG file (--plot), over all wavelengths. Empty: has none.
    std::function<void(const Arguments&, const std::string& file)> plot = {};
    /// Wavelengths of that spectrum, at which it is printed when none is given. Empty: has none.
    std::function<std::vector<double>(const Arguments&)> spectrum_um = {};
};

/// All of them; a new one is one row (src/cli/calculations.cpp).
const std::vector<Calculation>& calculations();

/// `pyroscene calc NAME ...` with the words after `calc`; with --help among them, what the calculation takes and gives.
/// Throws an input error; std::invalid_argument for a wrong command line.
void run_calc(const std::vector<std::string>& words);

/// The list of names, options and results, for --help.
std::string calc_help();

}  // namespace pyroscene::cli
