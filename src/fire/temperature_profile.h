#pragma once

#include <string_view>

namespace pyroscene::fire {

/// Temperature of flame gas between the base (s = 0) and the tip (s = 1) of a flame.
struct TemperatureProfile {
    enum class Shape {
        Constant,   ///< base temperature everywhere
        Linear,     ///< straight line from base to tip temperature
        McCaffrey,  ///< continuous flame up to s = 0.4, then excess over the air proportional to 1/s
    };
    Shape shape = Shape::Constant;
    double tip_K = 823.15;  ///< Linear: 550 degC, where a flame stops being visible (Drysdale 1999)
    double air_K = 300.0;   ///< McCaffrey: excess temperatures count from here

    /// Temperature at a place along the flame; s outside [0, 1] counts as its end. McCaffrey (1979): on the axis of a buoyant
    /// diffusion flame the excess is constant for z/Q^(2/5) < 0.08 m kW^(-2/5) (persistent flame), falls as 1/z up to 0.20
    /// (intermittent flame), and as z^(-5/3) in the plume above. The tip is where the intermittent flame ends.
    [[nodiscard]] double at(double base_K, double s) const noexcept;

    /// The one temperature whose T^5 is the mean over [s0, s1]: thin soot (absorption proportional to 1/lambda) emits in
    /// proportion to T^5, so cutting a flame into voxels of any height leaves its emission as it is. Relative error < 1e-4.
    [[nodiscard]] double emission_mean_K(double base_K, double s0, double s1) const noexcept;
};

/// The words of the scenario file, in the order of Shape.
inline constexpr std::string_view kTemperatureProfileNames[] = {"constant", "linear", "mccaffrey"};

/// Excess temperature on the axis of McCaffrey's fire plume in all three regimes:
///   dT = (k / (0.9 sqrt(2 g)))^2 (z / Q^(2/5))^(2 eta - 1) T_air,  Q in kW
/// with (eta, k) = (1/2, 6.8), (0, 1.9), (-1/3, 1.1) below 0.08, below 0.20 and above it.
/// \return [K]; 0 for a power <= 0   \param height_m above the burner, > 0
double mccaffrey_excess_K(double height_m, double power_kW, double air_K) noexcept;

}  // namespace pyroscene::fire
