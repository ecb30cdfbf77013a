#pragma once

#include <string>

namespace pyroscene::cli {

/// `pyroscene sensors [ID] [--json]` on standard output.
void list_sensors(bool json);
void show_sensor(const std::string& id_or_path, bool json);

}  // namespace pyroscene::cli
