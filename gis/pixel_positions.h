#pragma once

#include <filesystem>
#include <vector>

namespace pyroscene::gis {

/// Where the pixels of an image lie on WGS 84 and how much ground they stand for.
struct PixelPositions {
    int samples = 0, lines = 0;
    std::vector<double> lon_deg, lat_deg;  ///< [line][sample] pixel centres; NaN = none
    std::vector<float>
        area_m2;  ///< spacing to the neighbours, horizontal, on the ellipsoid; NaN where a neighbour is missing
    std::vector<float> width_m, height_m;  ///< spacing along a line and from line to line
};

/// From the affine transform and CRS of any raster, else from its geolocation arrays (metadata domain GEOLOCATION with arrays of
/// the image's own size). Throws an input error naming the file when it has neither.
PixelPositions pixel_positions(const std::filesystem::path& path);

}  // namespace pyroscene::gis
