#include "fire/flame_height.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::fire {

double flame_height_heat_flux_m(double heat_flux_W_m2, double alpha, double volumetric_heat_release_W_m3) noexcept {
    if (!(heat_flux_W_m2 > 0.0)) return 0.0;  // also catches NaN
    return alpha * heat_flux_W_m2 / volumetric_heat_release_W_m3;
}

void RunningStatistics::add(double value_m) noexcept {
    ++count;
    const double from_old_mean = value_m - mean_m;
    mean_m += from_old_mean / static_cast<double>(count);
    m2_m2 += from_old_mean * (value_m - mean_m);
}

double RunningStatistics::standard_deviation_m() const noexcept {
    return count < 2 ? 0.0 : std::sqrt(m2_m2 / static_cast<double>(count - 1));
}

LimitedHeight limit_height(double height_m, const RunningStatistics& earlier, Physics physics) noexcept {
    if (earlier.count < 2) return {height_m, 0.0};
    const double spread_m = earlier.standard_deviation_m();
    const double highest_m = earlier.mean_m + spread_m;
    if (height_m > highest_m) return {highest_m, height_m - highest_m};
    if (physics == Physics::Thesis) return {std::max({height_m, earlier.mean_m - spread_m, 0.0}), 0.0};
    return {height_m, 0.0};
}

}  // namespace pyroscene::fire
