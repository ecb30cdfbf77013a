#include "sensors/scan.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::sensors {
namespace {

/// Sphere of the footprint formulas (docs/scan-geometry.md).
constexpr double kEarthRadius_m = 6378137.0;

/// Pixels of a line on one side of its middle.
int pixels_per_side(const ScanLaw& law) noexcept {
    int pixels = 0;
    for (const auto& zone : law.zones) pixels += zone.pixels;
    return pixels;
}

/// Zone of a pixel, counted from the middle outwards.
const ScanLaw::Zone& zone_of(const ScanLaw& law, int sample) noexcept {
    const int half = pixels_per_side(law);
    int from_middle = sample >= half ? sample - half : half - 1 - sample;
    for (const auto& zone : law.zones) {
        if (from_middle < zone.pixels) return zone;
        from_middle -= zone.pixels;
    }
    return law.zones.back();
}

/// Look-angle of a point this far from the nadir point on a sphere, seen from above it.
double look_angle_rad(double ground_distance_m, double height_m) noexcept {
    const double earth_angle = ground_distance_m / kEarthRadius_m;
    return std::atan2(std::sin(earth_angle), 1.0 + height_m / kEarthRadius_m - std::cos(earth_angle));
}

/// Angle from the middle of the scan, as it grows with the position, before the direction of the scan.
double angle_from_middle_rad(const ScanLaw& law, double u) noexcept {
    const double from_middle = u - 0.5 * law.positions;
    if (law.ground_spacing_m > 0.0) return look_angle_rad(from_middle * law.ground_spacing_m, law.orbit_height_m);
    return from_middle * law.step_across_rad;
}

/// Time from the middle of the sweep.
double time_from_middle_s(const ScanLaw& law, double u) noexcept {
    if (law.amplitude_rad > 0.0) {
        // One sweep is half a swing; beyond the turning point a position has no time of its own.
        const double angle = std::clamp(angle_from_middle_rad(law, u) / law.amplitude_rad, -1.0, 1.0);
        return std::asin(angle) * law.period_s / kPi;
    }
    return law.scan_rate_rad_s > 0.0 ? angle_from_middle_rad(law, u) / law.scan_rate_rad_s : 0.0;
}

Vec3 cone_direction(const ScanLaw& law, double u, double v) noexcept {
    // To the right in the image: rotation angles grow through 0 (ahead) and fall through 180 deg (nadir).
    const bool ahead = std::cos(law.cone_centre_rad) > 0.0;
    const double side = (ahead ? 1.0 : -1.0) * (law.right_to_left ? -1.0 : 1.0);
    const double phi = law.cone_centre_rad + side * (u - 0.5 * law.positions) * law.step_across_rad;
    // Later lines look farther ahead: on a wider cone in front of the axis, on a narrower one behind it.
    const double outwards = (v - 0.5 * law.lines_per_scan) * law.step_along_rad * (law.leading_detector_first ? -1.0 : 1.0);
    const double a = law.cone_half_angle_rad + (ahead ? outwards : -outwards), b = law.cone_tilt_rad;
    const Vec3 axis{std::sin(a) * std::cos(phi), std::sin(a) * std::sin(phi), std::cos(a)};
    return {axis.x * std::cos(b) + axis.z * std::sin(b), axis.y, -axis.x * std::sin(b) + axis.z * std::cos(b)};
}

/// Directions from a geostationary place, body x = north, y = east, z = centre of the Earth. North is up in the image.
Vec3 disk_direction(const ScanLaw& law, double u, double v) noexcept {
    const double x = (u - 0.5 * law.positions) * law.step_across_rad;
    const double y = (0.5 * law.lines_per_scan - v) * law.step_along_rad;
    return law.sweep_x ? Vec3{std::cos(x) * std::sin(y), std::sin(x), std::cos(x) * std::cos(y)}
                       : Vec3{std::sin(y), std::cos(y) * std::sin(x), std::cos(y) * std::cos(x)};
}

}  // namespace

