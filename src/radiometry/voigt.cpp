#include "radiometry/voigt.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "base/constants.h"

namespace pyroscene::radiometry {
namespace {

constexpr int kTerms = 32;

struct Series {
    double scale;                            ///< L of the paper
    std::array<double, kTerms> coefficient;  ///< ascending powers
};

/// Fourier coefficients of exp(-t^2) (L^2 + t^2) over theta, t = L tan(theta / 2); the function is even.
Series make_series() noexcept {
    Series s{std::sqrt(kTerms / std::sqrt(2.0)), {}};
    constexpr int kSamples = 4 * kTerms;
    for (int n = 1; n <= kTerms; ++n) {
        double sum = 0.0;
        for (int j = 1 - kSamples / 2; j < kSamples / 2; ++j) {
            const double theta = 2.0 * kPi * j / kSamples, t = s.scale * std::tan(theta / 2.0);
            sum += std::exp(-t * t) * (s.scale * s.scale + t * t) * std::cos(n * theta);
        }
        s.coefficient[static_cast<std::size_t>(n - 1)] = sum / kSamples;
    }
    return s;
}

}  // namespace

double voigt_function(double x, double y) noexcept {
    static const Series series = make_series();
    const std::complex<double> iz(-y, x), below = series.scale - iz, ratio = (series.scale + iz) / below;
    std::complex<double> polynomial = 0.0;
    for (int n = kTerms - 1; n >= 0; --n) polynomial = polynomial * ratio + series.coefficient[static_cast<std::size_t>(n)];
    return std::real(2.0 * polynomial / (below * below) + 1.0 / std::sqrt(kPi) / below);
}

double voigt_profile_per_Hz(double offset_Hz, double gauss_fwhm_Hz, double lorentz_fwhm_Hz) noexcept {
    const double half_1e_Hz = gauss_fwhm_Hz / (2.0 * std::sqrt(std::log(2.0)));
    return voigt_function(offset_Hz / half_1e_Hz, 0.5 * lorentz_fwhm_Hz / half_1e_Hz) / (half_1e_Hz * std::sqrt(kPi));
}

}  // namespace pyroscene::radiometry
