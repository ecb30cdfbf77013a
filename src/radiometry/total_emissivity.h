#pragma once

#include <array>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Emissivity of an opaque surface over all wavelengths: what it radiates at a temperature over sigma T^4.
struct TotalEmissivity {
    static constexpr double kFirst_K = 250.0, kStep_K = 250.0;
    std::array<double, 8> value{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};  ///< at 250, 500, ... 2000 K

    /// Linear between the nodes; the end values beyond.
    [[nodiscard]] double at(double T_K) const noexcept;
};

/// Mean of 1 - reflectance weighted with Planck's law at each node. The spectrum goes on with its end values where it has none;
/// shipped ones (0.35 to 15.5 um) cover all but 1e-4 of the radiation at 1000 K and nine tenths of it at 500 K.
TotalEmissivity total_emissivity(const Spectrum& reflectance);

}  // namespace pyroscene::radiometry
