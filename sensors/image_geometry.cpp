#include "sensors/image_geometry.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::sensors {
namespace {

std::string subject(const ImageGeometry& image) {
    return fmt::format("sensor {}, group {}", image.sensor->id, image.group->id);
}

std::string no_view(const CameraGroup& group, const std::string& view) {
    std::string names;
    for (const auto& v : group.views) names += (names.empty() ? "" : ", ") + v.name;
    return fmt::format("no view '{}'; it has {}", view, names.empty() ? "one only, without a name" : names);
}

/// One scan holds all lines of the image.
bool one_scan(const ScanLaw& law) { return law.kind == ScanLaw::Kind::Frame || law.kind == ScanLaw::Kind::Disk; }

/// Direction to a point in the frame of the instrument at a pose: what body_ray() undoes.
Vec3 instrument_direction(const Sensor& sensor, const Pose& pose, Vec3 ecef_m) {
    const Vec3 forward = body_ray(sensor, pose, {1.0, 0.0, 0.0}).direction,
               right = body_ray(sensor, pose, {0.0, 1.0, 0.0}).direction,
               down = body_ray(sensor, pose, {0.0, 0.0, 1.0}).direction;
    const Vec3 d = normalized(ecef_m - gis::ecef_from_geodetic(pose.position));
    return {dot(d, forward), dot(d, right), dot(d, down)};
}

/// Position (in scans and across) that looks at a point, by Newton's method on the angles between its direction and the
/// sightline's. `along` counts scans, or lines of the only scan.
struct Found {
    double along = 0.0, u = 0.0;
};
std::optional<Found> find(const ImageGeometry& image, Vec3 ecef_m) {
    ScanLaw law = image.scan;
    law.alternating = false;  // a sweep's direction hardly moves its pixels, but it would make the search jump
    const bool single = one_scan(law);
    const double middle = 0.5 * law.lines_per_scan;
    // Misses: how far, to the right and ahead, the point is from where position (along, u) looks [rad].
    const auto miss = [&](const Found& f) {
        const double scan = single ? 0.0 : f.along, v = single ? f.along : middle;
        const Pose pose = image.path.at(scan_pose_time_s(law, scan, f.u, v));
        Pose held = pose;
        held.roll_rad -= std::clamp(pose.roll_rad, -law.roll_compensation_rad, law.roll_compensation_rad);
        const Vec3 to = instrument_direction(*image.sensor, held, ecef_m), looks = scan_direction(law, f.u, v);
        const Vec3 side = normalized(cross({1.0, 0.0, 0.0}, looks)), ahead = cross(looks, side);
        const double right = dot(to, side), centre = dot(to, looks);
        // Over flat ground the first is linear in the scan angle, the second in the distance flown, however large they are.
        return std::array<double, 2>{std::atan2(right, centre), dot(to, ahead) / std::hypot(right, centre)};
    };
    Found f{single ? middle : 0.0, 0.5 * law.positions};
    constexpr int kMaximumSteps = 40;
    constexpr double kTolerance = 1e-4;  // of a position
    for (int i = 0; i < kMaximumSteps; ++i) {
        const auto here = miss(f);
        const double du = 0.5, dn = single ? 0.5 : 0.25;
        const auto right = miss({f.along, f.u + du}), later = miss({f.along + dn, f.u});
        const double a = (right[0] - here[0]) / du, b = (later[0] - here[0]) / dn;
        const double c = (right[1] - here[1]) / du, d = (later[1] - here[1]) / dn;
        const double determinant = a * d - b * c;
        if (!std::isfinite(determinant) || determinant == 0.0) return std::nullopt;
        double step_u = -(d * here[0] - b * here[1]) / determinant, step_n = -(a * here[1] - c * here[0]) / determinant;
        // The ends of a line bound the step: beyond them the law means nothing.
        const double next_u = std::clamp(f.u + step_u, -0.5 * law.positions, 1.5 * law.positions);
        step_u = next_u - f.u;
        f.u = next_u;
        f.along += step_n;
        if (std::abs(step_u) + std::abs(step_n) < kTolerance) return f;
    }
    return std::nullopt;
}

/// Image sample of a position: the inverse of scan_position(), which grows.
double sample_of(const ScanLaw& law, double u) {
    if (law.zones.empty()) return u;
    double low = -law.samples(), high = 2.0 * law.samples();
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (scan_position(law, middle) < u ? low : high) = middle;
    }
    return low;
}

}  // namespace

ScanLaw resolved_scan(const Sensor& sensor, const CameraGroup& group, const std::string& view, double height_agl_m,
                      double ground_speed_m_s) {
    ScanLaw law = group.scan;
    if (!view.empty()) {
        const auto found =
            std::find_if(group.views.begin(), group.views.end(), [&](const auto& v) { return v.name == view; });
        if (found == group.views.end())
            throw input_error(fmt::format("sensor {}, group {}", sensor.id, group.id), no_view(group, view));
        law = found->scan;
    }
    if (one_scan(law)) return law;
    const double contiguous_s =
        ground_speed_m_s > 0.0 ? law.lines_per_scan * law.step_along_rad * height_agl_m / ground_speed_m_s : 0.0;
    for (const double rate_hz : law.rates_hz) {
        law.period_s = 1.0 / rate_hz;
        if (law.period_s <= contiguous_s) break;
    }
    if (!(law.period_s > 0.0)) law.period_s = contiguous_s;
    if (!(law.period_s > 0.0))
        throw input_error(fmt::format("sensor {}, group {}", sensor.id, group.id),
                          "the time between lines does not follow from the file; the platform needs a speed");
    return law;
}

