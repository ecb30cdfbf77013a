#pragma once

namespace pyroscene::radiometry {

/// The thesis's Appendix A, kept to reproduce its figures. It is wrong in ways that matter: the 766/770 nm lines belong to
/// neutral potassium, yet the emitters are taken to be the ions (factor f, 4e-7 at 1100 K and 1 ppm); emission grows linearly
/// with the atoms though the line centres are opaque after a millimetre; the second line is a fixed 60 % of the first; and a
/// power into 4 pi from a volume is compared with blackbody power through the sensor's aperture. `alkali.h` is the model to use.
struct ThesisPotassium {
    double electron_density_per_m3 = 1e17;       ///< n_e, not stated in the thesis
    double potassium_density_per_m3 = 6.7e18;    ///< Na: 1 ppm at 1100 K; not stated
    double decay_rate_per_s = 3.8e7;             ///< a
    double excited_share = 1.0;                  ///< K1 per ion
    double excited_energy_J = 1.69 * 1.602e-19;  ///< E1: 1.69 eV as in thesis 2.1 (1.61 in truth)
    double volume_m3 = 1.0;                      ///< V
    double aperture_m2 = 1e-4;                   ///< A_i
    double partition_ratio = 0.5;                ///< Z of the ion over Z of the atom (the caption swaps them)
};

/// Fraction of ions, eq A.1 and A.2, with the constants as printed (E_i 6.92064e-19 J, k 1.38e-23, h 6.63e-34).
double thesis_ionised_fraction(const ThesisPotassium& in, double T_K) noexcept;

/// Power of both lines into 4 pi [W], eq A.3 and A.4:  P = 1.6 Na a K1 E1 f V.
double thesis_potassium_power_W(const ThesisPotassium& in, double T_K) noexcept;

/// Power ratio of potassium to blackbody, eq A.5 to A.8, for the window of one line; 1e-9 is applied twice, as printed, and the
/// sum runs over steps of 0.01 nm. \param lower_nm, upper_nm e.g. 766.40 and 766.60
double thesis_potassium_ratio(const ThesisPotassium& in, double T_K, double emissivity, double lower_nm,
                              double upper_nm) noexcept;

/// What eq A.1 and A.2 mean for a gas whose only electrons come from potassium: f^2 / (1 - f) = S(T) / N, CODATA constants and
/// the energy of neutral potassium, 4.3407 eV. \param atoms_per_m3 N, all potassium
double potassium_ionised_fraction(double T_K, double atoms_per_m3) noexcept;

}  // namespace pyroscene::radiometry
