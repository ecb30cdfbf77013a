#pragma once

#include "fire/state.h"

namespace pyroscene::fire {

/// Ground temperature after the flames have left (thesis eq 4.17, fitted numbers of eq 4.18).
///   T(t) = T1 exp(-t/tau1) + T2 exp(-t/tau2) + Ta,   T1, T2 temperature differences [K], Ta absolute [K]
/// \param time_s since the cell last burned [s]; negative times count as 0
/// \return [K]; 1082.81 K (809.66 degC) at t = 0 with the defaults
/// The fitted floor (33.19 degC) lies below the ambient of the thesis (34 degC): see scar_or_ambient_K.
double scar_temperature_K(const ScarCooling& cooling, double time_s) noexcept;

/// The scar curve, never colder than the unburned ground beside it [K].
double scar_or_ambient_K(const FireParameters& parameters, double time_s) noexcept;

}  // namespace pyroscene::fire
