#pragma once

#include <string>

#include "sensors/sensor.h"

namespace pyroscene::pipeline {

/// The sensor files' word for a scan type.
const char* scan_type_name(sensors::ScanType scan) noexcept;

/// A sensor as JSON text: height or orbit, camera groups with their scan (sensors/scan.h), bands with response, noise, saturation
/// and counts, confidence of the numbers, sources. Units in the names; null: not in the file, or none.
std::string sensor_json(const sensors::Sensor& sensor);

}  // namespace pyroscene::pipeline
