#include "analysis/spectral_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pyroscene::analysis {
namespace {

using Kind = SpectralIndex::Kind;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Tolerances take in the bands of the instruments for which an index was defined. Neutral potassium shines at 766.5 and 769.9 nm: the
// band that holds it lies within 5 nm of 768 nm, its neighbours reach neither the line nor the next absorption.
// Least values: no ground of data/optical that is lit by the sun reaches an HFDI of -0.15 (char comes near it); a line of emission
// rises above its continuum.
constexpr std::array<SpectralIndex, 8> kIndices{{{.name = "ndvi",
                                                  .kind = Kind::NormalisedDifference,
                                                  .band = {{{0.86, 0.06}, {0.65, 0.04}}},
                                                  .reflectance = true,
                                                  .formula = "(R0.86 - R0.65) / (R0.86 + R0.65)",
                                                  .source = "Rouse et al. 1974; thesis 3.2.1 (ii)"},
                                                 {.name = "nbr",
                                                  .kind = Kind::NormalisedDifference,
                                                  .band = {{{0.86, 0.06}, {2.2, 0.15}}},
                                                  .reflectance = true,
                                                  .formula = "(R0.86 - R2.2) / (R0.86 + R2.2)",
                                                  .source = "Key and Benson 2006"},
                                                 {.name = "hfdi",
                                                  .kind = Kind::NormalisedDifference,
                                                  .band = {{{2.429, 0.02}, {2.061, 0.02}}},
                                                  .of_fire = true,
                                                  .least_excess = 0.02,
                                                  .least_value = -0.15,
                                                  .formula = "(L2.429 - L2.061) / (L2.429 + L2.061)",
                                                  .source = "Dennison and Roberts 2009"},
                                                 {.name = "co2",
                                                  .kind = Kind::Absorption,
                                                  .bands = 3,
                                                  .band = {{{2.010, 0.006}, {1.990, 0.006}, {2.040, 0.006}}},
                                                  .share = 0.666,
                                                  .of_fire = true,
                                                  .least_excess = 0.04,
                                                  .least_value = 0.0,
                                                  .formula = "L2.010 / (0.666 L1.990 + 0.334 L2.040)",
                                                  .source = "Dennison 2006"},
                                                 {.name = "k-line",
                                                  .kind = Kind::Contrast,
                                                  .bands = 3,
                                                  .band = {{{0.768, 0.0052}, {0.7515, 0.006}, {0.7815, 0.006}}},
                                                  .of_fire = true,
                                                  .least_excess = 0.02,
                                                  .least_value = 0.0,
                                                  .formula = "(L0.768 - C) / C, C between L0.752 and L0.782",
                                                  .source = "Vodacek et al. 2002; continuum through both sides"},
                                                 {.name = "akbd",
                                                  .kind = Kind::Difference,
                                                  .band = {{{0.769, 0.0052}, {0.780, 0.006}}},
                                                  .of_fire = true,
                                                  .least_excess = 0.5,
                                                  .least_value = 0.0,
                                                  .formula = "L0.769 - L0.780",
                                                  .source = "Amici et al. 2011"},
                                                 {.name = "aviris-k",
                                                  .kind = Kind::Ratio,
                                                  .band = {{{0.75912, 0.006}, {0.74957, 0.006}}},
                                                  .of_fire = true,
                                                  .least_excess = 0.02,
                                                  .least_value = 0.0,
                                                  .formula = "L0.75912 / L0.74957",
                                                  .source = "thesis fig 3.1 (bands 44 and 43)"},
                                                 {.name = "aviris-co2",
                                                  .kind = Kind::Difference,
                                                  .band = {{{1.95137, 0.006}, {1.91115, 0.006}}},
                                                  .of_fire = true,
                                                  .least_excess = 0.5,
                                                  .least_value = 0.0,
                                                  .formula = "L1.95137 - L1.91115",
                                                  .source = "thesis fig 3.2 (bands 168 and 164)"}}};

constexpr double kNoEnd = std::numeric_limits<double>::infinity();
constexpr std::array<SeverityClass, 7> kSeverity{{{"enhanced regrowth, high", -0.251},
                                                  {"enhanced regrowth, low", -0.100},
                                                  {"unburned", 0.100},
                                                  {"low severity", 0.270},
                                                  {"moderate-low severity", 0.440},
                                                  {"moderate-high severity", 0.660},
                                                  {"high severity", kNoEnd}}};

double quotient(double above, double below) { return below > 0.0 ? above / below : std::nan(""); }

double value_of(const SpectralIndex& x, const std::array<double, 3>& v, std::span<const double> um) {
    switch (x.kind) {
        case Kind::NormalisedDifference:
            return quotient(v[0] - v[1], v[0] + v[1]);
        case Kind::Ratio:
            return quotient(v[0], v[1]);
        case Kind::Difference:
            return v[0] - v[1];
        case Kind::Absorption:
            return quotient(v[0], x.share * v[1] + (1.0 - x.share) * v[2]);
        case Kind::Contrast: {
            const double continuum = std::lerp(v[1], v[2], (um[0] - um[1]) / (um[2] - um[1]));
            return quotient(v[0] - continuum, continuum);
        }
    }
    return std::nan("");
}

double median_of(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
}

}  // namespace

