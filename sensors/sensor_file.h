#pragma once

#include <filesystem>

#include "config/yaml.h"
#include "sensors/sensor.h"

// Parts of the sensor file reader; load_sensor() of sensor.h is the way in.
namespace pyroscene::sensors {

/// Reads one file of schema pyroscene-sensor/1. Throws one input error with all its problems.
Sensor read_sensor_file(const std::filesystem::path& path);

/// Fills group.scan and group.views, and group.samples and group.lines where they follow from them. Needs the platform, and
/// of the group its id, samples, lines, focal length and pitch.
void read_scan(const config::Node& geometry, const config::Node& node, const Sensor& sensor, CameraGroup& group);

/// Fills sensor.bands from `bands` or `spectral` of the file. Needs sensor.groups and sensor.source_path.
/// \param bits  of digitisation, for the bands that give none of their own
void read_bands(const config::Node& root, std::optional<int> bits, Sensor& sensor);

/// Fills sensor.native_form and native_gain from `distribution`. Needs sensor.bands.
void read_distribution(const config::Node& distribution, Sensor& sensor);

}  // namespace pyroscene::sensors
