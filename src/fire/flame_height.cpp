#include "fire/flame_height.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::fire {

double flame_height_heat_flux_m(double heat_flux_W_m2, double alpha, double volumetric_heat_release_W_m3) noexcept {
    if (!(heat_flux_W_m2 > 0.0)) return 0.0;  // also catches NaN
    return alpha * heat_flux_W_m2 / volumetric_heat_release_W_m3;
}

double plume_coefficient_m_kW(double air_temperature_K, double air_density_kg_m3, double air_heat_capacity_J_kg_K,
                              double heat_per_air_J_kg, Physics physics) noexcept {
    const double heat_per_air_kJ_kg = 1e-3 * heat_per_air_J_kg;
    const double density_power = physics == Physics::Thesis ? air_density_kg_m3 : air_density_kg_m3 * air_density_kg_m3;
    return 15.6 *
           std::pow(1e-3 * air_heat_capacity_J_kg_K * air_temperature_K /
                        (kGravity_m_s2 * density_power * heat_per_air_kJ_kg * heat_per_air_kJ_kg * heat_per_air_kJ_kg),
                    0.2);
}

double flame_height_heskestad_m(const FlameHeightInputs& in) noexcept {
    if (!(in.heat_release_W > 0.0)) return 0.0;
    return std::max(0.0, in.plume_coefficient_m_kW * std::pow(1e-3 * in.heat_release_W, 0.4) - 1.02 * in.diameter_m);
}

double flame_height_constant_m(const FlameHeightInputs& in) noexcept {
    return in.heat_flux_W_m2 > 0.0 ? in.constant_m : 0.0;
}

double flame_length_given_m(const FlameHeightInputs& in) noexcept {
    return in.given_length_m > 0.0 ? in.given_length_m : 0.0;
}

double vertical_height_m(FlameExtent extent, double size_m, double tilt_rad, double stand_height_m) noexcept {
    if (!(size_m > 0.0)) return 0.0;
    switch (extent) {
        case FlameExtent::Height:
            break;
        case FlameExtent::Length:
            return size_m * std::cos(tilt_rad);
        case FlameExtent::LengthAboveStand:
            return stand_height_m + size_m * std::cos(tilt_rad);
    }
    return size_m;
}

const FlameHeightMethod* find_flame_height_method(std::string_view name) noexcept {
    const auto* row = std::find_if(kFlameHeightMethods.begin(), kFlameHeightMethods.end(),
                                   [&](const FlameHeightMethod& method) { return method.name == name; });
    return row == kFlameHeightMethods.end() ? nullptr : row;
}

void RunningStatistics::add(double value_m) noexcept {
    ++count;
    const double from_old_mean = value_m - mean_m;
    mean_m += from_old_mean / static_cast<double>(count);
    m2_m2 += from_old_mean * (value_m - mean_m);
}

double RunningStatistics::standard_deviation_m() const noexcept {
    return count < 2 ? 0.0 : std::sqrt(m2_m2 / static_cast<double>(count - 1));
}

LimitedHeight limit_height(double height_m, const RunningStatistics& earlier, Physics physics) noexcept {
    if (earlier.count < 2) return {height_m, 0.0};
    const double spread_m = earlier.standard_deviation_m();
    const double highest_m = earlier.mean_m + spread_m;
    if (height_m > highest_m) return {highest_m, height_m - highest_m};
    if (physics == Physics::Thesis) return {std::max({height_m, earlier.mean_m - spread_m, 0.0}), 0.0};
    return {height_m, 0.0};
}

}  // namespace pyroscene::fire
