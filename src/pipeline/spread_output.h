#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/report.h"
#include "inputs/modelled_fire.h"

namespace pyroscene::pipeline {

/// Writes what a fire does as it passes: arrival.tif, and spread_rate.tif, fireline_intensity.tif and flame_length.tif where it knows
/// them. \param fingerprint  kept in the files
void write_front_rasters(const inputs::ModelledFire& fire, const std::filesystem::path& folder,
                         const std::string& fingerprint);

/// Writes its frames: heat_flux.tif and fuel_load.tif, a band per frame with time_s; fuel_load.tif begins with the load at 0 s.
/// \param utc  start of the clock
/// \param on_progress  called with the fraction done; may throw to cancel
void write_fire_frames(const inputs::ModelledFire& fire, const std::filesystem::path& folder, const std::string& fingerprint,
                       const std::string& utc, const std::function<void(double)>& on_progress);

/// Burnt area, largest rate, intensity and flame length, heat and fuel up to the last frame, as spread/... of the report.
void record_spread(RunReport& report, const inputs::ModelledFire& fire);

}  // namespace pyroscene::pipeline
