#include "render/receiver_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"

namespace pyroscene::render {
namespace {

constexpr double kPlanckResolution = 0.5;
constexpr float kSamePosition = 0.3F;  ///< neighbours closer than this in the Planck table are one piece of flame
constexpr int kPointsNearFlame = 8;
constexpr int kPlanesNearFlame = 4;  ///< a point near flame has this many times fewer planes
constexpr int kLeastPlanes = 4;      ///< through a flame however narrow it looks
constexpr int kLeastStrata = 4;
constexpr double kStrataPerHemisphere = 24.0;
constexpr double kOpaqueDepth = 9.0;

/// Monotone stand-in for the azimuth of (dx, dy), 0 <= p < 4: the quadrant and the place in it. Spares the arc tangent.
double diamond_angle(double dx, double dy) noexcept {
    if (dy >= 0.0) return dx >= 0.0 ? (dx + dy > 0.0 ? dy / (dx + dy) : 0.0) : 1.0 - dx / (dy - dx);
    return dx < 0.0 ? 2.0 - dy / (-dx - dy) : 3.0 + dx / (dx - dy);
}

double azimuth_of_diamond(double p) noexcept {
    const double quadrant = std::floor(p), f = p - quadrant;
    return quadrant * kPi / 2.0 + std::atan2(f, 1.0 - f);
}

/// sin^2 of the elevation with the sign of the elevation: strata even in it are even in irradiance on flat ground.
double elevation_measure(double slope) noexcept {
    return std::isinf(slope) ? std::copysign(1.0, slope) : slope * std::abs(slope) / (1.0 + slope * slope);
}
double slope_of_measure(double v) noexcept {
    return std::copysign(std::sqrt(std::abs(v) / std::max(1.0 - std::abs(v), 1e-12)), v);
}

PlanckRows coarse_planck(const RenderScene& scene) {
    const auto [low, high] = scene.flame->temperature_range_K();
    const std::array<double, 1> only{high};
    const int stride = padded(scene.optics->lambda_count);
    return {
        scene.optics->lambda_um, stride, low, high, low == high ? std::span<const double>(only) : std::span<const double>(),
        kPlanckResolution};
}

}  // namespace

LightScene::LightScene(const RenderScene& s, const GroundLightSettings& g)
    : scene(s), settings(g), planck(coarse_planck(s)), nodes(s.optics->flame_absorption_per_m), flame(*s.flame, planck) {
    least_k_per_m = *std::min_element(nodes.k_per_m().begin(), nodes.k_per_m().end());
    const auto [low, high] = s.terrain->height_range_m();
    rough = high - low > 1e-3;
}

double PlaneWeight::below(double slope) const noexcept {
    if (std::isinf(slope)) return slope > 0.0 ? along * kPi / 4.0 + up / 2.0 : -along * kPi / 4.0 + up / 2.0;
    const double cos2 = 1.0 / (1.0 + slope * slope);
    const double flat = 0.5 * up * slope * slope * cos2;
    return along == 0.0 ? flat : flat + 0.5 * along * (std::atan(slope) + slope * cos2);
}

double skyline_slope(const TerrainMesh& terrain, Vec3 from_m, double dx, double dy, double reach_m) noexcept {
    const double step_m = terrain.grid().cell_m;
    double slope = -std::numeric_limits<double>::infinity();
    for (double r = step_m; r <= reach_m; r += step_m) {
        const double h = terrain.height_at(from_m.x + r * dx, from_m.y + r * dy);
        if (!(h > -1e9)) break;  // left the raster
        slope = std::max(slope, (h - from_m.z) / r);
    }
    return slope;
}

ReceiverLight::ReceiverLight(const LightScene& shared)
    : shared_(&shared),
      kernels_(&spectral_kernels()),
      tau_(static_cast<std::size_t>(shared.nodes.padded_count())),
      emitted_(static_cast<std::size_t>(shared.planck.row_count()) * tau_.size()) {}

bool ReceiverLight::is_near_flame(const Receiver& receiver) const {
    const FlamePlanes& flame = shared_->flame;
    const double cell_m = shared_->scene.terrain->grid().cell_m;
    const auto near = [&](const FlamePlanes::Box& box) {
        return box.squared_gap_m2(receiver.x_m, receiver.y_m, 0.5 * cell_m) < cell_m * cell_m;
    };
    for (std::size_t b = 0; b < flame.boxes().size(); ++b) {
        if (!near(flame.boxes()[b])) continue;
        const auto first = flame.parts().begin() + static_cast<std::ptrdiff_t>(flame.first_part(b));
        const auto end = flame.parts().begin() + static_cast<std::ptrdiff_t>(flame.first_part(b + 1));
        if (std::any_of(first, end, near)) return true;
    }
    return false;
}

/// Adds the azimuths of a box seen from a point; true when the point lies in the box.
bool ReceiverLight::add_arc(const FlamePlanes::Box& box, double x_m, double y_m) {
    const double west = box.west_m - x_m, east = box.east_m - x_m, south = box.south_m - y_m, north = box.north_m - y_m;
    if (west <= 0.0 && east >= 0.0 && south <= 0.0 && north >= 0.0) return true;
    // The two corners of the silhouette, counter-clockwise, by the side of the box that the point lies on.
    const bool left = east<0.0, right = west> 0.0, below = north<0.0, above = south> 0.0;
    const double first_x = below ? west : above ? east : left ? east : west;
    const double first_y = left ? north : right ? south : below ? north : south;
    const double last_x = below ? east : above ? west : left ? east : west;
    const double last_y = left ? south : right ? north : below ? north : south;
    const double begin = diamond_angle(first_x, first_y);
    double end = diamond_angle(last_x, last_y);
    if (end < begin) end += 4.0;
    arcs_.push_back({begin, end});
    return false;
}

/// Azimuths in which any flame within reach stands. Boxes nearer than their own size are resolved into their parts.
void ReceiverLight::find_arcs(double x_m, double y_m) {
    const FlamePlanes& flame = shared_->flame;
    const double reach2_m2 = shared_->settings.reach_m * shared_->settings.reach_m;
    arcs_.clear();
    for (std::size_t b = 0; b < flame.boxes().size(); ++b) {
        const FlamePlanes::Box& box = flame.boxes()[b];
        const double gap2_m2 = box.squared_gap_m2(x_m, y_m, 0.0);
        if (gap2_m2 > reach2_m2) continue;
        const double size_m = std::max(box.east_m - box.west_m, box.north_m - box.south_m);
        if (gap2_m2 > size_m * size_m) {
            add_arc(box, x_m, y_m);
            continue;
        }
        for (std::size_t p = flame.first_part(b); p < flame.first_part(b + 1); ++p) {
            if (!add_arc(flame.parts()[p], x_m, y_m)) continue;
            arcs_.assign(1, {0.0, 4.0});
            return;
        }
    }
    merge_arcs();
}

/// Sorts the arcs and joins those that overlap, also around the zero of the circle.
void ReceiverLight::merge_arcs() {
    if (arcs_.empty()) return;
    std::sort(arcs_.begin(), arcs_.end(), [](Arc a, Arc b) { return a.begin < b.begin; });
    std::size_t count = 1;
    for (std::size_t i = 1; i < arcs_.size(); ++i) {
        Arc& last = arcs_[count - 1];
        if (arcs_[i].begin <= last.end)
            last.end = std::max(last.end, arcs_[i].end);
        else
            arcs_[count++] = arcs_[i];
    }
    // Arcs that run over the zero swallow the first ones.
    std::size_t first = 0;
    while (first + 1 < count && arcs_[count - 1].end - 4.0 >= arcs_[first].begin) {
        arcs_[count - 1].end = std::max(arcs_[count - 1].end, arcs_[first].end + 4.0);
        ++first;
    }
    arcs_.resize(count);
    arcs_.erase(arcs_.begin(), arcs_.begin() + static_cast<std::ptrdiff_t>(first));
    if (arcs_.back().end - arcs_.back().begin >= 4.0) arcs_.assign(1, {0.0, 4.0});
}

void ReceiverLight::compute(const Receiver& receiver) {
    std::fill(emitted_.begin(), emitted_.end(), 0.0F);
    if (!is_near_flame(receiver)) {
        compute_point(receiver.x_m, receiver.y_m, receiver, shared_->settings.directions, 1.0);
        return;
    }
    const double cell_m = shared_->scene.terrain->grid().cell_m;
    for (int p = 0; p < kPointsNearFlame; ++p) {
        // Additive recurrence with the plastic number (Roberts 2018): even over the cell.
        const double u = 0.5 + 0.7548776662466927 * p, v = 0.5 + 0.5698402909980532 * p;
        compute_point(receiver.x_m + (u - std::floor(u) - 0.5) * cell_m, receiver.y_m + (v - std::floor(v) - 0.5) * cell_m,
                      receiver, std::max(4, shared_->settings.directions / kPlanesNearFlame), 1.0 / kPointsNearFlame);
    }
}

void ReceiverLight::compute_point(double x_m, double y_m, const Receiver& receiver, int planes_around, double weight) {
    find_arcs(x_m, y_m);
    const Vec3 from{x_m, y_m, shared_->scene.terrain->height_at(x_m, y_m)};
    for (const Arc arc : arcs_) {
        const double begin = azimuth_of_diamond(arc.begin), end = azimuth_of_diamond(arc.end);
        const int planes =
            std::max(kLeastPlanes, static_cast<int>(std::ceil((end - begin) / (2.0 * kPi) * planes_around - 1e-9)));
        const double width = (end - begin) / planes;
        for (int p = 0; p < planes; ++p) trace_plane(from, receiver, begin + (p + 0.5) * width, weight * width);
    }
}

void ReceiverLight::trace_plane(Vec3 from_m, const Receiver& receiver, double azimuth, double weight) {
    const double dx = std::cos(azimuth), dy = std::sin(azimuth);
    columns_.clear();
    shared_->flame.cross(from_m.x, from_m.y, dx, dy, shared_->settings.reach_m, columns_);
    if (columns_.empty()) return;
    if (shared_->rough) find_horizons(from_m, dx, dy);

    const PlaneWeight plane{receiver.normal.x * dx + receiver.normal.y * dy, receiver.normal.z};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const PlaneColumn& c : columns_) {
        const double bottom_m = shared_->flame.bottom_m() + c.k_begin * shared_->flame.dz_m() - from_m.z;
        const double top_m = shared_->flame.bottom_m() + c.k_end * shared_->flame.dz_m() - from_m.z;
        const auto slope = [](double height_m, double run_m) {
            return run_m > 0.0F ? height_m / run_m : std::copysign(std::numeric_limits<double>::infinity(), height_m);
        };
        high = std::max(high, slope(top_m, top_m > 0.0 ? c.enter_m : c.leave_m));
        low =
            std::min(low, std::max(slope(bottom_m, bottom_m > 0.0 ? c.leave_m : c.enter_m), static_cast<double>(c.horizon)));
    }
    low = std::max(low, plane.lowest_slope());
    if (!(low < high)) return;

