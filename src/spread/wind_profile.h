#pragma once

#include <optional>

#include "spread/rothermel.h"

namespace pyroscene::spread {

/// At what height a wind is given.
struct WindLevel {
    enum class Kind { Midflame, TwentyFeet, TenMetres, Metres } kind = Kind::TwentyFeet;
    double height_m = 6.096;              ///< Metres: above the vegetation, or above the ground with a roughness length
    std::optional<double> roughness_m{};  ///< Metres: of the ground, instead of that of the vegetation
};

/// Wind 6.1 m (20 ft) above the vegetation / wind as given. Midflame: 1 / wind_adjustment. Ten metres: 1 / 1.15. Metres: logarithmic
/// profile, ln((6.096 + 0.36 h) / 0.13 h) / ln((z + 0.36 h) / 0.13 h) over vegetation of height h (displacement 0.64 h, roughness 0.13 h:
/// Albini and Baughman 1979, INT-221; the trees where they shelter the fuel, else the fuel bed), or ln(6.096 / z0) / ln(z / z0) over
/// ground of roughness length z0. \pre height_m > roughness_m
double to_twenty_feet(const WindLevel& level, double fuel_depth_m, const Canopy& canopy) noexcept;

}  // namespace pyroscene::spread
