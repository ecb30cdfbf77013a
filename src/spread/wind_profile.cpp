#include "spread/wind_profile.h"

#include <cmath>

namespace pyroscene::spread {
namespace {

constexpr double kTwentyFeet_m = 6.096;

/// ln of height over roughness, both above the displacement of vegetation of height h; z counts from its top.
double profile(double z_m, double vegetation_m) noexcept {
    return std::log((z_m + 0.36 * vegetation_m) / (0.13 * vegetation_m));
}

}  // namespace

double to_twenty_feet(const WindLevel& level, double fuel_depth_m, const Canopy& canopy) noexcept {
    switch (level.kind) {
        case WindLevel::Kind::TwentyFeet:
            return 1.0;
        case WindLevel::Kind::TenMetres:
            return 1.0 / kTenMetresToTwentyFeet;
        case WindLevel::Kind::Midflame:
            return 1.0 / wind_adjustment(fuel_depth_m, canopy);
        case WindLevel::Kind::Metres:
            break;
    }
    if (level.roughness_m)
        return std::log(kTwentyFeet_m / *level.roughness_m) / std::log(level.height_m / *level.roughness_m);
    const double vegetation_m = shelters(canopy) ? canopy.height_m : fuel_depth_m;
    return profile(kTwentyFeet_m, vegetation_m) / profile(level.height_m, vegetation_m);
}

}  // namespace pyroscene::spread
