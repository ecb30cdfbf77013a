#pragma once

#include <optional>
#include <string>

namespace pyroscene {

/// Seconds since the Unix epoch, UTC without leap seconds.
struct UtcTime {
    double unix_s = 0.0;
    [[nodiscard]] std::string iso8601() const;
};

/// Parses "2017-07-15T22:00:00Z" (seconds and fraction optional, only Z). nullopt when it is none.
std::optional<UtcTime> parse_utc(const std::string& text);

}  // namespace pyroscene
