#include "fire/temperature_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::fire {
namespace {

/// End of the persistent flame as a part of the whole: 0.08 / 0.20.
constexpr double kPersistent = 0.4;

double fifth_power(double x) noexcept { return x * x * x * x * x; }

/// Integral of T^5 over [s0, s1] where T has no kink: Gauss-Legendre rule of four points.
double integral_of_T5(const TemperatureProfile& profile, double base_K, double s0, double s1) noexcept {
    if (!(s1 > s0)) return 0.0;
    constexpr std::array<double, 2> kNode{0.3399810435848563, 0.8611363115940526};
    constexpr std::array<double, 2> kWeight{0.6521451548625461, 0.3478548451374538};
    const double middle = 0.5 * (s0 + s1), half = 0.5 * (s1 - s0);
    double sum = 0.0;
    for (std::size_t i = 0; i < kNode.size(); ++i) {
        for (const double sign : {-1.0, 1.0})
            sum += kWeight[i] * fifth_power(profile.at(base_K, middle + sign * kNode[i] * half));
    }
    return half * sum;
}

}  // namespace

double TemperatureProfile::at(double base_K, double s) const noexcept {
    const double place = std::clamp(s, 0.0, 1.0);
    switch (shape) {
        case Shape::Linear:
            return base_K + (tip_K - base_K) * place;
        case Shape::McCaffrey:
            return place <= kPersistent ? base_K : air_K + (base_K - air_K) * kPersistent / place;
        case Shape::Constant:
            break;
    }
    return base_K;
}

double TemperatureProfile::emission_mean_K(double base_K, double s0, double s1) const noexcept {
    if (shape == Shape::Constant) return base_K;
    const double low = std::clamp(s0, 0.0, 1.0), high = std::clamp(s1, 0.0, 1.0);
    if (!(high > low)) return at(base_K, low);
    const double kink = std::clamp(kPersistent, low, high);
    const double sum = integral_of_T5(*this, base_K, low, kink) + integral_of_T5(*this, base_K, kink, high);
    return std::pow(sum / (high - low), 0.2);
}

double mccaffrey_excess_K(double height_m, double power_kW, double air_K) noexcept {
    if (!(power_kW > 0.0)) return 0.0;
    const double reduced = height_m / std::pow(power_kW, 0.4);
    const double eta = reduced < 0.08 ? 0.5 : reduced < 0.20 ? 0.0 : -1.0 / 3.0;
    const double k = reduced < 0.08 ? 6.8 : reduced < 0.20 ? 1.9 : 1.1;
    const double scale = k / (0.9 * std::sqrt(2.0 * kGravity_m_s2));
    return scale * scale * std::pow(reduced, 2.0 * eta - 1.0) * air_K;
}

}  // namespace pyroscene::fire
