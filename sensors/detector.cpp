#include "sensors/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "radiometry/planck.h"

namespace pyroscene::sensors {
namespace {

double planck_slope(double T_K, const Spectrum& response) {
    const double step_K = 1e-4 * T_K;  // error of the difference below 1e-6 in any band above 2 um
    return (radiometry::band_mean_radiance(T_K + step_K, response) -
            radiometry::band_mean_radiance(T_K - step_K, response)) /
           (2.0 * step_K);
}

/// One range of a detector: its noise, where it begins and ends, and the step of its counts (0 = not counted).
struct CountingRange {
    RadianceNoise noise;
    double begin = 0.0, full_scale = std::numeric_limits<double>::infinity(), step = 0.0;

    [[nodiscard]] double counted(double signal) const {
        return step > 0.0 ? begin + std::max(0.0, std::round((signal - begin) / step)) * step : signal;
    }
};

CountingRange counting_range(const Noise& noise, double factor, std::optional<double> full_scale, const Band& band) {
    CountingRange range{.noise = radiance_noise(noise, band.response)};
    range.noise.variance *= factor * factor;
    range.noise.shot *= factor * factor;
    range.noise.relative *= factor;
    if (full_scale) range.full_scale = *full_scale;
    if (full_scale && band.bits) range.step = *full_scale * std::exp2(-*band.bits);
    return range;
}

/// The range for all signals, and that for the ones up to its full scale (without one: none).
struct CountingRanges {
    CountingRange wide, sensitive;

    [[nodiscard]] const CountingRange& of(double signal) const { return signal <= sensitive.full_scale ? sensitive : wide; }
};

CountingRanges counting_ranges(const Band& band) {
    CountingRanges ranges;
    ranges.wide = counting_range(band.noise, band.noise_factor, band.saturation_radiance_W_m2_sr_um, band);
    ranges.sensitive.full_scale = -std::numeric_limits<double>::infinity();
    const auto& range = band.sensitive_range;
    if (!range) return ranges;
    ranges.sensitive = counting_range(range->noise, 1.0, range->maximum_W_m2_sr_um, band);
    if (range->share_of_counts) {  // the wide range goes on where the sensitive one ends
        ranges.wide.begin = ranges.sensitive.full_scale;
        ranges.wide.step *= (1.0 - ranges.wide.begin / ranges.wide.full_scale) / (1.0 - *range->share_of_counts);
        ranges.sensitive.step /= *range->share_of_counts;
    }
    return ranges;
}

/// Gaussian weights at 0, 1, 2, ... pixels, out to three standard deviations.
std::vector<double> gaussian_weights(double fwhm) {
    const double sigma = fwhm / (2.0 * std::sqrt(2.0 * std::log(2.0)));
    std::vector<double> weight;
    for (int i = 0; i <= static_cast<int>(std::ceil(3.0 * sigma)); ++i)
        weight.push_back(std::exp(-0.5 * (i / sigma) * (i / sigma)));
    return weight;
}

/// Convolves `count` values that stand `stride` apart; sums of weights that fall on nothing are left out.
void blur(const std::vector<double>& weight, std::size_t count, std::size_t stride, double* values,
          std::vector<double>& row) {
    row.resize(count);
    const auto reach = static_cast<std::ptrdiff_t>(weight.size()) - 1, last = static_cast<std::ptrdiff_t>(count) - 1;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        double sum = 0.0;
        for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j <= std::min(last, i + reach); ++j)
            sum += weight[static_cast<std::size_t>(std::abs(i - j))] * values[static_cast<std::size_t>(j) * stride];
        row[static_cast<std::size_t>(i)] = sum;
    }
    for (std::size_t i = 0; i < count; ++i) values[i * stride] = row[i];
}

void blur(const std::vector<double>& weight, std::size_t samples, std::vector<double>& plane) {
    std::vector<double> row;
    const std::size_t lines = plane.size() / samples;
    for (std::size_t line = 0; line < lines; ++line) blur(weight, samples, 1, plane.data() + line * samples, row);
    for (std::size_t sample = 0; sample < samples; ++sample) blur(weight, lines, samples, plane.data() + sample, row);
}

}  // namespace

double sunlit_radiance(double albedo, const Spectrum& response) {
    constexpr double kSunTemperature_K = 5772.0, kSunRadius_m = 6.957e8, kAstronomicalUnit_m = 1.495978707e11;
    constexpr double kRatio = kSunRadius_m / kAstronomicalUnit_m;
    return albedo * kRatio * kRatio * radiometry::band_mean_radiance(kSunTemperature_K, response);
}

