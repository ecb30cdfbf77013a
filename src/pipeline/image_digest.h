#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gis/raster_output.h"
#include "pipeline/output_names.h"

namespace pyroscene::pipeline {

/// A pixel that stands for its kind, with its spectrum.
struct PickedPixel {
    std::string kind;  ///< "brightest", "flame", "front", "scar", "background"
    int sample = 0, line = 0;
    double longitude_deg = 0.0, latitude_deg = 0.0;
    std::vector<double> fractions;                                 ///< as ImageDigest::mean_fractions; empty without truth
    double ground_temperature_K = 0.0, flame_temperature_K = 0.0;  ///< NaN without truth
    std::vector<double> radiance_W_m2_sr_um;                       ///< per band, as the detector reports it
    std::vector<double> arriving_W_m2_sr_um;  ///< per band, before noise, clipping and counting; NaN without truth
};

/// Radiances of one band over the image.
struct BandDigest {
    double lowest = 0.0, mean = 0.0, highest = 0.0;  ///< W m-2 sr-1 um-1
    std::vector<double> bin_centres, counts;  ///< bins of equal ratio up to the largest; values of 0 and below in none
};

/// An image in a few numbers, read from its files.
struct ImageDigest {
    int samples = 0, lines = 0;
    std::vector<gis::OutputBand> bands;
    std::vector<BandDigest> statistics;                          ///< per band
    std::vector<std::pair<std::string, double>> mean_fractions;  ///< of the truth: flame, front, ...; empty without
    std::optional<double> seen_frp_MW;                           ///< sum over the image; empty without the product
    std::size_t fire_pixels = 0;                                 ///< with flame or front in them
    std::vector<PickedPixel> picked;                             ///< kinds that the image does not hold are left out
};

/// Reads radiance, geolocation and, where they exist, truth and frp of one camera group; one band in memory at a time.
/// Brightest: largest sum over bands of radiance / largest radiance of the band, then most fire. Flame, front: largest seen fraction.
/// Scar, background: the median of pixels that hold nothing else; where no pixel is pure scar, the largest fraction without fire.
ImageDigest digest_image(const AcquisitionFiles& files);

}  // namespace pyroscene::pipeline
