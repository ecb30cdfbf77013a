#include "render/receiver_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/constants.h"
#include "base/random.h"

namespace pyroscene::render {
namespace {

constexpr double kPointsPerDirection = 0.75;    ///< in a cell near flame
constexpr int kLeastPlanes = 8;                 ///< through each arc with flame
constexpr double kCompact = 0.3;                ///< share of the circle below which flame is looked for by its arcs
constexpr double kGolden = 0.6180339887498949;  ///< steps of it, modulo 1, spread evenly however many there are
constexpr int kStrata = PlaneTrace::kLanes;
constexpr float kLeastSlope = 1e-6F;
constexpr double kOpaqueDepth = 9.0;

double fraction_of(double x) noexcept { return x - std::floor(x); }

/// Monotone stand-in for the azimuth of (dx, dy), 0 <= p < 4: the quadrant and the place in it. Spares the arc tangent.
double diamond_angle(double dx, double dy) noexcept {
    if (dy >= 0.0) return dx >= 0.0 ? (dx + dy > 0.0 ? dy / (dx + dy) : 0.0) : 1.0 - dx / (dy - dx);
    return dx < 0.0 ? 2.0 - dy / (-dx - dy) : 3.0 + dx / (dx - dy);
}

/// From `direction` (1 or -1) along the circle to the next corner of a box seen from a point, in diamond angle. The box's
/// depth grows from nothing at the edge of its silhouette to that corner.
double to_next_corner(const FlameColumns::Box& box, double x_m, double y_m, double from, double direction) noexcept {
    double least = 4.0;
    for (const double corner_x : {box.west_m, box.east_m}) {
        for (const double corner_y : {box.south_m, box.north_m}) {
            const double turn = direction * (diamond_angle(corner_x - x_m, corner_y - y_m) - from);
            const double away = 4.0 * fraction_of(turn / 4.0);
            if (away > 1e-9) least = std::min(least, away);
        }
    }
    return least;
}

double azimuth_of_diamond(double p) noexcept {
    const double quadrant = std::floor(p), f = p - quadrant;
    return quadrant * kPi / 2.0 + std::atan2(f, 1.0 - f);
}

/// Elevations of a plane by how much light they send to the receiver. With phi the angle above the receiver's own surface, whose
/// slope is `lowest`, light of even radiance falls in as cos(e) dq, q = 1 - cos(phi). The cosine is taken to be linear in q between
/// the ends, as it is on level ground (then equal shares are equal in sin^2 e).
class EvenElevations {
public:
    EvenElevations(double lowest, double low, double high) noexcept
        : lowest_(lowest),
          first_(measure(low)),
          step_(measure(high) - first_),
          at_low_(cosine(low)),
          at_high_(cosine(high)) {}
    /// Slope below which lies this share (0 to 1) of the light between the ends.
    [[nodiscard]] double slope_at(double share) const noexcept {
        const double cosine = std::sqrt(at_low_ * at_low_ + share * (at_high_ * at_high_ - at_low_ * at_low_));
        const double q = first_ + step_ * share * (at_low_ + at_high_) / (at_low_ + cosine);
        const double cos_phi = 1.0 - q, sin_phi = std::sqrt(std::max(q * (2.0 - q), 0.0));
        return (lowest_ * cos_phi + sin_phi) / std::max(cos_phi - lowest_ * sin_phi, 1e-6);
    }

private:
    [[nodiscard]] double measure(double slope) const noexcept {
        const double own = 1.0 / std::sqrt(1.0 + lowest_ * lowest_), there = cosine(slope);
        const double sine = std::isinf(slope) ? 1.0 : slope * there;
        const double cos_phi = own * (there + lowest_ * sine), sin_phi = own * (sine - lowest_ * there);
        return sin_phi * sin_phi / (1.0 + cos_phi);
    }
    static double cosine(double slope) noexcept { return 1.0 / std::sqrt(1.0 + slope * slope); }

