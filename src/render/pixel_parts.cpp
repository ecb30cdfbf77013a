#include "render/pixel_parts.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace pyroscene::render {
namespace {

/// Ground that a share may see beside the plane through its hit: part of its own size, for ground that is not a plane.
constexpr double kUneven = 0.25;
constexpr double kHalved = 1.41421356;  // shares end between 0.7 and 1.4 times the spacing wanted
constexpr double kLeastCosine = 0.05;   // of rays that graze a slope

/// Base shares of a pixel; row by row, as ImageRequest::rays has them.
void list_base(int n, std::vector<PixelPart>& parts) {
    parts.clear();
    for (int v = 0; v < n; ++v)
        for (int u = 0; u < n; ++u) parts.push_back({.index_u = u, .index_v = v});
}

/// A step between rays on level ground as it is on the slope that the ray meets.
Vec3 on_slope(Vec3 step_m, Vec3 direction, Vec3 normal) {
    const double cosine = std::min(dot(normal, direction), -kLeastCosine);
    return step_m - (dot(normal, step_m) / cosine) * direction;
}

double width_m(Vec3 step_m) { return std::hypot(step_m.x, step_m.y); }

double area_m2(Vec3 across_m, Vec3 along_m) { return std::abs(across_m.x * along_m.y - across_m.y * along_m.x); }

/// Where a part of a pixel sees the ground, and flames in front of it.
GroundBox box_of(const FireDetail& detail, Vec3 centre_m, Vec3 direction, Vec3 across_m, Vec3 along_m) {
    const double margin_m = kUneven * std::max(width_m(across_m), width_m(along_m));
    const double half_x = 0.5 * (std::abs(across_m.x) + std::abs(along_m.x)) + margin_m;
    const double half_y = 0.5 * (std::abs(across_m.y) + std::abs(along_m.y)) + margin_m;
    const double steepness = std::max(-direction.z, kLeastCosine);  // flame lies towards the camera
    const double dx = -direction.x / steepness * detail.flame_height_m(),
                 dy = -direction.y / steepness * detail.flame_height_m();
    return {centre_m.x + std::min(dx, 0.0) - half_x, centre_m.y + std::min(dy, 0.0) - half_y,
            centre_m.x + std::max(dx, 0.0) + half_x, centre_m.y + std::max(dy, 0.0) + half_y};
}

void widen(GroundBox& box, const GroundBox& by) {
    box = {std::min(box.west, by.west), std::min(box.south, by.south), std::max(box.east, by.east),
           std::max(box.north, by.north)};
}

/// Offset of a part's ray within it, so that cells and rays cannot beat: uniform in the part, none in base shares.
std::array<double, 2> jitter(int line, int sample, const PixelPart& p) {
    if (p.level_u + p.level_v == 0) return {0.0, 0.0};
    static const auto stream = stream_id("pixel parts");
    const RandomKey key{static_cast<std::uint64_t>(line) << 32U | static_cast<std::uint32_t>(sample), stream,
                        static_cast<std::uint32_t>(16 * p.level_u + p.level_v)};
    const auto index = static_cast<std::uint64_t>(p.index_v) << 32U | static_cast<std::uint32_t>(p.index_u);
    return {uniform01(key, index, 0) - 0.5, uniform01(key, index, 1) - 0.5};
}

}  // namespace

void PartTracer::split(const PixelPart& part, bool along_line, bool across_lines) {
    for (int v = 0; v <= (across_lines ? 1 : 0); ++v)
        for (int u = 0; u <= (along_line ? 1 : 0); ++u) {
            PixelPart half = part;
            if (along_line) half.level_u += 1, half.index_u = 2 * part.index_u + u;
            if (across_lines) half.level_v += 1, half.index_v = 2 * part.index_v + v;
            finer_.push_back(half);
        }
}

void PartTracer::look(int sample, const Pixel& pixel) {
    views_.resize(parts_.size());
    seen_.resize(parts_.size());
    parts_of_line_(sample, parts_, views_);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const PartView& view = views_[i];
        const auto [u, v] = jitter(line_, sample, parts_[i]);
        const Vec3 offset_m = u * view.across_m + v * view.along_m;
        Seen& seen = seen_[i];
        seen.ray = {view.ray.start_m + offset_m, view.ray.end_m + offset_m};
        seen.met = pixel.meet(seen.ray);
        const Vec3 direction = normalized(view.ray.end_m - view.ray.start_m);
        const Vec3 up = seen.met ? seen.met->hit.normal : Vec3{0.0, 0.0, 1.0};
        const Vec3 hit_m = seen.met ? seen.met->hit.point_m : seen.ray.end_m;
        seen.across_m = on_slope(view.across_m, direction, up);
        seen.along_m = on_slope(view.along_m, direction, up);
        seen.box = box_of(*detail_, hit_m - on_slope(offset_m, direction, up), direction, seen.across_m, seen.along_m);
    }
}

FireDetail::Spacing PartTracer::pixel_spacing() const {
    GroundBox pixel = seen_.front().box;
    double total_m2 = 0.0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        widen(pixel, seen_[i].box);
        total_m2 += area_m2(views_[i].across_m, views_[i].along_m);
    }
    return detail_->spacing(pixel, total_m2);
}

void PartTracer::trace(int sample, Pixel& pixel) {
    const int n = request_->parts_per_axis, deepest = request_->part_levels;
    list_base(n, parts_);
    look(sample, pixel);
    const FireDetail::Spacing spacing = pixel_spacing();
    while (!parts_.empty()) {
        finer_.clear();
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const PixelPart& part = parts_[i];
            const Seen& seen = seen_[i];
            const double wanted_m = detail_->spacing_within_m(seen.box, spacing);
            const bool along_line = part.level_u < deepest && width_m(seen.across_m) > kHalved * wanted_m;
            const bool across_lines = part.level_v < deepest && width_m(seen.along_m) > kHalved * wanted_m;
            if (along_line || across_lines) {
                split(part, along_line, across_lines);
            } else if (seen.met) {
                const auto base =
                    static_cast<std::size_t>((part.index_v >> part.level_v) * n + (part.index_u >> part.level_u));
                pixel.add(seen.ray, *seen.met, std::ldexp(request_->ray_weight[base], -part.level_u - part.level_v));
            }
        }
        parts_.swap(finer_);
        look(sample, pixel);
    }
}

bool PartTracer::shares_are_wide(int sample) {
    list_base(request_->parts_per_axis, parts_);
    views_.resize(parts_.size());
    parts_of_line_(sample, parts_, views_);
    double total_m2 = 0.0, widest_m = 0.0;
    for (const PartView& view : views_) {
        total_m2 += area_m2(view.across_m, view.along_m);
        widest_m = std::max({widest_m, width_m(view.across_m), width_m(view.along_m)});
    }
    return widest_m > kHalved * detail_->finest_spacing_m(total_m2);
}

bool PartTracer::begin(int line, int first_sample, int end_sample) {
    line_ = line;
    parts_of_line_ = request_->parts(line);
    return shares_are_wide(first_sample) || shares_are_wide((first_sample + end_sample) / 2) ||
           shares_are_wide(end_sample - 1);
}

}  // namespace pyroscene::render
