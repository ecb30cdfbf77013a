#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/random.h"
#include "fire/flame_field.h"
#include "fire/sampling.h"

namespace pyroscene::fire {
namespace {

void check(const FireState& state, const SurfaceField& surface, const Raster<float>& terrain_m, const FireParameters& fire) {
    const MapGrid& grid = state.cell_class.grid;
    if (!(terrain_m.grid == grid))
        throw input_error("terrain", fmt::format("its grid of {} x {} cells is not the fire's of {} x {}",
                                                 terrain_m.grid.cols, terrain_m.grid.rows, grid.cols, grid.rows));
    if (surface.grid.cols != grid.cols * surface.refinement || surface.grid.rows != grid.rows * surface.refinement)
        throw input_error("ground field", "was not made from this fire state");
    if (!(fire.jitter_m >= 0.0 && std::isfinite(fire.jitter_m)))
        throw input_error("fire.jitter_m", fmt::format("is {}, must not be negative", fire.jitter_m));
}

/// Uniform shift of the base in [-jitter, +jitter] per axis.
void jitter(FlameColumn& column, const RandomKey& key, std::size_t fine_cell, double jitter_m) noexcept {
    if (jitter_m == 0.0) return;
    column.x_m += jitter_m * (2.0 * uniform01(key, fine_cell, 0) - 1.0);
    column.y_m += jitter_m * (2.0 * uniform01(key, fine_cell, 1) - 1.0);
}

/// Embers as upright cubes where the wind has taken them by now.
void add_embers(const FireState& state, double time_s, const Raster<float>& terrain_m, const FireParameters& fire,
                const FlameParameters& flame, Vec3 scene_origin, std::vector<FlameColumn>& columns) {
    for (const Ember& ember : state.embers) {
        if (time_s - ember.release_s >= fire.embers.lifetime_s) continue;
        const EmberNow now = ember_at(ember, time_s, fire.embers, flame.temperature_K, fire.air_temperature_K);
        FlameColumn column{.x_m = now.x_m - scene_origin.x,
                           .y_m = now.y_m - scene_origin.y,
                           .width_m = ember.edge_m,
                           .bottom_m = now.bottom_m + flame.ember_gap_m,
                           .temperature_K = now.temperature_K};
        column.top_m = column.bottom_m + ember.edge_m;
        column.z_m =
            bilinear_or_own(terrain_m, terrain_m.grid.col_at(ember.ground_x_m), terrain_m.grid.row_at(ember.ground_y_m));
        if (!std::isnan(column.z_m)) columns.push_back(column);
    }
}

}  // namespace

std::vector<FlameColumn> make_columns(const FireState& state, const SurfaceField& surface, const Raster<float>& terrain_m,
                                      const FireParameters& fire, const FlameParameters& flame, Vec3 scene_origin,
                                      double time_s) {
    check(state, surface, terrain_m, fire);
    const RandomKey key{fire.seed, stream_id("flame jitter"), random_frame(state.time_s)};
    std::vector<FlameColumn> columns;
    surface.for_each_own_cell([&](int row, int col, std::size_t i) {
        const std::size_t cell = state.cell_class.grid.index(row / surface.refinement, col / surface.refinement);
        const double fraction = surface.front_fraction[i], cell_fraction = state.front_fraction[cell];
        if (!(fraction > 0.0 && cell_fraction > 0.0)) return;

        // The height is a mean over the cell; over the part that flames the same volume stands higher.
        FlameColumn column{.x_m = surface.grid.x_centre_m(col),
                           .y_m = surface.grid.y_centre_m(row),
                           .width_m = surface.grid.cell_m,
                           .area_fraction = fraction,
                           .top_m = state.flame_height_m[cell] / cell_fraction,
                           .tilt_rad = state.flame_tilt_rad[cell],
                           .azimuth_rad = state.flame_azimuth_rad[cell],
                           .temperature_K = flame.temperature_K};
        jitter(column, key, surface.grid.index(row, col), fire.jitter_m);
        column.z_m = bilinear_or_own(terrain_m, terrain_m.grid.col_at(column.x_m), terrain_m.grid.row_at(column.y_m));
        if (std::isnan(column.z_m)) return;
        column.x_m -= scene_origin.x;
        column.y_m -= scene_origin.y;
        if (flame.profile.shape != TemperatureProfile::Shape::Constant) column.flame_m = column.top_m;
        if (column.top_m > 0.0) columns.push_back(column);

        const double ember_m = state.ember_height_m[cell] / cell_fraction;
        if (!(ember_m > 0.0) || fire.embers.drift) return;
        column.flame_m = 0.0;
        column.bottom_m = column.top_m + flame.ember_gap_m;
        column.top_m = column.bottom_m + ember_m;
        columns.push_back(column);
    });
    if (fire.embers.drift) add_embers(state, time_s, terrain_m, fire, flame, scene_origin, columns);
    return columns;
}

std::vector<FlameColumn> make_columns(const FireState& state, const SurfaceField& surface, const Raster<float>& terrain_m,
                                      const FireParameters& fire, const FlameParameters& flame, Vec3 scene_origin) {
    return make_columns(state, surface, terrain_m, fire, flame, scene_origin, state.time_s);
}

}  // namespace pyroscene::fire
