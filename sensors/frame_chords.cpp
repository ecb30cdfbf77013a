#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "sensors/framing.h"

namespace pyroscene::sensors {
namespace {

/// Chord positions are wanted this far outside the frame, for point-spread functions wider than a pixel.
constexpr double kMargin_px = 4.0;
constexpr double kFirstStep_px = 16.0, kFinestStep_px = 1.0;
constexpr double kMaximumNodes = 1048576.0;  // 134 MB
/// Largest interpolation error allowed on the ground when the lattice is made; half of what the header promises.
constexpr double kTolerance_m = 5e-4, kTolerance_px = 5e-6;

/// Where the numbers of a chord lie in a lattice node.
enum Slot {
    kTop = 0,
    kBottom = 3,
    kTopLon = 6,
    kTopLat = 7,
    kBottomLon = 8,
    kBottomLat = 9,
    kView = 10,
    kTopRange = 13,
    kBottomRange = 14,
    kSlots = 16
};

/// Exact chords of one frame.
class ExactChords {
public:
    ExactChords(const Sensor& sensor, const CameraGroup& group, const Pose& pose, const gis::MapProjection& map,
                Vec3 origin_m, double bottom_m, double top_m)
        : sensor_(sensor), group_(group), pose_(pose), map_(map), origin_m_(origin_m), bottom_m_(bottom_m), top_m_(top_m) {
        if (!(pose.position.h_m > bottom_m))
            throw input_error(subject(),
                              fmt::format("the platform is at {:.1f} m above the ellipsoid, not above the lowest ground "
                                          "of the scene at {:.1f} m",
                                          pose.position.h_m, bottom_m));
    }

    [[nodiscard]] std::array<double, kSlots> at(double sample, double line) const {
        const EcefRay ray = pixel_ray(sensor_, group_, pose_, sample, line);
        const double bottom_range_m = distance_to_height_m(ray, bottom_m_);
        const bool starts_inside = pose_.position.h_m <= top_m_;
        const double top_range_m = starts_inside ? 0.0 : distance_to_height_m(ray, top_m_);
        if (std::isnan(bottom_range_m) || std::isnan(top_range_m)) throw misses_ground(sample, line);
        const auto top =
            starts_inside ? pose_.position : gis::geodetic_from_ecef(ray.origin_m + top_range_m * ray.direction);
        const auto bottom = gis::geodetic_from_ecef(ray.origin_m + bottom_range_m * ray.direction);
        const auto top_xy = map_.to_map(top.lat_deg, top.lon_deg), bottom_xy = map_.to_map(bottom.lat_deg, bottom.lon_deg);
        if (!std::isfinite(top_xy[0] + top_xy[1] + bottom_xy[0] + bottom_xy[1]))
            throw input_error(subject(),
                              fmt::format("the ground seen at sample {:.1f}, line {:.1f} (latitude {:.4f}, longitude "
                                          "{:.4f}) cannot be shown in the map projection of the scene",
                                          sample, line, bottom.lat_deg, bottom.lon_deg));
        const gis::LocalAxes axes = gis::local_axes(bottom.lat_deg, bottom.lon_deg);
        const Vec3 view = -ray.direction;
        return {top_xy[0] - origin_m_.x,
                top_xy[1] - origin_m_.y,
                (starts_inside ? top.h_m : top_m_) - origin_m_.z,
                bottom_xy[0] - origin_m_.x,
                bottom_xy[1] - origin_m_.y,
                bottom_m_ - origin_m_.z,
                unwrapped(top.lon_deg),
                top.lat_deg,
                unwrapped(bottom.lon_deg),
                bottom.lat_deg,
                dot(view, axes.east),
                dot(view, axes.north),
                dot(view, axes.up),
                top_range_m,
                bottom_range_m,
                0.0};
    }

private:
    [[nodiscard]] std::string subject() const { return fmt::format("sensor {}, group {}", sensor_.id, group_.id); }

    [[nodiscard]] Error misses_ground(double sample, double line) const {
        return input_error(subject(),
                           fmt::format("the line of sight at sample {:.1f}, line {:.1f} of {} x {} passes over the "
                                       "horizon; tilt the camera down (pitch {:.2f} deg, roll {:.2f} deg)",
                                       sample, line, group_.samples, group_.lines, pose_.pitch_rad / kDegree_rad,
                                       pose_.roll_rad / kDegree_rad));
    }

    /// Longitudes of a frame must not jump by 360 deg for the interpolation.
    [[nodiscard]] double unwrapped(double lon_deg) const {
        return pose_.position.lon_deg + std::remainder(lon_deg - pose_.position.lon_deg, 360.0);
    }

