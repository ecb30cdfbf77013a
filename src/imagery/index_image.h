#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/spectral_index.h"
#include "imagery/image_channels.h"
#include "imagery/sun_of_image.h"

namespace pyroscene::imagery {

/// What `pyroscene index` was asked for.
struct IndexJob {
    std::filesystem::path image;                  ///< radiances or reflectances with wavelength metadata
    std::string name = "ndvi";                    ///< of analysis::spectral_indices(), or dnbr
    std::optional<std::filesystem::path> before;  ///< dnbr: the image from before the fire; the other one is from after it
    std::optional<std::string> sensor;
    std::optional<double> sun_zenith_deg;  ///< default: from time and place
    std::filesystem::path output;          ///< GeoTIFF
};

struct IndexReport {
    std::vector<std::string> bands;
    double minimum = 0.0, median = 0.0, maximum = 0.0;
    struct Severity {
        std::string name;
        std::int64_t pixels = 0;
        double area_ha = 0.0;
    };
    std::vector<Severity> severity;  ///< dnbr: pixels and area of each class
};

std::vector<std::string> index_names();

/// Writes a raster of the index (COG on a map, else with the image's geolocation). dnbr: bands dNBR and RdNBR, and beside it
/// <output>_severity.tif with the classes of Key and Benson. An image from before on another grid is brought onto the later one's
/// (bilinear), which must then be on a map.
/// Throws an input error: a band that is missing, no time for a reflectance, images that do not lie on each other.
IndexReport index_image(const IndexJob& job);

/// An index of an image, and which bands it was made of.
struct IndexPlane {
    std::vector<float> values;
    std::vector<float> noise;         ///< standard deviation of the values; empty = the sensor is not known
    std::vector<unsigned char> dark;  ///< 1: every band below `least_radiance`, so no value
    std::vector<unsigned char>
        burnt_out;  ///< 1: every band at its saturation, which a white surface facing the sun does not reach
    std::vector<std::string> bands;
};
/// \param sun  for indices of reflectances; null = the index takes radiances
IndexPlane index_plane(ImageChannels& image, const analysis::SpectralIndex& index, const SunOfImage* sun,
                       double least_radiance = 0.0);

}  // namespace pyroscene::imagery
