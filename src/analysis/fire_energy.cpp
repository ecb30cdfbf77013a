#include "analysis/fire_energy.h"

#include <cmath>
#include <limits>

namespace pyroscene::analysis {
namespace {

double known(double power) { return std::isfinite(power) ? power : 0.0; }

double trapezoid(double from_s, double to_s, double a, double b) { return 0.5 * (to_s - from_s) * (a + b); }

}  // namespace

std::vector<double> fire_radiative_energy(std::span<const double> time_s, std::span<const double> power) {
    std::vector<double> energy(time_s.size(), 0.0);
    for (std::size_t k = 1; k < time_s.size(); ++k)
        energy[k] = energy[k - 1] + trapezoid(time_s[k - 1], time_s[k], known(power[k - 1]), known(power[k]));
    return energy;
}

void EnergyMap::add(double time_s, std::span<const float> power) {
    const bool first = energy_.empty();
    if (first) {
        energy_.assign(power.size(), 0.0);
        last_.assign(power.size(), 0.0F);
        peak_.assign(power.size(), 0.0F);
        peak_s_.assign(power.size(), std::numeric_limits<float>::quiet_NaN());
    }
    for (std::size_t i = 0; i < energy_.size(); ++i) {
        const auto now = static_cast<float>(known(static_cast<double>(power[i])));
        if (!first) energy_[i] += trapezoid(last_s_, time_s, static_cast<double>(last_[i]), static_cast<double>(now));
        if (now > peak_[i]) {
            peak_[i] = now;
            peak_s_[i] = static_cast<float>(time_s);
        }
        last_[i] = now;
    }
    last_s_ = time_s;
}

}  // namespace pyroscene::analysis
