#include "render/smoke_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "fire/flame_bodies.h"
#include "render/smoke_run.h"
#include "render/smoke_shadow.h"

namespace pyroscene::render {
namespace {

constexpr int kEdge = fire::FlameField::kBrickEdge;

/// Nodes along an axis from which smoke is marched towards the flames.
bool is_kept(int at, int last) { return at % 2 == 0 || at == last; }

/// The voxels that a ray from a node crosses, relative to the voxel above the node: the same for all nodes.
struct NodeStep {
    int i, j, k;
    float length_m;
};

/// From a node along `direction`, up or down through `layers` layers and at most `columns` columns aside.
std::vector<NodeStep> steps_from_node(const fire::VoxelGrid& g, Vec3 direction, int layers, int columns) {
    std::vector<NodeStep> steps;
    if (direction.z == 0.0) return steps;
    const double ray_m = layers * g.dz_m / std::abs(direction.z);
    const Vec3 way = ray_m * direction;
    AxisWalk z(0.0, way.z / g.dz_m);
    z.enter(0.0, 1.0, way.z > 0.0 ? 0 : -1, way.z > 0.0 ? 0 : -1);
    walk_cells(AxisWalk(0.5, 0.5 + way.x / g.dx_m), AxisWalk(0.5, 0.5 + way.y / g.dy_m), 0.0, 1.0, 1.0,
               {-columns, -columns, columns + 1, columns + 1}, [&](int i, int j, double from, double to) {
                   for (double at = from; at < to && std::abs(z.cell) <= layers;) {
                       const double next = z.leaves(1.0), until = std::min(next, to);
                       if (until > at) steps.push_back({i, j, z.cell, static_cast<float>((until - at) * ray_m)});
                       if (next <= to) z.cell += z.step;
                       at = std::max(at, until);
                   }
                   return true;
               });
    return steps;
}

}  // namespace

SmokeLight::SmokeLight(const RenderScene& scene, const SceneTables& tables, const FlameColumns& plume)
    : scene_(&scene),
      plume_(&plume),
      diffuse_(!tables.smoke.diffusion.empty()),
      flame_share_m2_(static_cast<std::size_t>(tables.stride), 0.0F),
      flame_radiance_(flame_share_m2_.size(), 0.0F) {
    if (!tables.smoke.scatters) return;
    find_box();
    find_sources(tables);
    fill_nodes();
}

/// The nodes' lattice: voxel columns of all bricks with smoke.
void SmokeLight::find_box() {
    const fire::FlameField& field = *scene_->plume;
    int west = field.brick_cols, east = 0, south = field.brick_rows, north = 0;
    for (int bj = 0; bj < field.brick_rows; ++bj) {
        for (int bi = 0; bi < field.brick_cols; ++bi) {
            const auto column =
                static_cast<std::size_t>(bj) * static_cast<std::size_t>(field.brick_cols) + static_cast<std::size_t>(bi);
            if (field.columns[column].brick_count == 0) continue;
            west = std::min(west, bi);
            east = std::max(east, bi + 1);
            south = std::min(south, bj);
            north = std::max(north, bj + 1);
        }
    }
    const fire::VoxelGrid& g = field.grid;
    const auto [lowest, highest] = plume_->height_range();
    corner_m_ = g.corner_m + Vec3{west * kEdge * g.dx_m, south * kEdge * g.dy_m, lowest * g.dz_m};
    nx_ = std::min(east * kEdge, g.nx) - west * kEdge;
    ny_ = std::min(north * kEdge, g.ny) - south * kEdge;
    nz_ = highest - lowest;
}

void SmokeLight::find_sources(const SceneTables& tables) {
    std::vector<float> emission(flame_share_m2_.size(), 0.0F);
    std::vector<Source> sources;
    const double flame_area_m2 = add_flames(tables, emission, sources);
    add_front(tables, flame_area_m2, emission, sources);
    double total = 0.0;
    for (const Source& source : sources) total += source.weight;
    const auto padded_count = static_cast<std::size_t>(padded(static_cast<int>(sources.size())));
    for (auto* row : {&source_x_m_, &source_y_m_, &source_z_m_, &source_weight_, &flat_}) row->assign(padded_count, 0.0F);
    softening_m2_.assign(padded_count, 1.0F);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source& source = sources[i];
        source_x_m_[i] = static_cast<float>(source.at_m.x);
        source_y_m_[i] = static_cast<float>(source.at_m.y);
        source_z_m_[i] = static_cast<float>(source.at_m.z);
        source_weight_[i] = total > 0.0 ? static_cast<float>(source.weight / total) : 0.0F;
        softening_m2_[i] = static_cast<float>(source.softening_m2);
        flat_[i] = source.flat ? 1.0F : 0.0F;
    }
    for (std::size_t l = 0; l < emission.size(); ++l)
        flame_radiance_[l] = flame_share_m2_[l] > 0.0F ? emission[l] / flame_share_m2_[l] : 0.0F;
}

