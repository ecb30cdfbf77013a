#pragma once

#include <vector>

#include "base/map_grid.h"
#include "gis/grid_mapping.h"
#include "gis/raster_input.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {

/// Band on the grid, row-major, NaN = no data. A raster on the grid itself is copied bit by bit.
/// Input errors: the raster does not overlap the grid, or holds only nodata there.
///
/// GDAL's own warper was measured and not used for this: its average takes bounding boxes of turned cells, and its bilinear
/// kernel, when it widens for a finer source, misplaces a plane by up to 0.1 source pixel.
std::vector<float> resample(const SourceBand& source, const MapGrid& grid, Resampling rule);

/// Part of a source raster held in memory.
struct SourcePixels {
    PixelWindow window;
    std::vector<float> values;        ///< row-major over the window, NaN = no data
    std::vector<double> row_weights;  ///< ground area of a pixel of each window row, in any one unit

    /// NaN outside the window. Column and row count from the raster's corner.
    [[nodiscard]] float at(int col, int row) const noexcept;
    /// Clamped to the window's rows.
    [[nodiscard]] double weight_of_row(int row) const noexcept;
};

/// Area-weighted mean:  sum(valid overlap area * value) / (whole area of the cell),
/// with exact overlap areas of the cell's outline and the source pixels, so that the sum of means times ground areas equals
/// the sum over the source. Nodata and the outside count as zero *within* a partly covered cell, which keeps the integral; a
/// cell with (nearly) no valid overlap is NaN. A uniform field stays uniform.
float average_by_area(const SourcePixels& source, const CellOutline& cell) noexcept;

/// Mean of the bilinear surface through the pixel centres over n_along_col x n_along_row points spread evenly in the cell (one
/// point for a source of the same or a coarser resolution): exact for planes, and a finer source is averaged, not picked from.
/// Invalid neighbours drop out. NaN unless the pixel that holds the cell's centre is valid.
float interpolate(const SourcePixels& source, const CellOutline& cell, int n_along_col, int n_along_row) noexcept;

/// The pixel that holds the cell's centre.
float pick_nearest(const SourcePixels& source, const CellOutline& cell) noexcept;

}  // namespace pyroscene::gis
