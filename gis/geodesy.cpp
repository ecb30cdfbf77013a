#include "gis/geodesy.h"

#include <cmath>

#include <fmt/format.h>
#include <GeographicLib/Constants.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::gis {

Vec3 ecef_from_geodetic(const Geodetic& p) noexcept {
    Vec3 ecef;
    GeographicLib::Geocentric::WGS84().Forward(p.lat_deg, p.lon_deg, p.h_m, ecef.x, ecef.y, ecef.z);
    return ecef;
}

Geodetic geodetic_from_ecef(Vec3 ecef_m) noexcept {
    Geodetic p;
    GeographicLib::Geocentric::WGS84().Reverse(ecef_m.x, ecef_m.y, ecef_m.z, p.lat_deg, p.lon_deg, p.h_m);
    return p;
}

LocalAxes local_axes(double lat_deg, double lon_deg) noexcept {
    const double sin_lat = std::sin(lat_deg * kDegree_rad), cos_lat = std::cos(lat_deg * kDegree_rad);
    const double sin_lon = std::sin(lon_deg * kDegree_rad), cos_lon = std::cos(lon_deg * kDegree_rad);
    return {.east = {-sin_lon, cos_lon, 0.0},
            .north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
            .up = {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}};
}

Geodetic move_along_geodesic(const Geodetic& from, double azimuth_deg, double distance_m) noexcept {
    Geodetic to{.lat_deg = 0.0, .lon_deg = 0.0, .h_m = from.h_m};
    GeographicLib::Geodesic::WGS84().Direct(from.lat_deg, from.lon_deg, azimuth_deg, distance_m, to.lat_deg, to.lon_deg);
    return to;
}

GeodesicStep step_along_geodesic(const Geodetic& from, double azimuth_deg, double distance_m) noexcept {
    GeodesicStep to{.point = {.lat_deg = 0.0, .lon_deg = 0.0, .h_m = from.h_m}};
    GeographicLib::Geodesic::WGS84().Direct(from.lat_deg, from.lon_deg, azimuth_deg, distance_m, to.point.lat_deg,
                                            to.point.lon_deg, to.azimuth_deg);
    return to;
}

std::string utm_or_ups_crs(double lat_deg, double lon_deg) {
    if (!(std::abs(lat_deg) <= 90.0) || !std::isfinite(lon_deg))
        throw input_error("position", fmt::format("latitude {} and longitude {} are not on the Earth", lat_deg, lon_deg));
    const int zone = GeographicLib::UTMUPS::StandardZone(lat_deg, lon_deg);
    return fmt::format("EPSG:{}", GeographicLib::UTMUPS::EncodeEPSG(zone, lat_deg >= 0.0));
}

}  // namespace pyroscene::gis
