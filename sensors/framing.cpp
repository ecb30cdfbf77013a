#include "sensors/framing.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::sensors {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWgs84SemiMajor_m = 6378137.0;
constexpr double kWgs84SemiMinor_m = kWgs84SemiMajor_m * (1.0 - 1.0 / 298.257223563);

/// Elementary rotations, positive counter-clockwise.
Vec3 rotate_x(double angle_rad, Vec3 v) noexcept {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}
Vec3 rotate_y(double angle_rad, Vec3 v) noexcept {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
}
Vec3 rotate_z(double angle_rad, Vec3 v) noexcept {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}
Vec3 rotate_attitude(double heading_rad, double pitch_rad, double roll_rad, Vec3 v) noexcept {
    return rotate_z(heading_rad, rotate_y(pitch_rad, rotate_x(roll_rad, v)));
}

struct ImagePoint {
    double x = 0.0, y = 0.0;  ///< on the focal plane, in focal lengths
};

/// What Brown's model adds to the ideal point: radial k1 r^2 + k2 r^4 + k3 r^6, tangential p1, p2.
struct Distortion {
    double radial = 1.0;
    ImagePoint tangential;
};
Distortion distortion_at(const CameraGroup& g, ImagePoint u) noexcept {
    const double r2 = u.x * u.x + u.y * u.y;
    return {1.0 + r2 * (g.radial[0] + r2 * (g.radial[1] + r2 * g.radial[2])),
            {2.0 * g.tangential[0] * u.x * u.y + g.tangential[1] * (r2 + 2.0 * u.x * u.x),
             g.tangential[0] * (r2 + 2.0 * u.y * u.y) + 2.0 * g.tangential[1] * u.x * u.y}};
}

ImagePoint undistorted(const Sensor& sensor, const CameraGroup& g, ImagePoint measured) {
    if (g.radial == std::array<double, 3>{} && g.tangential == std::array<double, 2>{}) return measured;
    constexpr int kMaximumSteps = 200;
    constexpr double kTolerance = 1e-14;  // in focal lengths: far below a thousandth of a pixel
    ImagePoint u = measured;
    for (int i = 0; i < kMaximumSteps; ++i) {
        const Distortion d = distortion_at(g, u);
        const ImagePoint next{(measured.x - d.tangential.x) / d.radial, (measured.y - d.tangential.y) / d.radial};
        const double change = std::abs(next.x - u.x) + std::abs(next.y - u.y);
        u = next;
        if (change < kTolerance) return u;
    }
    throw input_error(fmt::format("sensor {}, group {}", sensor.id, g.id),
                      fmt::format("the distortion cannot be inverted at ({:.4f}, {:.4f}) focal lengths from the axis; "
                                  "check distortion.k and distortion.p",
                                  measured.x, measured.y));
}

}  // namespace

EcefRay pixel_ray(const Sensor& sensor, const CameraGroup& group, const Pose& pose, double sample, double line) {
    if (!(group.focal_length_m > 0.0) || !(group.pixel_pitch_m > 0.0))
        throw input_error(fmt::format("sensor {}, group {}", sensor.id, group.id),
                          "the file gives no focal_length_mm and pixel_pitch_um, so its pixels have no lines of sight");
    // The files count pixel centres at integers, images are addressed by corners.
    const double px_per_f = group.focal_length_m / group.pixel_pitch_m;
    const ImagePoint measured{(sample - 0.5 - group.principal_point_px[0]) / px_per_f,
                              (line - 0.5 - group.principal_point_px[1]) / px_per_f};
    const ImagePoint ideal = undistorted(sensor, group, measured);
    // Camera x (right in the image) is the right wing, camera y (down in the image) points backwards, the axis down.
    const Vec3 mounted{-ideal.y, ideal.x, 1.0};
    return body_ray(sensor, pose, mounted);
}

EcefRay body_ray(const Sensor& sensor, const Pose& pose, Vec3 mounted) {
    const auto& offset = sensor.boresight_offset_rad;
    const Vec3 body = rotate_attitude(offset[2], offset[1], offset[0], mounted);
    const Vec3 ned = rotate_attitude(pose.heading_rad, pose.pitch_rad, pose.roll_rad, body);
    const gis::LocalAxes axes = gis::local_axes(pose.position.lat_deg, pose.position.lon_deg);
    const Vec3 ecef = ned.x * axes.north + ned.y * axes.east - ned.z * axes.up;
    return {gis::ecef_from_geodetic(pose.position), normalized(ecef)};
}

double distance_to_height_m(const EcefRay& ray, double h_m) {
    constexpr double kGrazing = 1e-6, kTolerance_m = 1e-7;
    constexpr int kMaximumSteps = 20;
    if (gis::geodetic_from_ecef(ray.origin_m).h_m < h_m) return kNaN;
    const double a = kWgs84SemiMajor_m + h_m, b = kWgs84SemiMinor_m + h_m;
    const Vec3 p{ray.origin_m.x / a, ray.origin_m.y / a, ray.origin_m.z / b};
    const Vec3 d{ray.direction.x / a, ray.direction.y / a, ray.direction.z / b};
    const double A = dot(d, d), B = dot(p, d), C = dot(p, p) - 1.0;
    const double discriminant = B * B - A * C;
    if (!(B < 0.0) || !(discriminant >= 0.0)) return kNaN;
    // The smaller root in the form without cancellation: C is tiny beside B for an aircraft.
    double t = C / (-B + std::sqrt(discriminant));
    // A grown ellipsoid is no surface of constant height (centimetres at 3 km): correct along the ray.
    for (int i = 0; i < kMaximumSteps; ++i) {
        const gis::Geodetic at = gis::geodetic_from_ecef(ray.origin_m + t * ray.direction);
        const double climb = dot(ray.direction, gis::local_axes(at.lat_deg, at.lon_deg).up);
        if (!(climb < -kGrazing)) return kNaN;
        const double excess_m = at.h_m - h_m;
        t -= excess_m / climb;
        if (std::abs(excess_m) < kTolerance_m) return t;
    }
    return kNaN;
}

gis::Geodetic intersect_height(const EcefRay& ray, double h_m) {
    const double t = distance_to_height_m(ray, h_m);
    if (std::isnan(t)) return {kNaN, kNaN, kNaN};
    return gis::geodetic_from_ecef(ray.origin_m + t * ray.direction);
}

LookAngles look_angles(const gis::Geodetic& ground, Vec3 sensor_ecef_m) {
    const gis::LocalAxes axes = gis::local_axes(ground.lat_deg, ground.lon_deg);
    const Vec3 view = sensor_ecef_m - gis::ecef_from_geodetic(ground);
    const double east = dot(view, axes.east), north = dot(view, axes.north), up = dot(view, axes.up);
    double azimuth = std::atan2(east, north);
    if (azimuth < 0.0) azimuth += 2.0 * kPi;
    return {std::atan2(std::hypot(east, north), up), azimuth, length(view)};
}

}  // namespace pyroscene::sensors
