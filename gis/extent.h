#pragma once

#include <array>
#include <string>

#include "base/map_grid.h"
#include "gis/crs.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {

/// Bounding box in some CRS; x is longitude for a geographic one.
struct Extent {
    double west = 0.0, east = 0.0, south = 0.0, north = 0.0;
};

/// GDAL's affine of a north-up grid.
std::array<double, 6> geotransform_of(const MapGrid& grid) noexcept;

/// Box of a raster's outline seen through `transform` (null = its own CRS). NaN when a part of the outline has no image.
Extent extent_of(const std::array<double, 6>& geotransform, int cols, int rows, const CrsTransform* transform);

/// "longitude -114.2 to -114.1, latitude 46.6 to 46.7", for messages.
std::string describe_extent(const SourceBand& source);
std::string describe_extent(const MapGrid& grid);

}  // namespace pyroscene::gis
