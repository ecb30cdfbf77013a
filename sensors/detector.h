#pragma once

#include <cstdint>
#include <span>

#include "base/random.h"
#include "sensors/sensor.h"

namespace pyroscene::sensors {

/// Radiance noise of a band as sigma = constant + relative |L|, so that a pixel costs no Planck function.
struct RadianceNoise {
    double constant_W_m2_sr_um = 0.0;
    double relative = 0.0;
};

/// How the file's noise figure turns into radiance:
/// - NEdT: value * d(band mean of Planck)/dT at at_temperature_K (central difference), constant.
/// - SNR: at_radiance / value, constant; without at_radiance the noise is signal / value.
/// - SNR at an albedo: that of a Lambertian ground of this albedo under a sun in the zenith without atmosphere, the sun a
///   black body of 5772 K and radius 695 700 km at 1 au (IAU 2015 resolution B3); constant.
RadianceNoise radiance_noise(const Band& band);

/// Standard deviation of the radiance noise for a given signal [W m-2 sr-1 um-1]; 0 when the file states none.
double noise_radiance(const Band& band, double radiance_W_m2_sr_um);

/// What the detector makes of one band of noise-free radiance, in place: noise, clipping at saturation, quantisation over
/// [0, saturation] to `bits`. Element i of the plane draws its own random number, so the result does not depend on order.
/// The step is saturation / 2^bits, rounded to nearest, negative signals read 0; a clipped pixel reads the saturation
/// radiance itself. Without a saturation there is no full scale and nothing is clipped or quantised. NaN stays NaN.
/// \param saturated  set to 1 where the signal was clipped, else 0 (same length)
/// \return number of saturated pixels
std::int64_t apply_detector(const Band& band, const RandomKey& key, std::span<float> radiance_W_m2_sr_um,
                            std::span<std::uint8_t> saturated);

}  // namespace pyroscene::sensors
