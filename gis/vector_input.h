#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/raster.h"

namespace pyroscene::gis {

using Position = std::array<double, 2>;  ///< x, y (longitude, latitude in geographic systems)
using Path = std::vector<Position>;

/// Points, lines and areas, whatever features they belong to.
struct Shapes {
    std::vector<Position> points;
    std::vector<Path> lines;
    std::vector<std::vector<Path>> polygons;  ///< rings of each: the outline, then holes

    [[nodiscard]] bool empty() const noexcept { return points.empty() && lines.empty() && polygons.empty(); }
};

/// Joins lines end to end where ends are at most `reach_m` apart and makes areas of those that close, as perimeters are often mapped as
/// lines, in pieces. The rest stays lines. \return how many areas that gave
int close_lines(Shapes& shapes, double reach_m);

/// What to read of a vector file.
struct ShapesRequest {
    std::filesystem::path file;
    std::string layer;  ///< empty = the only one
    std::string crs;    ///< of a file that does not say; else empty
};

/// Reads all shapes of a layer of any format that OGR knows, in the coordinates of a map. One clear input error each: missing file, not
/// a vector file, no such layer or several without a name (they are listed), no CRS anywhere or one although the file says it, a
/// position without an image on the map, no shape at all.
Shapes read_shapes(const ShapesRequest& request, const MapGrid& grid);

/// From a CRS to the coordinates of a map, in place. Throws an input error with `subject` for a position without an image there.
void shapes_to_map(Shapes& shapes, const std::string& crs, const MapGrid& grid, const std::string& subject);

/// 1 where shapes lie: cells whose centre is in an area; with `touched` all that an area, a line or a point touches.
Raster<std::uint8_t> cells_of(const Shapes& shapes, const MapGrid& grid, bool touched);

}  // namespace pyroscene::gis
