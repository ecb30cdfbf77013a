#include "render/receiver_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"

namespace pyroscene::render {
namespace {

constexpr double kPlanckResolution = 0.5;
constexpr int kAzimuthBins = 512;
constexpr int kLeastPlanes = 4;  ///< through a flame however narrow it looks
constexpr int kLeastStrata = 3;
constexpr double kStrataPerHemisphere = 24.0;
constexpr double kOpaqueDepth = 14.0;

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
      azimuth_marked_(kAzimuthBins, 0),
      tau_(static_cast<std::size_t>(shared.nodes.padded_count())),
      emitted_(static_cast<std::size_t>(shared.planck.row_count()) * tau_.size()) {}

/// Marks the azimuths in which any flame within reach stands, seen from anywhere in the cell.
void ReceiverLight::mark_azimuths(const Receiver& receiver) {
    std::fill(azimuth_marked_.begin(), azimuth_marked_.end(), 0);
    const double half_m = 0.5 * shared_->scene.terrain->grid().cell_m, reach_m = shared_->settings.reach_m;
    constexpr double kBinsPerUnit = kAzimuthBins / 4.0;
    for (const FlamePlanes::Box& box : shared_->flame.boxes()) {
        const double west = box.west_m - receiver.x_m - half_m, east = box.east_m - receiver.x_m + half_m;
        const double south = box.south_m - receiver.y_m - half_m, north = box.north_m - receiver.y_m + half_m;
        const double gap_x = std::max({west, -east, 0.0}), gap_y = std::max({south, -north, 0.0});
        if (gap_x * gap_x + gap_y * gap_y > reach_m * reach_m) continue;
        if (gap_x == 0.0 && gap_y == 0.0) {
            std::fill(azimuth_marked_.begin(), azimuth_marked_.end(), 1);
            return;
        }
        const double middle = diamond_angle(0.5 * (west + east), 0.5 * (south + north));
        double below = 0.0, above = 0.0;
        const auto extend = [&](double dx, double dy) {
            double off = diamond_angle(dx, dy) - middle;
            off = off > 2.0 ? off - 4.0 : off < -2.0 ? off + 4.0 : off;
            below = std::min(below, off);
            above = std::max(above, off);
        };
        extend(west, south), extend(west, north), extend(east, south), extend(east, north);
        const int first = static_cast<int>(std::floor((middle + below) * kBinsPerUnit));
        const int last = static_cast<int>(std::floor((middle + above) * kBinsPerUnit));
        for (int b = first; b <= last; ++b) azimuth_marked_[static_cast<std::size_t>((b + kAzimuthBins) % kAzimuthBins)] = 1;
    }
}

void ReceiverLight::compute(const Receiver& receiver) {
    std::fill(emitted_.begin(), emitted_.end(), 0.0F);
    mark_azimuths(receiver);
    const double finest = 2.0 * kPi / shared_->settings.directions;
    int index = 0;
    const auto trace_arc = [&](int first_bin, int end_bin, int least_planes) {
        const double begin = azimuth_of_diamond(first_bin * 4.0 / kAzimuthBins),
                     end = azimuth_of_diamond(end_bin * 4.0 / kAzimuthBins);
        const int planes = std::max(least_planes, static_cast<int>(std::ceil((end - begin) / finest - 1e-9)));
        const double width = (end - begin) / planes;
        for (int p = 0; p < planes; ++p) trace_plane(receiver, begin + (p + 0.5) * width, width, index++);
    };
    const auto marked = [&](int bin) { return azimuth_marked_[static_cast<std::size_t>(bin % kAzimuthBins)] != 0; };
    int start = 0;
    while (start < kAzimuthBins && marked(start)) ++start;
    if (start == kAzimuthBins) {
        trace_arc(0, kAzimuthBins, kLeastPlanes);
        return;
    }
    for (int bin = start; bin < start + kAzimuthBins;) {  // begins in a gap: no arc is cut at bin 0
        if (!marked(bin)) {
            ++bin;
            continue;
        }
        int end = bin;
        while (marked(end)) ++end;
        trace_arc(bin, end, kLeastPlanes);
        bin = end;
    }
}

void ReceiverLight::trace_plane(const Receiver& receiver, double azimuth, double width, int index) {
    const TerrainMesh& terrain = *shared_->scene.terrain;
    const double dx = std::cos(azimuth), dy = std::sin(azimuth), cell_m = terrain.grid().cell_m;
    // Additive recurrence with the plastic number (Roberts 2018): even over the cell for any number of planes.
    const double u = 0.5 + 0.7548776662466927 * index, v = 0.5 + 0.5698402909980532 * index;
    const double x_m = receiver.x_m + (u - std::floor(u) - 0.5) * cell_m,
                 y_m = receiver.y_m + (v - std::floor(v) - 0.5) * cell_m;
    columns_.clear();
    shared_->flame.cross(x_m, y_m, dx, dy, shared_->settings.reach_m, columns_);
    if (columns_.empty()) return;
    const double z_m = terrain.height_at(x_m, y_m);
    if (shared_->rough) find_horizons(x_m, y_m, z_m, dx, dy);

    const PlaneWeight plane{receiver.normal.x * dx + receiver.normal.y * dy, receiver.normal.z};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const PlaneColumn& c : columns_) {
        const double bottom_m = shared_->flame.bottom_m() + c.k_begin * shared_->flame.dz_m() - z_m;
        const double top_m = shared_->flame.bottom_m() + c.k_end * shared_->flame.dz_m() - z_m;
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
        trace_stratum(z_m, slope_of_measure(v_top - 0.5 * (v_high - v_low) / strata), width * (up_to - below));
        below = up_to;
    }
}

/// Notes for each column how steep a line of sight must be to pass the terrain in front of it.
void ReceiverLight::find_horizons(double x_m, double y_m, double z_m, double dx, double dy) {
    const TerrainMesh& terrain = *shared_->scene.terrain;
    const double step_m = terrain.grid().cell_m;
    double slope = -std::numeric_limits<double>::infinity(), r = step_m;
    for (PlaneColumn& column : columns_) {
        for (; r < column.enter_m; r += step_m) {
            const double h = terrain.height_at(x_m + r * dx, y_m + r * dy);
            if (h > -1e9) slope = std::max(slope, (h - z_m) / r);
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
                if (flame.planck_position(voxel) != position && depth_m > 0.0F) {
                    flush(depth_m, position, w);
                    depth_m = 0.0F;
                }
                position = flame.planck_position(voxel);
                depth_m += length_m;
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