double SmokeLight::add_flames(const SceneTables& tables, std::vector<float>& emission, std::vector<Source>& sources) {
    double area_m2 = 0.0;
    const SpectralKernels& kernels = spectral_kernels();
    const std::size_t n = flame_share_m2_.size();
    std::vector<float> tau(n), emitted(n);
    for (const fire::FlameBody& body : fire::flame_bodies(*scene_->flame)) {
        const auto chord_m = static_cast<float>(body.chord_m());
        const PlanckRows::Lookup at = tables.planck.at(body.T_K);
        std::fill(tau.begin(), tau.end(), 1.0F);
        std::fill(emitted.begin(), emitted.end(), 0.0F);
        kernels.emit(tables.stride, tables.absorption_per_m.data(), chord_m, tables.planck.row(at.row), tables.stride,
                     at.count, at.weight.data(), static_cast<float>(0.25 * body.area_m2), tau.data(), emitted.data());
        double scattered = 0.0;  // what the smoke makes of it ranks the sources
        for (std::size_t l = 0; l < n; ++l) {
            flame_share_m2_[l] += static_cast<float>(body.area_m2 / (16.0 * kPi)) * (1.0F - tau[l]);
            emission[l] += emitted[l] / static_cast<float>(4.0 * kPi);
            scattered += static_cast<double>(tables.smoke.extinction_per_m[l] * tables.smoke.albedo[l] * emitted[l]);
        }
        sources.push_back({body.middle_m, scattered, body.area_m2 / (16.0 * kPi)});
        area_m2 += body.area_m2;
    }
    return area_m2;
}

void SmokeLight::add_front(const SceneTables& tables, double flame_area_m2, std::vector<float>& emission,
                           std::vector<Source>& sources) {
    const fire::SurfaceField& surface = *scene_->surface;
    const MapGrid& map = scene_->terrain->grid();
    std::map<std::size_t, Source> patches;  // by map cell; the weight is its area, the place a sum
    surface.for_each_own_cell([&](int row, int col, std::size_t i) {
        const auto front = static_cast<double>(surface.front_fraction[i]);
        if (!(front > 0.0) || std::isnan(surface.base_temperature_K[i])) return;
        const double x_m = surface.grid.x_centre_m(col), y_m = surface.grid.y_centre_m(row);
        const double area_m2 = front * surface.grid.cell_area_m2();
        const Vec3 at{x_m - scene_->scene_origin_m.x, y_m - scene_->scene_origin_m.y, 0.0};
        const int map_row = std::clamp(static_cast<int>(map.row_at(y_m)), 0, map.rows - 1),
                  map_col = std::clamp(static_cast<int>(map.col_at(x_m)), 0, map.cols - 1);
        Source& patch = patches[map.index(map_row, map_col)];
        patch.at_m = patch.at_m + area_m2 * at;
        patch.weight += area_m2;
    });
    double area_m2 = 0.0;
    for (auto& [cell, patch] : patches) {
        patch.at_m = patch.at_m / patch.weight;
        patch.at_m.z = scene_->terrain->height_at(patch.at_m.x, patch.at_m.y);
        patch.softening_m2 = patch.weight / (2.0 * kPi);  // half the sphere when at the patch itself
        patch.flat = true;
        if (std::isfinite(patch.at_m.z)) area_m2 += patch.weight;
    }
    if (!(area_m2 > 0.0)) return;
    const PlanckRows::Lookup hot = tables.planck.at(tables.front_K);
    const float* emissivity = tables.emissivity[tables.burnt_material];
    double scattered_per_m2 = 0.0;
    const auto flame_area = static_cast<float>(flame_area_m2 / (16.0 * kPi));
    for (std::size_t l = 0; l < emission.size(); ++l) {
        float B = 0.0F;
        for (int j = 0; j < hot.count; ++j) B += hot.weight[static_cast<std::size_t>(j)] * tables.planck.row(hot.row + j)[l];
        const float through = flame_area > 0.0F ? 1.0F - flame_share_m2_[l] / flame_area : 1.0F;
        const float share_per_m2 = emissivity[l] * through / static_cast<float>(8.0 * kPi);
        flame_share_m2_[l] += share_per_m2 * static_cast<float>(area_m2);
        emission[l] += share_per_m2 * static_cast<float>(area_m2) * B;
        scattered_per_m2 +=
            4.0 * kPi * static_cast<double>(tables.smoke.extinction_per_m[l] * tables.smoke.albedo[l] * share_per_m2 * B);
    }
    for (auto& [cell, patch] : patches) {
        if (!std::isfinite(patch.at_m.z)) continue;
        patch.weight *= scattered_per_m2;
        sources.push_back(patch);
    }
}

