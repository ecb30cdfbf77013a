#include "pipeline/modelled_fire.h"

#include <cmath>

namespace pyroscene::pipeline {

Raster<float> heat_flux_W_m2(const ModelledFire& fire, double time_s) {
    return fire::mean_heat_flux_W_m2(fire.ground, time_s - fire.mean_over_s, time_s);
}

Raster<float> fuel_left_kg_m2(const ModelledFire& fire, double time_s) {
    auto left = fire::remaining_share(fire.ground, time_s);
    left.name = "fuel_load";
    left.unit = "kg m-2";
    for (std::size_t i = 0; i < left.values.size(); ++i) left.values[i] *= fire.fuel_load_kg_m2.values[i];
    return left;
}

double heat_released_J(const ModelledFire& fire, double time_s) {
    const auto left = fire::remaining_share(fire.ground, time_s);
    double sum = 0.0;
    for (std::size_t i = 0; i < left.values.size(); ++i)
        if (const double heat = fire.ground.heat_J_m2.values[i]; std::isfinite(heat)) sum += heat * (1.0 - left.values[i]);
    return sum * left.grid.cell_area_m2();
}

}  // namespace pyroscene::pipeline
