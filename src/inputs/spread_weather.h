#pragma once

#include "scenario/scenario.h"
#include "spread/landscape.h"

namespace pyroscene::inputs {

/// Wind (inputs.wind) and fuel moistures (inputs.spread.moisture) on the map grid, an entry for each time at which something changes.
/// Throws an input error for tables and rasters that are out of range, not ascending in time, or without times.
std::vector<spread::Weather> spread_weather(const scenario::Scenario& scenario, const MapGrid& grid);

/// A raster of one value everywhere becomes that value.
spread::Field compact_field(Raster<float> raster);

/// Position of the last of some ascending times at or before a moment; the first when there is none.
std::size_t holding(const std::vector<double>& times_s, double time_s);

}  // namespace pyroscene::inputs
