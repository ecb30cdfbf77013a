#pragma once

#include <numbers>

/// Physical constants, SI unless the name says otherwise. Source: CODATA 2018 (exact since the 2019 SI).
namespace pyroscene {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree_rad = kPi / 180.0;

inline constexpr double kPlanck_J_s = 6.62607015e-34;
inline constexpr double kLightSpeed_m_s = 299792458.0;
inline constexpr double kBoltzmann_J_K = 1.380649e-23;

/// First radiation constant for spectral radiance, 2 h c^2, with wavelength in um [W um^4 m-2 sr-1].
inline constexpr double kC1L_W_um4_m2_sr = 2.0 * kPlanck_J_s * kLightSpeed_m_s * kLightSpeed_m_s * 1e24;
/// Second radiation constant h c / k [um K].
inline constexpr double kC2_um_K = kPlanck_J_s * kLightSpeed_m_s / kBoltzmann_J_K * 1e6;
/// Stefan-Boltzmann constant [W m-2 K-4].
inline constexpr double kStefanBoltzmann_W_m2_K4 = 5.670374419e-8;

/// 0 degC [K].
inline constexpr double kZeroCelsius_K = 273.15;
/// Standard acceleration used by the fire relations [m s-2] (fire-behaviour literature uses 9.81).
inline constexpr double kGravity_m_s2 = 9.81;

/// Mean radius of the Earth (IUGG R1) [m].
inline constexpr double kEarthRadius_m = 6371008.8;
/// The one that MODTRAN's geometry is made with [km].
inline constexpr double kModtranEarthRadius_km = 6371.23;

}  // namespace pyroscene