    const double v_low = elevation_measure(low), v_high = elevation_measure(high);
    const int strata = std::max(kLeastStrata, static_cast<int>(std::ceil((v_high - v_low) * kStrataPerHemisphere)));
    double below = plane.below(low);
    for (int s = 0; s < strata; ++s) {
        const double v_top = v_low + (v_high - v_low) * (s + 1) / strata;
        const double up_to = plane.below(s + 1 == strata ? high : slope_of_measure(v_top));
        trace_stratum(from_m.z, slope_of_measure(v_top - 0.5 * (v_high - v_low) / strata), weight * (up_to - below));
        below = up_to;
    }
}

/// Notes for each column how steep a line of sight must be to pass the terrain in front of it.
void ReceiverLight::find_horizons(Vec3 from_m, double dx, double dy) {
    const TerrainMesh& terrain = *shared_->scene.terrain;
    const double step_m = terrain.grid().cell_m;
    double slope = -std::numeric_limits<double>::infinity(), r = step_m;
    for (PlaneColumn& column : columns_) {
        for (; r < column.enter_m; r += step_m) {
            const double h = terrain.height_at(from_m.x + r * dx, from_m.y + r * dy);
            if (h > -1e9) slope = std::max(slope, (h - from_m.z) / r);
        }
        column.horizon = static_cast<float>(slope);
    }
}

