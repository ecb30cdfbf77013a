#include "radiometry/sun.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/constants.h"

namespace pyroscene::radiometry {
namespace {

double degrees(double angle_rad) { return angle_rad / kDegree_rad; }

/// Days from 1970-01-01 to a Gregorian date (Hinnant's civil calendar formula).
double unix_time_s(int year, int month, int day, int hour, int minute, double second) {
    const int y = month <= 2 ? year - 1 : year, era = y / 400, yoe = y - era * 400;
    const int doy = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1, doe = yoe * 365 + yoe / 4 - yoe / 100 + doy;
    return 86400.0 * (era * 146097 + doe - 719468) + 3600.0 * hour + 60.0 * minute + second;
}

TEST(Sun, RedaAndreasExample) {
    // Solar Position Algorithm, worked example: 2003-10-17 12:30:30 at UTC-7, 39.742476 N, 105.1786 W: topocentric zenith
    // 50.11162 deg, azimuth 194.34024 deg, distance 0.9965422974 AU. The zenith includes refraction; the geometric one
    // follows from the example's topocentric declination -9.316179 and hour angle 11.10629 deg.
    const auto sun = sun_position(unix_time_s(2003, 10, 17, 19, 30, 30.0), 39.742476, -105.1786);
    const double lat = 39.742476 * kDegree_rad, d = -9.316179 * kDegree_rad, h = 11.10629 * kDegree_rad;
    const double geometric = std::acos(std::sin(lat) * std::sin(d) + std::cos(lat) * std::cos(d) * std::cos(h));
    EXPECT_NEAR(degrees(sun.zenith_rad), degrees(geometric), 0.003);
    EXPECT_NEAR(degrees(sun.zenith_rad), 50.11162, 0.02);  // refraction at 40 deg elevation, 820 hPa: 0.0163 deg
    EXPECT_NEAR(degrees(sun.azimuth_rad), 194.34024, 0.003);
    EXPECT_NEAR(sun.distance_AU, 0.9965422974, 5e-6);
}

TEST(Sun, MeeusExampleFromThePole) {
    // Meeus, Astronomical Algorithms, example 25.b: 1992-10-13 0h TD, apparent declination -7.783871 deg (-7d47'02"),
    // distance 0.99760775 AU. At the pole the zenith distance is 90 deg minus the declination, plus parallax. UT = TD - 59 s.
    const auto sun = sun_position(unix_time_s(1992, 10, 13, 0, 0, 0.0) - 59.0, 90.0, 0.0);
    EXPECT_NEAR(degrees(sun.zenith_rad), 97.783871 + 0.00243, 0.002);
    EXPECT_NEAR(sun.distance_AU, 0.99760775, 1e-5);
}

TEST(Sun, EquinoxesAndSolstices) {
    // Instants of 2024 (USNO): March equinox 03:06 UTC 20 March, June solstice 20:51 UTC 20 June, December 09:21 UTC 21 December.
    const auto declination_deg = [](double t) { return 90.0 - degrees(sun_position(t, 90.0, 0.0).zenith_rad); };
    EXPECT_NEAR(declination_deg(unix_time_s(2024, 3, 20, 3, 6, 0.0)), -0.0024, 0.002);  // parallax lowers it
    EXPECT_NEAR(declination_deg(unix_time_s(2024, 6, 20, 20, 51, 0.0)), 23.4359, 0.003);
    EXPECT_NEAR(declination_deg(unix_time_s(2024, 12, 21, 9, 21, 0.0)), -23.4384, 0.004);
}

TEST(Sun, PerihelionAndAphelion) {
    // 2024 (USNO): perihelion 3 January 0.983307 AU, aphelion 5 July 1.016725 AU.
    EXPECT_NEAR(sun_position(unix_time_s(2024, 1, 3, 0, 39, 0.0), 0.0, 0.0).distance_AU, 0.983307, 1e-5);
    EXPECT_NEAR(sun_position(unix_time_s(2024, 7, 5, 5, 6, 0.0), 0.0, 0.0).distance_AU, 1.016725, 1e-5);
}

TEST(Sun, AzimuthIsClockwiseFromNorth) {
    // Mid-latitude north, June: morning sun in the east, noon in the south, evening in the west; south of the tropic noon is north.
    const double day = unix_time_s(2024, 6, 21, 0, 0, 0.0);
    EXPECT_NEAR(degrees(sun_position(day + 8 * 3600.0, 45.0, 0.0).azimuth_rad), 90.0, 15.0);
    EXPECT_NEAR(degrees(sun_position(day + 12.03 * 3600.0, 45.0, 0.0).azimuth_rad), 180.0, 2.0);
    EXPECT_NEAR(degrees(sun_position(day + 16 * 3600.0, 45.0, 0.0).azimuth_rad), 270.0, 15.0);
    const double south_noon = degrees(sun_position(day + 12.03 * 3600.0, -35.0, 0.0).azimuth_rad);
    EXPECT_LT(std::min(south_noon, 360.0 - south_noon), 2.0);
}

TEST(Sun, LongitudeIsEastPositiveAndNightIsBelowTheHorizon) {
    const double noon_at_greenwich = unix_time_s(2017, 7, 15, 12, 6, 0.0);
    EXPECT_LT(degrees(sun_position(noon_at_greenwich, 46.7, 0.0).zenith_rad), 26.0);
    EXPECT_GT(degrees(sun_position(noon_at_greenwich, 46.7, 180.0).zenith_rad), 90.0);
    // Three hours earlier the sun is highest 45 degrees further east.
    EXPECT_NEAR(degrees(sun_position(noon_at_greenwich - 3 * 3600.0, 46.7, 45.0).zenith_rad),
                degrees(sun_position(noon_at_greenwich, 46.7, 0.0).zenith_rad), 0.05);
}

}  // namespace
}  // namespace pyroscene::radiometry
