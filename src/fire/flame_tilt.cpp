#include "fire/flame_tilt.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

/// acos of a cosine that rounding, or a relation outside its range, may have lifted above 1.
double tilt_of_cosine_rad(double cosine) noexcept { return std::acos(std::clamp(cosine, 0.0, 1.0)); }

/// U* = U / (g m'' D / rho)^(1/3); infinite where nothing burns.
double dimensionless_wind(const TiltInputs& in, double density_kg_m3) noexcept {
    return in.wind_m_s / std::cbrt(kGravity_m_s2 * std::max(0.0, in.burning_rate_kg_m_s) / density_kg_m3);
}

/// tan A = c U / sqrt(g H), solved for A when the size is a length.
double froude_tilt_rad(const TiltInputs& in, double c) noexcept {
    if (!(in.wind_m_s > 0.0)) return 0.0;
    const double speed_m_s = c * in.wind_m_s, size_m = std::max(0.0, in.flame_size_m);
    if (in.extent == FlameExtent::Height) return std::atan2(speed_m_s, std::sqrt(kGravity_m_s2 * size_m));
    if (size_m == 0.0) return 0.5 * kPi;
    // tan^2 A cos A = K and cos^2 = 1 - sin^2 give cos^2 A + K cos A - 1 = 0; this form of the root does not cancel.
    const double k = speed_m_s * speed_m_s / (kGravity_m_s2 * size_m);
    return tilt_of_cosine_rad(2.0 / (k + std::sqrt(k * k + 4.0)));
}

/// V' of eq 4.33 with the plume velocity of eq 4.34.
double thesis_wind_ratio(const TiltInputs& in) noexcept {
    const double plume_m_s = 1.9 * std::pow(1e-3 * std::max(0.0, in.heat_release_W), 0.2);
    const double bracket = 2.0 * in.air_heat_capacity_J_kg_K * in.air_temperature_K * in.air_density_kg_m3 /
                           (kPi * in.fuel_vapour_density_kg_m3 * in.heat_of_combustion_J_kg);
    return in.wind_m_s / plume_m_s * std::cbrt(bracket);
}

}  // namespace

double buoyant_velocity_m_s(const TiltInputs& in) noexcept {
    if (!(in.fireline_intensity_W_m > 0.0)) return 0.0;
    return std::cbrt(2.0 * kGravity_m_s2 * in.fireline_intensity_W_m /
                     (in.air_density_kg_m3 * in.air_heat_capacity_J_kg_K * in.air_temperature_K));
}

double flame_tilt_buoyant_velocity_rad(const TiltInputs& in) noexcept {
    if (!(in.wind_m_s > 0.0)) return 0.0;
    const double buoyant_m_s = buoyant_velocity_m_s(in), slope_rad = in.slope_rad;
    const double along_ground_m_s = in.wind_m_s * std::cos(slope_rad) + std::tan(slope_rad) * buoyant_m_s;
    return std::atan2(along_ground_m_s, buoyant_m_s) - slope_rad;
}

double flame_tilt_aga_rad(const TiltInputs& in) noexcept {
    if (!(in.wind_m_s > 0.0)) return 0.0;
    return tilt_of_cosine_rad(1.0 / std::sqrt(std::max(1.0, dimensionless_wind(in, in.fuel_vapour_density_kg_m3))));
}

double flame_tilt_thomas_rad(const TiltInputs& in) noexcept {
    if (!(in.wind_m_s > 0.0)) return 0.0;
    return tilt_of_cosine_rad(0.7 * std::pow(dimensionless_wind(in, in.air_density_kg_m3), -0.49));
}

double flame_tilt_albini_rad(const TiltInputs& in) noexcept { return froude_tilt_rad(in, 1.22); }
double flame_tilt_putnam_rad(const TiltInputs& in) noexcept { return froude_tilt_rad(in, 1.4); }

double flame_tilt_rule_rad(const TiltInputs& in) noexcept { return in.wind_m_s > 0.0 ? std::atan(in.wind_m_s / 2.0) : 0.0; }

double flame_tilt_butler_rad(const TiltInputs& in) noexcept {
    if (!(in.wind_m_s > 0.0)) return 0.0;
    constexpr double kLength_m = 10.0;
    return std::atan(in.wind_m_s * std::sqrt(1.5 * in.wind_m_s / (kGravity_m_s2 * kLength_m)));
}

double flame_tilt_thesis_rad(const TiltInputs& in) noexcept {
    const bool as_printed = in.physics == Physics::Thesis;
    if (!(in.wind_m_s > 0.0)) return as_printed ? 0.5 * kPi : 0.0;
    const double value = 1.0 / std::sqrt(std::max(1.0, thesis_wind_ratio(in)));
    return as_printed ? std::asin(value) : tilt_of_cosine_rad(value);
}

const FlameTiltMethod* find_flame_tilt_method(std::string_view name) noexcept {
    const auto* row = std::find_if(kFlameTiltMethods.begin(), kFlameTiltMethods.end(),
                                   [&](const FlameTiltMethod& method) { return method.name == name; });
    return row == kFlameTiltMethods.end() ? nullptr : row;
}

double downwind_azimuth_rad(double wind_east_m_s, double wind_north_m_s) noexcept {
    const double azimuth_rad = std::atan2(wind_east_m_s, wind_north_m_s);
    return azimuth_rad < 0.0 ? azimuth_rad + 2.0 * kPi : std::abs(azimuth_rad);
}

}  // namespace pyroscene::fire
