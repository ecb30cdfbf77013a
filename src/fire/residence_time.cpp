#include "fire/residence_time.h"

namespace pyroscene::fire {

double characteristic_surface_to_volume_per_m(std::span<const FuelParticles> particles) noexcept {
    double surface = 0.0, weighted = 0.0;
    for (const auto& p : particles) {
        surface += p.load_kg_m2 * p.surface_to_volume_per_m;
        weighted += p.load_kg_m2 * p.surface_to_volume_per_m * p.surface_to_volume_per_m;
    }
    return surface > 0.0 ? weighted / surface : 0.0;
}

double residence_time_s(double surface_to_volume_per_m) noexcept {
    constexpr double kFoot_m = 0.3048, kMinute_s = 60.0;
    return surface_to_volume_per_m > 0.0 ? 384.0 * kMinute_s / (surface_to_volume_per_m * kFoot_m) : 0.0;
}

}  // namespace pyroscene::fire
