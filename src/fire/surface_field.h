#pragma once

#include <cstdint>
#include <vector>

#include "fire/state.h"

namespace pyroscene::fire {

/// The ground at one moment on a grid `refinement` times finer than the map: what burns where inside a cell.
/// Flaming area, hence radiant power, of every map cell is conserved for any refinement.
struct SurfaceField {
    MapGrid grid;                           ///< the fine grid, same corner and CRS as the map
    int refinement = 1;                     ///< fine cells per map cell and axis
    std::vector<float> base_temperature_K;  ///< [row][col] ground that does not flame: scar or ambient; NaN = no data
    std::vector<float> front_fraction;      ///< [row][col] part of the fine cell at front_temperature_K
    std::vector<std::uint8_t> burned;       ///< [row][col] 1 = burnt or burning (char), 0 = vegetation
    double front_temperature_K = 0.0;
    double ambient_temperature_K = 0.0;
};

/// The ground at `time_s`, which may lie after the state: scars have cooled to that very time, cells keep their class.
///  - Front: the flaming area of the cell (front_fraction x refinement^2 fine cells) goes to the fine cells that the
///    bilinearly interpolated arrival time reached last, then to those it will reach next: a strip. The rest is scar by its
///    own arrival or still vegetation. Without an arrival time, and in cells that the front passed longer ago than the scar's
///    first time constant, the flaming fine cells are drawn at random (reproducibly). Without one the rest is vegetation in
///    the first frame of the cell's fire, then scar since its first burning. Physics::Thesis: every fine cell carries the
///    fraction of the cell.
///  - Scar: the clock of a fine cell is its own interpolated arrival, else scar_clock_s of the cell. Fine cells that the
///    interpolated arrival has not reached are still vegetation.
///  - Unburned stays so whatever the arrival time says.
/// \param refinement fine cells per map cell and axis, >= 1
/// Throws an input error for refinement < 1 or a time before the state's.
SurfaceField surface_at(const FireState& state, double time_s, const FireParameters& parameters, int refinement);

}  // namespace pyroscene::fire