void ReceiverLight::trace_stratum(double z_m, double slope, double weight) {
    const FlamePlanes& flame = shared_->flame;
    const auto start = static_cast<float>((z_m - flame.bottom_m()) / flame.dz_m()),
               rise = static_cast<float>(slope / flame.dz_m());
    const auto stretch = static_cast<float>(std::sqrt(1.0 + slope * slope)), w = static_cast<float>(weight);
    const float run_per_voxel = rise != 0.0F ? 1.0F / std::abs(rise) : std::numeric_limits<float>::infinity();
    const auto opaque_m = static_cast<float>(kOpaqueDepth / shared_->least_k_per_m);
    std::fill(tau_.begin(), tau_.end(), 1.0F);
    float depth_m = 0.0F, total_m = 0.0F, position = 0.0F;
    for (const PlaneColumn& c : columns_) {
        if (slope <= static_cast<double>(c.horizon) || total_m > opaque_m) break;
        const float z_in = start + rise * c.enter_m, z_out = start + rise * c.leave_m;
        const auto k_begin = static_cast<float>(c.k_begin), k_end = static_cast<float>(c.k_end);
        if (std::max(z_in, z_out) <= k_begin || std::min(z_in, z_out) >= k_end) continue;
        // Part of the crossing between the column's lowest and highest flame, then voxel by voxel.
        float r = c.enter_m;
        const float wall = rise > 0.0F ? k_begin : k_end;
        if (rise > 0.0F ? z_in < k_begin : z_in > k_end) r += std::abs(wall - z_in) * run_per_voxel;
        int k = std::clamp(static_cast<int>(start + rise * r), c.k_begin, c.k_end - 1);
        while (r < c.leave_m) {
            const float edge = static_cast<float>(rise > 0.0F ? k + 1 : k);
            const float until = std::min(c.leave_m, c.enter_m + std::abs(edge - z_in) * run_per_voxel);
            const std::size_t voxel = FlamePlanes::voxel(c.first_voxel, k);
            const float fill = flame.fill(voxel);
            if (fill > 0.0F && until > r) {
                const float length_m = fill * (until - r) * stretch;
                const float here = flame.planck_position(voxel);
                if (depth_m > 0.0F && std::abs(here - position) > kSamePosition) {
                    flush(depth_m, position, w);
                    depth_m = 0.0F;
                }
                depth_m += length_m;
                position = depth_m > length_m ? position + (here - position) * length_m / depth_m : here;
                total_m += length_m;
            }
            r = std::max(r, until);
            k += rise > 0.0F ? 1 : -1;
            if (k < c.k_begin || k >= c.k_end) break;
        }
    }
    if (depth_m > 0.0F) flush(depth_m, position, w);
}

void ReceiverLight::flush(float depth_m, float planck_position, float weight) {
    const PlanckRows::Lookup found = shared_->planck.at_position(planck_position);
    const int nodes = shared_->nodes.padded_count();
    kernels_->emit_weights(nodes, shared_->nodes.k_per_m().data(), depth_m, found.count, found.weight.data(), weight,
                           tau_.data(), emitted_.data() + static_cast<std::ptrdiff_t>(found.row) * nodes);
}

}  // namespace pyroscene::render
