#pragma once

#include <vector>

namespace pyroscene {

/// What a spectrum means, so that a reflectance cannot be taken for a transmittance.
enum class Quantity { Radiance, Irradiance, Transmittance, Reflectance, Response, AbsorptionPerM, Dimensionless };

/// Samples of one quantity over ascending vacuum wavelength [um], linear in between.
struct Spectrum {
    Quantity kind = Quantity::Dimensionless;
    std::vector<double> lambda_um, value;

    /// Linear interpolation; outside the range the end value (clamp = true) or zero.
    [[nodiscard]] double at(double wavelength_um, bool clamp = true) const noexcept;
};

/// Mean of a piecewise linear spectrum over [lower_um, upper_um] (exact integral of the polyline / width).
/// Outside its range the spectrum is extended with its end values. lower_um < upper_um.
double mean_over(const Spectrum& s, double lower_um, double upper_um) noexcept;

}  // namespace pyroscene
