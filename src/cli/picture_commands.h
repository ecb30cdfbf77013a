#pragma once

namespace CLI {
class App;
}

namespace pyroscene::cli {

/// Adds `plot` (a diagram of a table's columns) and `picture` (bands of a raster as PNG). Both throw input errors.
void add_picture_commands(CLI::App& app, const bool& quiet);

}  // namespace pyroscene::cli
