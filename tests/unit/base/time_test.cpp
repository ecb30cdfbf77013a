#include <gtest/gtest.h>

#include "base/time.h"

namespace pyroscene {

// Expected seconds: GNU date, `date -u -d <text> +%s`.
TEST(UtcTime, ParsesToUnixSeconds) {
    EXPECT_EQ(parse_utc("1970-01-01T00:00:00Z").value().unix_s, 0.0);
    EXPECT_EQ(parse_utc("2017-07-15T22:00:00Z").value().unix_s, 1500156000.0);
    EXPECT_EQ(parse_utc("2000-02-29T12:34:56Z").value().unix_s, 951827696.0);
    EXPECT_EQ(parse_utc("1969-12-31T23:59Z").value().unix_s, -60.0);
    EXPECT_EQ(parse_utc("2038-01-19T03:14:08Z").value().unix_s, 2147483648.0);
    EXPECT_DOUBLE_EQ(parse_utc("1970-01-01T00:00:01.25Z").value().unix_s, 1.25);
}

TEST(UtcTime, RefusesWhatIsNoUtcTime) {
    for (const char* text : {"",
                             "yesterday",
                             "2017-07-15",
                             "2017-07-15T22:00:00",
                             "2017-07-15 22:00:00Z",
                             "2017-07-15T22:00:00+02:00",
                             "2017-07-15T24:00:00Z",
                             "2017-07-15T22:60:00Z",
                             "2017-07-15T22:00:60Z",
                             "2017-13-01T00:00:00Z",
                             "2017-02-29T00:00:00Z",
                             "2017-00-10T00:00:00Z",
                             "17-07-15T22:00:00Z",
                             "2017-7-15T22:00:00Z",
                             "2017-07-15T22:00:00.Z",
                             "2017-07-15T22:00:0Z",
                             "2017-07-15T22:00:1.5Z",
                             "2017-07-15T22Z",
                             "2017-07-15T22:00:00ZZ",
                             "2017-07-15T22:00:00.5e1Z",
                             "2017-07-15T22:00:-1Z",
                             "-017-07-15T22:00:00Z"}) {
        SCOPED_TRACE(text);
        EXPECT_FALSE(parse_utc(text).has_value());
    }
}

TEST(UtcTime, WritesIso8601) {
    EXPECT_EQ(UtcTime{0.0}.iso8601(), "1970-01-01T00:00:00Z");
    EXPECT_EQ(UtcTime{1500156000.0}.iso8601(), "2017-07-15T22:00:00Z");
    EXPECT_EQ(UtcTime{1500156000.25}.iso8601(), "2017-07-15T22:00:00.250Z");
    EXPECT_EQ(UtcTime{-60.0}.iso8601(), "1969-12-31T23:59:00Z");
    EXPECT_EQ(UtcTime{951827695.9996}.iso8601(), "2000-02-29T12:34:56Z");  // rounds to milliseconds
}

TEST(UtcTime, SurvivesThereAndBack) {
    for (const char* text :
         {"1901-01-01T00:00:00Z", "2000-12-31T23:59:59Z", "2024-02-29T06:07:08Z", "2099-06-30T12:00:00.125Z"})
        EXPECT_EQ(parse_utc(text).value().iso8601(), text);
}

}  // namespace pyroscene
