#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare.h"

namespace pyroscene::imagery {

/// What `pyroscene compare` was asked for.
struct CompareJob {
    std::filesystem::path synthetic;  ///< on a map: an ortho product
    std::filesystem::path real;       ///< any georeferenced raster that overlaps it
    std::filesystem::path output;     ///< folder
    bool register_images = true;      ///< find and undo a shift of the real image
    double largest_shift = 0.1;       ///< of the shorter side; a larger one is not believed
    std::optional<double> threshold;  ///< of the fire masks, unit of the images; default: Otsu's of the synthetic image
};

/// One pair of bands.
struct BandComparison {
    int synthetic_band = 0, real_band = 0;  ///< from 1
    std::string name, unit;
    analysis::PlaneAgreement agreement;
    double threshold = 0.0;
    analysis::MaskAgreement fire;
};

struct CompareReport {
    double shift_east_m = 0.0, shift_north_m = 0.0;  ///< by which the real image was moved onto the synthetic one
    double registration_response = 0.0;              ///< peak of the phase correlation, 0 to 1
    bool shift_believed = true;
    double pixel_m = 0.0;
    std::vector<BandComparison> bands;
};

/// Brings the real image onto the grid of the synthetic one (bilinear), registers it by phase correlation of the last common
/// band (sub-pixel), and writes into the folder: difference.tif (synthetic - real, COG), scores.json, pictures.png and report.html, which
/// holds all of it and opens without a server.
/// Bands are paired by wavelength where both images tell it (centres within half the wider FWHM), else by number.
/// Throws an input error: no georeference, no overlap, no pair of bands.
CompareReport compare_images(const CompareJob& job);

}  // namespace pyroscene::imagery
