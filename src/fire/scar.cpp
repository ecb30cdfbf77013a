#include "fire/scar.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::fire {

double scar_temperature_K(const ScarCooling& cooling, double time_s) noexcept {
    const double t = std::max(time_s, 0.0);
    return cooling.amplitude1_K * std::exp(-t / cooling.time_constant1_s) +
           cooling.amplitude2_K * std::exp(-t / cooling.time_constant2_s) + cooling.floor_K;
}

double scar_or_ambient_K(const FireParameters& parameters, double time_s) noexcept {
    return std::max(parameters.ambient_temperature_K, scar_temperature_K(parameters.scar, time_s));
}

}  // namespace pyroscene::fire
