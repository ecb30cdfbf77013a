#include "sensors/image_chords.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::sensors {
namespace {

/// Chord positions are wanted this far outside a scan, for point-spread functions wider than a pixel.
constexpr double kMargin_px = 4.0;
constexpr double kFirstStep = 16.0, kFinestStep = 1.0;
constexpr int kFirstStride = 64;
constexpr double kMaximumNodes = 1048576.0;  // 134 MB
/// Largest interpolation error allowed on the ground when the lattice is made; half of what the header promises.
constexpr double kTolerance_m = 5e-4, kTolerance_px = 5e-6;
/// A camera at most so far above the upper shell may look past the ground.
constexpr double kNearGround_m = 100.0;

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

/// Exact chords of one image.
class ExactChords {
public:
    ExactChords(const ImageGeometry& image, const gis::MapProjection& map, Vec3 origin_m, double bottom_m, double top_m)
        : image_(image), map_(map), origin_m_(origin_m), bottom_m_(bottom_m), top_m_(top_m) {
        const auto origin = map.to_geodetic(origin_m.x, origin_m.y);
        reference_lon_deg_ = origin.lon_deg;
    }

    /// Makes all chords end so far from the sensor when it stands near the ground and not all of the image's corners and
    /// edges come down to it within that distance; tells whether.
    bool open_beyond(double reach_m) {
        const bool frame = image_.scan.kind == ScanLaw::Kind::Frame;
        if (!frame || !(reach_m > 0.0) || image_.path.at(0.0).position.h_m > top_m_ + kNearGround_m) return false;
        for (const double u : {0.0, 0.5, 1.0})
            for (const double v : {0.0, 0.5, 1.0}) {
                const auto s = sightline(image_, 0.0, u * image_.samples, v * image_.lines);
                if (!(distance_to_height_m(s.ray, bottom_m_) <= reach_m)) reach_m_ = reach_m;
            }
        return reach_m_ > 0.0;
    }

