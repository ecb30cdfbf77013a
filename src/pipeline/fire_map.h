#pragma once

#include <array>
#include <string>
#include <vector>

#include "fire/state.h"

namespace pyroscene::pipeline {

/// An outline on the map with its name.
struct MapOutline {
    std::string label;
    std::vector<std::array<double, 2>> ring_xy_m;
};

/// Bytes of a PNG: shaded terrain (light from the north-west), burnt ground coloured by its time of arrival, burning cells in red,
/// outlines, map coordinates, scale bar and colour bar. Shows the part of the map that holds fire and outlines, with a margin.
std::string fire_map_png(const Raster<float>& terrain_m, const fire::FireState& state,
                         const std::vector<MapOutline>& outlines);

}  // namespace pyroscene::pipeline
