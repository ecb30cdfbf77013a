#include "config/scalar.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace pyroscene::config {

namespace {

constexpr double kUnbounded = 1e300;

std::string_view without_plus(std::string_view text) noexcept {
    const bool plus_then_value = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
    return plus_then_value ? text.substr(1) : text;
}

/// from_chars also knows "inf", "nan" and "infinity", which YAML spells with a dot.
bool starts_like_a_number(std::string_view text) noexcept {
    if (!text.empty() && text[0] == '-') text.remove_prefix(1);
    return !text.empty() && ((text[0] >= '0' && text[0] <= '9') || text[0] == '.');
}

template <class T>
std::optional<T> parse_whole(std::string_view text) noexcept {
    T value{};
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::optional<double> parse_double(std::string_view text) noexcept {
    const std::string_view digits = without_plus(text);
    if (digits == ".inf") return std::numeric_limits<double>::infinity();
    if (digits == "-.inf") return -std::numeric_limits<double>::infinity();
    if (digits == ".nan") return std::numeric_limits<double>::quiet_NaN();
    if (!starts_like_a_number(digits)) return std::nullopt;
    return parse_whole<double>(digits);
}

std::optional<long long> parse_integer(std::string_view text) noexcept { return parse_whole<long long>(without_plus(text)); }

std::optional<bool> parse_bool(std::string_view text) noexcept {
    if (text == "true" || text == "True" || text == "TRUE") return true;
    if (text == "false" || text == "False" || text == "FALSE") return false;
    return std::nullopt;
}

bool in_range(double value, const Range& range) noexcept {
    if (std::isnan(value)) return false;
    if (range.open_minimum && value == range.minimum) return false;
    return value >= range.minimum && value <= range.maximum;
}

std::string range_text(const Range& range) {
    const bool below = range.minimum > -kUnbounded, above = range.maximum < kUnbounded;
    const char* lower_sign = range.open_minimum ? ">" : ">=";
    if (below && above && !range.open_minimum) return fmt::format("must be between {} and {}", range.minimum, range.maximum);
    if (below && above) return fmt::format("must be > {} and <= {}", range.minimum, range.maximum);
    if (below) return fmt::format("must be {} {}", lower_sign, range.minimum);
    if (above) return fmt::format("must be <= {}", range.maximum);
    return "must be a finite number";
}

std::string not_a_number_text(std::string_view text, std::string_view expected) {
    const auto digits_end = text.find_first_not_of("+-.0123456789");
    const bool unit_follows = digits_end != std::string_view::npos && digits_end > 0 && text[digits_end] != 'e' &&
                              text[digits_end] != 'E' && text.find(':') == std::string_view::npos;
    const char* hint = unit_follows ? " (a value carries no unit; the unit is in the key)" : "";
    return fmt::format("expected {}, found '{}'{}", expected, text, hint);
}

}  // namespace pyroscene::config
