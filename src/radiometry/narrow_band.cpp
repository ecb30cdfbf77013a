#include "radiometry/narrow_band.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kReference_K = 273.0;

/// Collisional half-widths [1/cm/atm] at 273 K by partner, and of self-resonance (NASA SP-3080).
struct Widths {
    double h2o, co2, co, o2, n2, resonance;
    double molar_mass_g;
};
constexpr std::array<Widths, 3> kWidths{{
    {0.09, 0.12, 0.10, 0.04, 0.09, 0.44, 18.015},  // H2O
    {0.07, 0.09, 0.06, 0.055, 0.07, 0.01, 44.01},  // CO2
    {0.06, 0.07, 0.06, 0.05, 0.06, 0.0, 28.01},    // CO
}};

double mole_fraction(GasSpecies species, const FlameGas& gas) noexcept {
    switch (species) {
        case GasSpecies::H2O:
            return gas.x_H2O;
        case GasSpecies::CO2:
            return gas.x_CO2;
        case GasSpecies::CO:
            return gas.x_CO;
        case GasSpecies::CH4:
            return gas.x_CH4;
    }
    return 0.0;
}

double lorentz_width_per_cm(const Widths& w, double T_K, const FlameGas& gas, double x_self) noexcept {
    const double cooling = kReference_K / T_K;
    const double partners = w.h2o * gas.x_H2O + w.co2 * gas.x_CO2 + w.co * gas.x_CO + w.o2 * gas.x_O2 + w.n2 * gas.x_N2();
    return pressure_atm(gas) * (std::sqrt(cooling) * partners + w.resonance * cooling * x_self);
}

/// 1 / (1 - ln(1 + z) / z), without cancellation for small z.
double doppler_term(double z) noexcept {
    if (z < 1e-4) return 1.0 / (z * (0.5 - z * (1.0 / 3.0 - z / 4.0)));
    return 1.0 / (1.0 - std::log1p(z) / z);
}

/// -ln erfc(u), also where erfc underflows.
double minus_ln_erfc(double u) noexcept {
    if (u < 20.0) return -std::log(std::erfc(u));
    return u * u + std::log(u * std::sqrt(kPi)) + 0.5 / (u * u);
}

}  // namespace

GasAbsorption gas_absorption(const GasOptics& optics, GasSpecies species, double lambda_um, double T_K,
                             const FlameGas& gas) noexcept {
    const double x_self = mole_fraction(species, gas), wavenumber = 1e4 / lambda_um;
    if (!(x_self > 0.0)) return {};
    const GasTable& table = optics[species];
    const double T_table_K =
        std::clamp(T_K, table.kappa_per_atm_m.temperature_K.front(), table.kappa_per_atm_m.temperature_K.back());
    GasAbsorption found;
    found.per_m = table.kappa_per_atm_m.at(wavenumber, T_table_K) * x_self * pressure_atm(gas);
    if (!(found.per_m > 0.0)) return {};
    const double density = table.line_density.at(wavenumber, T_table_K);
    if (species == GasSpecies::CH4) {
        found.a_lorentz = density * pressure_atm(gas);
        return found;
    }
    const Widths& w = kWidths[static_cast<std::size_t>(species)];
    found.a_lorentz = lorentz_width_per_cm(w, T_table_K, gas, x_self) * density;
    found.a_doppler = 5.94e-6 * wavenumber * std::sqrt(T_table_K / (kReference_K * w.molar_mass_g)) * density;
    return found;
}

void GasColumn::add(const GasAbsorption& absorption, double length_m) noexcept {
    const double depth = absorption.per_m * length_m;
    x += depth;
    x_a_lorentz += depth * absorption.a_lorentz;
    x_a_doppler += depth * absorption.a_doppler;
}

double gas_optical_depth(GasSpecies species, const GasColumn& column) noexcept {
    const double x = column.x;
    if (!(x > 0.0)) return 0.0;
    if (species == GasSpecies::CH4) {
        const double a = column.x_a_lorentz / x;
        return minus_ln_erfc(std::sqrt(4.0 * a / (16.0 * a / kPi + x)) * x);
    }
    // x_C and x_D only enter as (1 - (x_C/x)^2)^-1 = (1 + r) / r and (1 - ln(1+z)/z)^-1.
    const double r = std::max(x * x / (4.0 * column.x_a_lorentz), 1e-15);
    const double v = x * x / (1.7 * column.x_a_doppler), z = std::max(v * v, 1e-15);
    const double lorentz = (1.0 + r) / r, doppler = doppler_term(z);
    const double y = std::max(lorentz * lorentz + doppler * doppler - 1.0, 1.0);
    return x * std::sqrt(1.0 - 1.0 / std::sqrt(y));
}

double standard_pressure_Pa(double height_m) noexcept {
    return kAtmosphere_Pa * std::pow(1.0 - 0.0065 * std::min(height_m, 11000.0) / 288.15, 5.2559);
}

}  // namespace pyroscene::radiometry
