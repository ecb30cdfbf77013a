#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/raster.h"
#include "base/vec3.h"
#include "fire/state.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "inputs/modelled_fire.h"
#include "inputs/wind_inputs.h"
#include "scenario/scenario.h"

namespace pyroscene::inputs {

/// Everything of a scenario that does not change with time, on the map grid.
struct SceneInputs {
    MapGrid grid;
    Raster<float> terrain_m;               ///< ellipsoidal height
    Raster<std::uint8_t> cover;            ///< index into the surface library of unburnt ground
    std::vector<std::string> cover_names;  ///< what the indices mean (surface spectrum names)
    SharedRaster<float> arrival_time_s;
    fire::FrontInputs front;                ///< what the scenario's flame relations read
    Raster<std::uint8_t> scar_class;        ///< see fire::FrameInputs::scar_class
    std::optional<WindLevels> wind_levels;  ///< where inputs.wind says its height
    std::optional<ModelledFire> modelled;   ///< of a spread model; heat flux comes from it
    std::vector<FrameSource> frames;        ///< of the heat flux, ascending in time
    Vec3 origin_m;                          ///< map x, y of the scene frame's origin (centre of the grid), z = 0
    gis::Geodetic centre;                   ///< of the map, at mean terrain height
    double lowest_m = 0.0, highest_m = 0.0, mean_height_m = 0.0;
};

/// Reads the static inputs and spreads the fire where the scenario asks for it. Throws an input error for the first thing wrong.
/// \param on_progress  called with the fraction of the fire's time that is spread; may throw to cancel
SceneInputs load_scene_inputs(const scenario::Scenario& scenario, const std::function<void(double)>& on_progress = {});

/// The frames of the heat-flux input, ascending in time. Throws an input error: no time_s, times not ascending, too few bands.
std::vector<FrameSource> heat_flux_frames(const scenario::RasterSource& source);

/// Reads the rasters of one frame onto the map grid. The frame refers to `inputs`, which must outlive it.
fire::FrameInputs load_frame(const scenario::Scenario& scenario, const SceneInputs& inputs, std::size_t frame);

/// Index of the last frame at or before a time. Throws an input error naming the acquisition when there is none.
std::size_t frame_at(const std::vector<FrameSource>& frames, double time_s, const std::string& acquisition_id);

/// Files whose content decides the fire states (rasters), in a fixed order without repetition.
std::vector<std::filesystem::path> input_files(const scenario::Scenario& scenario);

}  // namespace pyroscene::inputs
