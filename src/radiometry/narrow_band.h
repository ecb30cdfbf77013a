#pragma once

#include "base/flame_gas.h"
#include "radiometry/gas_table.h"

namespace pyroscene::radiometry {

/// Pressure of the U.S. Standard Atmosphere 1976 below 11 km:  p = p0 (1 - 0.0065 h / 288.15)^5.2559.
double standard_pressure_Pa(double height_m) noexcept;

inline double pressure_atm(const FlameGas& gas) noexcept { return gas.pressure_Pa / kAtmosphere_Pa; }

/// Absorption of one species at one wavelength in the statistical narrow-band model.
struct GasAbsorption {
    double per_m = 0.0;    ///< kappa p: weak-line absorption coefficient [1/m], a mean over 5 to 50 1/cm
    double a_lorentz = 0;  ///< a_C = gamma_C / d: how much the lines overlap by collisions
    double a_doppler = 0;  ///< a_D = gamma_D / d: by thermal motion; 0 for CH4, whose model has no Doppler part
};

/// Looks one species up. Collisional half-widths are sums over the partners of NASA SP-3080 as in RADCAL,
///   gamma_C = sqrt(273/T) sum_j g_j p_j + g_res (273/T) p_self,     gamma_D = 5.94e-6 omega sqrt(T / (273 M))   [1/cm]
/// \param lambda_um > 0, absorbs between 1.075 and 16.7 um   \param T_K clamped to 300 .. 2000
/// \param gas pressure and all mole fractions count: partners widen the lines
GasAbsorption gas_absorption(const GasOptics& optics, GasSpecies species, double lambda_um, double T_K,
                             const FlameGas& gas) noexcept;

/// What a ray has gathered of one species: Curtis-Godson sums over its pieces (both approximations exact for one piece).
struct GasColumn {
    double x = 0.0;            ///< sum of kappa p length: optical depth if lines were infinitely wide
    double x_a_lorentz = 0.0;  ///< sum of x a_C
    double x_a_doppler = 0.0;  ///< sum of x a_D

    void add(const GasAbsorption& absorption, double length_m) noexcept;
};

/// Optical depth of the gathered gas: -ln of its mean transmittance, with a = sum(x a) / sum(x).
///   x_C = x / sqrt(1 + x / 4 a_C),   x_D = 1.7 a_D sqrt(ln(1 + (x / 1.7 a_D)^2)),
///   y = (1 - (x_C/x)^2)^-2 + (1 - (x_D/x)^2)^-2 - 1,   depth = x sqrt(1 - y^-1/2)
/// CH4, whose lines are evenly spaced:  depth = -ln(1 - erf(sqrt(4 a_C) x / sqrt(16 a_C / pi + x)))
/// Source: Ludwig, Malkmus et al. 1973 (NASA SP-3080); Grosshandler 1993 (NIST TN 1402).
double gas_optical_depth(GasSpecies species, const GasColumn& column) noexcept;

}  // namespace pyroscene::radiometry
