#pragma once

#include <vector>

#include "radiometry/flame_optics.h"

namespace pyroscene::radiometry {

/// One part of a wavelength's absorption: `weight` of the spectrum around it absorbs with `k_per_m`.
struct AbsorptionPart {
    double k_per_m = 0.0, weight = 1.0;
};

/// k-distribution of a flame at one wavelength and temperature: transmittance of a path s of flame is sum_i w_i exp(-k_i s)
/// with weights that are positive and sum to 1, fitted to the narrow-band model between 0.01 and 300 m. Soot and atoms
/// follow Beer's law and shift all k. Largest error of the transmittance 3e-3 (tested); one part when no gas absorbs.
std::vector<AbsorptionPart> absorption_mix(const FlameOptics& optics, const FlameGas& gas, double lambda_um, double T_K);

}  // namespace pyroscene::radiometry
