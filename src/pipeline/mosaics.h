#pragma once

#include "pipeline/products_phase.h"

namespace pyroscene::pipeline {

/// One mosaic of a scenario and the images of one camera group it is made of, in the order of the scenario.
struct MosaicJob {
    const scenario::Mosaic& mosaic;
    std::vector<ProductJob> members;
    std::filesystem::path file;  ///< to write
    std::string fingerprint;
};

/// Merges the images into one Cloud-Optimized GeoTIFF: the radiance bands, then time of the pixel, number of the image and view
/// zenith angle. Throws an input error when the images have not the same bands.
void write_mosaic(const MosaicJob& job, RunReport& report);

}  // namespace pyroscene::pipeline
