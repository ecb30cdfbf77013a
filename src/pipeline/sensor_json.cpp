#include "pipeline/sensor_json.h"

#include <nlohmann/json.hpp>

namespace pyroscene::pipeline {

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
    using Json = nlohmann::ordered_json;
    const auto optional = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
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
    for (const auto& g : sensor.groups)
        json["groups"].push_back({{"id", g.id},
                                  {"samples", g.samples},
                                  {"lines", g.lines},
                                  {"focal_length_m", g.focal_length_m},
                                  {"pixel_pitch_m", g.pixel_pitch_m}});
    for (const auto& b : sensor.bands)
        json["bands"].push_back(
            {{"id", b.id},
             {"group", b.group},
             {"centre_um", b.centre_um},
             {"fwhm_um", b.fwhm_um},
             {"response", b.measured_response ? "measured" : "nominal"},
             {"response_lambda_um", b.response.lambda_um},
             {"response_value", b.response.value},
             {"saturation_radiance_W_m2_sr_um", optional(b.saturation_radiance_W_m2_sr_um)},
             {"sensitive_range_W_m2_sr_um", b.sensitive_range ? Json(b.sensitive_range->maximum_W_m2_sr_um) : Json()},
             {"fold_over_factor", optional(b.fold_over)},
             {"bits", optional(b.bits)}});
    for (const auto& [path, code] : sensor.confidence) json["confidence"].push_back({{"of", path}, {"code", code}});
    for (const auto& [key, text] : sensor.sources) json["sources"][key] = text;
    return json.dump(2);
}

}  // namespace pyroscene::pipeline
