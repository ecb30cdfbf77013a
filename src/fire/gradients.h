#pragma once

#include "base/raster.h"

namespace pyroscene::fire {

/// Spread rate of the front, normal to it, from the time at which it arrived: R = 1 / |grad t| [m s-1, map distance].
/// The gradient is that of the plane which fits the arrival times of a square window best: 3 x 3 cells, widened to at most
/// 9 x 9 until the window holds three different times (a raster rounded to output steps has plateaus) and the plane explains
/// more than half of their variance (it does not where the fire was lit or two fronts met). Cells without arrival time are
/// left out, so the edge of the burn needs no special care. Burnt cells where no window will do take the mean of their
/// neighbours, ring by ring. Never above `maximum_m_s`.
/// \return NaN where the fire never arrived, and in burns too small or too sudden to have a gradient anywhere near
Raster<float> spread_rate_m_s(const Raster<float>& arrival_time_s, double maximum_m_s);

/// Slope of the ground along the axes of the map, rise over run, by central differences (one-sided at borders and beside
/// cells without height, 0 where neither neighbour is known).
struct TerrainSlope {
    Raster<float> east, north;
};
TerrainSlope terrain_slope(const Raster<float>& terrain_m);

}  // namespace pyroscene::fire
