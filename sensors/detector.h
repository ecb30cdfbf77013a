#pragma once

#include <cstdint>
#include <span>

#include "base/random.h"
#include "sensors/sensor.h"

namespace pyroscene::sensors {

/// What the detector makes of one band of noise-free radiance, in place: noise, clipping at saturation, quantisation over
/// [0, saturation] to `bits`. Element i of the plane draws its own random number, so the result does not depend on order.
/// \param saturated  set to 1 where the signal was clipped, else 0 (same length)
/// \return number of saturated pixels
std::int64_t apply_detector(const Band& band, const RandomKey& key, std::span<float> radiance_W_m2_sr_um,
                            std::span<std::uint8_t> saturated);

/// Standard deviation of the radiance noise for a given signal [W m-2 sr-1 um-1]; 0 when the file states none.
double noise_radiance(const Band& band, double radiance_W_m2_sr_um);

}  // namespace pyroscene::sensors
