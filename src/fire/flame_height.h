#pragma once

#include <array>
#include <string_view>

#include "fire/fireline_laws.h"
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

/// Coefficient of Heskestad's flame height for given air [m kW^-2/5].
///   A = 15.6 (c_p T / (g rho^2 (H_c / r)^3))^(1/5), c_p in kJ kg-1 K-1, H_c / r in kJ per kg of AIR
/// \param heat_per_air_J_kg heat of combustion / air-to-fuel mass ratio [J kg-1]; 2.9e6 to 3.2e6 for most fuels, wood too
/// \param physics Thesis: rho to the first power as eq 4.24 prints it. Its quoted range 0.240 to 0.226 needs rho squared.
/// Source: Heskestad 1995 (SFPE handbook); 293.15 K, 1.204 kg m-3, 1006 J kg-1 K-1, 3.0e6 J kg-1 -> 0.23453.
double plume_coefficient_m_kW(double air_temperature_K, double air_density_kg_m3, double air_heat_capacity_J_kg_K,
                              double heat_per_air_J_kg, Physics physics) noexcept;

/// Mean height of the flame of a fire as round as a pool (Heskestad 1995; thesis eq 4.23).
///   h = -1.02 D + A Q^(2/5), Q in kW; a negative result means that there is no standing flame: 0
/// Uses heat_release_W, diameter_m, plume_coefficient_m_kW. Range: 0.05 to 100 m pools; 1 MW, 1 m, A 0.235 -> 2.7045 m.
double flame_height_heskestad_m(const FlameHeightInputs& in) noexcept;

/// A height that the user knows, wherever heat is released.
double flame_height_constant_m(const FlameHeightInputs& in) noexcept;

/// The length read from a raster.
double flame_length_given_m(const FlameHeightInputs& in) noexcept;

/// What a method grows with. HeatFlux methods take the mean flux of the cell and give the mean height over the cell; all others
/// give the height of the flames that stand on the flaming share of the cell.
enum class FlameDriver : std::uint8_t { HeatFlux, HeatRelease, FirelineIntensity, Given };

/// One way to get the size of a flame, by name. A new method is a function and a row (docs/recipes/add-a-flame-height-method.md).
struct FlameHeightMethod {
    std::string_view name;
    FlameDriver driver;
    FlameExtent extent;
    double (*size_m)(const FlameHeightInputs&) noexcept;
};

inline constexpr std::array kFlameHeightMethods{
    FlameHeightMethod{"heat_flux", FlameDriver::HeatFlux, FlameExtent::Height,
                      [](const FlameHeightInputs& in) noexcept {
                          return flame_height_heat_flux_m(in.heat_flux_W_m2, in.alpha, in.volumetric_heat_release_W_m3);
                      }},
    FlameHeightMethod{"heskestad", FlameDriver::HeatRelease, FlameExtent::Height, &flame_height_heskestad_m},
    FlameHeightMethod{"byram", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_byram_m},
    FlameHeightMethod{"weise_biging", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_weise_biging_m},
    FlameHeightMethod{"thomas", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_thomas_m},
    FlameHeightMethod{"nelson_adkins", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_nelson_adkins_m},
    FlameHeightMethod{"nelson_lab", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_nelson_lab_m},
    FlameHeightMethod{"nelson_field", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_nelson_field_m},
    FlameHeightMethod{"butler", FlameDriver::FirelineIntensity, FlameExtent::LengthAboveStand, &flame_length_butler_m},
    FlameHeightMethod{"clark", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_clark_m},
    FlameHeightMethod{"fernandes", FlameDriver::FirelineIntensity, FlameExtent::Length, &flame_length_fernandes_m},
    FlameHeightMethod{"finney_grumstrup", FlameDriver::FirelineIntensity, FlameExtent::Length,
                      &flame_length_finney_grumstrup_m},
    FlameHeightMethod{"constant", FlameDriver::Given, FlameExtent::Height, &flame_height_constant_m},
    FlameHeightMethod{"raster", FlameDriver::Given, FlameExtent::Length, &flame_length_given_m},
};

/// The row of a name; null when there is none.
const FlameHeightMethod* find_flame_height_method(std::string_view name) noexcept;

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
