#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fire/flame_extent.h"
#include "fire/state.h"

namespace pyroscene::fire {

/// What tilt relations are made of. Each reads what its description names. Air defaults: thesis 4.6.4 and the usual 1005 J kg-1 K-1.
struct TiltInputs {
    double wind_m_s = 0.0;                ///< horizontal wind speed, >= 0
    double fireline_intensity_W_m = 0.0;  ///< heat flux x depth of the flaming zone, per metre of front
    double air_density_kg_m3 = 1.18;
    double air_heat_capacity_J_kg_K = 1005.0;
    double air_temperature_K = 300.0;
    double burning_rate_kg_m_s = 0.0;  ///< mass burnt per area x depth (or diameter) of the burning area, m'' D = I / H_c
    double fuel_vapour_density_kg_m3 = 0.36;
    double heat_of_combustion_J_kg = 16.515e6;
    double heat_release_W = 0.0;  ///< of the whole burning area
    double flame_size_m = 0.0;    ///< height, or length along the axis, as `extent` says
    FlameExtent extent = FlameExtent::Height;
    double slope_rad = 0.0;  ///< of the ground along the wind, > 0 where the wind blows uphill; buoyant_velocity only
    Physics physics = Physics::Default;
};

// All relations return the tilt from the VERTICAL [rad]: 0 in calm air, growing with wind, at most pi/2 on level ground.

/// Vertical speed of the hot gas above a line fire: w_b = (2 g I / (rho c_p T))^(1/3) [m s-1]; 0 for I <= 0.
/// Source: Nelson & Adkins 1986 (convection number N_c = 2 g I / (rho c_p T U^3) = (w_b / U)^3); g = 9.81 m s-2.
double buoyant_velocity_m_s(const TiltInputs& in) noexcept;

/// Flame tilt by the ratio of wind and buoyant velocity: tan A = U / w_b; on a slope s, tan A' = tan s + U cos s / w_b from
/// the ground's normal (Nelson 2002), which leans s downhill, so A = A' - s. Below pi/2 while the fire releases heat.
double flame_tilt_buoyant_velocity_rad(const TiltInputs& in) noexcept;

/// American Gas Association 1974: cos A = U*^(-1/2) (1 for U* <= 1), U* = U / (g m'' D / rho_fuel vapour)^(1/3). Pool fires.
double flame_tilt_aga_rad(const TiltInputs& in) noexcept;

/// Thomas 1963: cos A = 0.7 U*^(-0.49), at most 1, U* as above with the density of AIR. Cribs.
double flame_tilt_thomas_rad(const TiltInputs& in) noexcept;

/// Albini 1981: tan A = 1.22 U / sqrt(g H), H the flame height. Given a length L, H = L cos A is solved for:
/// cos A = (sqrt(K^2 + 4) - K) / 2, K = (1.22 U)^2 / (g L).
double flame_tilt_albini_rad(const TiltInputs& in) noexcept;

/// Putnam 1965: as Albini with 1.4 for 1.22. Natural-gas flames in a wind tunnel.
double flame_tilt_putnam_rad(const TiltInputs& in) noexcept;

/// Rule of thumb of thesis 2.8.2 (de Ris): 2 m/s bend a flame by 45 degrees; tan A = U / (2 m/s). True of small flames only.
double flame_tilt_rule_rad(const TiltInputs& in) noexcept;

/// Butler et al. 2004, crown fires: tan A = sqrt(3 U^3 / (2 g 10 m)), U at the top of the canopy.
double flame_tilt_butler_rad(const TiltInputs& in) noexcept;

/// Thesis eq 4.31-4.34: V' = (U / u) (2 c_p T rho / (pi rho_f H_c))^(1/3), u = 1.9 Q^(1/5) (Q in kW).
/// Default physics: cos A = 1 (V' <= 1), V'^(-1/2) beyond. With SI units V' = 0.340 U / u, which exceeds 1 only above 14 m/s
/// over 100 kW and 105 m/s over the thesis's hottest cell: these flames hardly ever tilt.
/// Physics::Thesis: sin A = the same, as printed, with A from the vertical: flames lie flat in calm air.
double flame_tilt_thesis_rad(const TiltInputs& in) noexcept;

/// What a relation needs beside the wind and the air.
enum class TiltDriver : std::uint8_t { None, FirelineIntensity, BurningRate, FlameSize, HeatRelease };

/// One tilt relation, by name. A new one is a function and a row.
struct FlameTiltMethod {
    std::string_view name;
    TiltDriver driver;
    bool has_slope;  ///< the relation is defined on slopes
    double (*tilt_rad)(const TiltInputs&) noexcept;
};
inline constexpr std::array kFlameTiltMethods{
    FlameTiltMethod{"buoyant_velocity", TiltDriver::FirelineIntensity, true, &flame_tilt_buoyant_velocity_rad},
    FlameTiltMethod{"aga", TiltDriver::BurningRate, false, &flame_tilt_aga_rad},
    FlameTiltMethod{"thomas", TiltDriver::BurningRate, false, &flame_tilt_thomas_rad},
    FlameTiltMethod{"albini", TiltDriver::FlameSize, false, &flame_tilt_albini_rad},
    FlameTiltMethod{"putnam", TiltDriver::FlameSize, false, &flame_tilt_putnam_rad},
    FlameTiltMethod{"rule", TiltDriver::None, false, &flame_tilt_rule_rad},
    FlameTiltMethod{"butler", TiltDriver::None, false, &flame_tilt_butler_rad},
    FlameTiltMethod{"thesis", TiltDriver::HeatRelease, false, &flame_tilt_thesis_rad},
};

/// The row of a name; null when there is none.
const FlameTiltMethod* find_flame_tilt_method(std::string_view name) noexcept;

/// Direction the wind blows TO, clockwise from grid north, in [0, 2 pi) [rad]; 0 in calm air.
double downwind_azimuth_rad(double wind_east_m_s, double wind_north_m_s) noexcept;

}  // namespace pyroscene::fire
