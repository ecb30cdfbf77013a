#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detection_score.h"

namespace pyroscene::imagery {

/// What `pyroscene detect` was asked for.
struct DetectJob {
    std::filesystem::path image;            ///< radiances (or, for mod14 and viirs375, brightness temperatures in K)
    std::string method = "mod14";           ///< mod14, viirs375, or an index of analysis::spectral_indices() that is of fire
    std::optional<std::string> sensor;      ///< whose responses the bands have; default: as the image says
    std::optional<int> mir_band, tir_band;  ///< from 1; default: nearest 3.96 (viirs375: 3.74) and 11 um
    std::optional<std::filesystem::path>
        reflective;  ///< image of the same ground with bands near 0.65, 0.86 and 2.1 um; default: this one
    std::optional<std::filesystem::path> water;  ///< raster of the same size, 1 = water
    std::optional<double> sun_zenith_deg;        ///< default: from time and place
    std::optional<double> threshold;             ///< of an index; default: from the scene
    double deviations = 6.0;                     ///< of the scene, above which an index is fire
    double least_radiance = 0.05;                ///< W m-2 sr-1 um-1; darker pixels have no index
    std::optional<std::filesystem::path> truth;  ///< default: truth.tif beside radiance.tif, if there
    double least_area_m2 = 1.0;                  ///< of fire, from which on a pixel of the truth is one
    std::filesystem::path output;                ///< GeoTIFF; the other files go beside it
    const std::atomic<bool>* cancelled = nullptr;
};

struct DetectReport {
    std::string method, bands;
    std::int64_t fire_pixels = 0, unknown = 0, glint = 0, cloud = 0, water = 0, land = 0;
    double total_MW = 0.0;  ///< NaN without a MIR band
    std::optional<double> threshold;
    std::optional<analysis::DetectionScore> score;
    std::vector<std::string> notes;  ///< tests that were left out, and why
};

std::vector<std::string> detection_methods();

/// Writes
///   <output>                GeoTIFF of classes (analysis::FireClass)
///   <output>_layers.tif     confidence, what was tested (MIR temperature or index), background temperature, power
///   <output>_hotspots.csv, .geojson, .gpkg   fire pixels in the columns of NASA FIRMS
///   <output>_scores.json    against the truth, if there is one: omission, commission, by power and by area
/// Throws an input error: a band that is missing, no place on the Earth, no time (contextual methods), images of different size.
DetectReport detect_image(const DetectJob& job);

}  // namespace pyroscene::imagery
