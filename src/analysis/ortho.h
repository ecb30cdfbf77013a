#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/map_grid.h"
#include "base/raster.h"

namespace pyroscene::analysis {

/// For every cell of a map grid, the image position whose ground point is the cell's centre.
/// Positions are in samples and lines with pixel CORNERS at integers; NaN where the image does not look.
struct OrthoLookup {
    MapGrid grid;
    std::vector<float> sample, line;
    std::vector<float> ground_z_m;  ///< height of that ground point, interpolated like the position; NaN where not seen
};

/// Lines that a scanner takes in one sweep. Neighbouring sweeps overlap far from nadir (bow-tie), so that their lines are no
/// neighbours on the ground.
struct ScanLines {
    int lines_per_scan = 0;      ///< 0 or 1 = every line is the neighbour of the one before
    int first_line_of_scan = 0;  ///< place of the image's first line in its sweep
    /// First line of the sweep that follows line `line`, at most `lines`.
    [[nodiscard]] int end_of_scan(int line, int lines) const noexcept {
        if (lines_per_scan < 2) return lines;
        const int end = line + lines_per_scan - (first_line_of_scan + line) % lines_per_scan;
        return end < lines ? end : lines;
    }
};

/// Inverts per-pixel ground coordinates. Neighbouring pixel centres span quads on the map; each map cell centre inside a
/// quad gets its bilinear position. Where quads overlap (steep terrain folded away from the view, swath bow-tie) the higher
/// ground wins. The outermost half pixel is extrapolated, that of each sweep too.
/// Where a ridge hides ground, the quads between the ridge and the ground behind it bridge the gap; hide_unseen() removes
/// them. \param x_m, y_m, z_m  [line][sample] ground point of each pixel centre on the map, NaN = none Throws an input error
/// for an image narrower than 2 x 2 pixels or arrays of other lengths.
OrthoLookup ortho_lookup(const MapGrid& grid, int samples, int lines, std::span<const double> x_m,
                         std::span<const double> y_m, std::span<const double> z_m, const ScanLines& scans = {});

/// Sets cells to NaN whose interpolated ground lies more than tolerance_m above or below the terrain: they are hidden from
/// the sensor. \param terrain_z_m heights on the lookup's grid (same reference as z_m); NaN hides nothing
/// \return number of cells removed
std::int64_t hide_unseen(OrthoLookup& lookup, std::span<const float> terrain_z_m, double tolerance_m);

/// Heights at the cell centres of a grid, bilinear between the cell centres of `terrain_m` (both in one CRS); NaN outside it
/// and where all four neighbours have no height. What hide_unseen() compares with.
std::vector<float> heights_on(const MapGrid& grid, const Raster<float>& terrain_m);

/// Resamples one plane [line][sample] onto the lookup's grid: bilinear over valid pixels, or nearest. NaN where nothing is
/// seen.
std::vector<float> ortho_resample(const OrthoLookup& lookup, int samples, int lines, std::span<const float> plane,
                                  bool nearest);

/// North-up grid that covers all finite ground points, with the given cell, corners at multiples of the cell and the CRS of
/// `like`. Throws an input error when no point is finite or the grid would have more than 2^31 - 1 cells.
MapGrid ortho_grid(const MapGrid& like, double cell_m, std::span<const double> x_m, std::span<const double> y_m);

}  // namespace pyroscene::analysis