Sightline sightline(const ImageGeometry& image, double scan, double u, double v) {
    const ScanLaw& law = image.scan;
    Sightline s;
    s.time_s = scan_time_s(law, scan, u, v);
    s.pose = image.path.at(scan_pose_time_s(law, scan, u, v));
    s.pose.roll_rad -= std::clamp(s.pose.roll_rad, -law.roll_compensation_rad, law.roll_compensation_rad);
    s.ray = law.kind == ScanLaw::Kind::Frame ? pixel_ray(*image.sensor, *image.group, s.pose, u, v)
                                             : body_ray(*image.sensor, s.pose, scan_direction(law, u, v));
    return s;
}

ScanPosition scan_position_of(const ImageGeometry& image, int sample, int line, double sample_offset, double line_offset) {
    const ScanLaw& law = image.scan;
    const int m = law.lines_per_scan, absolute = image.first_line + line, s = image.first_sample + sample;
    const int scan = absolute >= 0 ? absolute / m : -((m - 1 - absolute) / m);
    // Odd samples of a staggered array sit in the front row.
    const double stagger = s % 2 != 0 ? law.stagger : -law.stagger;
    return {scan, scan_position(law, s + 0.5) + sample_offset * scan_pixel_width(law, s),
            absolute - scan * m + 0.5 + line_offset + stagger};
}

double pixel_time_s(const ImageGeometry& image, int sample, int line) {
    const auto p = scan_position_of(image, sample, line);
    return image.time_s + scan_time_s(image.scan, p.scan, p.u, p.v);
}

bool pixel_deleted(const ImageGeometry& image, int sample, int line) {
    const auto position = scan_position_of(image, sample, line);
    return scan_deletes(image.scan, image.first_sample + sample, static_cast<int>(std::floor(position.v)));
}

void crop_to(ImageGeometry& image, std::span<const gis::Geodetic> points, int margin, bool all_samples,
             std::optional<int> lines) {
    const ScanLaw& law = image.scan;
    image.first_sample = image.first_line = 0;
    image.samples = law.samples();
    image.lines = law.lines_per_scan;
    if (law.kind == ScanLaw::Kind::Frame) return;
    double left = 1e30, right = -1e30, first = 1e30, last = -1e30;
    for (const auto& point : points) {
        const auto found = find(image, gis::ecef_from_geodetic(point));
        if (!found) throw input_error(subject(image), "the scene is not within reach of its scan");
        const double sample = sample_of(law, found->u),
                     line = one_scan(law) ? found->along : found->along * law.lines_per_scan;
        left = std::min(left, sample);
        right = std::max(right, sample);
        first = std::min(first, line);
        last = std::max(last, line);
    }
    constexpr double kMostLines = 1e6;
    if (!(last - first < kMostLines))
        throw input_error(subject(image), "the scene takes more than a million lines; give `lines`");
    if (right < 0.0 || left > law.samples())
        throw input_error(subject(image), fmt::format("the scene lies at samples {:.0f} to {:.0f} of a line of {}: outside "
                                                      "its swath",
                                                      left, right, law.samples()));
    if (!all_samples) {
        image.first_sample = std::max(0, static_cast<int>(std::floor(left)) - margin);
        image.samples = std::min(law.samples(), static_cast<int>(std::ceil(right)) + margin) - image.first_sample;
    }
    if (one_scan(law)) {
        image.first_line = std::clamp(static_cast<int>(std::floor(first)) - margin, 0, law.lines_per_scan - 1);
        image.lines = std::clamp(static_cast<int>(std::ceil(last)) + margin, 1, law.lines_per_scan) - image.first_line;
    } else {
        // Lines of a scan overlap away from nadir, so whole scans are taken; half a scan on both sides for the skew of it.
        const int m = law.lines_per_scan;
        const int first_scan = static_cast<int>(std::floor(first / m - 0.5 - static_cast<double>(margin) / m));
        const int last_scan = static_cast<int>(std::ceil(last / m + 0.5 + static_cast<double>(margin) / m));
        image.first_line = first_scan * m;
        image.lines = (last_scan - first_scan + 1) * m;
    }
    if (lines) {
        // Around the middle of the scene on a disk, else around scan 0, which looks at what the path was made for.
        image.first_line = one_scan(law) ? image.first_line + (image.lines - *lines) / 2 : (law.lines_per_scan - *lines) / 2;
        image.lines = *lines;
        if (one_scan(law)) image.first_line = std::clamp(image.first_line, 0, std::max(0, law.lines_per_scan - *lines));
    }
    if (law.kind == ScanLaw::Kind::Disk)
        image.time_s -=
            scan_time_s(law, 0.0, image.first_sample + 0.5 * image.samples, image.first_line + 0.5 * image.lines);
}

}  // namespace pyroscene::sensors