    const Sensor& sensor_;
    const CameraGroup& group_;
    const Pose& pose_;
    const gis::MapProjection& map_;
    Vec3 origin_m_;
    double bottom_m_, top_m_;
};

/// Weights of the cubic through four neighbours at fraction f between the second and the third (f may leave [0, 1]).
std::array<double, 4> lagrange_weights(double f) noexcept {
    return {-f * (f - 1.0) * (f - 2.0) / 6.0, (f + 1.0) * (f - 1.0) * (f - 2.0) / 2.0, -(f + 1.0) * f * (f - 2.0) / 2.0,
            (f + 1.0) * f * (f - 1.0) / 6.0};
}

/// Stencil of four nodes around an image position; at the rim it is moved inwards.
struct Stencil {
    int first = 0;
    std::array<double, 4> weight{};
};
Stencil stencil(double position, double step, int nodes) noexcept {
    const double u = position / step;
    const int first = std::clamp(static_cast<int>(std::floor(u)) - 1, 0, nodes - 4);
    return {first, lagrange_weights(u - (first + 1))};
}

double ground_distance_m(const std::array<double, kSlots>& a, const std::array<double, kSlots>& b) noexcept {
    return std::max(std::hypot(a[kTop] - b[kTop], a[kTop + 1] - b[kTop + 1]),
                    std::hypot(a[kBottom] - b[kBottom], a[kBottom + 1] - b[kBottom + 1]));
}

}  // namespace

template <std::size_t count>
std::array<double, count> FrameChords::interpolate(double sample, double line) const noexcept {
    const Stencil across = stencil(sample - first_, col_step_, cols_), along = stencil(line - first_, row_step_, rows_);
    std::array<double, count> sum{};
    for (int j = 0; j < 4; ++j) {
        const Node* row = &nodes_[static_cast<std::size_t>(along.first + j) * static_cast<std::size_t>(cols_) +
                                  static_cast<std::size_t>(across.first)];
        for (int i = 0; i < 4; ++i) {
            const double w = along.weight[static_cast<std::size_t>(j)] * across.weight[static_cast<std::size_t>(i)];
            for (std::size_t k = 0; k < count; ++k) sum[k] += w * row[i][k];
        }
    }
    return sum;
}

FrameChords::FrameChords(const Sensor& sensor, const CameraGroup& group, const Pose& pose, const gis::MapProjection& map,
                         Vec3 scene_origin_m, double bottom_m, double top_m) {
    const ExactChords exact(sensor, group, pose, map, scene_origin_m, bottom_m, top_m);
    first_ = -kMargin_px;
    const double width = group.samples + 2.0 * kMargin_px, height = group.lines + 2.0 * kMargin_px;
    for (double step = kFirstStep_px;;) {
        cols_ = std::max(4, static_cast<int>(std::ceil(width / step)) + 1);
        rows_ = std::max(4, static_cast<int>(std::ceil(height / step)) + 1);
        col_step_ = width / (cols_ - 1);
        row_step_ = height / (rows_ - 1);
        nodes_.clear();
        nodes_.reserve(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_));
        for (int row = 0; row < rows_; ++row)
            for (int col = 0; col < cols_; ++col)
                nodes_.push_back(exact.at(first_ + col * col_step_, first_ + row * row_step_));
        double error = 0.0;  // in tolerances
        for (const int row : {0, rows_ / 2, rows_ - 2})
            for (const int col : {0, cols_ / 2, cols_ - 2}) {
                const double sample = first_ + (col + 0.5) * col_step_, line = first_ + (row + 0.5) * row_step_;
                const auto here = interpolate<kSlots>(sample, line);
                const double pixel_m = std::max(ground_distance_m(interpolate<kSlots>(sample + 1.0, line), here),
                                                ground_distance_m(interpolate<kSlots>(sample, line + 1.0), here));
                error = std::max(error, ground_distance_m(exact.at(sample, line), here) /
                                            std::max(kTolerance_m, kTolerance_px * pixel_m));
            }
        // The error falls with the fourth power of the step, so that very oblique frames get a finer lattice at once.
        const double finest = std::max(kFinestStep_px, std::sqrt(width * height / kMaximumNodes));
        if (error < 1.0 || step <= finest) return;
        step = std::max(finest, 0.9 * step * std::min(1.0, std::pow(error, -0.25)));
    }
}

Chord FrameChords::at(double sample, double line) const noexcept {
    const auto n = interpolate<kSlots>(sample, line);
    const auto wrapped = [](double lon_deg) {
        return lon_deg < -180.0 ? lon_deg + 360.0 : lon_deg >= 180.0 ? lon_deg - 360.0 : lon_deg;
    };
    return {.top_m = {n[kTop], n[kTop + 1], n[kTop + 2]},
            .bottom_m = {n[kBottom], n[kBottom + 1], n[kBottom + 2]},
            .top_lon_deg = wrapped(n[kTopLon]),
            .top_lat_deg = n[kTopLat],
            .bottom_lon_deg = wrapped(n[kBottomLon]),
            .bottom_lat_deg = n[kBottomLat],
            .view_enu = normalized({n[kView], n[kView + 1], n[kView + 2]}),
            .top_range_m = n[kTopRange],
            .bottom_range_m = n[kBottomRange]};
}

FrameChords::Ends FrameChords::ends(double sample, double line) const noexcept {
    const auto n = interpolate<kBottom + 3>(sample, line);
    return {{n[kTop], n[kTop + 1], n[kTop + 2]}, {n[kBottom], n[kBottom + 1], n[kBottom + 2]}};
}

}  // namespace pyroscene::sensors
