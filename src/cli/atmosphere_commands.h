#pragma once

#include <string>

namespace CLI {
class App;
}

namespace pyroscene::cli {

/// Adds `import-atmosphere` and `atmosphere-deck` to the program's commands. Both run while the command line is parsed.
void add_atmosphere_commands(CLI::App& app, const bool& quiet, const std::string& command_line);

}  // namespace pyroscene::cli
