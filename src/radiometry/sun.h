#pragma once

namespace pyroscene::radiometry {

/// Where the centre of the sun's disk stands, seen from a place on the ground.
struct SunPosition {
    double zenith_rad = 0.0;   ///< from the local vertical, 0..pi; above pi/2 the sun has set
    double azimuth_rad = 0.0;  ///< clockwise from true north, 0..2 pi
    double distance_AU = 1.0;  ///< sun to Earth
};

/// Geometric position of the sun (no refraction: it lifts the sun by 0.02 deg at 45 deg, 0.5 deg at the horizon).
/// Method: Earth's heliocentric longitude and distance from the leading terms of VSOP87, nutation and sidereal time after
/// Meeus, Astronomical Algorithms (1998), ch. 12, 22, 25; parallax of an observer at sea level. The terms kept and the
/// formulae agree with Reda & Andreas (2004, Solar Energy 76:577), whose full series is the reference.
/// Accuracy: 0.003 deg in 1950 to 2100 (truncated series 0.002 deg, delta T, sea-level parallax).
/// \param unix_time_s UTC seconds since 1970-01-01   \param lat_deg geodetic, north positive   \param lon_deg east positive
SunPosition sun_position(double unix_time_s, double lat_deg, double lon_deg) noexcept;

}  // namespace pyroscene::radiometry