int ScanLaw::samples() const noexcept { return zones.empty() ? positions : 2 * pixels_per_side(*this); }

double scan_position(const ScanLaw& law, double sample) noexcept {
    if (law.zones.empty()) return sample;
    double from_middle = sample - pixels_per_side(law), position = 0.0;
    const double side = from_middle < 0.0 ? -1.0 : 1.0;
    from_middle *= side;
    for (std::size_t i = 0; i < law.zones.size(); ++i) {
        const auto& zone = law.zones[i];
        const double inside = i + 1 < law.zones.size() ? std::min<double>(from_middle, zone.pixels) : from_middle;
        position += inside * zone.width;
        from_middle -= inside;
    }
    return 0.5 * law.positions + side * position;
}

double scan_pixel_width(const ScanLaw& law, int sample) noexcept {
    return law.zones.empty() ? 1.0 : zone_of(law, sample).width;
}

bool scan_deletes(const ScanLaw& law, int sample, int line_of_scan) noexcept {
    if (law.zones.empty()) return false;
    const int rows = zone_of(law, sample).deleted_rows;
    return line_of_scan < rows || line_of_scan >= law.lines_per_scan - rows;
}

double scan_angle_rad(const ScanLaw& law, double u) noexcept {
    const double angle = angle_from_middle_rad(law, u);
    return law.right_to_left ? -angle : angle;
}

Vec3 mirror_direction(double sigma_rad, double tau_rad) noexcept {
    return {std::sin(tau_rad), std::cos(tau_rad) * std::sin(sigma_rad), std::cos(tau_rad) * std::cos(sigma_rad)};
}

Vec3 scan_direction(const ScanLaw& law, double u, double v) noexcept {
    const double tau = (v - 0.5 * law.lines_per_scan) * law.step_along_rad * (law.leading_detector_first ? -1.0 : 1.0);
    switch (law.kind) {
        case ScanLaw::Kind::Frame:
            break;
        case ScanLaw::Kind::Pushbroom: {
            const double side = law.right_to_left ? -1.0 : 1.0;
            return normalized({tau, side * (u - 0.5 - law.centre_position) * law.pitch_over_focal, 1.0});
        }
        case ScanLaw::Kind::LineArray:
            return mirror_direction(scan_angle_rad(law, u), tau);
        case ScanLaw::Kind::Mirror: {
            const double sigma = scan_angle_rad(law, u);
            if (!law.image_rotates) return mirror_direction(sigma, tau);
            return mirror_direction(sigma - tau * std::sin(sigma), tau * std::cos(sigma));
        }
        case ScanLaw::Kind::Cone:
            return cone_direction(law, u, v);
        case ScanLaw::Kind::Disk:
            return disk_direction(law, u, v);
    }
    return {0.0, 0.0, 1.0};
}

double scan_time_s(const ScanLaw& law, double n, double u, double v) noexcept {
    switch (law.kind) {
        case ScanLaw::Kind::Frame:
            return 0.0;
        case ScanLaw::Kind::Pushbroom:
        case ScanLaw::Kind::LineArray:
            return n * law.period_s;
        case ScanLaw::Kind::Disk:  // period_s is that of one line
            return (v - 0.5 * law.lines_per_scan) * law.period_s + time_from_middle_s(law, u);
        case ScanLaw::Kind::Mirror:
        case ScanLaw::Kind::Cone:
            break;
    }
    const bool backwards = law.alternating && (static_cast<long long>(std::floor(n)) & 1LL) != 0;
    const double in_line = time_from_middle_s(law, u);
    return n * law.period_s + (backwards ? -in_line : in_line);
}

double scan_pose_time_s(const ScanLaw& law, double n, double u, double v) noexcept {
    return law.line_corrector ? n * law.period_s : scan_time_s(law, n, u, v);
}

}  // namespace pyroscene::sensors
