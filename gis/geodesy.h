#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "base/vec3.h"

namespace pyroscene::gis {

/// Position on or above WGS 84; height above the ellipsoid.
struct Geodetic {
    double lat_deg = 0.0, lon_deg = 0.0, h_m = 0.0;
};

Vec3 ecef_from_geodetic(const Geodetic& p) noexcept;
Geodetic geodetic_from_ecef(Vec3 ecef_m) noexcept;

/// Unit vectors of the local frame of the ellipsoid normal, in ECEF.
struct LocalAxes {
    Vec3 east, north, up;
};
LocalAxes local_axes(double lat_deg, double lon_deg) noexcept;

/// Point reached from `from` on a geodesic of WGS 84 (GeographicLib), same height.
Geodetic move_along_geodesic(const Geodetic& from, double azimuth_deg, double distance_m) noexcept;

/// The same, with the azimuth of the geodesic at the point reached.
struct GeodesicStep {
    Geodetic point;
    double azimuth_deg = 0.0;
};
GeodesicStep step_along_geodesic(const Geodetic& from, double azimuth_deg, double distance_m) noexcept;

/// EPSG code text ("EPSG:32611") of the UTM zone, or of UPS near the poles, that contains the point (GeographicLib).
std::string utm_or_ups_crs(double lat_deg, double lon_deg);

/// Map projection to and from WGS 84 geographic coordinates (PROJ, axis order always x/lon first, datum shift included).
/// Not thread-safe: one object per thread.
class MapProjection {
public:
    /// \param crs  anything PROJ understands. Throws an input error for an unknown or not projected CRS.
    explicit MapProjection(const std::string& crs);
    MapProjection(MapProjection&&) noexcept;
    ~MapProjection();

    [[nodiscard]] Geodetic to_geodetic(double x_m, double y_m, double h_m = 0.0) const;
    /// {x, y} on the map; NaN outside the projection's domain.
    [[nodiscard]] std::array<double, 2> to_map(double lat_deg, double lon_deg) const;
    /// Many at once: lon/lat in degrees to x/y, in place.
    void to_map(std::span<double> lon_to_x, std::span<double> lat_to_y) const;
    void to_geographic(std::span<double> x_to_lon, std::span<double> y_to_lat) const;
    /// Grid convergence: azimuth of grid north, clockwise from true north [rad].
    [[nodiscard]] double convergence_rad(double x_m, double y_m) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pyroscene::gis
