#pragma once

#include <string>

#include "scenario/scenario.h"
#include "sensors/image_geometry.h"

namespace pyroscene::pipeline {

/// What the acquisitions of a scenario would see, before anything is rendered: GeoJSON (RFC 7946, WGS 84) with one polygon per
/// camera group, its image's outline at the mean height of the terrain, and nine of its pixels (corners, edges, centre).
/// Properties: acquisition, sensor, group, `kind` (image or pixel); of an image samples, lines and time, of a pixel its
/// sample, line, time, view zenith and its size on the ground across and along the line. `over: fire` counts as the centre
/// of the map. Points beyond the horizon are left out. Throws an input error as resolve_geometry() does.
std::string footprints_geojson(const scenario::Scenario& scenario);

/// What the middle pixel of an image spans on ground of one height, along its line [m]; 0 when it does not see that ground.
double pixel_width_m(const sensors::ImageGeometry& image, double ground_height_m);

}  // namespace pyroscene::pipeline
