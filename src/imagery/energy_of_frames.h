#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pyroscene::imagery {

/// What `pyroscene fre` was asked for.
struct FreJob {
    std::vector<std::filesystem::path> frames;  ///< maps of fire radiative power: ortho_frp.tif, or results of `frp`
    std::filesystem::path output;               ///< GeoTIFF; the table goes beside it
};

/// One moment.
struct FreStep {
    std::string time;        ///< ISO 8601 UTC
    double time_s = 0.0;     ///< after the first
    double power_MW = 0.0;   ///< of all cells of the first frame's map
    double energy_MJ = 0.0;  ///< since the first moment
};

/// Integrates fire radiative power over the moments of several images (trapezoids), on the map of the earliest one; the others are
/// brought onto it so that power is kept. Writes
///   <output>              COG: energy per area [MJ m-2], energy of the cell [MJ], seconds after the first moment when power was largest
///   <output>_series.csv   time, power and energy so far
/// Frames may come in any order. Throws an input error: fewer than two frames, two of the same time, no time, no band of fire radiative
/// power per area, not on a map.
std::vector<FreStep> energy_of_frames(const FreJob& job);

}  // namespace pyroscene::imagery