    double lowest_, first_, step_, at_low_, at_high_;
};

/// Gas at the emission-weighted mean temperature of all flame: exact for flame of one temperature.
AbsorptionNodes absorption_nodes(const RenderScene& scene) {
    const SceneOptics& optics = *scene.optics;
    if (!optics.flame_tables || optics.grey || scene.flame->empty()) return AbsorptionNodes(optics.flame_absorption_per_m);
    const double T_K = scene.flame->emission_mean_temperature_K();
    std::vector<std::vector<radiometry::AbsorptionPart>> mixes;
    for (const double lambda_um : optics.lambda_um)
        mixes.push_back(radiometry::absorption_mix(*optics.flame_tables, optics.flame_gas, lambda_um, T_K));
    return AbsorptionNodes(mixes);
}

PlanckSeries planck_series(const RenderScene& scene) {
    const auto [low, high] = scene.flame->temperature_range_K();
    return {scene.optics->lambda_um, padded(scene.optics->lambda_count), low, high};
}

}  // namespace

LightScene::LightScene(const RenderScene& s, const GroundLightSettings& g)
    : scene(s), settings(g), planck(planck_series(s)), nodes(absorption_nodes(s)), flame(*s.flame) {
    voxels.reserve(s.flame->bricks.size() * fire::FlameField::kBrickVoxels * 2);
    for (const auto& brick : s.flame->bricks) {
        for (std::size_t v = 0; v < brick.fill.size(); ++v) {
            voxels.push_back(brick.fill[v]);
            voxels.push_back(brick.fill[v] > 0.0F ? static_cast<float>(planck.reduced(brick.temperature_K[v])) : 0.0F);
        }
    }
    const auto [low, high] = s.terrain->height_range_m();
    rough = high - low > 1e-3;
}

ReceiverLight::ReceiverLight(const LightScene& shared)
    : shared_(&shared),
      kernels_(&spectral_kernels()),
      emitted_(static_cast<std::size_t>(shared.nodes.count()) * static_cast<std::size_t>(shared.planck.moments())) {
    sums_.resize(emitted_.size() * kStrata);
    hottest_.resize(static_cast<std::size_t>(shared.nodes.count()) * kStrata);
}

bool ReceiverLight::is_near_flame(const Receiver& receiver) const {
    const FlameColumns& flame = shared_->flame;
    const double cell_m = shared_->scene.terrain->grid().cell_m;
    const auto near = [&](const FlameColumns::Box& box) {
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
bool ReceiverLight::add_arc(const FlameColumns::Box& box, double x_m, double y_m) {
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
    arcs_.push_back({begin, end, &box, &box});
    return false;
}

/// Azimuths in which any flame within reach stands. Boxes nearer than their own size are resolved into their parts.
void ReceiverLight::find_arcs(double x_m, double y_m) {
    const FlameColumns& flame = shared_->flame;
    const double reach2_m2 = shared_->settings.reach_m * shared_->settings.reach_m;
    arcs_.clear();
    for (std::size_t b = 0; b < flame.boxes().size(); ++b) {
        const FlameColumns::Box& box = flame.boxes()[b];
        const double gap2_m2 = box.squared_gap_m2(x_m, y_m, 0.0);
        if (gap2_m2 > reach2_m2) continue;
        const double size_m = std::max(box.east_m - box.west_m, box.north_m - box.south_m);
        if (gap2_m2 > size_m * size_m) {
            add_arc(box, x_m, y_m);
            continue;
        }
        for (std::size_t p = flame.first_part(b); p < flame.first_part(b + 1); ++p) {
            if (!add_arc(flame.parts()[p], x_m, y_m)) continue;
            arcs_.assign(1, kCircle);
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
            last.reach(arcs_[i].end, arcs_[i].last);
        else
            arcs_[count++] = arcs_[i];
    }
    // Arcs that run over the zero swallow the first ones.
    std::size_t first = 0;
    while (first + 1 < count && arcs_[count - 1].end - 4.0 >= arcs_[first].begin) {
        arcs_[count - 1].reach(arcs_[first].end + 4.0, arcs_[first].last);
        ++first;
    }
    arcs_.resize(count);
    arcs_.erase(arcs_.begin(), arcs_.begin() + static_cast<std::ptrdiff_t>(first));
    if (arcs_.back().end - arcs_.back().begin >= 4.0) arcs_.assign(1, kCircle);
}

void ReceiverLight::compute(const Receiver& receiver) {
    std::fill(sums_.begin(), sums_.end(), 0.0F);
    std::fill(hottest_.begin(), hottest_.end(), 0.0F);
    if (is_near_flame(receiver))
        compute_cell(receiver);
    else
        compute_centre(receiver);
    const auto over_strata = [](const std::vector<float>& sums, std::size_t i) {
        float sum = 0.0F;
        for (int s = 0; s < kStrata; ++s) sum += sums[i * kStrata + static_cast<std::size_t>(s)];
        return sum;
    };
    const auto moments = static_cast<std::size_t>(shared_->planck.moments());
    for (std::size_t i = 0; i < emitted_.size(); ++i) {
        const float hottest = over_strata(hottest_, i / moments);
        emitted_[i] = over_strata(sums_, i) + (i % moments % 2 == 0 ? hottest : -hottest);
    }
}

/// Beside a flame irradiance varies within the cell far more than with azimuth: many points, each with two planes, through
/// the whole circle or through each arc where flame fills little of it. Additive recurrences spread points (plastic number, Roberts 2018) and azimuths (golden ratio) evenly; every cell
/// starts them elsewhere, so that cells do not err alike where the flame's voxels repeat with the cells.
void ReceiverLight::compute_cell(const Receiver& receiver) {
    static const std::uint32_t kStream = stream_id("light near flame");
    const RandomKey key{.stream = kStream};
    const double cell_m = shared_->scene.terrain->grid().cell_m;
    const int points = std::max(8, static_cast<int>(kPointsPerDirection * shared_->settings.directions));
    find_arcs(receiver.x_m, receiver.y_m);
    double covered = 0.0;
    for (const Arc& arc : arcs_) covered += 0.25 * (arc.end - arc.begin);
    const bool compact = covered < kCompact;
    if (!compact) arcs_.assign(1, kCircle);
    const auto place = [&](std::uint32_t axis, double step, int p) {
        return fraction_of(uniform01(key, receiver.cell, axis) + step * p);
    };
    for (int p = 0; p < points; ++p) {
        const double x_m = receiver.x_m + (place(0, 0.7548776662466927, p) - 0.5) * cell_m;
        const double y_m = receiver.y_m + (place(1, 0.5698402909980532, p) - 0.5) * cell_m;
        const Vec3 from{x_m, y_m, shared_->scene.terrain->height_at(x_m, y_m)};
        if (compact) find_arcs(x_m, y_m);
        for (const Arc& arc : arcs_) {
            const double begin = azimuth_of_diamond(arc.begin), half = 0.5 * (azimuth_of_diamond(arc.end) - begin);
            const double azimuth = begin + half * place(2, kGolden, p);
            const double in_stratum = place(3, std::numbers::sqrt2, p);
            trace_plane(from, receiver, azimuth, half / points, in_stratum);
            trace_plane(from, receiver, azimuth + half, half / points, 1.0 - in_stratum);
        }
    }
}

void ReceiverLight::compute_centre(const Receiver& receiver) {
    const double x_m = receiver.x_m, y_m = receiver.y_m;
    find_arcs(x_m, y_m);
    // As dense as all directions around the circle, but at least a quarter of them for all flame together.
    double covered_rad = 0.0;
    for (const Arc& arc : arcs_) covered_rad += azimuth_of_diamond(arc.end) - azimuth_of_diamond(arc.begin);
    const double planes_per_rad = shared_->settings.directions / std::min(2.0 * kPi, 4.0 * covered_rad);
    const Vec3 from{x_m, y_m, shared_->scene.terrain->height_at(x_m, y_m)};
    for (const Arc& arc : arcs_) {
        // The flame's depth grows at the edges of the arc: these parts get planes of their own, or narrow ones would be missed.
        std::array<double, 4> cut{arc.begin, arc.begin, arc.end, arc.end};
        if (arc.first != nullptr) {
            cut[1] = std::min(arc.begin + to_next_corner(*arc.first, x_m, y_m, arc.begin, 1.0), arc.end);
            cut[2] = std::max(arc.end - to_next_corner(*arc.last, x_m, y_m, arc.end, -1.0), arc.begin);
            if (cut[1] > cut[2]) std::swap(cut[1], cut[2]);
        }
        for (double& c : cut) c = azimuth_of_diamond(c);
        const double all = cut[3] - cut[0];
        const int planes = std::max(kLeastPlanes, static_cast<int>(std::ceil(all * planes_per_rad - 1e-9)));
        const auto share = [&](double width) {
            return width > 0.0 ? std::max(1, static_cast<int>(std::lround(width / all * planes))) : 0;
        };
        const int first = share(cut[1] - cut[0]), last = share(cut[3] - cut[2]);
        trace_planes(from, receiver, cut[0], cut[1], first);
        trace_planes(from, receiver, cut[1], cut[2], cut[2] > cut[1] ? std::max(1, planes - first - last) : 0);
        trace_planes(from, receiver, cut[2], cut[3], last);
    }
}

/// Planes through the middles of equal parts of a range of azimuths. Those at equal distances from its middle look at places of
/// their strata that mirror each other; together they see each stratum at as many places as there are planes.
void ReceiverLight::trace_planes(Vec3 from_m, const Receiver& receiver, double begin, double end, int count) {
    const double width = (end - begin) / count;
    for (int p = 0; p < count; ++p) {
        const double from_middle = p + 0.5 - 0.5 * count;
        trace_plane(from_m, receiver, begin + (p + 0.5) * width, width, fraction_of(0.5 + kGolden * from_middle));
    }
}

void ReceiverLight::trace_plane(Vec3 from_m, const Receiver& receiver, double azimuth, double weight, double in_stratum) {
    const double dx = std::cos(azimuth), dy = std::sin(azimuth);
    cross_columns(from_m, dx, dy);
    if (columns_.empty()) return;
    if (shared_->rough) find_horizons(from_m, dx, dy);
    const PlaneWeight plane{receiver.normal.x * dx + receiver.normal.y * dy, receiver.normal.z};
    double low = plane.lowest_slope(), high = 0.0;
    if (!slopes_of_flame(from_m, low, high)) return;

    alignas(32) std::array<float, kStrata> slopes{}, weights{};
    const EvenElevations elevations(plane.lowest_slope(), low, high);
    double below = plane.below(low);
    for (int s = 0; s < kStrata; ++s) {
        const auto i = static_cast<std::size_t>(s);
        const double up_to = plane.below(s + 1 == kStrata ? high : elevations.slope_at((s + 1.0) / kStrata));
        const auto slope = static_cast<float>(elevations.slope_at((s + in_stratum) / kStrata));
        slopes[i] = std::abs(slope) < kLeastSlope ? kLeastSlope : slope;
        weights[i] = static_cast<float>(weight * (up_to - below));
        below = up_to;
    }
    PlaneTrace trace;
    trace.columns = columns_.data();
    trace.column_count = static_cast<int>(columns_.size());
    trace.voxels = shared_->voxels.data();
    trace.slope = slopes.data();
    trace.weight = weights.data();
    const fire::VoxelGrid& grid = shared_->flame.grid();
    trace.receiver_height = static_cast<float>((from_m.z - grid.corner_m.z) / grid.dz_m);
    trace.voxels_per_m = static_cast<float>(1.0 / grid.dz_m);
    trace.k_per_m = shared_->nodes.k_per_m().data();
    trace.nodes = shared_->nodes.count();
    trace.moments = shared_->planck.moments();
    trace.opaque_m = static_cast<float>(kOpaqueDepth) / shared_->nodes.k_per_m().front();
    trace.sums = sums_.data();
    trace.hottest = hottest_.data();
    kernels_->trace_plane(trace);
}

/// Columns with flame on the horizontal ray from a point, near to far, within reach.
void ReceiverLight::cross_columns(Vec3 from_m, double dx, double dy) {
    columns_.clear();
    const fire::VoxelGrid& grid = shared_->flame.grid();
    const double reach_m = shared_->settings.reach_m;
    const double x = (from_m.x - grid.corner_m.x) / grid.dx_m, y = (from_m.y - grid.corner_m.y) / grid.dy_m;
    shared_->flame.cross(
        AxisWalk(x, x + dx * reach_m / grid.dx_m), AxisWalk(y, y + dy * reach_m / grid.dy_m), 0.0, 1.0,
        [&](const FlameColumns::Column& column, double enter, double leave) {
            columns_.push_back({static_cast<float>(enter * reach_m), static_cast<float>(leave * reach_m),
                                -std::numeric_limits<float>::infinity(), column.first_voxel, column.k_begin, column.k_end});
            return true;
        });
}

/// Notes for each column how steep a line of sight must be to pass the terrain in front of it. Terrain has its edges where the
/// plane crosses the lines through cell centres: it is looked at there, so that the crest of a ridge is not stepped over.
void ReceiverLight::find_horizons(Vec3 from_m, double dx, double dy) {
    const TerrainMesh& terrain = *shared_->scene.terrain;
    const TerrainHeights& heights = terrain.heights();
    const auto lines = [&](double from, double rate) {
        const double place = from / heights.cell_m - 0.5,
                     next = rate > 0.0 ? std::floor(place) + 1.0 : std::ceil(place) - 1.0;
        const double step_m = heights.cell_m / std::max(std::abs(rate), 1e-12);
        return std::array{std::abs(next - place) * step_m, step_m};
    };
    auto [x_m, x_step_m] = lines(from_m.x - heights.lower_m.x, dx);
    auto [y_m, y_step_m] = lines(heights.upper_m.y - from_m.y, -dy);
    double slope = -std::numeric_limits<double>::infinity();
    for (PlaneColumn& column : columns_) {
        for (double r; (r = std::min(x_m, y_m)) < static_cast<double>(column.enter_m);) {
            const double h = terrain.height_at(from_m.x + r * dx, from_m.y + r * dy);
            if (h > -1e9) slope = std::max(slope, (h - from_m.z) / r);
            (x_m <= y_m ? x_m : y_m) += x_m <= y_m ? x_step_m : y_step_m;
        }
        column.horizon = static_cast<float>(slope);
    }
}

/// Range of slopes in which the columns show flame above the terrain; `low` is at least what it was. False when empty.
bool ReceiverLight::slopes_of_flame(Vec3 from_m, double& low, double& high) const {
    const fire::VoxelGrid& grid = shared_->flame.grid();
    constexpr double kVertical = std::numeric_limits<double>::infinity();
    double lowest = kVertical;
    high = -kVertical;
    for (const PlaneColumn& c : columns_) {
        const double bottom_m = grid.corner_m.z + c.k_begin * grid.dz_m - from_m.z, enter_m = c.enter_m, leave_m = c.leave_m;
        const double top_m = grid.corner_m.z + c.k_end * grid.dz_m - from_m.z;
        // Over the receiver itself the way to the column is none: flame from the ground up is seen in all slopes.
        const double to_bottom = bottom_m > 0.0 ? bottom_m / leave_m : enter_m > 0.0 ? bottom_m / enter_m : -kVertical;
        const double to_top = top_m <= 0.0 ? top_m / leave_m : enter_m > 0.0 ? top_m / enter_m : kVertical;
        lowest = std::min(lowest, std::max(to_bottom, static_cast<double>(c.horizon)));
        high = std::max(high, to_top);
    }
    low = std::max(low, lowest);
    return low < high;
}

}  // namespace pyroscene::render
