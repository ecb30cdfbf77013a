#pragma once

#include <string>
#include <vector>

#include "base/report.h"
#include "fire/flame_field.h"
#include "inputs/scene_inputs.h"
#include "pipeline/optical_tables.h"
#include "radiometry/spectral_grid.h"
#include "radiometry/sun.h"
#include "radiometry/view_atmosphere.h"
#include "render/scene.h"
#include "sensors/image_chords.h"

namespace pyroscene::pipeline {

/// Pose of an acquisition's platform, from its place over the map and the terrain (or the fire) below.
/// Throws an input error: place outside the map, altitude below the terrain.
sensors::Pose resolve_pose(const scenario::Acquisition& acquisition, const inputs::SceneInputs& inputs,
                           const fire::FireState* state);

/// Pixels, path and times of one camera group's image: a frame, a flight line, a pass of a satellite, or a flown trajectory.
/// \param state  for `over: fire`; null puts the platform over the centre (to judge sizes before there is a fire)
/// Throws an input error: no orbit or speed for what is asked, a scene outside the swath.
sensors::ImageGeometry resolve_geometry(const scenario::Acquisition& acquisition, const inputs::SceneInputs& inputs,
                                        const fire::FireState* state, const sensors::Sensor& sensor,
                                        const sensors::CameraGroup& group);

/// Bands of one camera group that the acquisition asks for, as positions in Sensor::bands. May be empty.
std::vector<int> wanted_bands(const scenario::Acquisition& acquisition, const sensors::Sensor& sensor,
                              const std::string& group);

/// Groups of the sensor that the acquisition asks for and that have wanted bands. Throws an input error for unknown names.
std::vector<std::string> wanted_groups(const scenario::Acquisition& acquisition, const sensors::Sensor& sensor);

/// The fire as a camera sees it at one moment, free of any sensor.
struct FireScene {
    fire::SurfaceField surface;
    fire::FlameField flame;
    fire::FlameField plume;  ///< smoke; empty without one
    FlameGas gas;            ///< of the flame
    radiometry::TotalEmissivity burnt_emissivity;
};
FireScene make_fire_scene(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                          const fire::FireState& state, double time_s);

/// Everything spectral of one camera group.
struct SpectralScene {
    radiometry::SpectralGrid grid;
    render::SceneOptics optics;
    radiometry::ViewAtmosphere atmosphere;
    int surroundings_material = -1;  ///< of the ground around the scene; -1 = no data there
    double air_K = 0.0;              ///< near the ground; 0 without air
};
/// \param sensor_agl_m sensor height above the mean terrain  \param largest_view_zenith_rad of any pixel, to warn of
/// \param sun position at the scene centre
SpectralScene make_spectral_scene(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                                  const OpticalTables& tables, const FireScene& fire, const std::vector<Spectrum>& responses,
                                  double sensor_agl_m, double largest_view_zenith_rad, const radiometry::SunPosition& sun,
                                  RunReport& report);

/// The transport wavelengths alone, as make_spectral_scene() picks them.
radiometry::SpectralGrid transport_grid(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                                        const OpticalTables& tables, const std::vector<Spectrum>& responses,
                                        double sensor_agl_m, const radiometry::SunPosition& sun);

/// Where the tables of the air end before what an image asks of them, and what is taken instead.
std::vector<std::string> air_warnings(const scenario::Scenario& scenario, const OpticalTables& tables, double sensor_agl_m,
                                      double largest_view_zenith_rad, const radiometry::SunPosition& sun);

}  // namespace pyroscene::pipeline
