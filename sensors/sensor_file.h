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

/// How signals are counted, for bands that say nothing of their own.
struct Digitisation {
    std::optional<int> visible_bits{}, thermal_bits{};
    double exposure_ratio = 1.0;  ///< nominal to short, of instruments that take both

    [[nodiscard]] std::optional<int> bits(double centre_um) const noexcept;
};
Digitisation read_digitisation(const config::Node& node);

/// Fills sensor.bands from `bands` or `spectral` of the file. Needs sensor.groups and sensor.source_path.
void read_bands(const config::Node& root, const Digitisation& digitisation, Sensor& sensor);

/// Noise, bits, saturation and gains of a band whose centre and response are known.
void read_detector(const config::Node& node, const Digitisation& digitisation, Band& band);
/// The same for the channels of an imaging spectrometer, from `noise` and `saturation` of the file.
void read_channel_detectors(const config::Node& root, const Digitisation& digitisation, std::vector<Band>& bands);

/// Fills sensor.native_form and native_gain from `distribution`. Needs sensor.bands.
void read_distribution(const config::Node& distribution, Sensor& sensor);

}  // namespace pyroscene::sensors
