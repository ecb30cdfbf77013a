#pragma once

#include "inputs/wind_inputs.h"
#include "scenario/scenario.h"
#include "spread/landscape.h"

namespace pyroscene::inputs {

/// Wind (inputs.wind) and fuel moistures (inputs.spread.moisture) on the map grid, an entry for each time at which something changes.
/// \param levels  where the scenario says at what height the wind blows; else null
/// Throws an input error for tables and rasters that are out of range, not ascending in time, or without times.
std::vector<spread::Weather> spread_weather(const scenario::Scenario& scenario, const MapGrid& grid,
                                            const WindLevels* levels);

/// A raster of one value everywhere becomes that value.
spread::Field compact_field(Raster<float> raster);

/// A number, or a raster on the grid. With a scale its values have no unit of the file's but that of the key.
spread::Field field_of(const scenario::QuantitySource& source, const char* name, const char* unit, const MapGrid& grid);

/// Position of the last of some ascending times at or before a moment; the first when there is none.
std::size_t holding(const std::vector<double>& times_s, double time_s);

}  // namespace pyroscene::inputs
