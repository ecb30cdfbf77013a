#pragma once

#include <span>

#include "fire/state.h"

namespace pyroscene::fire {

/// Shape of the cooling curve. Each is a sum of exponentials over a floor.
enum class ScarModel { DoubleExponential, SingleExponential };

/// One scar model: its name in scenarios and on the command line, how many exponentials it has, and published coefficients.
struct ScarModelRow {
    ScarModel model;
    const char* name;
    int terms;
    ScarCooling defaults;
};

/// All models. double_exponential: eq 4.17 with the fitted numbers of eq 4.18. single_exponential: eq 2.9 with the ambient
/// term that it lacks, T = Ta + (T0 - Ta) exp(-t/tau) with T0 = 800 degC, tau = 100 s and Ta = 34 degC; without that term
/// scars would cool to 0 degC.
std::span<const ScarModelRow> scar_models() noexcept;
const ScarModelRow& scar_model(ScarModel model) noexcept;

/// Ground temperature after the flames have left (thesis eq 4.17).
///   T(t) = T1 exp(-t/tau1) + T2 exp(-t/tau2) + Ta,   T1, T2 temperature differences [K], Ta absolute [K]
/// \param time_s since the cell last burned [s]; negative times count as 0
/// \return [K]; 1082.81 K (809.66 degC) at t = 0 with the defaults
/// The fitted floor (33.19 degC) lies below the ambient of the thesis (34 degC): see scar_or_ambient_K.
double scar_temperature_K(const ScarCooling& cooling, double time_s) noexcept;

/// The curve of a map cell: that of its class of cover, else the general one.
const ScarCooling& scar_of_cell(const FireState& state, const FireParameters& parameters, std::size_t cell) noexcept;

/// A curve, never colder than the unburned ground beside it [K].
double scar_or_ambient_K(const FireParameters& parameters, const ScarCooling& cooling, double time_s) noexcept;
/// The general scar curve, never colder than the unburned ground beside it [K].
double scar_or_ambient_K(const FireParameters& parameters, double time_s) noexcept;

}  // namespace pyroscene::fire
