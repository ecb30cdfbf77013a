#include "pipeline/sensor_json.h"

#include <nlohmann/json.hpp>

namespace pyroscene::pipeline {
namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json if_given(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}
/// For numbers of which 0 says that there is none.
Json unless_zero(double value) { return value != 0.0 ? Json(value) : Json(nullptr); }

const char* law_name(sensors::ScanLaw::Kind kind) noexcept {
    using Kind = sensors::ScanLaw::Kind;
    switch (kind) {
        case Kind::Frame:
            return "frame";
        case Kind::Pushbroom:
            return "pushbroom";
        case Kind::LineArray:
            return "line_array";
        case Kind::Mirror:
            return "mirror";
        case Kind::Cone:
            return "cone";
        case Kind::Disk:
            return "disk";
    }
    return "";
}

Json scan_json(const sensors::ScanLaw& scan) {
    Json json = {{"law", law_name(scan.kind)},
                 {"positions", scan.positions},
                 {"lines_per_scan", scan.lines_per_scan},
                 {"period_s", unless_zero(scan.period_s)},
                 {"scan_rate_rad_s", unless_zero(scan.scan_rate_rad_s)},
                 {"step_across_rad", unless_zero(scan.step_across_rad)},
                 {"step_along_rad", unless_zero(scan.step_along_rad)},
                 {"right_to_left", scan.right_to_left}};
    for (const auto& zone : scan.zones)
        json["zones"].push_back(
            {{"pixels", zone.pixels}, {"positions_per_pixel", zone.width}, {"deleted_rows", zone.deleted_rows}});
    return json;
}

Json group_json(const sensors::CameraGroup& g) {
    Json json = {{"id", g.id},
                 {"samples", g.samples},
                 {"lines", g.lines},
                 {"focal_length_m", g.focal_length_m},
                 {"pixel_pitch_m", g.pixel_pitch_m},
                 {"ifov_rad", g.focal_length_m > 0.0 ? Json(g.pixel_pitch_m / g.focal_length_m) : Json(nullptr)},
                 {"scan", scan_json(g.scan)}};
    for (const auto& view : g.views) json["views"].push_back({{"name", view.name}, {"scan", scan_json(view.scan)}});
    return json;
}

/// In the words of the sensor files.
Json noise_json(const sensors::Noise& noise) {
    using Kind = sensors::Noise::Kind;
    switch (noise.kind) {
        case Kind::None:
            return nullptr;
        case Kind::NoiseEquivalentTemperature:
            return {{"kind", "nedt"}, {"value_K", noise.value}, {"at_K", noise.at_temperature_K}};
        case Kind::NoiseEquivalentRadiance:
            return {{"kind", "nedl"}, {"value_W_m2_sr_um", noise.value}, {"shot_W_m2_sr_um", noise.shot}};
        case Kind::SignalToNoise:
            return {{"kind", "snr"}, {"value", noise.value}, {"at_radiance_W_m2_sr_um", if_given(noise.at_radiance)}};
        case Kind::SignalToNoiseAtAlbedo:
            return {{"kind", "snr_at_albedo"}, {"value", noise.value}, {"at_albedo", if_given(noise.at_albedo)}};
    }
    return nullptr;
}

Json band_json(const sensors::Band& b) {
    const auto& finer = b.sensitive_range;
    return {{"id", b.id},
            {"group", b.group},
            {"centre_um", b.centre_um},
            {"fwhm_um", b.fwhm_um},
            {"response", b.measured_response ? "measured" : "nominal"},
            {"response_lambda_um", b.response.lambda_um},
            {"response_value", b.response.value},
            {"noise", noise_json(b.noise)},
            {"saturation_radiance_W_m2_sr_um", if_given(b.saturation_radiance_W_m2_sr_um)},
            {"sensitive_range_W_m2_sr_um", finer ? Json(finer->maximum_W_m2_sr_um) : Json(nullptr)},
            {"sensitive_range_noise", finer ? noise_json(finer->noise) : Json(nullptr)},
            {"sensitive_range_share_of_counts", finer ? if_given(finer->share_of_counts) : Json(nullptr)},
            {"fold_over_factor", if_given(b.fold_over)},
            {"bits", if_given(b.bits)}};
}

}  // namespace

const char* scan_type_name(sensors::ScanType scan) noexcept {
    switch (scan) {
        case sensors::ScanType::Framing:
            return "framing";
        case sensors::ScanType::Pushbroom:
            return "pushbroom";
        case sensors::ScanType::Whiskbroom:
            return "whiskbroom";
        case sensors::ScanType::LineScanner:
            return "line_scanner";
        case sensors::ScanType::Conical:
            return "conical";
        case sensors::ScanType::SpinScan:
            return "spin_scan";
        case sensors::ScanType::GeoScan:
            return "geo_scan";
    }
    return "";
}

std::string sensor_json(const sensors::Sensor& sensor) {
    Json json = {{"id", sensor.id},
                 {"name", sensor.name},
                 {"file", sensor.source_path},
                 {"platform", sensor.platform_name},
                 {"airborne", sensor.airborne},
                 {"scan_type", scan_type_name(sensor.scan)},
                 {"groups", Json::array()},
                 {"bands", Json::array()},
                 {"confidence", Json::array()},
                 {"sources", Json::object()}};
    if (sensor.airborne) json["altitude_agl_m"] = sensor.altitude_agl_m;
    if (sensor.orbit)
        json["orbit"] = {{"height_m", sensor.orbit->height_m},
                         {"inclination_deg", sensor.orbit->inclination_deg},
                         {"geostationary_longitude_deg", if_given(sensor.orbit->geostationary_longitude_deg)}};
    for (const auto& g : sensor.groups) json["groups"].push_back(group_json(g));
    for (const auto& b : sensor.bands) json["bands"].push_back(band_json(b));
    for (const auto& [path, code] : sensor.confidence) json["confidence"].push_back({{"of", path}, {"code", code}});
    for (const auto& [key, text] : sensor.sources) json["sources"][key] = text;
    return json.dump(2);
}

}  // namespace pyroscene::pipeline
