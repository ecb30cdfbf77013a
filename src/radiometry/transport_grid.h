#pragma once

#include <span>
#include <vector>

#include "radiometry/atmosphere.h"
#include "radiometry/flame_optics.h"
#include "radiometry/spectral_grid.h"

namespace pyroscene::radiometry {

/// What gives band radiances fine structure.
struct SpectralStructure {
    const FlameOptics* flame = nullptr;  ///< null: no gas, no lines
    FlameGas gas;
    std::vector<AtmosphericTerms> air;  ///< a few lines of sight of the scene; empty = vacuum
};

/// Grid for bands in which gas of the flame or of the air absorbs, alkali lines or strong lines of the sun lie: nodes are single wavelengths picked, with weights >= 0, so
/// that the band means of a training set of scenes come out right: blackbodies of 300 to 2000 K (5e-5; dark bands 7e-4),
/// flames of three temperatures and four lengths before black and hot ground, layered and lean flames, ambient ground by day and
/// night, scattered sun, each through vacuum or through every line of sight (7e-4). Optimal spectral sampling (Moncet et al. 2008, J. Atmos. Sci. 65:3917) with
/// Lawson and Hanson's non-negative least squares. All quantities are taken at the nodes themselves, so that lines, soot and
/// air keep their correlation. Other bands are cut as by make_spectral_grid(responses).
/// Throws as that one.
SpectralGrid make_spectral_grid(std::span<const Spectrum> responses, const SpectralStructure& structure);

}  // namespace pyroscene::radiometry
