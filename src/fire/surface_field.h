#pragma once

#include <cstdint>
#include <vector>

#include "fire/state.h"

namespace pyroscene::fire {

/// The ground at one moment on a grid `refinement` times finer than the map: what burns where inside a cell.
/// Flaming area, hence radiant power, of every map cell is conserved for any refinement.
struct SurfaceField {
    MapGrid grid;                              ///< the fine grid, same corner and CRS as the map
    int refinement = 1;                        ///< fine cells per map cell and axis
    std::vector<float> base_temperature_K;     ///< [row][col] ground that does not flame: scar or ambient; NaN = no data
    std::vector<float> front_fraction;         ///< [row][col] part of the fine cell at front_temperature_K
    std::vector<std::uint8_t> burned;          ///< [row][col] 1 = burnt or burning (char), 0 = vegetation
    double front_temperature_K = 0.0;
    double ambient_temperature_K = 0.0;
};

/// The ground at `time_s` >= state.time_s. Scars have cooled to that very time. With an arrival time raster the front is a
/// strip inside the cell: the fine cells that the (bilinearly interpolated) arrival time reached last burn; without one,
/// or under Physics::Thesis, the whole cell carries the same fraction.
SurfaceField surface_at(const FireState& state, double time_s, const FireParameters& parameters, int refinement);

}  // namespace pyroscene::fire
