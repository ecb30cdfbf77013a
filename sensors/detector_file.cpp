#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "radiometry/planck.h"
#include "sensors/detector.h"
#include "sensors/sensor_file.h"

namespace pyroscene::sensors {
namespace {

using config::Node;
using config::Range;

constexpr double kThermal_um = 3.0;         // longer bands count with the bits of thermal detectors
constexpr double kMicrowatt_cm2_nm = 10.0;  // W m-2 um-1

Noise read_noise(const Node& node) {
    Noise noise;
    if (!node.present()) return noise;
    static_cast<void>(node.required_child("kind"));
    const std::string kind = node.choice("kind", "none", {"none", "nedt", "nedl", "snr", "snr_at_albedo"});
    if (kind == "nedt") {
        noise.kind = Noise::Kind::NoiseEquivalentTemperature;
        noise.value = node.required_child("value_k").as_number(0.0, Range::positive());
        noise.at_temperature_K = node.number("at_k", noise.at_temperature_K, Range::positive());
    } else if (kind == "nedl") {
        noise.kind = Noise::Kind::NoiseEquivalentRadiance;
        noise.value = node.required_child("value_w_m2_sr_um").as_number(0.0, Range::not_negative());
        noise.shot = node.number("shot_w_m2_sr_um", 0.0, Range::not_negative());
    } else if (kind == "snr" || kind == "snr_at_albedo") {
        noise.kind = kind == "snr" ? Noise::Kind::SignalToNoise : Noise::Kind::SignalToNoiseAtAlbedo;
        noise.value = node.required_child("value").as_number(1.0, Range::positive());
        if (kind == "snr") noise.at_radiance = node.optional_number("at_radiance_w_m2_sr_um", Range::positive());
        if (kind == "snr_at_albedo") noise.at_albedo = node.required_child("at_albedo").as_number(1.0, Range::positive());
    }
    node.ignore("note");
    node.finish();
    return noise;
}

/// Width of the band over which a radiance "in the band" [W m-2 sr-1] is spread.
double equivalent_width_um(const Spectrum& response) {
    double area = 0.0;
    for (std::size_t i = 1; i < response.value.size(); ++i)
        area += 0.5 * (response.value[i] + response.value[i - 1]) * (response.lambda_um[i] - response.lambda_um[i - 1]);
    return area;
}

/// One limit, in the first of the words that the file uses: radiance, temperature of a black body, or albedo in full sun.
std::optional<double> read_limit(const Node& node, const char* radiance_key, const char* temperature_key, const Band& band) {
    const auto radiance = node.optional_number(radiance_key, Range::positive());
    const auto temperature_K = node.optional_number(temperature_key, Range::positive());
    if (radiance || !temperature_K || band.response.value.empty()) return radiance;
    return radiometry::band_mean_radiance(*temperature_K, band.response);
}

void read_saturation(const Node& node, double exposure_ratio, Band& band) {
    const bool known = !band.response.value.empty();
    auto& limit = band.saturation_radiance_W_m2_sr_um;
    limit = read_limit(node, "radiance_w_m2_sr_um", "temperature_k", band);
    const auto in_band = node.optional_number("radiance_w_m2_sr_band", Range::positive());
    const auto albedo = node.optional_number("albedo", Range::positive());
    // A gain that is set by command: high over vegetated land.
    const auto high_gain = node.optional_number("high_gain_w_m2_sr_um", Range::positive());
    if (!limit && high_gain) limit = high_gain;
    if (!limit && in_band && known) limit = *in_band / equivalent_width_um(band.response);
    if (!limit && albedo && known) limit = sunlit_radiance(*albedo, band.response);
    band.fold_over = node.optional_number("fold_over_factor", Range{1.0, 1e6});
    // Two exposures: the nominal one saturates here, the short one is noisier by their ratio.
    if (const auto nominal_K = node.optional_number("nominal_gain_temperature_k", Range::positive()); nominal_K && known) {
        band.sensitive_range = {radiometry::band_mean_radiance(*nominal_K, band.response), band.noise};
        band.noise_factor = exposure_ratio;
    }
    for (const char* key : {"l1b_limit_temperature_k", "low_gain_w_m2_sr_um", "minimum_w_m2_sr_band", "note"})
        node.ignore(key);
    node.finish();
}

/// Noise of one gain as nedt_k_at_<T>k, which names its temperature; the fallback when there is none.
Noise read_gain_noise(const Node& node, const Noise& fallback) {
    static const std::regex name("nedt_k_at_([0-9.]+)k");
    for (const auto& key : node.keys()) {
        std::smatch found;
        if (!std::regex_match(key, found, name)) continue;
        return {.kind = Noise::Kind::NoiseEquivalentTemperature,
                .value = node.number(key, 0.0, Range::positive()),
                .at_temperature_K = std::stod(found[1])};
    }
    return fallback;
}

void read_dual_gain(const Node& node, Band& band) {
    if (!node.present()) return;
    if (node.has("stages")) band.bits.reset();  // of more than two stages: clipped, not counted
    node.ignore("stages");
    node.ignore("range");
    const Node high = node.child("high_gain"), low = node.child("low_gain");
    if (high.present()) {
        const auto maximum = read_limit(high, "max_radiance_w_m2_sr_um", "max_temperature_k", band);
        if (maximum) band.sensitive_range = {*maximum, read_gain_noise(high, band.noise)};
        high.finish();
    }
    if (low.present()) {
        const auto maximum = read_limit(low, "max_radiance_w_m2_sr_um", "max_temperature_k", band);
        if (!band.saturation_radiance_W_m2_sr_um) band.saturation_radiance_W_m2_sr_um = maximum;
        band.noise = read_gain_noise(low, band.noise);
        low.finish();
    }
    const auto& sensitive = band.sensitive_range;
    if (sensitive && band.saturation_radiance_W_m2_sr_um &&
        sensitive->maximum_W_m2_sr_um > *band.saturation_radiance_W_m2_sr_um)
        high.report(fmt::format("ends at {:.4g} W m-2 sr-1 um-1, above the saturation of {:.4g}",
                                sensitive->maximum_W_m2_sr_um, *band.saturation_radiance_W_m2_sr_um));
    node.finish();
}

/// One scale of counts with a knee: finer steps below it.
void read_dual_slope(const Node& node, Band& band) {
    if (!node.present()) return;
    const double albedo = node.required_child("knee_albedo").as_number(0.25, Range::positive());
    const double share = node.required_child("share_of_counts").as_number(0.5, Range{0.01, 0.99});
    node.finish();
    if (band.response.value.empty()) return;
    const double knee = sunlit_radiance(albedo, band.response);
    if (!band.saturation_radiance_W_m2_sr_um || knee >= *band.saturation_radiance_W_m2_sr_um)
        node.report("needs a saturation above its knee");
    else
        band.sensitive_range = {knee, band.noise, share};
}

/// Wavelengths [um] that the end of a name gives: ..._below_0.7um, ..._0.7_1.3um, ..._above_1.85um.
std::optional<std::array<double, 2>> range_of_name(const std::string& name) {
    static const std::regex open(".*_(below|above)_([0-9.]+)um"), closed(".*_([0-9.]+)_([0-9.]+)um");
    std::smatch found;
    if (std::regex_match(name, found, open)) {
        const double limit_um = std::stod(found[2]);
        return found[1] == "below" ? std::array{0.0, limit_um} : std::array{limit_um, 1e9};
    }
    if (std::regex_match(name, found, closed)) return std::array{std::stod(found[1]), std::stod(found[2])};
    return std::nullopt;
}

void read_channel_noise(const Node& noise, std::vector<Band>& bands) {
    static_cast<void>(noise.choice("kind", "model", {"model", "none"}));
    const Node nedl = noise.child("nedl_uw_cm2_nm_sr");
    for (const auto& name : nedl.keys()) {
        const double value = nedl.number(name, 0.0, Range::positive());
        const auto range_um = range_of_name(name);
        if (!range_um) {
            nedl.child(name).report("expected a name that ends in _below_<um>um, _<um>_<um>um or _above_<um>um");
            continue;
        }
        for (Band& band : bands)
            if (band.centre_um >= (*range_um)[0] && band.centre_um < (*range_um)[1])
                band.noise = {.kind = Noise::Kind::NoiseEquivalentRadiance, .value = kMicrowatt_cm2_nm * value};
    }
    for (const char* key : {"nedl_native", "note"}) noise.ignore(key);
    nedl.finish();
    noise.finish();
}

}  // namespace

Digitisation read_digitisation(const Node& node) {
    const auto bits = [&](std::initializer_list<const char*> keys) -> std::optional<int> {
        for (const char* key : keys)
            if (const Node found = node.child(key); found.present() && found.is_scalar())
                return static_cast<int>(found.as_integer(16, Range::between(1, 32)));
        return std::nullopt;
    };
    Digitisation out{bits({"bits", "bits_visible", "bits_vis"}), bits({"bits", "bits_thermal", "bits_ir"}), 1.0};
    out.exposure_ratio = node.number("exposure_ratio", 1.0, Range{1.0, 1e6});
    for (const char* key : {"bits_dnb", "exposures", "native_unit", "product", "since_1995", "to_si"}) node.ignore(key);
    node.finish();
    return out;
}

std::optional<int> Digitisation::bits(double centre_um) const noexcept {
    return centre_um < kThermal_um ? visible_bits : thermal_bits;
}

void read_detector(const Node& node, const Digitisation& digitisation, Band& band) {
    band.noise = read_noise(node.child("noise"));
    band.bits = digitisation.bits(band.centre_um);
    if (const Node own = node.child("bits"); own.present())
        band.bits = static_cast<int>(own.as_integer(16, Range::between(1, 32)));
    read_saturation(node.child("saturation"), digitisation.exposure_ratio, band);
    read_dual_gain(node.child("dual_gain"), band);
    read_dual_slope(node.child("dual_slope"), band);
}

void read_channel_detectors(const Node& root, const Digitisation& digitisation, std::vector<Band>& bands) {
    for (Band& band : bands) band.bits = digitisation.bits(band.centre_um);
    if (const Node noise = root.child("noise"); noise.present()) read_channel_noise(noise, bands);
    const Node saturation = root.child("saturation");
    if (const auto k = saturation.optional_number("k", Range::positive()))
        for (Band& band : bands) band.saturation_radiance_W_m2_sr_um = sunlit_radiance(*k, band.response);
    for (const char* key : {"rule", "product_limit_native"}) saturation.ignore(key);
    saturation.finish();
}

}  // namespace pyroscene::sensors
