#pragma once

namespace pyroscene::radiometry {

/// Voigt function K(x, y) = y/pi int exp(-t^2) / (y^2 + (x - t)^2) dt, the real part of the Faddeeva function.
/// \param x  distance from the line centre, \param y > 0 Lorentz half-width, both in units of Doppler's 1/e half-width
/// Weideman (1994, SIAM J. Numer. Anal. 31:1497) with 32 terms: relative error below 1e-8 for y > 0.01.
double voigt_function(double x, double y) noexcept;

/// Line profile normalised to unit area over frequency [1/Hz].
/// \param offset_Hz from the centre   \param gauss_fwhm_Hz, lorentz_fwhm_Hz  full widths at half maximum, > 0
double voigt_profile_per_Hz(double offset_Hz, double gauss_fwhm_Hz, double lorentz_fwhm_Hz) noexcept;

}  // namespace pyroscene::radiometry
