#pragma once

#include <span>

namespace pyroscene::fire {

/// Fuel particles of one size in a fuel bed.
struct FuelParticles {
    double load_kg_m2 = 0.0;
    double surface_to_volume_per_m = 0.0;
};

/// Characteristic surface-to-volume ratio of a fuel bed: sum w s^2 / sum w s [1/m] (Rothermel 1972 for one particle density; it
/// does not depend on how much of the herbs is cured, since cured herbs keep their s). 0 for a bed without fuel.
double characteristic_surface_to_volume_per_m(std::span<const FuelParticles> particles) noexcept;

/// Time for which flames stand at one place: 384 min / sigma, sigma in 1/ft (Anderson 1969) [s]; 0 for sigma <= 0.
/// 4921.26 1/m (tall grass, fuel model 3) -> 15.36 s.
double residence_time_s(double surface_to_volume_per_m) noexcept;

}  // namespace pyroscene::fire
