#include "fire/flame_tilt.h"

#include <cmath>

#include "base/constants.h"

namespace pyroscene::fire {

double buoyant_velocity_m_s(const TiltInputs& in) noexcept {
    if (!(in.fireline_intensity_W_m > 0.0)) return 0.0;
    return std::cbrt(2.0 * kGravity_m_s2 * in.fireline_intensity_W_m /
                     (in.air_density_kg_m3 * in.air_heat_capacity_J_kg_K * in.air_temperature_K));
}

double flame_tilt_buoyant_velocity_rad(const TiltInputs& in) noexcept {
    return std::atan2(in.wind_m_s, buoyant_velocity_m_s(in));  // atan2(0, 0) = 0: no wind, no fire, upright
}

double downwind_azimuth_rad(double wind_east_m_s, double wind_north_m_s) noexcept {
    const double azimuth_rad = std::atan2(wind_east_m_s, wind_north_m_s);
    return azimuth_rad < 0.0 ? azimuth_rad + 2.0 * kPi : std::abs(azimuth_rad);
}

}  // namespace pyroscene::fire
