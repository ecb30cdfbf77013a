#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/map_grid.h"

namespace pyroscene::analysis {

/// For every cell of a map grid, the image position whose ground point is the cell's centre.
/// Positions are in samples and lines with pixel CORNERS at integers; NaN where the image does not look.
struct OrthoLookup {
    MapGrid grid;
    std::vector<float> sample, line;
};

/// Inverts per-pixel ground coordinates. Neighbouring pixel centres span quads on the map; each map cell centre inside a quad
/// gets its bilinear position. Where quads overlap (steep terrain folded away from the view, swath bow-tie) the higher
/// ground wins. The outermost half pixel is extrapolated.
/// \param x_m, y_m, z_m  [line][sample] ground point of each pixel centre on the map, NaN = none
OrthoLookup ortho_lookup(const MapGrid& grid, int samples, int lines, std::span<const double> x_m, std::span<const double> y_m,
                         std::span<const double> z_m);

/// Resamples one plane [line][sample] onto the lookup's grid: bilinear over valid pixels, or nearest. NaN where nothing is seen.
std::vector<float> ortho_resample(const OrthoLookup& lookup, int samples, int lines, std::span<const float> plane, bool nearest);

/// North-up grid that covers all finite ground points, with the given cell, corners at multiples of the cell.
MapGrid ortho_grid(const MapGrid& like, double cell_m, std::span<const double> x_m, std::span<const double> y_m);

}  // namespace pyroscene::analysis
