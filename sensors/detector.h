#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "sensors/sensor.h"

namespace pyroscene::sensors {

/// Radiance noise as sigma = sqrt(variance + shot |L|) + relative |L|, so that a pixel costs no Planck function.
struct RadianceNoise {
    double variance = 0.0;  ///< [(W m-2 sr-1 um-1)^2]
    double shot = 0.0;      ///< [W m-2 sr-1 um-1]
    double relative = 0.0;

    [[nodiscard]] double sigma(double radiance_W_m2_sr_um) const noexcept;
};

/// How a file's noise figure turns into radiance:
/// - NEdT: value * d(band mean of Planck)/dT at at_temperature_K (central difference), constant.
/// - NEdL: sqrt(value^2 + shot L).
/// - SNR: at_radiance / value, constant; without at_radiance the noise is signal / value.
/// - SNR at an albedo: that of a Lambertian ground of this albedo under a sun in the zenith without atmosphere
///   (sunlit_radiance); constant.
RadianceNoise radiance_noise(const Noise& noise, const Spectrum& response);

/// Band radiance of a Lambertian ground under a sun in the zenith without atmosphere, albedo E0 / pi, the sun a black body of
/// 5772 K and radius 695 700 km at 1 au (IAU 2015 resolution B3) [W m-2 sr-1 um-1].
double sunlit_radiance(double albedo, const Spectrum& response);

/// Standard deviation of the radiance noise for a given signal [W m-2 sr-1 um-1]; 0 when the file states none.
double noise_radiance(const Band& band, double radiance_W_m2_sr_um);

/// The same of many signals, with the rounding of the counts (step / sqrt 12). NaN stays NaN.
std::vector<float> noise_and_rounding(const Band& band, std::span<const float> radiance_W_m2_sr_um);

/// Flags of apply_detector(): the signal was clipped, or ran over its counter and reads far too low.
enum Saturation : std::uint8_t { kUnsaturated = 0, kClipped = 1, kFoldedOver = 2 };

/// What the detector makes of one band of noise-free radiance, in place: noise, clipping at saturation (or folding over, see
/// Band::fold_over), quantisation over [0, full scale] to `bits`. A signal up to the maximum of the sensitive range has the
/// noise and the full scale of that range. Element i of the plane draws its own random number, so the result does not depend
/// on order, nor on the parts that a plane comes in. The step is full scale / 2^bits, rounded to nearest, negative signals read 0; a clipped pixel reads the saturation
/// radiance itself. Without a saturation there is no full scale and nothing is clipped or quantised. NaN stays NaN.
/// \param saturated  set to a Saturation for each element (same length)
/// \param first  place of the first element given in its plane
/// \return number of clipped or folded pixels
std::int64_t apply_detector(const Band& band, const RandomKey& key, std::span<float> radiance_W_m2_sr_um,
                            std::span<std::uint8_t> saturated, std::size_t first = 0);

/// Mixes the sensor's stray light into one plane [line][sample], in place: (1 - share) of each pixel's radiance and `share` of
/// the Gaussian mean around it, over pixels that hold data. Nothing for a share of 0.
void add_stray_light(const StrayLight& stray, int samples, std::span<float> radiance_W_m2_sr_um);

}  // namespace pyroscene::sensors
