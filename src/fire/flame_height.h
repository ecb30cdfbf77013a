#pragma once

#include <array>
#include <string_view>

#include "fire/state.h"

namespace pyroscene::fire {

/// Flame height from the surface heat flux, method 1 of the thesis.
///   l = alpha H / q'''                                                              (eq 4.19-4.22)
/// Eq 4.22 prints Q_h / (q''' w1 w2) and calls Q_h a flux; with a flux the result would be 1/m. Q_h is the power of the
/// cell, so Q_h / (w1 w2) is the flux H and no area is left in the formula. \param heat_flux_W_m2 heat flux; a cell mean
/// gives the mean height over the cell [W m-2]; <= 0 or NaN gives 0 \param alpha dimensionless scale  \param
/// volumetric_heat_release_W_m3 heat release per flame volume [W m-3], > 0 \return vertical height [m]; 5.92e6 W m-2, alpha
/// 1, 2e6 W m-3 -> 2.96 m
double flame_height_heat_flux_m(double heat_flux_W_m2, double alpha, double volumetric_heat_release_W_m3) noexcept;

/// One way to get a flame height, by name. More methods are more rows.
struct FlameHeightMethod {
    std::string_view name;
    double (*height_m)(double heat_flux_W_m2, double alpha, double volumetric_heat_release_W_m3) noexcept;
};
inline constexpr std::array<FlameHeightMethod, 1> kFlameHeightMethods{{{"heat_flux", &flame_height_heat_flux_m}}};

/// A flame height divided into the standing flame and what has torn off above it.
struct LimitedHeight {
    double flame_m = 0.0, ember_m = 0.0;
};

/// The one-sigma rule (thesis 4.6.1, 4.6.5): a height above mean + sd of all earlier frames is cut there and the excess is
/// detached flame. While fewer than two heights are known there is no limit, so the first frame is free.
/// Physics::Thesis also raises heights below mean - sd to it; Physics::Default does not, because that adds flame volume,
/// hence power, which the heat flux did not deliver.
LimitedHeight limit_height(double height_m, const RunningStatistics& earlier, Physics physics) noexcept;

}  // namespace pyroscene::fire
