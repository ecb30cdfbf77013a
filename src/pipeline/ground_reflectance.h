#pragma once

#include <string>
#include <vector>

#include "radiometry/spectral_grid.h"
#include "radiometry/surfaces.h"
#include "radiometry/total_emissivity.h"
#include "scenario/scenario.h"

namespace pyroscene::pipeline {

/// Shipped surface spectra and those of the scenario. Throws an input error naming what is wrong with a file.
radiometry::SurfaceLibrary scenario_surfaces(const scenario::Scenario& scenario);

/// Reflectance of the materials on the spectral grid, [material][node]: the covers in their order, then burnt ground, which is
/// char with the share `surface.burn_severity` of ash. One grey emissivity replaces all.
/// Throws an input error: unknown surface, a spectrum of the user's that does not cover the grid.
std::vector<float> ground_reflectance(const scenario::Scenario& scenario, const std::vector<std::string>& covers,
                                      const radiometry::SpectralGrid& grid);

/// Emissivity of burnt ground over all wavelengths.
radiometry::TotalEmissivity burnt_emissivity(const scenario::Scenario& scenario);

}  // namespace pyroscene::pipeline
