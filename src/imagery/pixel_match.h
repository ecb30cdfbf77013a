#pragma once

#include <span>
#include <vector>

#include "gis/pixel_positions.h"

namespace pyroscene::imagery {

/// A plane of one image on the pixels of another of the same ground: mean of the pixels whose centres lie within a circle that has the
/// area of the pixel (and of the nearest one where a coarser image has none). NaN where there is nothing.
std::vector<float> averaged_onto(const gis::PixelPositions& to, const gis::PixelPositions& from,
                                 std::span<const float> plane);

}  // namespace pyroscene::imagery
