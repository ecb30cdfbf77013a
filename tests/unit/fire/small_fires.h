#pragma once

#include <limits>
#include <vector>

#include "fire/flame_field.h"
#include "fire/state.h"
#include "fire/surface_field.h"

/// Hand-made rasters of a few cells for the fire tests.
namespace pyroscene::fire::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline MapGrid small_grid(int cols, int rows, double cell_m = 20.0) {
    return {.cols = cols, .rows = rows, .west_m = 1000.0, .north_m = 5000.0, .cell_m = cell_m, .crs_wkt = "test"};
}

inline Raster<float> raster(const MapGrid& grid, std::vector<float> values) {
    Raster<float> out(grid, "test", "");
    out.values = std::move(values);
    return out;
}

/// One row of cells, 20 m, calm unless wind is given.
inline FrameInputs frame(double time_s, std::vector<float> heat_flux_W_m2, float east_m_s = 0.0F, float north_m_s = 0.0F) {
    const MapGrid grid = small_grid(static_cast<int>(heat_flux_W_m2.size()), 1);
    FrameInputs in;
    in.time_s = time_s;
    in.heat_flux_W_m2 = raster(grid, std::move(heat_flux_W_m2));
    in.wind_east_m_s = Raster<float>(grid, "u", "m s-1", east_m_s);
    in.wind_north_m_s = Raster<float>(grid, "v", "m s-1", north_m_s);
    return in;
}

inline FrameInputs frame_with_arrival(double time_s, std::vector<float> heat_flux_W_m2, std::vector<float> arrival_s) {
    FrameInputs in = frame(time_s, std::move(heat_flux_W_m2));
    in.arrival_time_s = share(raster(in.heat_flux_W_m2.grid, std::move(arrival_s)));
    return in;
}

inline CellClass class_of(const FireState& state, int col) { return static_cast<CellClass>(state.cell_class.at(0, col)); }

inline double sum(const std::vector<float>& values) {
    double total = 0.0;
    for (const float v : values) total += v;
    return total;
}

inline std::vector<float> dense(const SparseRaster<float>& raster) {
    std::vector<float> values(raster.grid.size());
    raster.copy(0, values);
    return values;
}

inline double sum(const SparseRaster<float>& raster) { return sum(dense(raster)); }

}  // namespace pyroscene::fire::test
