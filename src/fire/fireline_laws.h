#pragma once

#include "fire/flame_extent.h"

namespace pyroscene::fire {

/// What flame-size relations are made of. Each relation reads what its description names; the rest may stay as it is.
struct FlameHeightInputs {
    double heat_flux_W_m2 = 0.0;          ///< mean over the cell
    double heat_release_W = 0.0;          ///< of the burning area
    double diameter_m = 0.0;              ///< of the circle with the burning area
    double fireline_intensity_W_m = 0.0;  ///< heat released per time and metre of front
    double front_depth_m = 0.0;           ///< of the flaming zone, along the spread
    double given_length_m = 0.0;          ///< read from a raster
    double alpha = 1.0;                   ///< scale of method 1, dimensionless
    double volumetric_heat_release_W_m3 = 2.0e6;
    double plume_coefficient_m_kW = 0.235;  ///< Heskestad's A [m kW^-2/5]
    double constant_m = 2.0;
};

// Laws L = a I^b between fireline intensity I [kW m-1] and flame LENGTH L [m]. They hold for line fires whose flames are much
// longer than the front is deep. Coefficients as compiled by Finney & Grumstrup 2023 (Int. J. Wildland Fire). I <= 0 or NaN: 0.
// Values in the comments are those at 100, 1000 and 10000 kW m-1.

/// Byram 1959 (thesis eq 4.28): 0.0775 I^0.46, needle litter; low for shrubs. 0.64462, 1.85910, 5.36169 m.
double flame_length_byram_m(const FlameHeightInputs& in) noexcept;
/// Weise & Biging 1996 (thesis eq 4.30): 0.016 I^0.70, sticks and excelsior in a wind tunnel, low I. 0.40190, 2.01428, 10.0953 m.
double flame_length_weise_biging_m(const FlameHeightInputs& in) noexcept;
/// Thomas 1963: 0.0266 I^(2/3), wood cribs and crown fires (0.0267 in some compilations). 0.57308, 2.66000, 12.3466 m.
double flame_length_thomas_m(const FlameHeightInputs& in) noexcept;
/// Nelson & Adkins 1986: 0.0475 I^0.493, needles and palmetto. 0.45993, 1.43118, 4.45342 m.
double flame_length_nelson_adkins_m(const FlameHeightInputs& in) noexcept;
/// Nelson et al. 2012, laboratory: 0.0142 I^(2/3), head fires in southern fuels. 0.30593, 1.42, 6.59106 m.
double flame_length_nelson_lab_m(const FlameHeightInputs& in) noexcept;
/// Nelson et al. 2012, field: 0.0155 I^(2/3). 0.33394, 1.55, 7.19446 m.
double flame_length_nelson_field_m(const FlameHeightInputs& in) noexcept;
/// Butler et al. 2004: 0.0175 I^(2/3), crown fire, ABOVE the top of the stand. 0.37703, 1.75000, 8.12278 m.
double flame_length_butler_m(const FlameHeightInputs& in) noexcept;
/// Clark 1983: 0.000722 I^0.9934, head fires in grass. 0.07004, 0.68982, 6.79418 m.
double flame_length_clark_m(const FlameHeightInputs& in) noexcept;
/// Fernandes et al. 2009: 0.045 I^0.543, maritime pine litter. 0.54855, 1.91519, 6.68671 m.
double flame_length_fernandes_m(const FlameHeightInputs& in) noexcept;
/// Finney & Grumstrup 2023: 0.01051 I^0.774 D^-0.161 with the depth D [m] of the flaming zone; 0 where D is not above 0.
/// D = 1 m: 0.37120, 2.20599, 13.1100 m; 5 m: 0.28646, 1.70243, 10.1174 m.
double flame_length_finney_grumstrup_m(const FlameHeightInputs& in) noexcept;

}  // namespace pyroscene::fire
