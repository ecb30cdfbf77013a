#pragma once

#include <string>

#include "sensors/sensor.h"

namespace pyroscene::pipeline {

/// The sensor files' word for a scan type.
const char* scan_type_name(sensors::ScanType scan) noexcept;

/// A sensor as JSON text: bands with response, noise and saturation, camera groups, confidence of the numbers, sources.
std::string sensor_json(const sensors::Sensor& sensor);

}  // namespace pyroscene::pipeline
