#include "gis/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::gis {
namespace {

/// Exponents of length, mass, time, temperature, solid angle, plane angle.
using Dimensions = std::array<int, 6>;

struct Unit {
    double scale = 1.0;  ///< to SI
    Dimensions dimensions{};
    double zero_K = 0.0;  ///< temperature of the scale's zero, for a unit that stands alone

    void multiply(const Unit& other, int exponent) {
        scale *= std::pow(other.scale, exponent);
        for (std::size_t i = 0; i < dimensions.size(); ++i) dimensions[i] += exponent * other.dimensions[i];
    }
};

struct NamedUnit {
    std::string_view name;
    Unit unit;
};

constexpr Dimensions kNone{}, kLength{1}, kArea{2}, kMass{0, 1}, kTime{0, 0, 1}, kTemperature{0, 0, 0, 1},
    kSolidAngle{0, 0, 0, 0, 1}, kAngle{0, 0, 0, 0, 0, 1}, kSpeed{1, 0, -1}, kForce{1, 1, -2}, kPressure{-1, 1, -2},
    kEnergy{2, 1, -2}, kPower{2, 1, -3};

/// Symbols that take an SI prefix.
constexpr NamedUnit kPrefixable[] = {
    {"m", {1.0, kLength}},      {"g", {1e-3, kMass}},      {"s", {1.0, kTime}},      {"K", {1.0, kTemperature}},
    {"sr", {1.0, kSolidAngle}}, {"N", {1.0, kForce}},      {"Pa", {1.0, kPressure}}, {"J", {1.0, kEnergy}},
    {"W", {1.0, kPower}},       {"cal", {4.184, kEnergy}}, {"rad", {1.0, kAngle}},   {"metre", {1.0, kLength}},
    {"meter", {1.0, kLength}},  {"gram", {1e-3, kMass}},   {"watt", {1.0, kPower}},  {"joule", {1.0, kEnergy}},
    {"second", {1.0, kTime}},
};

constexpr std::pair<std::string_view, double> kPrefixes[] = {
    {"k", 1e3},    {"M", 1e6},      {"G", 1e9},      {"h", 1e2},      {"d", 1e-1},
    {"c", 1e-2},   {"m", 1e-3},     {"u", 1e-6},     {"n", 1e-9},     {"kilo", 1e3},
    {"mega", 1e6}, {"centi", 1e-2}, {"milli", 1e-3}, {"micro", 1e-6}, {"nano", 1e-9},
};

/// Symbols and words that stand for themselves. Customary units: NIST Special Publication 811 (2008), appendix B; ton is the
/// short ton and Btu the International Table one, as in the fire-behaviour tables.
constexpr NamedUnit kFixed[] = {
    {"ft", {0.3048, kLength}},
    {"foot", {0.3048, kLength}},
    {"feet", {0.3048, kLength}},
    {"us-ft", {1200.0 / 3937.0, kLength}},
    {"ftUS", {1200.0 / 3937.0, kLength}},
    {"US survey foot", {1200.0 / 3937.0, kLength}},
    {"in", {0.0254, kLength}},
    {"inch", {0.0254, kLength}},
    {"yd", {0.9144, kLength}},
    {"mi", {1609.344, kLength}},
    {"mile", {1609.344, kLength}},
    {"ch", {20.1168, kLength}},
    {"chain", {20.1168, kLength}},
    {"micron", {1e-6, kLength}},
    {"acre", {4046.8564224, kArea}},
    {"ac", {4046.8564224, kArea}},
    {"ha", {1e4, kArea}},
    {"hectare", {1e4, kArea}},
    {"lb", {0.45359237, kMass}},
    {"pound", {0.45359237, kMass}},
    {"ton", {907.18474, kMass}},
    {"t", {1e3, kMass}},
    {"tonne", {1e3, kMass}},
    {"min", {60.0, kTime}},
    {"minute", {60.0, kTime}},
    {"sec", {1.0, kTime}},
    {"h", {3600.0, kTime}},
    {"hr", {3600.0, kTime}},
    {"hour", {3600.0, kTime}},
    {"d", {86400.0, kTime}},
    {"day", {86400.0, kTime}},
    {"mph", {0.44704, kSpeed}},
    {"kn", {1852.0 / 3600.0, kSpeed}},
    {"kt", {1852.0 / 3600.0, kSpeed}},
    {"knot", {1852.0 / 3600.0, kSpeed}},
    {"kph", {1.0 / 3.6, kSpeed}},
    {"kmh", {1.0 / 3.6, kSpeed}},
    {"Btu", {1055.05585262, kEnergy}},
    {"BTU", {1055.05585262, kEnergy}},
    {"kelvin", {1.0, kTemperature}},
    {"degC", {1.0, kTemperature, kZeroCelsius_K}},
    {"C", {1.0, kTemperature, kZeroCelsius_K}},
    {"celsius", {1.0, kTemperature, kZeroCelsius_K}},
    {"deg C", {1.0, kTemperature, kZeroCelsius_K}},
    {"degrees C", {1.0, kTemperature, kZeroCelsius_K}},
    {"degree_Celsius", {1.0, kTemperature, kZeroCelsius_K}},
    {"degrees Celsius", {1.0, kTemperature, kZeroCelsius_K}},
    {"degF", {5.0 / 9.0, kTemperature, 459.67 * 5.0 / 9.0}},
    {"F", {5.0 / 9.0, kTemperature, 459.67 * 5.0 / 9.0}},
    {"fahrenheit", {5.0 / 9.0, kTemperature, 459.67 * 5.0 / 9.0}},
    {"steradian", {1.0, kSolidAngle}},
    {"deg", {kDegree_rad, kAngle}},
    {"degree", {kDegree_rad, kAngle}},
    {"%", {0.01, kNone}},
    {"percent", {0.01, kNone}},
    {"ppm", {1e-6, kNone}},
    {"fraction", {1.0, kNone}},
    {"dimensionless", {1.0, kNone}},
    // LANDFIRE stores integers that are the quantity times ten or a hundred.
    {"m*10", {0.1, kLength}},
    {"kg m-3*100", {0.01, {-3, 1}}},
};

const Unit* find_named(std::span<const NamedUnit> table, std::string_view name) {
    for (const auto& entry : table)
        if (entry.name == name) return &entry.unit;
    return nullptr;
}

std::optional<Unit> find_exact(std::string_view name) {
    if (const Unit* unit = find_named(kFixed, name)) return *unit;
    if (const Unit* unit = find_named(kPrefixable, name)) return *unit;
    for (const auto& [prefix, factor] : kPrefixes) {
        if (!name.starts_with(prefix)) continue;
        if (const Unit* unit = find_named(kPrefixable, name.substr(prefix.size()))) {
            Unit scaled = *unit;
            scaled.scale *= factor;
            return scaled;
        }
    }
    return std::nullopt;
}

/// Tries the name as it is, then in lower case, then without a plural s (words only: "ms" is a millisecond).
std::optional<Unit> find_unit(const std::string& name) {
    if (const auto unit = find_exact(name)) return unit;
    if (name.size() < 3) return std::nullopt;
    std::string lower = name;
    for (char& c : lower) c = (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
    if (const auto unit = find_exact(lower)) return unit;
    if (lower.ends_with('s')) return find_exact(lower.substr(0, lower.size() - 1));
    return std::nullopt;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

std::string plain_spelling(std::string_view text) {
    std::string s(text);
    constexpr std::pair<const char*, const char*> kReplacements[] = {
        {"²", "2"}, {"³", "3"},   {"¹", "1"},  {"⁴", "4"}, {"⁻", "-"}, {"·", " "}, {"⋅", " "}, {"×", " "},     {"µ", "u"},
        {"μ", "u"}, {"°", "deg"}, {"**", "^"}, {"[", "("}, {"]", ")"}, {"{", ""},  {"}", ""},  {" per ", "/"}, {"\t", " "},
    };
    for (const auto& [from, to] : kReplacements) replace_all(s, from, to);
    const auto first = s.find_first_not_of(' ');
    return first == std::string::npos ? std::string{} : s.substr(first, s.find_last_not_of(' ') - first + 1);
}

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '%' || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Recursive descent over  product := factor { [separator | '/'] factor },  factor := '(' product ')' | number | name,
/// each with an optional exponent.
class Parser {
public:
    explicit Parser(std::string_view text) : text_(text) {}

    std::optional<Unit> parse() {
        auto unit = product();
        if (!unit || at_ != text_.size()) return std::nullopt;
        if (factors_ != 1 || unit->dimensions != kTemperature) unit->zero_K = 0.0;
        return unit;
    }

private:
    std::optional<Unit> product() {
        Unit result;
        for (bool any = false;; any = true) {
            const bool inverse = skip_separators();
            if (at_ == text_.size() || text_[at_] == ')') return any && !inverse ? std::optional(result) : std::nullopt;
            const auto next = factor();
            if (!next) return std::nullopt;
            const auto power = exponent();
            if (!power) return std::nullopt;
            result.multiply(*next, inverse ? -*power : *power);
            result.zero_K = next->zero_K;
        }
    }

    bool skip_separators() {
        bool inverse = false;
        for (; at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '.' || text_[at_] == '*' || text_[at_] == '/');
             ++at_)
            inverse = inverse || text_[at_] == '/';
        return inverse;
    }

    std::optional<Unit> factor() {
        if (text_[at_] == '(') {
            ++at_;
            const auto inner = product();
            if (!inner || at_ == text_.size()) return std::nullopt;
            ++at_;
            return inner;
        }
        ++factors_;
        if (is_digit(text_[at_])) return number();
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
        return at_ == begin ? std::nullopt : find_unit(std::string(text_.substr(begin, at_ - begin)));
    }

    std::optional<Unit> number() {
        Unit unit;
        const auto [end, status] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), unit.scale);
        if (status != std::errc{} || !(unit.scale > 0.0)) return std::nullopt;
        at_ = static_cast<std::size_t>(end - text_.data());
        return unit;
    }

