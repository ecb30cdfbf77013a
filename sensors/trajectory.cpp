#include "sensors/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::sensors {
namespace {

/// WGS 84: gravitational constant of the Earth and its rate of turn.
constexpr double kEarthGravity_m3_s2 = 3.986004418e14, kEarthRate_rad_s = 7.292115e-5;

/// Unit quaternion w, x, y, z.
using Quaternion = std::array<double, 4>;

/// Rz(heading) Ry(pitch) Rx(roll).
Quaternion attitude(const Pose& p) {
    const double ch = std::cos(0.5 * p.heading_rad), sh = std::sin(0.5 * p.heading_rad);
    const double cp = std::cos(0.5 * p.pitch_rad), sp = std::sin(0.5 * p.pitch_rad);
    const double cr = std::cos(0.5 * p.roll_rad), sr = std::sin(0.5 * p.roll_rad);
    return {ch * cp * cr + sh * sp * sr, ch * cp * sr - sh * sp * cr, ch * sp * cr + sh * cp * sr,
            sh * cp * cr - ch * sp * sr};
}

void set_attitude(Pose& pose, const Quaternion& q) {
    const auto [w, x, y, z] = q;
    pose.heading_rad = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
    pose.pitch_rad = std::asin(std::clamp(2.0 * (w * y - z * x), -1.0, 1.0));
    pose.roll_rad = std::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
}

Quaternion slerp(const Quaternion& a, Quaternion b, double f) {
    double cosine = 0.0;
    for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    if (cosine < 0.0) {  // the same attitude the short way round
        for (double& component : b) component = -component;
        cosine = -cosine;
    }
    const double angle = std::acos(std::min(1.0, cosine)), sine = std::sin(angle);
    const bool near = sine < 1e-9;
    const double wa = near ? 1.0 - f : std::sin((1.0 - f) * angle) / sine, wb = near ? f : std::sin(f * angle) / sine;
    Quaternion q{};
    for (std::size_t i = 0; i < 4; ++i) q[i] = wa * a[i] + wb * b[i];
    return q;
}

/// Poses of a flight as they are interpolated between.
class Flight {
public:
    explicit Flight(std::vector<Pose> poses) : poses_(std::move(poses)) {
        for (const auto& pose : poses_) ecef_m_.push_back(gis::ecef_from_geodetic(pose.position));
    }

    [[nodiscard]] Pose at(double time_s) const {
        constexpr double kSlack_s = 1e-6;
        if (!(time_s >= poses_.front().time_s - kSlack_s && time_s <= poses_.back().time_s + kSlack_s))
            throw input_error("trajectory", fmt::format("covers {:g} s to {:g} s, but the image needs {:g} s",
                                                        poses_.front().time_s, poses_.back().time_s, time_s));
        const auto after = std::upper_bound(poses_.begin() + 1, poses_.end() - 1, time_s,
                                            [](double t, const Pose& p) { return t < p.time_s; });
        const auto i = static_cast<std::size_t>(after - poses_.begin()) - 1;
        const Pose &a = poses_[i], &b = poses_[i + 1];
        const double span_s = b.time_s - a.time_s, f = (time_s - a.time_s) / span_s;
        const double f2 = f * f, f3 = f2 * f;
        const Vec3 position = (2.0 * f3 - 3.0 * f2 + 1.0) * ecef_m_[i] + (3.0 * f2 - 2.0 * f3) * ecef_m_[i + 1] +
                              span_s * ((f3 - 2.0 * f2 + f) * velocity(i) + (f3 - f2) * velocity(i + 1));
        Pose pose;
        pose.position = gis::geodetic_from_ecef(position);
        pose.time_s = time_s;
        set_attitude(pose, slerp(attitude(a), attitude(b), f));
        return pose;
    }

    [[nodiscard]] double ground_speed_m_s() const {
        return length(ecef_m_.back() - ecef_m_.front()) / (poses_.back().time_s - poses_.front().time_s);
    }

private:
    /// Slope of the parabola through a pose and its neighbours; at the ends that of the chord.
    [[nodiscard]] Vec3 velocity(std::size_t i) const {
        const auto between = [&](std::size_t a, std::size_t b) {
            return (ecef_m_[b] - ecef_m_[a]) / (poses_[b].time_s - poses_[a].time_s);
        };
        if (i == 0) return between(0, 1);
        if (i + 1 == poses_.size()) return between(i - 1, i);
        const double before_s = poses_[i].time_s - poses_[i - 1].time_s, after_s = poses_[i + 1].time_s - poses_[i].time_s;
        return (after_s * between(i - 1, i) + before_s * between(i, i + 1)) / (before_s + after_s);
    }

