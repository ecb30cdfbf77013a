#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fire_detection.h"
#include "gis/image_stream.h"
#include "gis/pixel_positions.h"
#include "imagery/detect_image.h"

namespace pyroscene::imagery {

/// Everything that is known of an image's pixels: what detectors work on and what their files tell.
struct DetectionScene {
    const DetectJob& job;
    gis::PixelPositions where;
    std::size_t n = 0;
    std::vector<float> mir_K{}, tir_K{}, mir_radiance{};  ///< empty = no such band
    double mir_coefficient = 0.0;                         ///< a of L = a T^4
    std::vector<float> sun_zenith_deg{};                  ///< empty = not known
    std::vector<float> tested{};                          ///< index, empty = mir_K
    std::string tested_name = "MIR brightness temperature", tested_unit = "K";
};

/// Classes, layers and hot spots beside them (detect_image()).
void write_detection(const DetectionScene& scene, const gis::ImageInfo& info, const analysis::Detection& found,
                     const std::vector<float>& power_MW);

/// Against the truth that the job names or that lies beside the image, written as _scores.json; nothing without one.
std::optional<analysis::DetectionScore> score_against_truth(const DetectionScene& scene, const gis::ImageInfo& info,
                                                            const std::vector<unsigned char>& fire);

}  // namespace pyroscene::imagery
