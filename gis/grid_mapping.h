#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/map_grid.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {

/// A cell of the target grid seen in the source raster: continuous column and row of its NW, NE, SE and SW corner.
struct CellOutline {
    std::array<double, 4> col{}, row{};
};

/// Where the cells of a map grid lie in a raster: continuous column/row (corner at integers) of the one to that of the other.
/// Positions are exact at the nodes of a lattice and interpolated between, to 0.005 source pixels (checked on construction).
/// Longitudes are wrapped so that a raster on 0...360 degrees meets a grid west of Greenwich.
class GridMapping {
public:
    GridMapping(const MapGrid& grid, const SourceBand& source);

    /// True when both have the same pixels.
    [[nodiscard]] bool identical() const noexcept { return identical_; }
    /// Length of a grid cell's edge along grid columns / along grid rows, in source pixels, at the grid's centre.
    [[nodiscard]] double pixels_along_col() const noexcept { return pixels_along_col_; }
    [[nodiscard]] double pixels_along_row() const noexcept { return pixels_along_row_; }

    /// The cells of one grid row, west to east. NaN where the projection has no image.
    [[nodiscard]] std::vector<CellOutline> outlines(int grid_row) const;
    /// Source pixels that the grid rows [first, last) touch, with a margin for interpolation; empty when they do not meet.
    [[nodiscard]] PixelWindow source_window(int first_row, int last_row) const;

private:
    struct Line {
        std::vector<double> col, row;
    };
    /// Exact, in place.
    void grid_to_source(std::span<double> col, std::span<double> row) const;
    void measure_scale();
    void build_lattice(int step);
    [[nodiscard]] double lattice_error() const;
    [[nodiscard]] Line corner_line(int grid_row) const;

    MapGrid grid_;
    std::array<double, 6> inverse_{};
    int source_cols_ = 0, source_rows_ = 0;
    std::optional<CrsTransform> to_source_crs_;  ///< none = same CRS
    double centre_lon_deg_ = 0.0;
    bool wraps_ = false, identical_ = false;
    double pixels_along_col_ = 1.0, pixels_along_row_ = 1.0;
    std::vector<int> node_col_, node_row_;  ///< grid lines of the lattice
    Line nodes_;                            ///< their images, row by row
};

}  // namespace pyroscene::gis
