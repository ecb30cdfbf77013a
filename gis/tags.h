#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gis/raster_output.h"

class GDALMajorObject;

/// Everything an output raster says of itself besides pixels and georeference, as one flat list.
namespace pyroscene::gis {

/// The default metadata domain of a dataset or band.
std::map<std::string, std::string> default_metadata(GDALMajorObject& object);

/// One metadata item; band 0 is the dataset, an empty domain the default one.
struct Tag {
    int band = 0;
    std::string domain, key, value;
};

/// Pixel statistics of a band in GDAL's sense (population standard deviation, share of valid pixels).
struct BandStatistics {
    double minimum = 0.0, maximum = 0.0, mean = 0.0, standard_deviation = 0.0, valid_percent = 0.0;
    bool any = false;  ///< false = no valid pixel: only the share is meaningful
};

/// Gathers them from the pixels of a band in their order, however cut.
class StatisticsSum {
public:
    template <class T>
    void add(std::span<const T> pixels) noexcept;  ///< T = float or double; NaN = no data
    [[nodiscard]] BandStatistics statistics() const noexcept;
    [[nodiscard]] std::size_t pixels() const noexcept { return pixels_; }

private:
    /// Every fourth pixel: four sums grow at the same time, by the place of a pixel and not by the parts that it comes in.
    struct Lane {
        double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
        double sum = 0.0, sum_of_squares = 0.0;  ///< of the differences to the first value: no cancellation
        std::size_t valid = 0;

        void add(double value, double first) noexcept {
            const bool known = value == value;
            minimum = value < minimum ? value : minimum;
            maximum = value > maximum ? value : maximum;
            const double d = known ? value - first : 0.0;
            sum += d;
            sum_of_squares += d * d;
            valid += known ? 1U : 0U;
        }
    };
    double first_ = std::numeric_limits<double>::quiet_NaN();
    std::array<Lane, 4> lanes_;
    std::size_t pixels_ = 0;
};

/// All tags of a raster: the caller's, provenance, time, wavelengths (band, ENVI and IMAGERY domains), geolocation, classes,
/// statistics (one entry per band). Throws a runtime error with `subject` for an acquisition time that is not ISO 8601.
std::vector<Tag> output_tags(const OutputRaster& raster, const std::vector<BandStatistics>& statistics,
                             const std::string& subject);

/// Colour of a class in colour tables.
struct ClassColour {
    short red = 0, green = 0, blue = 0;
};
ClassColour class_colour(std::size_t class_index) noexcept;

/// Keys of band metadata that output_tags() derives from other members; readers take them out again.
bool is_derived_band_key(const std::string& key);

}  // namespace pyroscene::gis
