#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "gis/image_stream.h"
#include "gis/pixel_positions.h"

namespace pyroscene::imagery {

/// Where the sun stands over each pixel.
struct SunOfImage {
    std::vector<float> zenith_deg, azimuth_deg;  ///< NaN where the pixel has no place
    double distance_AU = 1.0;
};

/// From the image's ACQUISITION_DATE and the places of its pixels, or one zenith angle for all.
/// Throws an input error when the image has no such item that is UTC in ISO 8601, and no angle is given.
SunOfImage sun_of_image(const std::filesystem::path& path, const gis::ImageInfo& info, const gis::PixelPositions& where,
                        const std::optional<double>& zenith_deg);

}  // namespace pyroscene::imagery
