#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "gis/image_stream.h"
#include "sensors/sensor.h"

namespace pyroscene::imagery {

/// The sensor that took an image: the one given (id or file), else the shipped one that the image names. An image may come from a
/// sensor file of the user's own, whose path it does not tell: nullopt then.
std::optional<sensors::Sensor> sensor_of_image(const gis::ImageInfo& info, const std::optional<std::string>& sensor);

/// The sensor's band that a band of an image is: the one of the same id, else the one whose centre lies within a quarter of its width.
/// \param band  has a wavelength
/// Throws an input error about the image when the sensor has no such band.
const sensors::Band& band_of_image(const sensors::Sensor& sensor, const gis::OutputBand& band,
                                   const std::filesystem::path& image);

}  // namespace pyroscene::imagery
