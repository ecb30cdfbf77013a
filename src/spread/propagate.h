#pragma once

#include <functional>
#include <vector>

#include "base/raster.h"
#include "spread/fire_shape.h"

namespace pyroscene::spread {

/// A point that burns from a time on. Positions are continuous columns and rows of the grid (cell centres at + 0.5).
struct Seed {
    double col = 0.0, row = 0.0, time_s = 0.0;
};

struct Propagation {
    MapGrid grid;
    std::vector<Seed> seeds;
    std::vector<double> period_start_s;  ///< ascending; the first holds before its start too, the last for ever
    /// The shapes of a period, one per cell. Called once per period and in order, at most a few periods ahead of the fire.
    std::function<FireShapes(std::size_t period)> shapes;
    double end_s = 0.0;                              ///< the fire is followed until then
    std::function<void(double time_s)> on_progress;  ///< now and then; may throw to cancel. Empty = none
};

/// When the front passes the centre of each cell and how fast.
struct Arrival {
    Raster<float> time_s;            ///< NaN = not before the end
    std::vector<Slowness> slowness;  ///< of the front that arrived, one per cell
};

/// The first arrival of the fire at each cell: the least time over all paths from the seeds, by an ordered front (Dijkstra's order)
/// that reaches a cell over straight rays from anywhere between two burnt cells of a ring of 32 neighbours, with arrival times
/// interpolated by cubics from times and slownesses (semi-Lagrangian; Sethian and Vladimirsky 2003, with Hermite interpolation). A cell that
/// is taken also sees whether the fire comes as early by one way from where the ways to its parents began, straight (as Theta*, Nash,
/// Daniel, Koenig and Felner 2007, straightens paths on grids) or bent to a parabola with the earliest arrival: on even ground the
/// exact way from the seed whatever the shape, and where rates change smoothly an error that falls faster than the size of the cells.
/// A way longer than 50 cells (100 when straight) goes on from its middle. A cell that turns out to be reached earlier is taken up again.
/// Rays take the time of each cell for the part that they cross and do not cross cells without fire, nor the corner between two of them.
/// Runs on one thread; the result is the same everywhere.
Arrival propagate(const Propagation& job);

}  // namespace pyroscene::spread
