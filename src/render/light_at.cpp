#include "render/light_at.h"

#include <algorithm>
#include <cmath>

#include "render/sky_view.h"

namespace pyroscene::render {

void light_around(const GroundIrradiance& light, double x_m, double y_m, GroundLight& out) {
    const MapGrid& grid = light.grid;
    const double col = std::clamp(grid.col_at(x_m) - 0.5, 0.0, grid.cols - 1.0);
    const double row = std::clamp(grid.row_at(y_m) - 0.5, 0.0, grid.rows - 1.0);
    const int c = std::min(static_cast<int>(col), std::max(grid.cols - 2, 0));
    const int r = std::min(static_cast<int>(row), std::max(grid.rows - 2, 0));
    const double fc = col - c, fr = row - r;
    out.row_count = 0;
    out.open = out.hidden = 0.0;
    for (int j = 0; j < 4; ++j) {
        const int dr = j / 2, dc = j % 2;
        const double weight = (dr != 0 ? fr : 1.0 - fr) * (dc != 0 ? fc : 1.0 - fc);
        if (weight == 0.0) continue;
        const std::size_t cell = grid.index(r + dr, c + dc);
        const std::int32_t found = light.row_of_cell[cell];
        if (found < 0) {
            const double sky = light.sky_view ? light.sky_view->at(cell) : 1.0;
            out.open += weight * sky;
            out.hidden += weight * (1.0 - sky);
            continue;
        }
        const auto i = static_cast<std::size_t>(out.row_count++);
        out.row[i] = found;
        out.weight[i] = weight;
    }
}

double sun_cosine(const RenderScene& scene, const TerrainMesh::Hit& hit) noexcept {
    const double cosine = dot(hit.normal, scene.to_sun);
    if (cosine <= 0.0) return 0.0;
    const double horizontal = std::hypot(scene.to_sun.x, scene.to_sun.y);
    if (scene.to_sun.z >= scene.terrain->steepest_slope() * horizontal) return cosine;
    const double climb_m = scene.terrain->height_range_m()[1] - hit.point_m.z;
    const double distance_m = (climb_m + 1.0) / scene.to_sun.z;
    return scene.terrain->occluded(hit.point_m, scene.to_sun, distance_m) ? 0.0 : cosine;
}

}  // namespace pyroscene::render
