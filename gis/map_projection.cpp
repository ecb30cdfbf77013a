#include <array>
#include <cmath>

#include "gis/crs.h"
#include "gis/geodesy.h"

namespace pyroscene::gis {

struct MapProjection::Impl {
    CrsTransform to_lonlat;
};

MapProjection::MapProjection(const std::string& crs)
    : impl_(std::make_unique<Impl>(CrsTransform(parse_map_crs(crs, "map CRS").wkt, kGeographicCrs))) {}
MapProjection::MapProjection(MapProjection&&) noexcept = default;
MapProjection::~MapProjection() = default;

Geodetic MapProjection::to_geodetic(double x_m, double y_m, double h_m) const {
    impl_->to_lonlat.forward({&x_m, 1}, {&y_m, 1});
    return {.lat_deg = y_m, .lon_deg = x_m, .h_m = h_m};
}

std::array<double, 2> MapProjection::to_map(double lat_deg, double lon_deg) const {
    impl_->to_lonlat.inverse({&lon_deg, 1}, {&lat_deg, 1});
    return {lon_deg, lat_deg};
}

void MapProjection::to_map(std::span<double> lon_to_x, std::span<double> lat_to_y) const {
    impl_->to_lonlat.inverse(lon_to_x, lat_to_y);
}

void MapProjection::to_geographic(std::span<double> x_to_lon, std::span<double> y_to_lat) const {
    impl_->to_lonlat.forward(x_to_lon, y_to_lat);
}

double MapProjection::convergence_rad(double x_m, double y_m) const {
    // 30 m: the second-order error (30 m / 6.4e6 m)^2 and the rounding 1e-9 m / 60 m are both below 1e-10 rad.
    return y_axis_azimuth_rad(impl_->to_lonlat, x_m, y_m, 30.0);
}

}  // namespace pyroscene::gis
