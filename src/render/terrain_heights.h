#pragma once

#include <cstddef>

#include "base/map_grid.h"
#include "base/vec3.h"

namespace pyroscene::render {

/// The heights of a terrain mesh, without the mesh: a view that is cheap to copy and lives as long as the mesh. Vertices stand at
/// cell centres and on the raster's rim, (rows + 2) lines of (cols + 2).
struct TerrainHeights {
    const float* vertices = nullptr;  ///< [line][place], relative to `zero_m`
    int cols = 0, rows = 0;
    double cell_m = 0.0;
    Vec3 lower_m, upper_m;  ///< corners of the raster, lowest and highest vertex, scene frame
    double zero_m = 0.0;

    /// Stored height of the vertex in the middle of a cell (-1 and one past the last: on the rim); add zero_m.
    [[nodiscard]] const float* stored(int row, int col) const noexcept {
        const std::size_t line = static_cast<std::size_t>(cols) + 2;
        return vertices + static_cast<std::size_t>(row + 1) * line + static_cast<std::size_t>(col + 1);
    }
    /// Bilinear between vertices; NaN outside the raster.
    [[nodiscard]] double at(double x_m, double y_m) const noexcept;
};

}  // namespace pyroscene::render
