#pragma once

#include <vector>

#include "base/map_grid.h"
#include "gis/grid_mapping.h"
#include "gis/raster_input.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {

/// Band on the grid, row-major, NaN = no data. A raster on the grid itself is copied bit by bit.
/// Bilinear and nearest go through GDAL's warper (a target cell whose centre lies in a valid source pixel gets a value; when
/// the source is finer, bilinear widens to a triangle as large as the cell); Conserve is average_by_area().
/// Input errors: the raster does not overlap the grid, or holds only nodata there.
std::vector<float> resample(const SourceBand& source, const MapGrid& grid, Resampling rule);

/// Part of a source raster held in memory.
struct SourcePixels {
    PixelWindow window;
    std::vector<float> values;        ///< row-major over the window, NaN = no data
    std::vector<double> row_weights;  ///< ground area of a pixel of each window row, in any one unit
    [[nodiscard]] double weight_of_row(int row) const noexcept;  ///< clamped to the window's rows
};

/// Area-weighted means for grid rows [first, last) into `out` (size cols * (last - first)):
///   v = sum(valid overlap area * value) / (whole area of the target cell),
/// with exact overlap areas of the target quadrilateral and the source pixels, so that the sum of v times ground area equals
/// that of the source. Nodata and the outside count as zero *within* a partly covered cell, which keeps the integral; a cell
/// with (nearly) no valid overlap is NaN. A uniform field stays exactly uniform.
void average_by_area(const GridMapping& mapping, const SourcePixels& source, int grid_cols, int first_row, int last_row,
                     float* out);

}  // namespace pyroscene::gis
