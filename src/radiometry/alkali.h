#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "base/flame_gas.h"
#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Farther than this from its centre [um] a line absorbs nothing: a Lorentz wing is not to be trusted there.
inline constexpr double kAlkaliReach_um = 0.03;

/// A resonance line of neutral alkali atoms.
struct AlkaliLine {
    double wavelength_um = 0.0;  ///< vacuum
    double oscillator_strength = 0.0;
    double mass_u = 0.0;
    /// Collisional full width: fwhm P (reference_K / T)^exponent [1/cm]; known to +-40 % only.
    double collision_fwhm_per_cm_atm = 0.0, collision_reference_K = 0.0, collision_exponent = 0.0;
};

/// Doublets of potassium (767, 770 nm) and sodium (589 nm), two lines each.
struct AlkaliLines {
    std::vector<AlkaliLine> potassium, sodium;
};

/// Reads data/optical/alkali_lines.csv. Throws an input error that names file and line.
AlkaliLines load_alkali_lines(const std::filesystem::path& path);

/// Full widths at half maximum [Hz]: thermal (thesis eq 3.5) and collisional. The natural width (eq 3.3, 1.2e-5 nm) is a
/// thousandth of the collisional one and left out; eq 3.6 is an order of magnitude.
struct LineWidths {
    double gauss_Hz, lorentz_Hz;
};
LineWidths line_widths(const AlkaliLine& line, double T_K, double pressure_atm) noexcept;

/// Absorption coefficient of free atoms at one wavelength [1/m], stimulated emission included:
///   k = e^2 / (4 eps0 m_e c) f N (1 - exp(-h nu / kT)) V(nu),   N = x P / (k_B T)
/// Emission is B(T) k (Kirchhoff). Nearly all atoms are neutral and in the ground state: at 1100 K and 1 ppm 4e-7 are ions.
/// \param mole_fraction  free atoms per molecule (1 ppm = 1e-6)
double line_absorption_per_m(const AlkaliLine& line, double lambda_um, double T_K, double mole_fraction,
                             double pressure_atm) noexcept;
/// Sum over lines, each as far as kAlkaliReach_um.
double doublet_absorption_per_m(std::span<const AlkaliLine> lines, double lambda_um, double T_K, double mole_fraction,
                                double pressure_atm) noexcept;

/// Potassium and sodium of a mixture together [1/m].
double alkali_absorption_per_m(const AlkaliLines& lines, double lambda_um, double T_K, const FlameGas& gas) noexcept;

/// Wavelengths [um] that resolve a doublet between two limits: dense at the line centres, sparse in the wings, so that the
/// trapezium rule over them integrates functions of k to about 1e-4. Ascending, with both limits.
std::vector<double> doublet_wavelengths_um(std::span<const AlkaliLine> lines, double lower_um, double upper_um);

/// Equivalent width W = int (1 - exp(-k L)) d lambda [um] of a doublet over +-0.03 um around it, by quadrature.
/// The limit takes 1.4 % off a W of 7 nm and 0.1 % off one of 1.4 nm.
/// \param x_path_m  mole fraction times path
double equivalent_width_um(std::span<const AlkaliLine> lines, double x_path_m, double T_K, double pressure_atm);

/// The same, tabulated over ln(x L) and ln T at one pressure for x L from 1e-12 to 1e-3 m and 800 to 2000 K; linear in the
/// logarithms between nodes (0.2 % of the quadrature), clamped in T, linear in x L below.
class EquivalentWidthTable {
public:
    EquivalentWidthTable(std::span<const AlkaliLine> lines, double pressure_atm);
    [[nodiscard]] double at_um(double x_path_m, double T_K) const noexcept;

private:
    std::vector<double> ln_width_;  ///< [temperature][x path]
};

/// Band radiance of an isothermal flame with the atoms over that without, cold black background: the resolved integral
///   1 + int r B exp(-tau_c) (1 - exp(-k L)) / int r B (1 - exp(-tau_c)),  tau_c the optical depth of all else (constant here).
/// Its limit is 1 / eps_c: a thick flame shows no line.
double alkali_band_ratio(std::span<const AlkaliLine> lines, const Spectrum& response, double continuum_depth,
                         double x_path_m, double T_K, double pressure_atm);

}  // namespace pyroscene::radiometry