    std::optional<int> exponent() {
        std::size_t p = at_;
        const bool caret = p < text_.size() && text_[p] == '^';
        if (caret) ++p;
        const bool negative = p < text_.size() && text_[p] == '-';
        if (p < text_.size() && (text_[p] == '-' || text_[p] == '+')) ++p;
        if (p == text_.size() || !is_digit(text_[p])) return p == at_ ? std::optional(1) : std::nullopt;
        int value = 0;
        for (; p < text_.size() && is_digit(text_[p]); ++p) value = 10 * value + (text_[p] - '0');
        at_ = p;
        return value > 9 ? std::nullopt : std::optional(negative ? -value : value);
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int factors_ = 0;
};

std::optional<Unit> parse_unit(std::string_view text) {
    const std::string plain = plain_spelling(text);
    if (const Unit* whole = find_named(kFixed, plain)) return *whole;
    return Parser(plain).parse();
}

constexpr std::pair<std::string_view, std::string_view> kExamples[] = {
    {"m", "m, km, ft"},
    {"W m-2", "W m-2, W/m2, W/m^2, kW/m2, MW/m2, Btu/ft2/s"},
    {"kg m-2", "kg m-2, kg/m2, g/m2, t/ha, lb/ft2, tons/acre"},
    {"m s-1", "m s-1, m/s, km/h, mph, kn, ft/min"},
    {"s", "s, min, h, days"},
    {"K", "K, degC, degF"},
    {"1", "1, %, fraction"},
    {"kW m-1", "kW m-1, kW/m, W/m, Btu/ft/s"},
    {"W m-2 sr-1 um-1", "W m-2 sr-1 um-1, W/m2/sr/um, mW/m2/sr/nm, uW/(cm2 sr nm)"},
};

std::string_view examples_for(std::string_view wanted) {
    for (const auto& [unit, list] : kExamples)
        if (unit == wanted) return list;
    return wanted;
}

}  // namespace

std::optional<UnitConversion> unit_conversion(std::string_view found, std::string_view wanted) {
    const auto from = parse_unit(found), to = parse_unit(wanted);
    if (!from || !to || from->dimensions != to->dimensions) return std::nullopt;
    UnitConversion conversion{.scale = from->scale / to->scale, .offset = (from->zero_K - to->zero_K) / to->scale};
    if (std::abs(conversion.scale - 1.0) < 1e-12) conversion.scale = 1.0;  // the same unit spelt in another order
    return conversion;
}

UnitConversion require_unit(const std::string& subject, std::string_view found, const std::string& wanted) {
    if (plain_spelling(found).empty()) return {};
    if (const auto conversion = unit_conversion(found, wanted)) return *conversion;
    const bool known = parse_unit(found).has_value();
    throw input_error(subject,
                      fmt::format("unit '{}' {}; expected {} (accepted: {})", found,
                                  known ? "belongs to another quantity" : "is not known", wanted, examples_for(wanted)));
}

}  // namespace pyroscene::gis
