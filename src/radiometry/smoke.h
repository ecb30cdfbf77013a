#pragma once

#include <filesystem>
#include <string_view>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Optics of smoke per gram of particles (PM2.5).
struct SmokeOptics {
    Spectrum extinction_m2_g;  ///< mass extinction efficiency [m2 g-1]
    Spectrum albedo;           ///< single scattering: scattered / extinct
    Spectrum asymmetry;        ///< Henyey-Greenstein g
};

/// Kinds of smoke in data/optical/smoke_optics_fine.csv.
inline constexpr std::string_view kSmokeKinds[] = {"savanna", "cerrado", "amazon_forest", "boreal_forest"};

/// Reads the columns of one kind. Throws an input error for an unreadable table or a kind that it lacks.
SmokeOptics load_smoke_optics(const std::filesystem::path& path, std::string_view kind);

/// Smoke at one wavelength, per metre of path.
struct SmokeCoefficients {
    double extinction_per_m = 0.0, single_scattering_albedo = 0.0, asymmetry = 0.0;
    [[nodiscard]] double scattering_per_m() const noexcept { return extinction_per_m * single_scattering_albedo; }
    [[nodiscard]] double absorption_per_m() const noexcept { return extinction_per_m - scattering_per_m(); }
};

/// Coefficients at a wavelength; extinction follows a power law between the samples, the rest is linear; end values outside.
/// \param concentration_g_m3 mass of particles per volume, >= 0
SmokeCoefficients smoke_coefficients(const SmokeOptics& smoke, double lambda_um, double concentration_g_m3) noexcept;

/// Henyey & Greenstein (1941) phase function [1/sr]: (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)), 1 over the sphere.
/// \param cosine of the scattering angle: 1 = straight on   \param asymmetry -1 < g < 1
double henyey_greenstein_per_sr(double cosine, double asymmetry) noexcept;

}  // namespace pyroscene::radiometry
