#pragma once

#include <memory>
#include <span>
#include <string>

/// Coordinate reference systems as text and the transformation between two of them.
namespace pyroscene::gis {

/// What the program has to know of a CRS. Vertical parts of compound systems are dropped.
struct CrsInfo {
    std::string wkt;   ///< WKT2:2019
    std::string name;  ///< as its authority calls it
    bool geographic = false, projected = false;
    double metres_per_unit = 1.0;  ///< of the axes of a projected CRS

    [[nodiscard]] bool projected_in_metres() const noexcept;
};

/// Understands "EPSG:32611", WKT of any kind, PROJJSON and PROJ strings; never files or URLs.
/// Throws an input error with `subject` for anything else.
CrsInfo parse_crs(const std::string& text, const std::string& subject);

/// As parse_crs; throws also when the CRS is not projected or its unit is not the metre (found, expected).
CrsInfo parse_map_crs(const std::string& text, const std::string& subject);

/// Same system, whatever its spelling.
bool same_crs(const std::string& wkt_a, const std::string& wkt_b);

/// WGS 84 longitude, latitude.
inline constexpr const char* kGeographicCrs = "EPSG:4326";

/// Transformation between two CRS, x (longitude) always first, in the units of the systems (degrees for geographic ones).
/// Positions without an image become NaN. Not thread-safe: one object per thread.
class CrsTransform {
public:
    /// Throws an input error when PROJ knows no way from one to the other.
    CrsTransform(const std::string& source, const std::string& target);
    CrsTransform(CrsTransform&&) noexcept;
    ~CrsTransform();

    /// In place. Both spans have the same length.
    void forward(std::span<double> x, std::span<double> y) const;
    void inverse(std::span<double> x, std::span<double> y) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Azimuth of the positive y axis of a system at a place given in it, clockwise from true north [rad]; central difference of
/// positions `half_step` units apart on the ellipsoid. `to_lonlat` goes from that system to WGS 84.
double y_axis_azimuth_rad(const CrsTransform& to_lonlat, double x, double y, double half_step);

}  // namespace pyroscene::gis
