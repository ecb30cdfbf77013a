#pragma once

#include "fire/state.h"

namespace pyroscene::fire {

/// The flaming front inside one map cell.
struct CellFront {
    double fraction = 0.0;                ///< share of the cell's area that flames, 0 to 1
    double depth_m = 0.0;                 ///< of the flaming zone along the spread; may exceed the cell
    double fireline_intensity_W_m = 0.0;  ///< [W m-1]
    double heat_release_W = 0.0;          ///< of the cell: heat flux x area (eq 4.25-4.27 put right)
    double diameter_m = 0.0;              ///< of the circle with the burning area of the cell
};

/// Front of a burning cell by the rules of the parameters (docs/physics-fire.md 3 and 5.2); `counts` takes what could not be
/// derived. \param arrival_s time at which the fire arrived (may lie ahead), NaN = unknown
CellFront front_of_cell(const FrameInputs& frame, std::size_t cell, double arrival_s, const FireParameters& parameters,
                        FlameCounts& counts);

/// Fraction, height, embers and tilt of every front cell of a labelled state, in row-major order so that the running
/// statistics are reproducible. Throws an input error for a method that is not in the tables.
void set_flames(FireState& state, const FrameInputs& frame, const FireParameters& parameters);

}  // namespace pyroscene::fire
