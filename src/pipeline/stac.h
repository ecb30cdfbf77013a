#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/products_phase.h"

namespace pyroscene::pipeline {

/// What a STAC item says of one rendered image (SpatioTemporal Asset Catalog 1.0.0 with the eo, projection, raster, view and
/// processing extensions).
struct StacImage {
    std::vector<std::array<double, 2>> footprint_lon_lat;  ///< closed ring, counter-clockwise
    double gsd_m = 0.0;
    double sun_azimuth_deg = 0.0, sun_elevation_deg = 0.0;
    double off_nadir_deg = 0.0;                 ///< at the sensor, of the image's centre
    double incidence_deg = 0.0;                 ///< view zenith at the ground there
    std::vector<std::filesystem::path> assets;  ///< files in the acquisition's folder
    MapGrid ortho_grid;
};
void write_stac_item(const ProductJob& job, const StacImage& image);

/// Path of the item of a camera group, and the fingerprint it carries (empty when there is none).
std::filesystem::path stac_item_path(const AcquisitionFiles& files);
std::string stac_item_fingerprint(const std::filesystem::path& item);

}  // namespace pyroscene::pipeline
