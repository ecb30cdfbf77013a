#pragma once

namespace pyroscene {

/// What flame gas is made of: mole fractions of the absorbers, soot and free alkali atoms. The rest is air-like and transparent.
/// Defaults: diluted post-flame gas of vegetation fires with the reference soot (docs/physics-fire.md says how far they vary).
struct FlameGas {
    double soot_volume_fraction = 2e-7;  ///< m3 of soot per m3; lean grass 5e-8, crown fire 1e-6
    double x_H2O = 0.14, x_CO2 = 0.10, x_CO = 0.02, x_CH4 = 0.0;
    double x_O2 = 0.03;          ///< nitrogen is what is left
    double potassium_ppm = 1.0;  ///< free atoms, mole fraction x 1e6; 0.05 to 10
    double sodium_ppm = 0.0;     ///< free atoms, like potassium
    double pressure_Pa = 101325.0;

    [[nodiscard]] double x_N2() const noexcept { return 1.0 - x_H2O - x_CO2 - x_CO - x_CH4 - x_O2; }

    friend bool operator==(const FlameGas&, const FlameGas&) = default;
};

}  // namespace pyroscene
