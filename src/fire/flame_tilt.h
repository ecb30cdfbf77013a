#pragma once

#include <array>
#include <string_view>

namespace pyroscene::fire {

/// What tilt relations are made of. Air defaults: thesis 4.6.4 and the usual 1005 J kg-1 K-1.
struct TiltInputs {
    double wind_m_s = 0.0;                ///< horizontal wind speed, >= 0
    double fireline_intensity_W_m = 0.0;  ///< heat flux x depth of the flaming zone, per metre of front
    double air_density_kg_m3 = 1.18;
    double air_heat_capacity_J_kg_K = 1005.0;
    double air_temperature_K = 300.0;
};

/// Vertical speed of the hot gas above a line fire: w_b = (2 g I / (rho c_p T))^(1/3) [m s-1]; 0 for I <= 0.
/// Source: Nelson & Adkins 1986 (convection number N_c = 2 g I / (rho c_p T U^3) = (w_b / U)^3); g = 9.81 m s-2.
double buoyant_velocity_m_s(const TiltInputs& in) noexcept;

/// Flame tilt by the ratio of wind and buoyant velocity: tan A = U / w_b.
/// \return angle from the VERTICAL [rad], 0 in calm air, below pi/2 while the fire releases heat
/// Thesis eq 4.31-4.34 are not used: their angle reads "from the vertical" where it must be the elevation (calm flames would
/// lie flat), and with SI units their wind ratio stays below 1 for every fire cell, so no flame would ever tilt.
double flame_tilt_buoyant_velocity_rad(const TiltInputs& in) noexcept;

/// One tilt relation, by name. More methods are more rows.
struct FlameTiltMethod {
    std::string_view name;
    double (*tilt_rad)(const TiltInputs&) noexcept;
};
inline constexpr std::array<FlameTiltMethod, 1> kFlameTiltMethods{{{"buoyant_velocity", &flame_tilt_buoyant_velocity_rad}}};

/// Direction the wind blows TO, clockwise from grid north, in [0, 2 pi) [rad]; 0 in calm air.
double downwind_azimuth_rad(double wind_east_m_s, double wind_north_m_s) noexcept;

}  // namespace pyroscene::fire