std::span<const SpectralIndex> spectral_indices() noexcept { return kIndices; }

const SpectralIndex* find_spectral_index(std::string_view name) noexcept {
    const auto found = std::find_if(kIndices.begin(), kIndices.end(), [&](const auto& x) { return x.name == name; });
    return found == kIndices.end() ? nullptr : &*found;
}

std::vector<float> spectral_index(const SpectralIndex& index, std::span<const std::span<const float>> planes,
                                  std::span<const double> centre_um) {
    std::vector<float> out(planes[0].size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::array<double, 3> v{};
        for (std::size_t b = 0; b < static_cast<std::size_t>(index.bands); ++b) v[b] = static_cast<double>(planes[b][i]);
        out[i] = static_cast<float>(value_of(index, v, centre_um));
    }
    return out;
}

std::vector<float> spectral_index_noise(const SpectralIndex& index, std::span<const std::span<const float>> planes,
                                        std::span<const std::span<const float>> noise, std::span<const double> centre_um) {
    const auto bands = static_cast<std::size_t>(index.bands);
    std::vector<float> out(planes[0].size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::array<double, 3> v{};
        for (std::size_t b = 0; b < bands; ++b) v[b] = static_cast<double>(planes[b][i]);
        double variance = 0.0;
        for (std::size_t b = 0; b < bands; ++b) {
            auto above = v, below = v;
            const double half = 0.5 * static_cast<double>(noise[b][i]);
            above[b] += half;
            below[b] -= half;
            const double change = value_of(index, above, centre_um) - value_of(index, below, centre_um);
            variance += change * change;
        }
        out[i] = static_cast<float>(std::sqrt(variance));
    }
    return out;
}

RobustStatistics robust_statistics(std::span<const float> values) {
    std::vector<float> valid;
    std::copy_if(values.begin(), values.end(), std::back_inserter(valid), [](float v) { return std::isfinite(v); });
    if (valid.empty()) return {std::nan(""), std::nan("")};
    const double median = median_of(valid);
    for (float& v : valid) v = static_cast<float>(std::abs(static_cast<double>(v) - median));
    constexpr double kNormal = 1.4826;  // standard deviation of a normal distribution / median distance
    return {median, kNormal * median_of(valid)};
}

IndexDetection detect_by_index(const IndexScene& scene, const SpectralIndex& index, const IndexRule& rule) {
    const auto n = scene.values.size();
    IndexDetection out;
    out.scene = rule.night ? RobustStatistics{index.least_value, 0.0} : robust_statistics(scene.values);
    const double by_scene = out.scene.median + std::max(rule.deviations * out.scene.deviation, index.least_excess);
    out.threshold = rule.threshold.value_or(std::max(by_scene, index.least_value));
    out.result.fire.assign(n, FireClass::Clear);
    out.result.confidence_percent.assign(n, kNaN);
    out.result.background_mir_K.assign(n, kNaN);
    const double needed = out.threshold - out.scene.median;
    const bool by_noise = rule.night && !rule.threshold && !scene.noise.empty();
    for (std::size_t i = 0; i < n; ++i) {
        if (!scene.burnt_out.empty() && scene.burnt_out[i] != 0) {
            out.result.fire[i] = FireClass::High;
            out.result.confidence_percent[i] = 100.0F;
            continue;
        }
        const double value = static_cast<double>(scene.values[i]);
        if (!std::isfinite(value)) {
            if (scene.dark.empty() || scene.dark[i] == 0) out.result.fire[i] = FireClass::NotProcessed;
            continue;
        }
        if (!(value > out.threshold)) continue;
        if (by_noise && !(value - out.scene.median > rule.deviations * static_cast<double>(scene.noise[i]))) continue;
        const double times = needed > 0.0 ? (value - out.scene.median) / needed : 2.0;
        out.result.fire[i] = times < 2.0 ? FireClass::Nominal : FireClass::High;
        out.result.confidence_percent[i] = static_cast<float>(50.0 * std::clamp(times, 1.0, 2.0));
    }
    return out;
}

std::span<const SeverityClass> severity_classes() noexcept { return kSeverity; }

std::vector<unsigned char> burn_severity(std::span<const float> dnbr) {
    std::vector<unsigned char> out(dnbr.size(), 0);
    for (std::size_t i = 0; i < dnbr.size(); ++i) {
        if (!std::isfinite(dnbr[i])) continue;
        const auto found = std::find_if(kSeverity.begin(), kSeverity.end(),
                                        [&](const auto& c) { return static_cast<double>(dnbr[i]) < c.below; });
        out[i] = static_cast<unsigned char>(found - kSeverity.begin() + 1);
    }
    return out;
}

std::vector<float> relative_dnbr(std::span<const float> dnbr, std::span<const float> nbr_before) {
    std::vector<float> out(dnbr.size(), kNaN);
    for (std::size_t i = 0; i < dnbr.size(); ++i)
        if (std::abs(nbr_before[i]) >= 1e-3F) out[i] = dnbr[i] / std::sqrt(std::abs(nbr_before[i]));
    return out;
}

}  // namespace pyroscene::analysis
