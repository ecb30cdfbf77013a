#include "sensors/sensor.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/files.h"
#include "config/yaml.h"
#include "sensors/sensor_file.h"

namespace fs = std::filesystem;

namespace pyroscene::sensors {

const CameraGroup& Sensor::group(const std::string& group_id) const {
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const CameraGroup& g) { return g.id == group_id; });
    if (found != groups.end()) return *found;
    std::vector<std::string> ids;
    for (const auto& g : groups) ids.push_back(g.id);
    throw input_error(fmt::format("sensor {}", id), fmt::format("no group '{}'; it has {}", group_id, fmt::join(ids, ", ")));
}

std::vector<int> Sensor::bands_of(const std::string& group_id) const {
    std::vector<int> indices;
    for (std::size_t i = 0; i < bands.size(); ++i)
        if (bands[i].group == group_id) indices.push_back(static_cast<int>(i));
    return indices;
}

int Sensor::band_index(const std::string& band_id) const {
    const auto found = std::find_if(bands.begin(), bands.end(), [&](const Band& b) { return b.id == band_id; });
    return found == bands.end() ? -1 : static_cast<int>(found - bands.begin());
}

Sensor load_sensor(const std::string& id_or_path) {
    const fs::path path = id_or_path;
    if (id_or_path.find('/') != std::string::npos || path.extension() == ".yaml" || path.extension() == ".yml")
        return read_sensor_file(path);
    const auto ids = sensor_ids();
    if (std::find(ids.begin(), ids.end(), id_or_path) != ids.end())
        return read_sensor_file(sensor_folder() / "specs" / (id_or_path + ".yaml"));
    const std::string guess = config::nearest(id_or_path, ids);
    throw input_error("sensor",
                      fmt::format("no sensor '{}'{}; there are {} (or give the path of a .yaml file)", id_or_path,
                                  guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess), fmt::join(ids, ", ")));
}

std::vector<std::string> sensor_ids() {
    std::vector<std::string> ids;
    for (const auto& entry : fs::directory_iterator(sensor_folder() / "specs"))
        if (entry.path().extension() == ".yaml") ids.push_back(entry.path().stem().string());
    std::sort(ids.begin(), ids.end());
    return ids;
}

}  // namespace pyroscene::sensors
