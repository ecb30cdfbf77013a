#pragma once

#include <filesystem>
#include <string>

namespace pyroscene::gis {

/// Wind as speed and direction in two rasters of one grid (WindNinja's _vel and _ang).
struct PolarWind {
    std::filesystem::path speed, angle;  ///< angle: where the wind comes from, degrees clockwise
    std::string unit;                    ///< of the speed
    std::string crs;                     ///< of files that do not say theirs; empty = they do
    bool grid_north = false;             ///< angles count from the y axis of the files' map, else from true north
};

/// The same as components u, v [m s-1] along the axes of the files' map: a raster in memory of two bands. Directions are turned into
/// components before anything is interpolated; no data in one is no data in both, but calm air needs no direction.
/// Input errors: rasters of different grids, a unit that is no speed, speeds below 0 or above 150 m/s, angles outside -360 to 720 degrees,
/// WindNinja's cloud cover (_cld) instead of either.
std::filesystem::path wind_components(const PolarWind& wind);

}  // namespace pyroscene::gis
