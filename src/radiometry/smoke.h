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

/// Absorption per gram of particles:  mee (1 - ssa)  [m2 g-1], linear between the samples, clamped outside them.
/// savanna: 0.503 at 0.55 um, 0.0381 at 3.96 um.
double smoke_absorption_m2_g(const SmokeOptics& smoke, double lambda_um) noexcept;

}  // namespace pyroscene::radiometry
