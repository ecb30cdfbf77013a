#include <charconv>
#include <chrono>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/time.h"

namespace pyroscene {

namespace {

/// Takes `digits` decimal digits off the front; nullopt when there are others.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
    if (text.size() < digits) return std::nullopt;
    int value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
        if (text[i] < '0' || text[i] > '9') return std::nullopt;
        value = 10 * value + (text[i] - '0');
    }
    text.remove_prefix(digits);
    return value;
}

bool take(std::string_view& text, char expected) {
    if (text.empty() || text.front() != expected) return false;
    text.remove_prefix(1);
    return true;
}

/// "YYYY-MM-DD" as days since 1970-01-01 of the Gregorian calendar.
std::optional<std::chrono::sys_days> take_date(std::string_view& text) {
    const auto year = take_digits(text, 4);
    if (!year || !take(text, '-')) return std::nullopt;
    const auto month = take_digits(text, 2);
    if (!month || !take(text, '-')) return std::nullopt;
    const auto day = take_digits(text, 2);
    if (!day) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                           std::chrono::day(static_cast<unsigned>(*day))};
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date);
}

/// "HH:MM", "HH:MM:SS" or "HH:MM:SS.fff" as seconds of the day. UTC here has no leap seconds.
std::optional<double> take_time_of_day(std::string_view& text) {
    const auto hour = take_digits(text, 2);
    if (!hour || *hour > 23 || !take(text, ':')) return std::nullopt;
    const auto minute = take_digits(text, 2);
    if (!minute || *minute > 59) return std::nullopt;
    double second = 0.0;
    if (take(text, ':')) {
        if (text.size() < 2 || text[1] < '0' || text[1] > '9' || text[0] < '0' || text[0] > '5') return std::nullopt;
        const auto [end, failure] =
            std::from_chars(text.data(), text.data() + text.size(), second, std::chars_format::fixed);
        const auto length = static_cast<std::size_t>(end - text.data());
        if (failure != std::errc{} || (length != 2 && (length < 4 || text[2] != '.'))) return std::nullopt;
        text.remove_prefix(length);
    }
    return 3600.0 * *hour + 60.0 * *minute + second;
}

}  // namespace

std::optional<UtcTime> parse_utc(const std::string& text) {
    std::string_view rest = text;
    const auto date = take_date(rest);
    if (!date || !take(rest, 'T')) return std::nullopt;
    const auto seconds = take_time_of_day(rest);
    if (!seconds || rest != "Z") return std::nullopt;
    return UtcTime{86400.0 * static_cast<double>(date->time_since_epoch().count()) + *seconds};
}

std::string UtcTime::iso8601() const {
    const auto total_ms = static_cast<long long>(std::llround(unix_s * 1000.0));
    const std::chrono::sys_time<std::chrono::milliseconds> time{std::chrono::milliseconds(total_ms)};
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date{day};
    const std::chrono::hh_mm_ss clock{time - day};
    std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                                   static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                                   clock.hours().count(), clock.minutes().count(), clock.seconds().count());
    const auto fraction_ms = clock.subseconds().count();
    if (fraction_ms != 0) text += fmt::format(".{:03}", fraction_ms);
    return text + "Z";
}

}  // namespace pyroscene
