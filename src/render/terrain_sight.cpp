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
    receiver.normal = cell_normal(scene.terrain->heights(), row, col);
    return receiver;
}

Vec3 cell_normal(const TerrainHeights& heights, int row, int col) noexcept {
    if (row > 0 && row + 1 < heights.rows && col > 0 && col + 1 < heights.cols) {
        const auto z = [&](int dr, int dc) { return static_cast<double>(*heights.stored(row + dr, col + dc)); };
        return normalized(
            Vec3{(z(0, -1) - z(0, 1)) / (2.0 * heights.cell_m), (z(1, 0) - z(-1, 0)) / (2.0 * heights.cell_m), 1.0});
    }
    const double half_m = 0.499 * heights.cell_m;
    const double x_m = heights.lower_m.x + (col + 0.5) * heights.cell_m,
                 y_m = heights.upper_m.y - (row + 0.5) * heights.cell_m;
    const auto climb = [&](double dx, double dy) {
        return (heights.at(x_m - dx, y_m - dy) - heights.at(x_m + dx, y_m + dy)) / (2.0 * half_m);
    };
    return normalized(Vec3{climb(half_m, 0.0), climb(0.0, half_m), 1.0});
}

double PlaneWeight::below(double slope) const noexcept {
    if (std::isinf(slope)) return slope > 0.0 ? along * kPi / 4.0 + up / 2.0 : -along * kPi / 4.0 + up / 2.0;
    const double cos2 = 1.0 / (1.0 + slope * slope);
    const double flat = 0.5 * up * slope * slope * cos2;
    return along == 0.0 ? flat : flat + 0.5 * along * (std::atan(slope) + slope * cos2);
}

double PlaneWeight::hidden_by(double skyline) const noexcept {
    const double lowest = lowest_slope(), cosine = 1.0 + skyline * lowest;  // of the angle between, times something above 0
    if (!(skyline > lowest)) return 0.0;
    if (!(cosine > 0.0)) return below(skyline) - below(lowest);
    const double high_cos2 = 1.0 / (1.0 + skyline * skyline), low_cos2 = 1.0 / (1.0 + lowest * lowest);
    const double between_rad = std::atan((skyline - lowest) / cosine);
    return 0.5 * (up * (skyline * skyline * high_cos2 - lowest * lowest * low_cos2) +
                  along * (between_rad + skyline * high_cos2 - lowest * low_cos2));
}

double skyline_slope(const TerrainMesh& terrain, Vec3 from_m, double dx, double dy) noexcept {
    const double cell_m = terrain.grid().cell_m, highest_m = terrain.height_range_m()[1];
    double slope = -std::numeric_limits<double>::infinity();
    for (double r = cell_m;; r = next_look_m(r, cell_m)) {
        if ((highest_m - from_m.z) / r <= slope) return slope;  // nothing farther away can stand higher
        const double h = terrain.height_at(from_m.x + r * dx, from_m.y + r * dy);
        if (!(h > -1e9)) return slope;  // left the raster
        slope = std::max(slope, (h - from_m.z) / r);
    }
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