    [[nodiscard]] ChordNode at(double scan, double u, double v) const {
        const Sightline s = sightline(image_, scan, u, v);
        const auto& position = s.pose.position;
        if (!(position.h_m > bottom_m_))
            throw input_error(subject(),
                              fmt::format("the platform is at {:.1f} m above the ellipsoid, not above the lowest ground "
                                          "of the scene at {:.1f} m",
                                          position.h_m, bottom_m_));
        const bool is_open = reach_m_ > 0.0;
        const double bottom_range_m = is_open ? reach_m_ : distance_to_height_m(s.ray, bottom_m_);
        const bool starts_inside = is_open || position.h_m <= top_m_;
        const double top_range_m = starts_inside ? 0.0 : distance_to_height_m(s.ray, top_m_);
        if (std::isnan(bottom_range_m) || std::isnan(top_range_m)) throw misses_ground(s.pose, scan, u, v);
        const auto top = starts_inside ? position : gis::geodetic_from_ecef(s.ray.origin_m + top_range_m * s.ray.direction);
        const auto bottom = gis::geodetic_from_ecef(s.ray.origin_m + bottom_range_m * s.ray.direction);
        const auto top_xy = map_.to_map(top.lat_deg, top.lon_deg), bottom_xy = map_.to_map(bottom.lat_deg, bottom.lon_deg);
        if (!std::isfinite(top_xy[0] + top_xy[1] + bottom_xy[0] + bottom_xy[1]))
            throw input_error(subject(),
                              fmt::format("the ground seen at sample {:.1f}, line {:.1f} of scan {:g} (latitude {:.4f}, "
                                          "longitude {:.4f}) cannot be shown in the map projection of the scene",
                                          u, v, scan, bottom.lat_deg, bottom.lon_deg));
        const gis::LocalAxes axes = gis::local_axes(bottom.lat_deg, bottom.lon_deg);
        const Vec3 view = -s.ray.direction;
        return {top_xy[0] - origin_m_.x,
                top_xy[1] - origin_m_.y,
                (starts_inside ? top.h_m : top_m_) - origin_m_.z,
                bottom_xy[0] - origin_m_.x,
                bottom_xy[1] - origin_m_.y,
                (is_open ? bottom.h_m : bottom_m_) - origin_m_.z,
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
    [[nodiscard]] std::string subject() const {
        return fmt::format("sensor {}, group {}", image_.sensor->id, image_.group->id);
    }

    [[nodiscard]] Error misses_ground(const Pose& pose, double scan, double u, double v) const {
        const auto& law = image_.scan;
        return input_error(subject(), fmt::format("the line of sight at sample {:.1f}, line {:.1f} of {} x {} (scan {:g}) "
                                                  "passes over the horizon; tilt the camera down (pitch {:.2f} deg, roll "
                                                  "{:.2f} deg)",
                                                  u, v, law.positions, law.lines_per_scan, scan,
                                                  pose.pitch_rad / kDegree_rad, pose.roll_rad / kDegree_rad));
    }

    /// Longitudes of an image must not jump by 360 deg for the interpolation.
    [[nodiscard]] double unwrapped(double lon_deg) const {
        return reference_lon_deg_ + std::remainder(lon_deg - reference_lon_deg_, 360.0);
    }

    const ImageGeometry& image_;
    const gis::MapProjection& map_;
    Vec3 origin_m_;
    double bottom_m_, top_m_, reference_lon_deg_ = 0.0;
    double reach_m_ = 0.0;  ///< of open chords, else 0
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

double ground_distance_m(const ChordNode& a, const ChordNode& b) noexcept {
    return std::max(std::hypot(a[kTop] - b[kTop], a[kTop + 1] - b[kTop + 1]),
                    std::hypot(a[kBottom] - b[kBottom], a[kBottom + 1] - b[kBottom + 1]));
}

template <std::size_t count>
ChordNode interpolate(const ChordLattice& lattice, const ChordNode* nodes, double u, double v) noexcept {
    const Stencil across = stencil(u - lattice.first_u, lattice.step_u, lattice.cols),
                  along = stencil(v - lattice.first_v, lattice.step_v, lattice.rows);
    ChordNode sum{};
    for (int j = 0; j < 4; ++j) {
        const ChordNode* row = nodes + static_cast<std::ptrdiff_t>(along.first + j) * lattice.cols + across.first;
        for (int i = 0; i < 4; ++i) {
            const double w = along.weight[static_cast<std::size_t>(j)] * across.weight[static_cast<std::size_t>(i)];
            for (std::size_t k = 0; k < count; ++k) sum[k] += w * row[i][k];
        }
    }
    return sum;
}

void add_nodes(const ExactChords& exact, const ChordLattice& lattice, double scan, std::vector<ChordNode>& nodes) {
    for (int row = 0; row < lattice.rows; ++row)
        for (int col = 0; col < lattice.cols; ++col)
            nodes.push_back(exact.at(scan, lattice.first_u + col * lattice.step_u, lattice.first_v + row * lattice.step_v));
}

/// Rectangle of positions that a scan's chords are wanted for.
struct Span {
    double first_u, width, first_v, height;
};

ChordLattice lattice_over(const Span& span, double step) {
    ChordLattice lattice;
    lattice.cols = std::max(4, static_cast<int>(std::ceil(span.width / step)) + 1);
    lattice.rows = std::max(4, static_cast<int>(std::ceil(span.height / step)) + 1);
    lattice.first_u = span.first_u;
    lattice.first_v = span.first_v;
    lattice.step_u = span.width / (lattice.cols - 1);
    lattice.step_v = span.height / (lattice.rows - 1);
    return lattice;
}

/// Error of a lattice in the middle of some of its meshes, in tolerances.
double lattice_error(const ExactChords& exact, const ChordLattice& lattice, double scan) {
    std::vector<ChordNode> nodes;
    add_nodes(exact, lattice, scan, nodes);
    double error = 0.0;
    for (const int row : {0, lattice.rows / 2, lattice.rows - 2})
        for (const int col : {0, lattice.cols / 2, lattice.cols - 2}) {
            const double u = lattice.first_u + (col + 0.5) * lattice.step_u,
                         v = lattice.first_v + (row + 0.5) * lattice.step_v;
            const auto here = interpolate<kSlots>(lattice, nodes.data(), u, v);
            const double pixel_m = std::max(ground_distance_m(interpolate<kSlots>(lattice, nodes.data(), u + 1.0, v), here),
                                            ground_distance_m(interpolate<kSlots>(lattice, nodes.data(), u, v + 1.0), here));
            error = std::max(
                error, ground_distance_m(exact.at(scan, u, v), here) / std::max(kTolerance_m, kTolerance_px * pixel_m));
        }
    return error;
}

/// The coarsest lattice that is fine enough for a scan. The error falls with the fourth power of the step, so that very
/// oblique views get a finer lattice at once.
ChordLattice fitting_lattice(const ExactChords& exact, const Span& span, double scan, double first_step) {
    const double finest = std::max(kFinestStep, std::sqrt(span.width * span.height / kMaximumNodes));
    for (double step = first_step;;) {
        const ChordLattice lattice = lattice_over(span, step);
        const double error = lattice_error(exact, lattice, scan);
        if (error < 1.0 || step <= finest) return lattice;
        step = std::max(finest, 0.9 * step * std::min(1.0, std::pow(error, -0.25)));
    }
}

/// Error of a cubic through four scans `stride` apart, in their middle, in tolerances.
double stride_error(const ExactChords& exact, const ChordLattice& lattice, double scan, double stride) {
    double error = 0.0;
    const double v = lattice.first_v + 0.5 * (lattice.rows - 1) * lattice.step_v;
    for (const int col : {0, lattice.cols / 2, lattice.cols - 1}) {
        const double u = lattice.first_u + col * lattice.step_u;
        constexpr std::array<double, 4> kWeights{-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
        ChordNode sum{};
        for (std::size_t i = 0; i < 4; ++i) {
            const auto node = exact.at(scan + (static_cast<double>(i) - 1.5) * stride, u, v);
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += kWeights[i] * node[k];
        }
        const auto here = exact.at(scan, u, v);
        const double pixel_m = ground_distance_m(exact.at(scan, u, v + 1.0), here);
        error = std::max(error, ground_distance_m(sum, here) / std::max(kTolerance_m, kTolerance_px * pixel_m));
    }
    return error;
}

}  // namespace

ImageChords::ImageChords(const ImageGeometry& image, const gis::MapProjection& map, Vec3 scene_origin_m, double bottom_m,
                         double top_m, double reach_m) {
    ExactChords exact(image, map, scene_origin_m, bottom_m, top_m);
    open_ = exact.open_beyond(reach_m);
    const ScanLaw& law = image.scan;
    double widest = 1.0;
    for (const auto& zone : law.zones) widest = std::max<double>(widest, zone.width);
    const double left = scan_position(law, image.first_sample),
                 right = scan_position(law, image.first_sample + image.samples);
    const bool frame = law.kind == ScanLaw::Kind::Frame;
    const bool window = frame || law.kind == ScanLaw::Kind::Disk;
    const double v_margin = kMargin_px + law.stagger;
    Span span{left - kMargin_px * widest, right - left + 2.0 * kMargin_px * widest, -v_margin,
              law.lines_per_scan + 2.0 * v_margin};
    if (window) {
        span.first_v = image.first_line - kMargin_px;
        span.height = image.lines + 2.0 * kMargin_px;
    }
    first_scan_ = scan_position_of(image, 0, 0).scan;
    const int last = scan_position_of(image, 0, image.lines - 1).scan, scans = window ? 1 : last - first_scan_ + 1;
    const std::array<int, 3> samples{first_scan_, (first_scan_ + last) / 2, last};
    double step = kFirstStep;
    for (const int scan : samples) {
        lattice_ = fitting_lattice(exact, span, scan, step);
        step = std::min(step, std::max(lattice_.step_u, lattice_.step_v));
        if (scans == 1) break;
    }
    if (scans > 1) lattice_ = lattice_over(span, step);
    const bool smooth = image.path.smooth && (!law.alternating || law.line_corrector);
    double stride = smooth ? std::min<double>(kFirstStride, std::max(1, (scans - 1) / 3)) : 1.0;
    for (const int scan : samples)
        while (stride > 1.0) {
            const double error = stride_error(exact, lattice_, scan, stride);
            if (error < 1.0) break;
            stride = std::max(1.0, std::min(stride - 1.0, 0.9 * stride * std::pow(error, -0.25)));
        }
    stride_ = static_cast<int>(stride);
    scan_nodes_ = stride_ > 1 ? std::max(4, (scans - 1 + stride_ - 1) / stride_ + 1) : scans;
    nodes_.reserve(static_cast<std::size_t>(scan_nodes_) * static_cast<std::size_t>(lattice_.cols) *
                   static_cast<std::size_t>(lattice_.rows));
    for (int k = 0; k < scan_nodes_; ++k) add_nodes(exact, lattice_, first_scan_ + k * stride_, nodes_);
}

ScanChords ImageChords::scan(int number) const {
    const auto size = static_cast<std::size_t>(lattice_.cols) * static_cast<std::size_t>(lattice_.rows);
    const int from_first = std::clamp(number - first_scan_, 0, (scan_nodes_ - 1) * stride_);
    if (from_first % stride_ == 0) return {lattice_, nodes_.data() + static_cast<std::size_t>(from_first / stride_) * size};
    const Stencil between = stencil(from_first, stride_, scan_nodes_);
    std::vector<ChordNode> own(size, ChordNode{});
    for (std::size_t i = 0; i < 4; ++i) {
        const ChordNode* from = nodes_.data() + (static_cast<std::size_t>(between.first) + i) * size;
        for (std::size_t n = 0; n < size; ++n)
            for (std::size_t k = 0; k < kSlots; ++k) own[n][k] += between.weight[i] * from[n][k];
    }
    return {lattice_, nullptr, std::move(own)};
}

Chord ScanChords::at(double u, double v) const noexcept {
    const auto n = interpolate<kSlots>(lattice_, nodes_ != nullptr ? nodes_ : own_.data(), u, v);
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

ScanChords::Ends ScanChords::ends(double u, double v) const noexcept {
    const auto n = interpolate<kBottom + 3>(lattice_, nodes_ != nullptr ? nodes_ : own_.data(), u, v);
    return {{n[kTop], n[kTop + 1], n[kTop + 2]}, {n[kBottom], n[kBottom + 1], n[kBottom + 2]}};
}

}  // namespace pyroscene::sensors
