#pragma once

#include <vector>

#include "gis/raster_input.h"
#include "inputs/wind_levels.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// Bands of time series and the moments they hold for.
struct FrameSource {
    std::filesystem::path file;
    int band = 1;
    double time_s = 0.0;  ///< NaN = not said
};

/// Band of a time series: listed, else every band of every file in order, with the time that its metadata say.
std::vector<FrameSource> frame_bands(const scenario::RasterSource& source);

/// Wind of a moment along the axes of the grid: the pair of bands that holds for a frame, or the one wind of the map (of a moment, by a station's table), which is given
/// against true north and turned by the convergence at the centre; calm without any. With `levels` at 20 ft above the vegetation, else as given.
gis::Wind wind_at(const scenario::Scenario& scenario, const MapGrid& grid, std::size_t frame_count, std::size_t frame,
                  double time_s, const WindLevels* levels = nullptr);

/// The times of wind rasters or of a station's rows, ascending; empty for a wind that does not. Throws an input error for rasters without times.
std::vector<double> wind_times_s(const scenario::Scenario& scenario);

}  // namespace pyroscene::inputs
