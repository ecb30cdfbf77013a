#include "gis/units.h"

#include <string>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

TEST(Units, EverySpellingOfAHeatFluxIsTheSame) {
    for (const char* text : {"W m-2", "W/m2", "W/m^2", "W m**-2", "W m^-2", "W.m-2", "W*m-2", "W·m⁻²", "W/m²", "W / m2",
                             "[W/m^2]", "watts/m2", "Watt per metre^2", "J s-1 m-2", "W m^{-2}", " W m-2 "}) {
        const auto c = unit_conversion(text, "W m-2");
        ASSERT_TRUE(c) << text;
        EXPECT_TRUE(c->is_identity()) << text;
    }
}

struct Factor {
    const char *found, *canonical;
    double scale;
};

// Factors from NIST Special Publication 811 (2008), appendix B.8, four or more digits.
TEST(Units, ConvertByThePublishedFactors) {
    const Factor factors[] = {
        {"kW/m2", "W m-2", 1e3},
        {"MW m-2", "W m-2", 1e6},
        {"Btu/ft2/s", "W m-2", 1.135653e4},
        {"cal cm-2 s-1", "W m-2", 4.184e4},
        {"ft", "m", 0.3048},
        {"feet", "m", 0.3048},
        {"US survey foot", "m", 0.30480061},
        {"km", "m", 1e3},
        {"Meters", "m", 1.0},
        {"cm", "m", 0.01},
        {"m*10", "m", 0.1},
        {"min", "s", 60.0},
        {"minutes", "s", 60.0},
        {"h", "s", 3600.0},
        {"hours", "s", 3600.0},
        {"days", "s", 86400.0},
        {"ms", "s", 1e-3},
        {"lb/ft2", "kg m-2", 4.882428},
        {"tons/acre", "kg m-2", 0.2241702},
        {"tons per acre", "kg m-2", 0.2241702},
        {"t/ha", "kg m-2", 0.1},
        {"Mg ha-1", "kg m-2", 0.1},
        {"g/m^2", "kg m-2", 1e-3},
        {"km/h", "m s-1", 1.0 / 3.6},
        {"km h-1", "m s-1", 1.0 / 3.6},
        {"mph", "m s-1", 0.44704},
        {"mi/h", "m s-1", 0.44704},
        {"kn", "m s-1", 0.5144444},
        {"knots", "m s-1", 0.5144444},
        {"ft/min", "m s-1", 5.08e-3},
        {"m min-1", "m s-1", 1.0 / 60.0},
        {"ch/h", "m s-1", 20.1168 / 3600.0},
        {"W/m", "kW m-1", 1e-3},
        {"kW/m", "kW m-1", 1.0},
        {"Btu/ft/s", "kW m-1", 1.05505585262 / 0.3048},
        {"uW/(cm2 sr nm)", "W m-2 sr-1 um-1", 10.0},
        {"mW m-2 sr-1 nm-1", "W m-2 sr-1 um-1", 1.0},
        {"W/m^2/sr/µm", "W m-2 sr-1 um-1", 1.0},
        {"W sr-1 m-2 micrometer-1", "W m-2 sr-1 um-1", 1.0},
        {"%", "1", 0.01},
        {"percent", "1", 0.01},
        {"nm", "um", 1e-3},
        {"Nanometers", "um", 1e-3},
        {"Micrometers", "um", 1.0},
    };
    for (const auto& f : factors) {
        const auto c = unit_conversion(f.found, f.canonical);
        ASSERT_TRUE(c) << f.found;
        EXPECT_NEAR(c->scale / f.scale, 1.0, 5e-7) << f.found;
        EXPECT_EQ(c->offset, 0.0) << f.found;
    }
}

TEST(Units, TemperaturesHaveTheirZero) {
    for (const char* text : {"degC", "°C", "C", "celsius", "[C]", "deg C", "degrees Celsius"}) {
        const auto c = unit_conversion(text, "K");
        ASSERT_TRUE(c) << text;
        EXPECT_NEAR(c->scale * 25.0 + c->offset, 298.15, 1e-10) << text;
    }
    const auto fahrenheit = unit_conversion("degF", "K");
    ASSERT_TRUE(fahrenheit);
    EXPECT_NEAR(fahrenheit->scale * 212.0 + fahrenheit->offset, 373.15, 1e-10);
    EXPECT_TRUE(unit_conversion("K", "K")->is_identity());
    EXPECT_EQ(unit_conversion("J kg-1 degC-1", "J kg-1 K-1")->offset, 0.0);  // differences have no zero
}

TEST(Units, OtherQuantitiesDoNotConvert) {
    EXPECT_FALSE(unit_conversion("kW/m", "W m-2"));
    EXPECT_FALSE(unit_conversion("m", "W m-2"));
    EXPECT_FALSE(unit_conversion("kg m-3", "kg m-2"));
    EXPECT_FALSE(unit_conversion("K", "1"));
    EXPECT_FALSE(unit_conversion("mW m-2 sr-1 (cm-1)-1", "W m-2 sr-1 um-1"));  // per wavenumber, not per wavelength
    EXPECT_FALSE(unit_conversion("deg K", "K"));                               // an angle times a temperature
}

TEST(Units, NonsenseIsNoUnit) {
    for (const char* text : {"foo", "W/", "/", "m^", "(m", "m)", "W m--2", "seconds since 2017-07-15", "-", "²"})
        EXPECT_FALSE(unit_conversion(text, "W m-2")) << text;
}

TEST(RequireUnit, EmptyMeansCanonical) { EXPECT_TRUE(require_unit("a.tif, band 1", " ", "W m-2").is_identity()); }

std::string message_for(const char* found, const char* wanted) {
    try {
        (void)require_unit("heat.tif, band 3", found, wanted);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    ADD_FAILURE() << found << " was accepted";
    return {};
}

TEST(RequireUnit, NamesFileBandFoundAndExpected) {
    const std::string other = message_for("kW/m", "W m-2");
    EXPECT_EQ(other.find("heat.tif, band 3: unit 'kW/m' belongs to another quantity; expected W m-2"), 0u) << other;
    EXPECT_NE(other.find("kW/m2"), std::string::npos);
    EXPECT_NE(message_for("furlong", "m").find("unit 'furlong' is not known; expected m (accepted: m, km, ft)"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
