#include "radiometry/total_emissivity.h"

#include <algorithm>
#include <cmath>

#include "radiometry/planck.h"

namespace pyroscene::radiometry {

double TotalEmissivity::at(double T_K) const noexcept {
    const double last = static_cast<double>(value.size()) - 1.0,
                 position = std::clamp((T_K - kFirst_K) / kStep_K, 0.0, last);
    const auto i = std::min(static_cast<std::size_t>(position), value.size() - 2);
    return value[i] + (position - static_cast<double>(i)) * (value[i + 1] - value[i]);
}

TotalEmissivity total_emissivity(const Spectrum& reflectance) {
    constexpr int kWavelengths = 600;
    constexpr double kShortest_um = 0.3, kLongest_um = 200.0;
    TotalEmissivity out;
    for (std::size_t t = 0; t < out.value.size(); ++t) {
        const double T_K = TotalEmissivity::kFirst_K + static_cast<double>(t) * TotalEmissivity::kStep_K;
        double emitted = 0.0, black = 0.0;
        for (int i = 0; i < kWavelengths; ++i) {
            const double lambda_um = kShortest_um * std::pow(kLongest_um / kShortest_um, (i + 0.5) / kWavelengths);
            const double weight = lambda_um * planck_radiance(lambda_um, T_K);  // even in ln(lambda)
            black += weight;
            emitted += weight * (1.0 - reflectance.at(lambda_um));
        }
        out.value[t] = emitted / black;
    }
    return out;
}

}  // namespace pyroscene::radiometry
