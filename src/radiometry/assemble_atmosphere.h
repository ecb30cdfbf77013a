#pragma once

#include <string>
#include <vector>

#include "radiometry/atmosphere_run.h"
#include "radiometry/atmosphere_table.h"

namespace pyroscene::radiometry {

/// A look-up table made of runs, and what had to be assumed because no run tells it.
struct AssembledAtmosphere {
    AtmosphereTable table;
    std::vector<std::string> notes;
};

/// Puts runs on the nodes of a table.
///   path      transmittance, path thermal and path solar radiance come from the runs that look down, one for each sensor
///             altitude, view zenith, sun zenith and relative azimuth (0, 90, 180, or one that then stands for all)
///   sun       direct and diffuse irradiance of the ground from a run that names them, or from reflecting ground of albedo A:
///             E_dir cos s = pi DRCT_RFLT / (A tau),  E(A) = pi GRND_RFLT / (A tau) = E(0) / (1 - A S)
///   S, t_d    spherical albedo from two albedos; t_d = pi (L_ps(A) - L_ps(0)) / (A E(A))
///   sky       thermal irradiance from runs that name it, that look up, or that reflect it without a sun
/// A single view angle is extended by Beer's law: optical depth grows with the secant, sources L / (1 - tau) stay.
/// Runs for different wavelengths are joined; where two overlap the first one holds.
/// Throws an input error that names what is missing: geometry of a run, a node of the grid, the sun at the ground.
/// \param without_sun leave out all solar terms
AssembledAtmosphere assemble_atmosphere(std::vector<AtmosphereRun> runs, bool without_sun);

}  // namespace pyroscene::radiometry
