#pragma once

#include <optional>
#include <span>

#include "base/map_grid.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {

/// Where the cells of a map grid lie in a raster: continuous column/row (corner at integers) of the one to that of the other.
/// Longitudes are wrapped so that a raster on 0...360 degrees meets a grid west of Greenwich. Not thread-safe.
class GridMapping {
public:
    GridMapping(const MapGrid& grid, const SourceBand& source);

    /// In place; NaN where the projection has no image.
    void grid_to_source(std::span<double> col, std::span<double> row) const;
    void source_to_grid(std::span<double> col, std::span<double> row) const;

    /// Extent of one grid cell in source pixels along source columns and rows, at the grid's centre.
    [[nodiscard]] double cols_per_cell() const noexcept { return cols_per_cell_; }
    [[nodiscard]] double rows_per_cell() const noexcept { return rows_per_cell_; }
    /// True when both have the same pixels.
    [[nodiscard]] bool identical() const noexcept { return identical_; }

    /// Source pixels that the rows [first, last) of the grid touch, with a margin; empty when they do not meet.
    [[nodiscard]] PixelWindow source_window(int first_row, int last_row) const;

private:
    void measure_scale();

    MapGrid grid_;
    std::array<double, 6> geotransform_{}, inverse_{};
    int source_cols_ = 0, source_rows_ = 0;
    std::optional<CrsTransform> to_source_crs_;  ///< none = same CRS
    double centre_lon_ = 0.0;
    bool wraps_ = false, identical_ = false;
    double cols_per_cell_ = 1.0, rows_per_cell_ = 1.0;
};

}  // namespace pyroscene::gis
