#pragma once

#include <atomic>

namespace CLI {
class App;
}

namespace pyroscene::cli {

/// Adds the verbs `detect`, `index` and `fre`; their work is done while the command line is parsed.
void add_detection_commands(CLI::App& app, const bool& quiet, const std::atomic<bool>& interrupted);

}  // namespace pyroscene::cli
