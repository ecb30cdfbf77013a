#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/spectrum.h"

/// Blackbody radiance: single wavelengths, band integrals, their inverses, and a table for inner loops.
/// Radiances are W m-2 sr-1 um-1 (spectral, or the mean of a band) unless a name or comment says otherwise.
namespace pyroscene::radiometry {

/// Spectral radiance of a blackbody (Planck).
///   B = c1L / lambda^5 / (exp(c2 / (lambda T)) - 1),   c1L = 2 h c^2,  c2 = h c / k
/// \param lambda_um vacuum wavelength [um], > 0   \param T_K temperature [K]; T_K <= 0 gives 0, NaN gives NaN
/// \return [W m-2 sr-1 um-1]
/// Source: thesis eq 2.4, which is the exitance per metre of wavelength (pi x 1e6 x this). Constants: CODATA 2018.
double planck_radiance(double lambda_um, double T_K) noexcept;

/// Temperature of the blackbody with this spectral radiance, the inverse of planck_radiance.
/// \return [K]; NaN for a radiance that is NaN, zero or negative (no temperature can be given)
double brightness_temperature(double lambda_um, double radiance) noexcept;

/// Integral of the Planck function over [lower_um, upper_um], i.e. over a boxcar of height 1.
/// \param T_K <= 0 gives 0, NaN gives NaN   \param lower_um >= 0   \param upper_um >= lower_um
/// \return [W m-2 sr-1], relative error below 1e-12 (Gauss-Legendre panels in x = c2 / (lambda T))
double band_radiance(double T_K, double lower_um, double upper_um);

/// Response-weighted mean  int R B dl / int R dl  over the polyline `response` (zero outside its first and last point;
/// two points at one wavelength are a vertical edge). Relative error below 1e-11.
/// \param T_K <= 0 gives 0, NaN gives NaN
/// Throws an input error for a response that is empty, negative, not ascending or zero everywhere.
double band_mean_radiance(double T_K, const Spectrum& response);

/// Temperature whose band_mean_radiance is `radiance_mean`; residual below 1e-9 K for 150 to 3000 K.
/// \param near_K  where to begin to search; 0 = by itself
/// \return [K]; NaN for a radiance that is NaN, zero or negative
double band_brightness_temperature(double radiance_mean, const Spectrum& response, double near_K = 0.0);

/// band_brightness_temperature for whole images: the difference between the band temperature and the brightness
/// temperature at one wavelength of the band is tabulated (cubic Hermite in ln T), so a call costs one logarithm.
/// Within 1e-4 K of band_brightness_temperature for 150 to 3000 K (measured: docs/physics-radiometry.md); outside that
/// range it calls the exact function.
class BandThermometer {
public:
    explicit BandThermometer(Spectrum response);
    /// \return [K]; NaN for a radiance that is NaN, zero or negative
    [[nodiscard]] double temperature_K(double radiance_mean) const;

private:
    Spectrum response_;
    double lambda_um_ = 0.0;
    std::vector<double> band_ratio_, slope_;  ///< T_band / T_mono and its derivative per node, at nodes even in ln T_mono
    double first_ = 0.0, step_ = 0.0;         ///< ln T_mono of node 0, spacing
};

/// Planck function at fixed wavelengths for many temperatures, as rows of floats for vector loops:
///     int i; float f; table.locate(T_K, i, f);
///     B[l] = (1 - f) * row(i)[l] + f * row(i + 1)[l]
/// Rows are spaced evenly in 1/T, not in T: B is nearly exponential in 1/T, so the relative error of the linear
/// interpolation, (c2 d(1/T) / lambda)^2 / 8, does not depend on temperature and is largest at the shortest wavelength.
class PlanckTable {
public:
    /// \param lambda_um wavelengths of the columns
    /// \param T_min_K, T_max_K range, 0 < T_min_K < T_max_K; locate() clamps to it
    /// \param step_K distance of the two hottest rows (the largest; colder rows are closer together). 0 = as needed for an
    ///        interpolation error of at most 2e-6 at the shortest wavelength, held to kMaximumRows.
    /// Values below 1e-30 W m-2 sr-1 um-1 are stored as 0, so that no denormal number gets into the loops.
    PlanckTable(std::span<const double> lambda_um, double T_min_K, double T_max_K, double step_K = 0.0);

    [[nodiscard]] const float* row(int i) const noexcept { return values_.data() + static_cast<std::size_t>(i) * columns_; }
    [[nodiscard]] int row_count() const noexcept { return rows_; }
    /// Row below and fraction towards the next; 0 <= i <= row_count() - 2, 0 <= f <= 1. Row 0 is the coldest.
    /// T_K outside the table is clamped, NaN goes to row 0.
    void locate(double T_K, int& i, float& f) const noexcept;
    /// Interpolated values at one temperature; `out` has one element per wavelength.
    void evaluate(double T_K, std::span<float> out) const noexcept;

    static constexpr int kMaximumRows = 65536;

private:
    std::vector<float> values_;
    std::size_t columns_ = 0;
    int rows_ = 0;
    double first_per_K_ = 0.0, step_per_K_ = 0.0;  ///< 1/T of row 0 and decrease of 1/T per row
};

}  // namespace pyroscene::radiometry
