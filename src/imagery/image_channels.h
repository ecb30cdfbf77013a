#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/spectrum.h"
#include "gis/image_stream.h"
#include "sensors/sensor.h"

namespace pyroscene::imagery {

/// One band of an image, ready to compute with.
struct Channel {
    int number = 0;  ///< from 1
    std::string name, unit;
    double centre_um = 0.0;
    Spectrum response;
    std::vector<float> values;                ///< [line][sample]; NaN = no data
    std::optional<sensors::Band> detector{};  ///< absent: an image of an unknown sensor

    /// Band mean of a black body, W m-2 sr-1 um-1.
    [[nodiscard]] double black_body(double T_K) const;
    /// a of L = a T^4 fitted to the black body over 650, 675 ... 1350 K (analysis::power_law_coefficient).
    [[nodiscard]] double power_law_coefficient() const;
    /// Brightness temperatures [K] of the radiances; the values themselves where the band is in K.
    [[nodiscard]] std::vector<float> temperatures_K() const;
};

/// A range of wavelengths in which a band is looked for, and where it should be best.
struct BandWish {
    double best_um = 0.0, lowest_um = 0.0, highest_um = 0.0;
    const char* what = "";  ///< "MIR radiance", for messages
};

/// The bands of any raster with wavelength metadata, found by wavelength, with the spectral responses of a sensor.
class ImageChannels {
public:
    /// \param sensor  whose responses the bands have; default: the shipped one that the image names, else boxcars of the bands' FWHM
    explicit ImageChannels(const std::filesystem::path& image, const std::optional<std::string>& sensor = {});

    [[nodiscard]] const gis::ImageInfo& info() const noexcept { return image_.info(); }
    /// Number of the band nearest to the wish, the first of equally near ones; 0 = none in the range.
    [[nodiscard]] int find(const BandWish& wish) const;
    /// Another band at the same wavelength (MODIS 21 and 22); 0 = none.
    [[nodiscard]] int twin(int number) const;
    /// `wanted` when given, else find(). Throws an input error: no such band, no wavelength, nothing in the range.
    [[nodiscard]] int require(const std::optional<int>& wanted, const BandWish& wish) const;
    /// Reads a band. Throws an input error when its unit is no spectral radiance (or, if allowed, K or a reflectance).
    enum class Expect { Radiance, RadianceOrTemperature, RadianceOrReflectance };
    [[nodiscard]] Channel read(int number, Expect expect = Expect::Radiance);

private:
    gis::ImageStream image_;
    std::optional<sensors::Sensor> sensor_;
};

/// Response-weighted solar irradiance at 1 AU, W m-2 um-1 (trapezoids over the points of the response, refined).
double solar_irradiance_W_m2_um(const Spectrum& response);

/// Reflectances at the top of the atmosphere, pi L d^2 / (E cos theta), of a radiance band; the values themselves where the
/// band is a reflectance. NaN where the sun is lower than 5 degrees.
/// \param distance_AU  sun to Earth
std::vector<float> reflectances(const Channel& channel, const std::vector<float>& sun_zenith_deg, double distance_AU);

/// "2017-07-15", "2305" of ISO 8601 text; empty when it is none.
struct DateAndClock {
    std::string date, clock;
};
DateAndClock date_and_clock(const std::string& iso8601);

/// Text of a metadata item, or nothing.
std::string metadata_item(const gis::ImageInfo& info, const std::string& key);

}  // namespace pyroscene::imagery
