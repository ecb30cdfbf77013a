#include "inputs/modelled_fire.h"

#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pyroscene::inputs {

namespace {

constexpr int kRows = 16;  ///< of one piece of work

template <class Work>
void over_rows(const MapGrid& grid, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<int>(0, grid.rows, kRows),
                      [&](const tbb::blocked_range<int>& rows) { work(rows.begin(), rows.end()); });
}

Raster<float> share_left(const ModelledFire& fire, double time_s) {
    const MapGrid& grid = fire.ground.arrival_time_s.grid;
    Raster<float> left(grid, "remaining_share", "1", 1.0F);
    over_rows(grid, [&](int first, int last) { fire::fill_remaining_share(fire.ground, time_s, first, last, left); });
    return left;
}

}  // namespace

Raster<float> heat_flux_W_m2(const ModelledFire& fire, double time_s) {
    const MapGrid& grid = fire.ground.arrival_time_s.grid;
    Raster<float> flux(grid, "heat flux", "W m-2");
    over_rows(grid, [&](int first, int last) {
        fire::fill_mean_heat_flux(fire.ground, time_s - fire.mean_over_s, time_s, first, last, flux);
    });
    return flux;
}

Raster<float> fuel_left_kg_m2(const ModelledFire& fire, double time_s) {
    auto left = share_left(fire, time_s);
    left.name = "fuel_load";
    left.unit = "kg m-2";
    for (std::size_t i = 0; i < left.values.size(); ++i) left.values[i] *= fire.fuel_load_kg_m2.values[i];
    return left;
}

double heat_released_J(const ModelledFire& fire, double time_s) {
    const auto left = share_left(fire, time_s);
    double sum = 0.0;
    for (std::size_t i = 0; i < left.values.size(); ++i)
        if (const double heat = fire.ground.heat_J_m2.values[i]; std::isfinite(heat)) sum += heat * (1.0 - left.values[i]);
    return sum * left.grid.cell_area_m2();
}

}  // namespace pyroscene::inputs