void SmokeLight::fill_nodes() {
    const fire::VoxelGrid& g = scene_->plume->grid;
    const std::size_t count =
        static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_ + 1);
    nodes_.assign(count, Node{});
    const int i0 = static_cast<int>(std::lround((corner_m_.x - g.corner_m.x) / g.dx_m)),
              j0 = static_cast<int>(std::lround((corner_m_.y - g.corner_m.y) / g.dy_m)),
              k0 = static_cast<int>(std::lround((corner_m_.z - g.corner_m.z) / g.dz_m));
    // Smoke above each node by sums down the columns; then below.
    std::vector<float> fill(count, 0.0F);
    tbb::parallel_for(0, ny_, [&](int j) {
        for (int i = 0; i < nx_; ++i) {
            for (int k = nz_ - 1; k >= 0; --k) {
                const float here = fill[node_index(i, j, k)] = voxel_at(*scene_->plume, i0 + i, j0 + j, k0 + k).fill;
                nodes_[node_index(i, j, k)][Above] =
                    nodes_[node_index(i, j, k + 1)][Above] + here * static_cast<float>(g.dz_m);
            }
            const float all = nodes_[node_index(i, j, 0)][Above];
            for (int k = 0; k <= nz_; ++k) nodes_[node_index(i, j, k)][Below] = all - nodes_[node_index(i, j, k)][Above];
        }
    });
    if (scene_->to_sun.z > 0.0) {
        add_sun_columns(fill, scene_->to_sun, ToSun);
        if (diffuse_) add_sun_columns(fill, -scene_->to_sun, PastSun);
    }
    tbb::parallel_for(0, (nz_ + 1) * ny_, [&](int row) {
        const int k = row / ny_, j = row % ny_;
        const bool kept = is_kept(k, nz_) && is_kept(j, ny_ - 1);
        for (int i = 0; i < nx_; ++i) {
            const bool marches = kept && is_kept(i, nx_ - 1);
            if (!is_near_smoke(fill, i, j, k, marches ? 2 : 1)) continue;
            const Vec3 at_m = corner_m_ + Vec3{(i + 0.5) * g.dx_m, (j + 0.5) * g.dy_m, k * g.dz_m};
            light_by_flames(at_m, marches, nodes_[node_index(i, j, k)]);
        }
    });
    between_marches();
}

/// Any smoke in the voxels around a node; without it the node is never asked for.
bool SmokeLight::is_near_smoke(const std::vector<float>& fill, int i, int j, int k, int reach) const noexcept {
    for (int kk = std::max(k - reach, 0); kk <= std::min(k + reach - 1, nz_ - 1); ++kk)
        for (int jj = std::max(j - reach, 0); jj <= std::min(j + reach, ny_ - 1); ++jj)
            for (int ii = std::max(i - reach, 0); ii <= std::min(i + reach, nx_ - 1); ++ii)
                if (fill[node_index(ii, jj, kk)] > 0.0F) return true;
    return false;
}

