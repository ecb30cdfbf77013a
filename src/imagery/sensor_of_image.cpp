#include "imagery/sensor_of_image.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::imagery {

std::optional<sensors::Sensor> sensor_of_image(const gis::ImageInfo& info, const std::optional<std::string>& sensor) {
    if (sensor) return sensors::load_sensor(*sensor);
    const auto named = info.metadata.find("SENSOR");
    if (named == info.metadata.end()) return {};
    const auto shipped = sensors::sensor_ids();
    if (std::find(shipped.begin(), shipped.end(), named->second) == shipped.end()) return {};
    return sensors::load_sensor(named->second);
}

const sensors::Band& band_of_image(const sensors::Sensor& sensor, const gis::OutputBand& band,
                                   const std::filesystem::path& image) {
    const auto id = band.metadata.find("band_id");
    int index = id == band.metadata.end() ? -1 : sensor.band_index(id->second);
    for (std::size_t b = 0; index < 0 && b < sensor.bands.size(); ++b)
        if (std::abs(sensor.bands[b].centre_um - *band.wavelength_um) < 0.25 * sensor.bands[b].fwhm_um)
            index = static_cast<int>(b);
    if (index < 0)
        throw input_error(image.string(), fmt::format("sensor {} has no band at {} um", sensor.id, *band.wavelength_um));
    return sensor.bands[static_cast<std::size_t>(index)];
}

}  // namespace pyroscene::imagery
