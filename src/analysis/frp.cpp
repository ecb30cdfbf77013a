#include "analysis/frp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"

namespace pyroscene::analysis {
namespace {

constexpr double kColdest_K = 400.0, kHottest_K = 1800.0;
constexpr double kCertain_K = 360.0, kLeastContrast_K = 6.0, kLeastDeviations = 3.5;

constexpr std::array<PublishedCoefficient, 6> kPublished{{{"bird", 3.3e-9},     // Wooster et al. 2003, HSRS 3.4-4.2 um
                                                          {"modis", 3.0e-9},    // Wooster et al. 2005, bands 21 and 22
                                                          {"seviri", 3.06e-9},  // Wooster et al. 2015
                                                          {"goes", 3.08e-9},    // imager, Xu et al. 2010
                                                          {"viirs_m13", 2.88e-9},
                                                          {"viirs_i4", 3.21e-9}}};

/// Fraction that explains the MIR radiance with a fire of temperature T.
double fraction_of(const BispectralInput& in, const std::function<double(double)>& mir, double T_K) {
    return (in.mir - in.mir_background) / (mir(T_K) - in.mir_background);
}

struct Solution {
    double fraction = 0.0, temperature_K = 0.0;
    bool solved = false;
};

Solution solve(const BispectralInput& in, const std::function<double(double)>& mir,
               const std::function<double(double)>& tir) {
    if (!(in.mir > in.mir_background) || !(in.tir > in.tir_background)) return {};
    const auto excess = [&](double T_K) {
        return fraction_of(in, mir, T_K) * (tir(T_K) - in.tir_background) - (in.tir - in.tir_background);
    };
    double low = kColdest_K, high = kHottest_K, at_low = excess(low);
    if (!(mir(low) > in.mir_background) || !(at_low * excess(high) <= 0.0)) return {};
    for (int i = 0; i < 80 && high - low > 1e-10 * high; ++i) {
        const double middle = 0.5 * (low + high), value = excess(middle);
        if (value * at_low > 0.0) {
            low = middle;
            at_low = value;
        } else {
            high = middle;
        }
    }
    const double T_K = 0.5 * (low + high), p = fraction_of(in, mir, T_K);
    return {p, T_K, p > 0.0 && p <= 1.0};
}

double power(const BispectralInput& in, const Solution& s) {
    return s.fraction * kStefanBoltzmann_W_m2_K4 * (std::pow(s.temperature_K, 4.0) - std::pow(in.background_K, 4.0));
}

}  // namespace

double power_law_coefficient(std::span<const double> temperature_K, std::span<const double> radiance) noexcept {
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < std::min(temperature_K.size(), radiance.size()); ++i) {
        const double T4 = std::pow(temperature_K[i], 4.0);
        above += radiance[i] * T4;
        below += T4 * T4;
    }
    return above / below;
}

std::span<const PublishedCoefficient> published_coefficients() noexcept { return kPublished; }

double frp_mir_W_m2(double radiance, double background, double a, double transmittance) noexcept {
    return kStefanBoltzmann_W_m2_K4 / a * (radiance - background) / transmittance;
}

