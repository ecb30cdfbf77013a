#include "radiometry/sun.h"

#include <cmath>
#include <span>

#include "base/constants.h"

namespace pyroscene::radiometry {
namespace {

/// One term A cos(B + C t) of a VSOP87 series; A in 1e-8 rad or 1e-8 AU, t in Julian millennia from J2000.
struct PeriodicTerm {
    double amplitude, phase, frequency;
};

// Leading terms of the tables in Reda & Andreas (2004); dropped: below 5e-6 rad (1 arc second) in longitude, 5e-6 AU in
// distance.
constexpr PeriodicTerm kLongitude0[] = {{175347046.0, 0.0, 0.0},       {3341656.0, 4.6692568, 6283.07585},
                                        {34894.0, 4.6261, 12566.1517}, {3497.0, 2.7441, 5753.3849},
                                        {3418.0, 2.8289, 3.5231},      {3136.0, 3.6277, 77713.7715},
                                        {2676.0, 4.4181, 7860.4194},   {2343.0, 6.1352, 3930.2097},
                                        {1324.0, 0.7425, 11506.7698},  {1273.0, 2.0371, 529.691},
                                        {1199.0, 1.1096, 1577.3435},   {990.0, 5.233, 5884.927},
                                        {902.0, 2.045, 26.298},        {857.0, 3.508, 398.149},
                                        {780.0, 1.179, 5223.694},      {753.0, 2.533, 5507.553},
                                        {505.0, 4.583, 18849.228}};
constexpr PeriodicTerm kLongitude1[] = {
    {628331966747.0, 0.0, 0.0}, {206059.0, 2.678235, 6283.07585}, {4303.0, 2.6351, 12566.1517}, {425.0, 1.59, 3.523}};
constexpr PeriodicTerm kLongitude2[] = {{52919.0, 0.0, 0.0}, {8720.0, 1.0721, 6283.0758}, {309.0, 0.867, 12566.152}};
constexpr PeriodicTerm kDistance0[] = {{100013989.0, 0.0, 0.0},        {1670700.0, 3.0984635, 6283.07585},
                                       {13956.0, 3.05525, 12566.1517}, {3084.0, 5.1985, 77713.7715},
                                       {1628.0, 1.1739, 5753.3849},    {1576.0, 2.8469, 7860.4194},
                                       {925.0, 5.453, 11506.77},       {542.0, 4.564, 3930.21}};
constexpr PeriodicTerm kDistance1[] = {{103019.0, 1.10749, 6283.07585}, {1721.0, 1.0644, 12566.1517}};

double sum(std::span<const PeriodicTerm> terms, double t) noexcept {
    double total = 0.0;
    for (const auto& term : terms) total += term.amplitude * std::cos(term.phase + term.frequency * t);
    return total * 1e-8;
}

/// TT - UT [s]: parabola of Espenak & Meeus (2006) for 2005 to 2050. Off by up to 40 s in 1950 and 2100; the sun moves 1e-5
/// deg/s.
double delta_t_s(double julian_century) noexcept {
    const double years = julian_century * 100.0;
    return 62.92 + 0.32217 * years + 0.005589 * years * years;
}

struct Apparent {
    double right_ascension_rad, declination_rad, distance_AU, nutation_in_ascension_rad;
};

Apparent apparent_sun(double terrestrial_century) noexcept {
    const double T = terrestrial_century, t = T / 10.0;
    const double earth_longitude = sum(kLongitude0, t) + t * (sum(kLongitude1, t) + t * sum(kLongitude2, t));
    const double distance = sum(kDistance0, t) + t * sum(kDistance1, t);

    // Nutation, the four largest terms (Meeus ch. 22): node of the moon's orbit, mean longitudes of sun and moon.
    constexpr double kArcSecond = kDegree_rad / 3600.0;
    const double node = (125.04452 - 1934.136261 * T) * kDegree_rad, sun2 = 2.0 * (280.4665 + 36000.7698 * T) * kDegree_rad,
                 moon2 = 2.0 * (218.3165 + 481267.8813 * T) * kDegree_rad;
    const double in_longitude =
        (-17.20 * std::sin(node) - 1.32 * std::sin(sun2) - 0.23 * std::sin(moon2) + 0.21 * std::sin(2.0 * node)) *
        kArcSecond;
    const double in_obliquity =
        (9.20 * std::cos(node) + 0.57 * std::cos(sun2) + 0.10 * std::cos(moon2) - 0.09 * std::cos(2.0 * node)) * kArcSecond;
    const double obliquity = (84381.448 - 46.8150 * T - 0.00059 * T * T) * kArcSecond + in_obliquity;

    const double aberration = -20.4898 * kArcSecond / distance;
    const double longitude = earth_longitude + kPi + in_longitude + aberration;
    // The ecliptic latitude of the sun stays below 1.2 arc seconds and is left out.
    return {std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
            std::asin(std::sin(obliquity) * std::sin(longitude)), distance, in_longitude * std::cos(obliquity)};
}

}  // namespace

SunPosition sun_position(double unix_time_s, double lat_deg, double lon_deg) noexcept {
    const double days = unix_time_s / 86400.0 + 2440587.5 - 2451545.0;  // universal time from J2000
    const double century = days / 36525.0;
    const auto sun = apparent_sun(century + delta_t_s(century) / (86400.0 * 36525.0));

    const double sidereal_deg =
        280.46061837 + 360.98564736629 * days + century * century * (0.000387933 - century / 38710000.0);
    const double hour_angle =
        std::fmod(sidereal_deg + lon_deg, 360.0) * kDegree_rad + sun.nutation_in_ascension_rad - sun.right_ascension_rad;
    const double lat = lat_deg * kDegree_rad, d = sun.declination_rad;
    const double north = std::cos(lat) * std::sin(d) - std::sin(lat) * std::cos(d) * std::cos(hour_angle);
    const double east = -std::cos(d) * std::sin(hour_angle);
    const double up = std::sin(lat) * std::sin(d) + std::cos(lat) * std::cos(d) * std::cos(hour_angle);

    SunPosition out;
    const double parallax = 8.794 * kDegree_rad / 3600.0 / sun.distance_AU;
    const double geocentric_zenith = std::atan2(std::hypot(north, east), up);
    out.zenith_rad = geocentric_zenith + parallax * std::sin(geocentric_zenith);
    out.azimuth_rad = std::atan2(east, north);
    if (out.azimuth_rad < 0.0) out.azimuth_rad += 2.0 * kPi;
    out.distance_AU = sun.distance_AU;
    return out;
}

}  // namespace pyroscene::radiometry
