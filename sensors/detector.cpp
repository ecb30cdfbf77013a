#include "sensors/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "radiometry/planck.h"

namespace pyroscene::sensors {
namespace {

/// Radiance of a Lambertian ground: albedo E0 / pi with E0 = pi B(5772 K) (solar radius / 1 au)^2.
double sunlit_radiance(double albedo, const Spectrum& response) {
    constexpr double kSunTemperature_K = 5772.0, kSunRadius_m = 6.957e8, kAstronomicalUnit_m = 1.495978707e11;
    constexpr double kRatio = kSunRadius_m / kAstronomicalUnit_m;
    return albedo * kRatio * kRatio * radiometry::band_mean_radiance(kSunTemperature_K, response);
}

double planck_slope(double T_K, const Spectrum& response) {
    const double step_K = 1e-4 * T_K;  // error of the difference below 1e-6 in any band above 2 um
    return (radiometry::band_mean_radiance(T_K + step_K, response) -
            radiometry::band_mean_radiance(T_K - step_K, response)) /
           (2.0 * step_K);
}

}  // namespace

RadianceNoise radiance_noise(const Band& band) {
    const Noise& noise = band.noise;
    switch (noise.kind) {
        case Noise::Kind::None:
            return {};
        case Noise::Kind::NoiseEquivalentTemperature:
            return {.constant_W_m2_sr_um = noise.value * planck_slope(noise.at_temperature_K, band.response)};
        case Noise::Kind::SignalToNoise:
            if (noise.at_radiance) return {.constant_W_m2_sr_um = *noise.at_radiance / noise.value};
            return {.relative = 1.0 / noise.value};
        case Noise::Kind::SignalToNoiseAtAlbedo:
            if (noise.at_albedo)
                return {.constant_W_m2_sr_um = sunlit_radiance(*noise.at_albedo, band.response) / noise.value};
            return {.relative = 1.0 / noise.value};
    }
    return {};
}

double noise_radiance(const Band& band, double radiance_W_m2_sr_um) {
    const RadianceNoise noise = radiance_noise(band);
    return noise.constant_W_m2_sr_um + noise.relative * std::abs(radiance_W_m2_sr_um);
}

std::int64_t apply_detector(const Band& band, const RandomKey& key, std::span<float> radiance_W_m2_sr_um,
                            std::span<std::uint8_t> saturated) {
    if (radiance_W_m2_sr_um.size() != saturated.size())
        throw runtime_error(fmt::format("band {}", band.id),
                            fmt::format("{} pixels but {} saturation flags", radiance_W_m2_sr_um.size(), saturated.size()));
    const RadianceNoise noise = radiance_noise(band);
    const bool noisy = noise.constant_W_m2_sr_um > 0.0 || noise.relative > 0.0;
    const bool limited = band.saturation_radiance_W_m2_sr_um.has_value();
    const double maximum = band.saturation_radiance_W_m2_sr_um.value_or(std::numeric_limits<double>::infinity());
    const double step = limited && band.bits ? maximum * std::exp2(-*band.bits) : 0.0;
    std::int64_t clipped = 0;
    for (std::size_t i = 0; i < radiance_W_m2_sr_um.size(); ++i) {
        saturated[i] = 0;
        double signal = radiance_W_m2_sr_um[i];
        if (std::isnan(signal)) continue;
        if (noisy) signal += (noise.constant_W_m2_sr_um + noise.relative * std::abs(signal)) * standard_normal(key, i);
        if (signal > maximum) {
            signal = maximum;
            saturated[i] = 1;
            ++clipped;
        }
        if (step > 0.0) signal = std::max(0.0, std::round(signal / step)) * step;
        radiance_W_m2_sr_um[i] = static_cast<float>(signal);
    }
    return clipped;
}

}  // namespace pyroscene::sensors
