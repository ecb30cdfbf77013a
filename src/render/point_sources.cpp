#include "render/point_sources.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::render {
namespace {

constexpr int kEdge = fire::FlameField::kBrickEdge;

/// Calls visit(i, j, k, fill, temperature_K) for the burning voxels of one brick column, vertical column by column.
template <class Visit>
void visit_voxels(const fire::FlameField& flame, const fire::FlameField::BrickColumn& column, int brick_i, int brick_j,
                  Visit&& visit) {
    for (int j = 0; j < kEdge; ++j) {
        for (int i = 0; i < kEdge; ++i) {
            for (int k = 0; k < column.brick_count * kEdge; ++k) {
                const auto& brick = flame.bricks[static_cast<std::size_t>(column.first_brick + k / kEdge)];
                const auto v = static_cast<std::size_t>((k % kEdge * kEdge + j) * kEdge + i);
                if (brick.fill[v] > 0.0F)
                    visit(brick_i * kEdge + i, brick_j * kEdge + j, column.z_begin * kEdge + k, brick.fill[v],
                          brick.temperature_K[v]);
            }
        }
    }
}

}  // namespace

PointSources::PointSources(const RenderScene& scene, const SceneTables& tables, double cut, double reach_m)
    : reach_m_(cut > 0.0 ? std::min(reach_m, 1.0 / std::sqrt(cut)) : reach_m), stride_(tables.stride) {
    const fire::FlameField& flame = *scene.flame;
    const fire::VoxelGrid& grid = flame.grid;
    const double volume_m3 = grid.dx_m * grid.dy_m * grid.dz_m;
    const SpectralKernels& kernels = spectral_kernels();
    for (int bj = 0; bj < flame.brick_rows; ++bj) {
        for (int bi = 0; bi < flame.brick_cols; ++bi) {
            const auto& column = flame.columns[static_cast<std::size_t>(bj) * static_cast<std::size_t>(flame.brick_cols) +
                                               static_cast<std::size_t>(bi)];
            int last_i = -1, last_j = -1;
            double emission = 0.0, height_m = 0.0;  // of the current source, weighted by fill T^4
            visit_voxels(flame, column, bi, bj, [&](int i, int j, int k, float fill, float T_K) {
                if (i != last_i || j != last_j) {
                    last_i = i;
                    last_j = j;
                    emission = height_m = 0.0;
                    sources_.push_back(
                        {{grid.corner_m.x + (i + 0.5) * grid.dx_m, grid.corner_m.y + (j + 0.5) * grid.dy_m, 0.0},
                         sources_.size()});
                    intensity_W_sr_um_.resize(sources_.size() * static_cast<std::size_t>(stride_), 0.0F);
                }
                const double weight = static_cast<double>(fill) * std::pow(static_cast<double>(T_K), 4.0);
                emission += weight;
                height_m += weight * (grid.corner_m.z + (k + 0.5) * grid.dz_m);
                sources_.back().at_m.z = height_m / emission;
                const PlanckRows::Lookup found = tables.planck.at(static_cast<double>(T_K));
                float* intensity = intensity_W_sr_um_.data() + sources_.back().row * static_cast<std::size_t>(stride_);
                for (int n = 0; n < found.count; ++n) {
                    kernels.add_product(stride_,
                                        found.weight[static_cast<std::size_t>(n)] * fill * static_cast<float>(volume_m3),
                                        tables.absorption_per_m.data(), tables.planck.row(found.row + n), intensity);
                }
            });
        }
    }
    std::sort(sources_.begin(), sources_.end(), [](const Source& a, const Source& b) { return a.at_m.y < b.at_m.y; });
}

void PointSources::add(const RenderScene& scene, const Receiver& receiver, float* irradiance) const {
    constexpr int kPoints = 3;
    const double cell_m = scene.terrain->grid().cell_m, near_m = reach_m_ + cell_m;
    auto source = std::lower_bound(sources_.begin(), sources_.end(), receiver.y_m - near_m,
                                   [](const Source& s, double y_m) { return s.at_m.y < y_m; });
    for (; source != sources_.end() && source->at_m.y <= receiver.y_m + near_m; ++source) {
        if (std::abs(source->at_m.x - receiver.x_m) > near_m) continue;
        double share = 0.0;
        for (int p = 0; p < kPoints * kPoints; ++p) {
            const double x_m = receiver.x_m + ((p % kPoints + 0.5) / kPoints - 0.5) * cell_m;
            const double y_m = receiver.y_m + ((p / kPoints + 0.5) / kPoints - 0.5) * cell_m;
            const Vec3 way = source->at_m - Vec3{x_m, y_m, scene.terrain->height_at(x_m, y_m)};
            const double r_m = length(way);
            if (r_m > 0.0 && r_m <= reach_m_) share += std::max(dot(way, receiver.normal), 0.0) / (r_m * r_m * r_m);
        }
        if (!(share > 0.0)) continue;
        const auto weight = static_cast<float>(share / (kPoints * kPoints));
        const float* intensity = intensity_W_sr_um_.data() + source->row * static_cast<std::size_t>(stride_);
        spectral_kernels().add_rows(stride_, intensity, stride_, 1, &weight, irradiance);
    }
}

}  // namespace pyroscene::render
