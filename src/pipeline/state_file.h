#pragma once

#include <filesystem>

#include "fire/state.h"

namespace pyroscene::pipeline {

/// Name of the state file of a moment: state/t000003600.tif.
std::filesystem::path state_path(const std::filesystem::path& output, double time_s);

/// Writes a state as one multi-band GeoTIFF; the running statistics and the fingerprint are metadata.
void write_state(const std::filesystem::path& path, const fire::FireState& state, const std::string& fingerprint,
                 const std::string& acquisition_time);

/// Reads it back. `predicted_arrival` is the scenario's arrival raster, which the file does not repeat.
fire::FireState read_state(const std::filesystem::path& path, const MapGrid& grid,
                           const SharedRaster<float>& predicted_arrival);

}  // namespace pyroscene::pipeline