double RadianceNoise::sigma(double radiance_W_m2_sr_um) const noexcept {
    const double signal = std::abs(radiance_W_m2_sr_um);
    return std::sqrt(variance + shot * signal) + relative * signal;
}

RadianceNoise radiance_noise(const Noise& noise, const Spectrum& response) {
    const auto constant = [](double sigma) { return RadianceNoise{.variance = sigma * sigma}; };
    switch (noise.kind) {
        case Noise::Kind::None:
            return {};
        case Noise::Kind::NoiseEquivalentTemperature:
            return constant(noise.value * planck_slope(noise.at_temperature_K, response));
        case Noise::Kind::NoiseEquivalentRadiance:
            return {.variance = noise.value * noise.value, .shot = noise.shot};
        case Noise::Kind::SignalToNoise:
            if (noise.at_radiance) return constant(*noise.at_radiance / noise.value);
            return {.relative = 1.0 / noise.value};
        case Noise::Kind::SignalToNoiseAtAlbedo:
            if (noise.at_albedo) return constant(sunlit_radiance(*noise.at_albedo, response) / noise.value);
            return {.relative = 1.0 / noise.value};
    }
    return {};
}

double noise_radiance(const Band& band, double radiance_W_m2_sr_um) {
    const auto& range = band.sensitive_range;
    const bool sensitive = range && radiance_W_m2_sr_um <= range->maximum_W_m2_sr_um;
    return sensitive ? radiance_noise(range->noise, band.response).sigma(radiance_W_m2_sr_um)
                     : band.noise_factor * radiance_noise(band.noise, band.response).sigma(radiance_W_m2_sr_um);
}

std::vector<float> noise_and_rounding(const Band& band, std::span<const float> radiance_W_m2_sr_um) {
    const auto ranges = counting_ranges(band);
    std::vector<float> out;
    out.reserve(radiance_W_m2_sr_um.size());
    for (const float L : radiance_W_m2_sr_um) {
        const auto& range = ranges.of(static_cast<double>(L));
        const double sigma = range.noise.sigma(static_cast<double>(L));
        out.push_back(static_cast<float>(std::sqrt(sigma * sigma + range.step * range.step / 12.0)));
    }
    return out;
}

std::int64_t apply_detector(const Band& band, const RandomKey& key, std::span<float> radiance_W_m2_sr_um,
                            std::span<std::uint8_t> saturated, std::size_t first) {
    if (radiance_W_m2_sr_um.size() != saturated.size())
        throw runtime_error(fmt::format("band {}", band.id),
                            fmt::format("{} pixels but {} saturation flags", radiance_W_m2_sr_um.size(), saturated.size()));
    const auto ranges = counting_ranges(band);
    const CountingRange& wide = ranges.wide;
    const double folds_from = wide.full_scale * band.fold_over.value_or(std::numeric_limits<double>::infinity());
    std::int64_t clipped = 0;
    for (std::size_t i = 0; i < radiance_W_m2_sr_um.size(); ++i) {
        saturated[i] = kUnsaturated;
        double signal = radiance_W_m2_sr_um[i];
        if (std::isnan(signal)) continue;
        if (const double sigma = ranges.of(signal).noise.sigma(signal); sigma > 0.0)
            signal += sigma * standard_normal(key, first + i);
        if (signal > folds_from) {
            signal = std::fmod(signal - folds_from, wide.full_scale);
            saturated[i] = kFoldedOver;
        } else if (signal > wide.full_scale) {
            signal = wide.full_scale;
            saturated[i] = kClipped;
        }
        clipped += saturated[i] != kUnsaturated ? 1 : 0;
        radiance_W_m2_sr_um[i] = static_cast<float>(ranges.of(signal).counted(signal));
    }
    return clipped;
}

void add_stray_light(const StrayLight& stray, int samples, std::span<float> radiance_W_m2_sr_um) {
    if (!(stray.share > 0.0) || samples < 1) return;
    const auto weight = gaussian_weights(stray.fwhm_samples);
    std::vector<double> light(radiance_W_m2_sr_um.size(), 0.0), known(light.size(), 0.0);
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (std::isnan(radiance_W_m2_sr_um[i])) continue;
        light[i] = radiance_W_m2_sr_um[i];
        known[i] = 1.0;
    }
    blur(weight, static_cast<std::size_t>(samples), light);
    blur(weight, static_cast<std::size_t>(samples), known);
    for (std::size_t i = 0; i < light.size(); ++i) {
        float& radiance = radiance_W_m2_sr_um[i];
        if (!std::isnan(radiance))
            radiance = static_cast<float>((1.0 - stray.share) * radiance + stray.share * light[i] / known[i]);
    }
}

}  // namespace pyroscene::sensors
