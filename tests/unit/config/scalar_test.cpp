#include "config/scalar.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace pyroscene::config {

TEST(ParseDouble, TakesTheWholeTextOrNothing) {
    EXPECT_EQ(parse_double("3"), 3.0);
    EXPECT_EQ(parse_double("-0.25"), -0.25);
    EXPECT_EQ(parse_double("+7.5"), 7.5);
    EXPECT_EQ(parse_double("1e3"), 1000.0);
    EXPECT_EQ(parse_double("2e-7"), 2e-7);
    EXPECT_EQ(parse_double("5.0E+5"), 5.0e5);
    EXPECT_EQ(parse_double(".5"), 0.5);
    for (const char* text :
         {"", "3 m", "m", "1,5", "0x10", "1e", "--3", "+-3", "3.0.0", "inf", "nan", "infinity", "-inf", "1e999"}) {
        SCOPED_TRACE(text);
        EXPECT_FALSE(parse_double(text).has_value());
    }
}

TEST(ParseDouble, KnowsTheYamlSpellingOfInfinity) {
    EXPECT_EQ(parse_double(".inf"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(parse_double("-.inf"), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(parse_double(".nan").value()));
}

TEST(ParseInteger, RefusesFractionsAndExponents) {
    EXPECT_EQ(parse_integer("42"), 42);
    EXPECT_EQ(parse_integer("-3"), -3);
    for (const char* text : {"3.0", "1e3", "", "3 ", "99999999999999999999"}) {
        SCOPED_TRACE(text);
        EXPECT_FALSE(parse_integer(text).has_value());
    }
}

TEST(ParseBool, FollowsYaml12) {
    EXPECT_EQ(parse_bool("true"), true);
    EXPECT_EQ(parse_bool("FALSE"), false);
    for (const char* text : {"yes", "no", "on", "off", "1", "0", ""}) EXPECT_FALSE(parse_bool(text).has_value()) << text;
}

TEST(InRange, BoundsAreInclusiveUnlessOpen) {
    EXPECT_TRUE(in_range(1.0, Range::between(1.0, 2.0)));
    EXPECT_TRUE(in_range(2.0, Range::between(1.0, 2.0)));
    EXPECT_FALSE(in_range(2.0000001, Range::between(1.0, 2.0)));
    EXPECT_FALSE(in_range(0.0, Range::positive()));
    EXPECT_TRUE(in_range(1e-300, Range::positive()));
    EXPECT_TRUE(in_range(0.0, Range::not_negative()));
}

TEST(InRange, TakesInfinityOnlyWhereTheBoundIsInfinite) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(in_range(infinity, Range::any()));
    EXPECT_FALSE(in_range(infinity, Range::positive()));
    EXPECT_TRUE(in_range(infinity, Range{0.0, infinity, true}));
    EXPECT_FALSE(in_range(std::nan(""), Range{-infinity, infinity, false}));
}

TEST(RangeText, SaysWhatIsAllowed) {
    EXPECT_EQ(range_text(Range::positive()), "must be > 0");
    EXPECT_EQ(range_text(Range::not_negative()), "must be >= 0");
    EXPECT_EQ(range_text(Range::between(1.0, 300.0)), "must be between 1 and 300");
    EXPECT_EQ(range_text(Range{0.0, 1.0, true}), "must be > 0 and <= 1");
    EXPECT_EQ(range_text(Range{-1e300, 5.0, false}), "must be <= 5");
    EXPECT_EQ(range_text(Range::any()), "must be a finite number");
}

TEST(Nearest, FindsTheSmallestEditDistance) {
    const std::vector<std::string> keys{"terrain", "heat_flux", "fuel_load", "wind", "id"};
    EXPECT_EQ(nearest("terain", keys), "terrain");       // one letter left out
    EXPECT_EQ(nearest("heat_fulx", keys), "heat_flux");  // two neighbours swapped
    EXPECT_EQ(nearest("Fuel_Load", keys), "fuel_load");  // case is no difference
    EXPECT_EQ(nearest("winds", keys), "wind");
}

TEST(Nearest, IsEmptyWhenNothingIsNear) {
    const std::vector<std::string> keys{"terrain", "heat_flux", "id"};
    EXPECT_EQ(nearest("atmosphere", keys), "");
    EXPECT_EQ(nearest("xy", keys), "");  // replacing every letter is no likeness
    EXPECT_EQ(nearest("terrain", {}), "");
}

TEST(Nearest, AllowsAThirdOfTheLength) {
    EXPECT_EQ(nearest("abcdefghXYZl", {"abcdefghijkl"}), "abcdefghijkl");  // 3 of 12
    EXPECT_EQ(nearest("abcdefgVWXYZ", {"abcdefghijkl"}), "");              // 5 of 12
}

}  // namespace pyroscene::config
