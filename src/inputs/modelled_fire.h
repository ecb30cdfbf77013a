#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fire/burn_out.h"

namespace pyroscene::inputs {

/// A fire that is known by the time at which it arrives and by what burns then, as spread models give it; the heat flux of its frames
/// is computed when it is asked for. All rasters on the map grid, NaN where the fire does not come.
struct ModelledFire {
    fire::BurningGround ground;
    Raster<float> fuel_load_kg_m2;  ///< before the fire; 0 where nothing burns
    std::optional<Raster<float>> spread_rate_m_s, fireline_intensity_W_m, flame_length_m;  ///< as the front passes
    std::size_t cells_with_limited_wind = 0;                                               ///< see spread::FireSpread
    std::vector<std::string> warnings;                                                     ///< about what it was read from
    std::vector<double> frames_s;                                                          ///< ascending
    double mean_over_s = 6.0;  ///< the flux of a frame is the mean over this time before it
};

/// Heat flux of a frame, on all cores and the same for any number of them.
Raster<float> heat_flux_W_m2(const ModelledFire& fire, double time_s);
/// Fuel that is left at a time.
Raster<float> fuel_left_kg_m2(const ModelledFire& fire, double time_s);
/// Heat given off up to a time [J].
double heat_released_J(const ModelledFire& fire, double time_s);

}  // namespace pyroscene::inputs