Bispectral bispectral(const BispectralInput& in, const std::function<double(double)>& mir,
                      const std::function<double(double)>& tir) {
    const Solution s = solve(in, mir, tir);
    if (!s.solved) return {};
    Bispectral out{true, s.fraction, s.temperature_K, power(in, s), 0.0, 0.0, 0.0, 0.0};
    // Jacobian of the two equations with respect to p and T; its inverse carries the noise over.
    const double step_K = 1e-3 * s.temperature_K, T_K = s.temperature_K;
    const auto slope = [&](const std::function<double(double)>& band) {
        return (band(T_K + step_K) - band(T_K - step_K)) / (2.0 * step_K);
    };
    const double mir_p = mir(T_K) - in.mir_background, mir_T = s.fraction * slope(mir);
    const double tir_p = tir(T_K) - in.tir_background, tir_T = s.fraction * slope(tir);
    const double determinant = mir_p * tir_T - mir_T * tir_p;
    if (determinant == 0.0) return out;
    const double p_mir = tir_T / determinant, p_tir = -mir_T / determinant, T_mir = -tir_p / determinant,
                 T_tir = mir_p / determinant;
    const auto sum = [&](double a_mir, double a_tir, double b_mir, double b_tir) {
        return a_mir * b_mir * in.mir_noise * in.mir_noise + a_tir * b_tir * in.tir_noise * in.tir_noise;
    };
    out.fraction_sd = std::sqrt(sum(p_mir, p_tir, p_mir, p_tir));
    out.temperature_sd_K = std::sqrt(sum(T_mir, T_tir, T_mir, T_tir));
    if (out.fraction_sd > 0.0 && out.temperature_sd_K > 0.0)
        out.correlation = sum(p_mir, p_tir, T_mir, T_tir) / (out.fraction_sd * out.temperature_sd_K);
    const double power_p = out.frp_W_m2 / s.fraction,
                 power_T = 4.0 * s.fraction * kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 3.0);
    const double of_mir = power_p * p_mir + power_T * T_mir, of_tir = power_p * p_tir + power_T * T_tir;
    out.frp_sd_W_m2 = std::sqrt(sum(of_mir, of_tir, of_mir, of_tir));
    return out;
}

Background background_around(std::span<const float> plane, std::span<const unsigned char> fire, int samples, int lines,
                             int sample, int line) noexcept {
    constexpr int kSmallest = 2, kLargest = 10, kLeastPixels = 8;
    for (int half = kSmallest; half <= kLargest; ++half) {
        std::array<double, 2> sums{};
        int count = 0;
        const auto visit = [&](auto&& use) {
            for (int l = std::max(line - half, 0); l <= std::min(line + half, lines - 1); ++l) {
                for (int s = std::max(sample - half, 0); s <= std::min(sample + half, samples - 1); ++s) {
                    if (std::abs(l - line) <= 1 && std::abs(s - sample) <= 1) continue;
                    const auto i =
                        static_cast<std::size_t>(l) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(s);
                    if (fire[i] == 0 && std::isfinite(plane[i])) use(static_cast<double>(plane[i]));
                }
            }
        };
        visit([&](double v) {
            sums[0] += v;
            ++count;
        });
        const int area = (2 * half + 1) * (2 * half + 1);
        if (count < kLeastPixels || 4 * count < area) continue;
        const double mean = sums[0] / count;
        visit([&](double v) { sums[1] += std::abs(v - mean); });
        return {mean, sums[1] / count, count};
    }
    return {};
}

Background background_of_all(std::span<const float> plane, std::span<const unsigned char> fire) noexcept {
    Background all;
    double sum = 0.0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        if (fire[i] != 0 || !std::isfinite(plane[i])) continue;
        sum += static_cast<double>(plane[i]);
        ++all.pixels;
    }
    if (all.pixels > 0) all.mean = sum / all.pixels;
    return all;
}

std::vector<unsigned char> fire_pixels(std::span<const float> T_K, int samples, int lines, double least_K) {
    std::vector<unsigned char> candidate(T_K.size(), 0), fire(T_K.size(), 0);
    for (std::size_t i = 0; i < T_K.size(); ++i) candidate[i] = static_cast<double>(T_K[i]) > kCertain_K ? 1 : 0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int line = 0; line < lines; ++line) {
            for (int sample = 0; sample < samples; ++sample) {
                const auto i =
                    static_cast<std::size_t>(line) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
                const double own_K = static_cast<double>(T_K[i]);
                fire[i] = own_K > kCertain_K ? 1 : 0;
                if (fire[i] != 0 || !(own_K > least_K)) continue;
                const Background around = background_around(T_K, candidate, samples, lines, sample, line);
                if (around.pixels == 0) continue;
                const double contrast_K = own_K - around.mean;
                fire[i] =
                    contrast_K > kLeastContrast_K && contrast_K > kLeastDeviations * around.mean_absolute_deviation ? 1 : 0;
            }
        }
        candidate = fire;
    }
    return fire;
}

}  // namespace pyroscene::analysis
