#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/yaml.h"

/// How the text of one value becomes a number: strict, independent of the locale, the whole text or nothing.
namespace pyroscene::config {

/// Decimal number with optional sign, fraction and exponent ("1e3"), or .inf / -.inf / .nan as YAML writes them.
std::optional<double> parse_double(std::string_view text) noexcept;
/// Decimal integer with optional sign; "3.0" and "1e3" are none.
std::optional<long long> parse_integer(std::string_view text) noexcept;
/// true or false (also True, TRUE, ...); yes/no/on/off are none, as in YAML 1.2.
std::optional<bool> parse_bool(std::string_view text) noexcept;

/// NaN never is in a range; an infinity only where the bound itself is infinite.
bool in_range(double value, const Range& range) noexcept;
/// "must be > 0", "must be between 1 and 300", ...
std::string range_text(const Range& range);
/// What to tell about a text that is no number: points at units written into the value.
std::string not_a_number_text(std::string_view text, std::string_view expected);

}  // namespace pyroscene::config
