#pragma once

#include <filesystem>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Rayleigh-limit absorption constant of flame soot over wavelength: C = 6 pi Im((m^2-1)/(m^2+2)), dimensionless.
struct SootOptics {
    Spectrum absorption_constant;  ///< C, Quantity::Dimensionless
};

/// Reads the columns wavelength_um and C (data/optical/soot_optics.csv: Chang & Charalampopoulos 1990, 0.4 to 15 um).
/// Throws an input error: unreadable, fewer than two rows, wavelengths not ascending, C not positive.
SootOptics load_soot_optics(const std::filesystem::path& path);

/// C at a wavelength: linear between the samples; outside them the power law through the two outermost samples, an
/// extrapolation without data behind it.
double soot_absorption_constant(const SootOptics& soot, double lambda_um) noexcept;

/// Absorption coefficient of soot that takes the share `volume_fraction` of space:  kappa = C fv / lambda  [1/m]
/// (particles much smaller than the wavelength; scattering neglected).
/// \param lambda_um > 0   \param volume_fraction m3 of soot per m3, 0 gives 0; flames 5e-8 to 1e-6
double soot_absorption_per_m(const SootOptics& soot, double lambda_um, double volume_fraction) noexcept;

/// Planck mean of the above, 1340 fv T [1/m] (1000 to 1100 K).
double soot_planck_mean_per_m(double volume_fraction, double T_K) noexcept;

}  // namespace pyroscene::radiometry