/// Smoke towards the flames is marched at every second node along each axis: linear between them, axis by axis.
void SmokeLight::between_marches() {
    const auto fill_in = [&](int i, int j, int k, int di, int dj, int dk) {
        nodes_[node_index(i, j, k)][ToFlame] = 0.5F * (nodes_[node_index(i - di, j - dj, k - dk)][ToFlame] +
                                                       nodes_[node_index(i + di, j + dj, k + dk)][ToFlame]);
    };
    const auto fill_plane = [&](int k) {
        for (int j = 0; j < ny_; ++j)
            for (int i = 1; is_kept(j, ny_ - 1) && i < nx_ - 1; i += 2) fill_in(i, j, k, 1, 0, 0);
        for (int j = 1; j < ny_ - 1; j += 2)
            for (int i = 0; i < nx_; ++i) fill_in(i, j, k, 0, 1, 0);
    };
    tbb::parallel_for(0, nz_ / 2 + 1, [&](int half) { fill_plane(2 * half); });
    if (nz_ % 2 == 1) fill_plane(nz_);
    tbb::parallel_for(0, nz_ / 2, [&](int half) {
        for (int j = 0; 2 * half + 1 < nz_ && j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) fill_in(i, j, 2 * half + 1, 0, 0, 1);
    });
}

/// Smoke along one direction from every node: all rays cross the same voxels relative to their nodes.
void SmokeLight::add_sun_columns(const std::vector<float>& fill, Vec3 direction, Quantity into) {
    const auto steps = steps_from_node(scene_->plume->grid, direction, nz_, std::max(nx_, ny_));
    tbb::parallel_for(0, (nz_ + 1) * ny_, [&](int row) {
        const int k = row / ny_, j = row % ny_;
        std::vector<float> sum(static_cast<std::size_t>(nx_), 0.0F);
        for (const NodeStep& step : steps) {
            const int jj = j + step.j, kk = k + step.k;
            if (jj < 0 || jj >= ny_ || kk < 0 || kk >= nz_) continue;
            const int begin = std::max(0, -step.i), end = std::min(nx_, nx_ - step.i);
            const float* from = fill.data() + node_index(0, jj, kk);
            for (int i = begin; i < end; ++i) sum[static_cast<std::size_t>(i)] += step.length_m * from[i + step.i];
        }
        for (int i = 0; i < nx_; ++i) nodes_[node_index(i, j, k)][into] = sum[static_cast<std::size_t>(i)];
    });
}

void SmokeLight::light_by_flames(Vec3 at_m, bool marches, Node& node) const {
    const FlameSources sources{static_cast<int>(source_weight_.size()),
                               source_x_m_.data(),
                               source_y_m_.data(),
                               source_z_m_.data(),
                               source_weight_.data(),
                               softening_m2_.data(),
                               flat_.data()};
    const float here[3] = {static_cast<float>(at_m.x), static_cast<float>(at_m.y), static_cast<float>(at_m.z)};
    FlameLightAt light;
    spectral_kernels().light_of_flames(sources, here, light);
    const float sum = light.per_m2;
    if (!(sum > 0.0F)) return;
    const Vec3 to_flame = Vec3{light.place_m[0] / sum, light.place_m[1] / sum, light.place_m[2] / sum} - at_m;
    node[FlamePerM2] = sum;
    if (marches && length(to_flame) > 0.0) node[ToFlame] = static_cast<float>(smoke_between(*plume_, at_m, at_m + to_flame));
    node[FlameX] = light.way[0] / sum;
    node[FlameY] = light.way[1] / sum;
    node[FlameZ] = light.way[2] / sum;
}

SmokeLight::Node SmokeLight::at(Vec3 point_m) const noexcept {
    const fire::VoxelGrid& g = scene_->plume->grid;
    const auto place = [](double at, int count, int& first, float& part) {
        const double held = std::clamp(at, 0.0, count - 1.0);
        first = std::min(static_cast<int>(held), std::max(count - 2, 0));
        part = static_cast<float>(held - first);
    };
    int i = 0, j = 0, k = 0;
    float x = 0.0F, y = 0.0F, z = 0.0F;
    place((point_m.x - corner_m_.x) / g.dx_m - 0.5, nx_, i, x);
    place((point_m.y - corner_m_.y) / g.dy_m - 0.5, ny_, j, y);
    place((point_m.z - corner_m_.z) / g.dz_m, nz_ + 1, k, z);
    Node out{};
    for (int corner = 0; corner < 8; ++corner) {
        const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
        const float weight = (di != 0 ? x : 1.0F - x) * (dj != 0 ? y : 1.0F - y) * (dk != 0 ? z : 1.0F - z);
        if (weight == 0.0F) continue;
        const Node& node = nodes_[node_index(i + di, j + dj, k + dk)];
        for (std::size_t q = 0; q < out.size(); ++q) out[q] += weight * node[q];
    }
    return out;
}

}  // namespace pyroscene::render
