#include "render/terrain_sight.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <limits>

#include "render/scene_tables.h"

namespace pyroscene::render {

Receiver receiver_at(const RenderScene& scene, std::size_t cell) {
    const MapGrid& grid = scene.terrain->grid();
    const int row = static_cast<int>(cell / static_cast<std::size_t>(grid.cols));
    const int col = static_cast<int>(cell % static_cast<std::size_t>(grid.cols));
    Receiver receiver;
    receiver.cell = cell;
    receiver.x_m = grid.x_centre_m(col) - scene.scene_origin_m.x;
    receiver.y_m = grid.y_centre_m(row) - scene.scene_origin_m.y;
    const double half_m = 0.499 * grid.cell_m;
    const auto height = [&](double dx, double dy) { return scene.terrain->height_at(receiver.x_m + dx, receiver.y_m + dy); };
    receiver.normal = normalized(Vec3{(height(-half_m, 0.0) - height(half_m, 0.0)) / (2.0 * half_m),
                                      (height(0.0, -half_m) - height(0.0, half_m)) / (2.0 * half_m), 1.0});
    return receiver;
}

double PlaneWeight::below(double slope) const noexcept {
    if (std::isinf(slope)) return slope > 0.0 ? along * kPi / 4.0 + up / 2.0 : -along * kPi / 4.0 + up / 2.0;
    const double cos2 = 1.0 / (1.0 + slope * slope);
    const double flat = 0.5 * up * slope * slope * cos2;
    return along == 0.0 ? flat : flat + 0.5 * along * (std::atan(slope) + slope * cos2);
}

double skyline_slope(const TerrainMesh& terrain, Vec3 from_m, double dx, double dy) noexcept {
    const double cell_m = terrain.grid().cell_m, highest_m = terrain.height_range_m()[1];
    double slope = -std::numeric_limits<double>::infinity();
    for (double r = cell_m;; r += std::max(cell_m, 0.1 * r)) {
        if ((highest_m - from_m.z) / r <= slope) return slope;  // nothing farther away can stand higher
        const double h = terrain.height_at(from_m.x + r * dx, from_m.y + r * dy);
        if (!(h > -1e9)) return slope;  // left the raster
        slope = std::max(slope, (h - from_m.z) / r);
    }
}

SkyView::SkyView(const RenderScene& scene) : known_(std::make_unique<std::atomic<float>[]>(scene.terrain->grid().size())) {
    terrain_.terrain = scene.terrain;
    terrain_.scene_origin_m = scene.scene_origin_m;
}

double SkyView::at(std::size_t cell) const noexcept {
    // Threads that ask at the same time find the same.
    float known = known_[cell].load(std::memory_order_relaxed);
    if (known == 0.0F) {
        const double hidden_sr = hidden_by_terrain(*terrain_.terrain, receiver_at(terrain_, cell), 1, [](Vec3, double) {});
        known = 1.0F + static_cast<float>(std::clamp(1.0 - hidden_sr / kPi, 0.0, 1.0));
        known_[cell].store(known, std::memory_order_relaxed);
    }
    return static_cast<double>(known - 1.0F);
}

void reflect_between_slopes(const SceneTables& tables, const std::vector<std::vector<TerrainPatch>>& patches,
                            const std::vector<float>& through, int bounces, int decay, std::vector<float>& irradiance,
                            std::vector<float>& change) {
    const auto stride = static_cast<std::size_t>(tables.stride);
    const SpectralKernels& kernels = spectral_kernels();
    std::vector<float> next(change.size());
    std::size_t every = 1;
    for (int look = 2; look <= bounces; ++look, every *= static_cast<std::size_t>(decay)) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, patches.size(), 64), [&](const auto& rows) {
            std::vector<float> seen(stride);
            for (std::size_t row = rows.begin(); row != rows.end(); ++row) {
                const auto& of_row = patches[row];
                float* out = next.data() + row * stride;
                std::fill(out, out + stride, 0.0F);
                if (of_row.empty()) continue;
                const std::size_t step = std::min(every, of_row.size());
                double all = 0.0, used = 0.0;
                for (const TerrainPatch& patch : of_row) all += static_cast<double>(patch.weight_sr);
                std::fill(seen.begin(), seen.end(), 0.0F);
                for (std::size_t i = row % step; i < of_row.size(); i += step) {
                    const TerrainPatch& patch = of_row[i];
                    used += static_cast<double>(patch.weight_sr);
                    if (patch.row < 0) continue;
                    kernels.add_product(tables.stride, patch.weight_sr, tables.reflectance_per_pi[patch.material],
                                        change.data() + static_cast<std::size_t>(patch.row) * stride, seen.data());
                }
                if (!(used > 0.0)) continue;
                kernels.product(tables.stride, static_cast<float>(all / used), seen.data(), through.data() + row * stride,
                                out);
                for (std::size_t l = 0; l < stride; ++l) irradiance[row * stride + l] += out[l];
            }
        });
        std::swap(change, next);
    }
}

}  // namespace pyroscene::render
