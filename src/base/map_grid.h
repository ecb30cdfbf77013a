#pragma once

#include <cstddef>
#include <string>

namespace pyroscene {

/// North-up map grid with square cells in a projected CRS. Pixel corners lie at integers, centres at +0.5
/// (GDAL's rule); row 0 is the northern row; x is east, y is north, both in metres.
struct MapGrid {
    int cols = 0, rows = 0;
    double west_m = 0.0;   ///< x of the left edge of column 0
    double north_m = 0.0;  ///< y of the upper edge of row 0
    double cell_m = 0.0;   ///< edge of a cell, > 0
    std::string crs_wkt;   ///< WKT2 of a projected CRS in metres

    [[nodiscard]] std::size_t size() const noexcept {
        return static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] std::size_t index(int row, int col) const noexcept {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
    }
    [[nodiscard]] bool contains(int row, int col) const noexcept { return row >= 0 && row < rows && col >= 0 && col < cols; }
    [[nodiscard]] double east_m() const noexcept { return west_m + cols * cell_m; }
    [[nodiscard]] double south_m() const noexcept { return north_m - rows * cell_m; }
    [[nodiscard]] double x_centre_m(int col) const noexcept { return west_m + (col + 0.5) * cell_m; }
    [[nodiscard]] double y_centre_m(int row) const noexcept { return north_m - (row + 0.5) * cell_m; }
    /// Continuous column/row of a map position; the cell that contains it is its floor.
    [[nodiscard]] double col_at(double x_m) const noexcept { return (x_m - west_m) / cell_m; }
    [[nodiscard]] double row_at(double y_m) const noexcept { return (north_m - y_m) / cell_m; }
    [[nodiscard]] double cell_area_m2() const noexcept { return cell_m * cell_m; }

    friend bool operator==(const MapGrid&, const MapGrid&) = default;
};

}  // namespace pyroscene