    std::vector<Pose> poses_;
    std::vector<Vec3> ecef_m_;
};

/// Turn about the axis of the Earth.
Vec3 turned(Vec3 v, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// A circle around the centre of the Earth, in ECEF axes as they are at time 0.
struct Circle {
    double radius_m = 0.0, rate_rad_s = 0.0;
    Vec3 out, ahead;  ///< unit vectors at time 0

    /// In ECEF axes of the moment.
    [[nodiscard]] Pose at(double time_s, double pitch_rad, double roll_rad) const {
        const double c = std::cos(rate_rad_s * time_s), s = std::sin(rate_rad_s * time_s);
        const double turn = -kEarthRate_rad_s * time_s;
        const Vec3 position = turned(radius_m * (c * out + s * ahead), turn);
        const Vec3 inertial = turned(radius_m * rate_rad_s * (c * ahead - s * out), turn);
        const Vec3 velocity = inertial - cross({0.0, 0.0, kEarthRate_rad_s}, position);
        Pose pose{
            .position = gis::geodetic_from_ecef(position), .pitch_rad = pitch_rad, .roll_rad = roll_rad, .time_s = time_s};
        const auto axes = gis::local_axes(pose.position.lat_deg, pose.position.lon_deg);
        pose.heading_rad = std::atan2(dot(velocity, axes.east), dot(velocity, axes.north));
        return pose;
    }
};

Circle circle_over(const Orbit& orbit, bool ascending, const gis::Geodetic& below) {
    const Vec3 position = gis::ecef_from_geodetic({below.lat_deg, below.lon_deg, orbit.height_m});
    Circle circle;
    circle.radius_m = length(position);
    circle.rate_rad_s = std::sqrt(kEarthGravity_m3_s2 / std::pow(circle.radius_m, 3));
    circle.out = position / circle.radius_m;
    const double cos_latitude = std::hypot(circle.out.x, circle.out.y);
    const double sine = std::cos(orbit.inclination_deg * kDegree_rad) / cos_latitude;
    if (!(std::abs(sine) <= 1.0))
        throw input_error("orbit", fmt::format("an inclination of {:g} deg never comes over latitude {:.2f} deg",
                                               orbit.inclination_deg, below.lat_deg));
    const double cosine = (ascending ? 1.0 : -1.0) * std::sqrt(1.0 - sine * sine);
    const Vec3 east = Vec3{-circle.out.y, circle.out.x, 0.0} / cos_latitude, north = cross(circle.out, east);
    circle.ahead = cosine * north + sine * east;
    return circle;
}

}  // namespace

Trajectory standing(const Pose& pose) {
    return {.at = [pose](double time_s) {
        Pose now = pose;
        now.time_s = time_s;
        return now;
    }};
}

Trajectory straight_flight(const Pose& pose, double ground_speed_m_s) {
    const auto at = [pose, ground_speed_m_s](double time_s) {
        const auto step = gis::step_along_geodesic(pose.position, pose.heading_rad / kDegree_rad, ground_speed_m_s * time_s);
        Pose now = pose;
        now.position = step.point;
        now.heading_rad = step.azimuth_deg * kDegree_rad;
        now.time_s = time_s;
        return now;
    };
    return {.at = at, .ground_speed_m_s = ground_speed_m_s};
}

Trajectory flown(std::vector<Pose> poses) {
    if (poses.size() < 2) throw input_error("trajectory", fmt::format("{} poses, expected at least 2", poses.size()));
    for (std::size_t i = 1; i < poses.size(); ++i)
        if (!(poses[i].time_s > poses[i - 1].time_s))
            throw input_error("trajectory", fmt::format("time {:g} s follows {:g} s; times must ascend", poses[i].time_s,
                                                        poses[i - 1].time_s));
    const Flight flight(std::move(poses));
    return {.at = [flight](double time_s) { return flight.at(time_s); },
            .ground_speed_m_s = flight.ground_speed_m_s(),
            .smooth = false};
}

Trajectory orbit_pass(const Orbit& orbit, bool ascending, const gis::Geodetic& target, Vec3 body, double pitch_rad,
                      double roll_rad) {
    // The point below the satellite is moved until the direction meets the target; the shift it needs hardly depends on it.
    gis::Geodetic below = target;
    Circle circle = circle_over(orbit, ascending, below);
    const Sensor aligned;
    constexpr int kMaximumSteps = 60;
    constexpr double kTolerance_deg = 1e-11;
    for (int i = 0; i < kMaximumSteps; ++i) {
        const auto seen = intersect_height(body_ray(aligned, circle.at(0.0, pitch_rad, roll_rad), body), target.h_m);
        if (std::isnan(seen.h_m)) throw input_error("orbit", "the direction to the target passes the Earth");
        const double north = target.lat_deg - seen.lat_deg, east = std::remainder(target.lon_deg - seen.lon_deg, 360.0);
        below.lat_deg = std::clamp(below.lat_deg + north, -89.99, 89.99);
        below.lon_deg = std::remainder(below.lon_deg + east, 360.0);
        circle = circle_over(orbit, ascending, below);
        if (std::abs(north) + std::abs(east) < kTolerance_deg) break;
    }
    const double speed_m_s = circle.rate_rad_s * length(gis::ecef_from_geodetic({below.lat_deg, below.lon_deg, 0.0}));
    return {.at = [circle, pitch_rad, roll_rad](double time_s) { return circle.at(time_s, pitch_rad, roll_rad); },
            .ground_speed_m_s = speed_m_s};
}

Trajectory geostationary(const Orbit& orbit) {
    return standing({.position = {0.0, orbit.geostationary_longitude_deg.value_or(0.0), orbit.height_m}});
}

}  // namespace pyroscene::sensors
