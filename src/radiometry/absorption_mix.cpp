#include "radiometry/absorption_mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "radiometry/nonnegative_fit.h"

namespace pyroscene::radiometry {
namespace {

constexpr int kLengths = 46;
constexpr double kShortest_m = 0.01, kLongest_m = 300.0, kRatio = 1.6;
constexpr double kTolerance = 1e-3, kSumWeight = 100.0;
constexpr std::size_t kMostParts = 12;

std::array<GasAbsorption, kGasSpeciesCount> all_gases(const GasOptics& optics, const FlameGas& gas, double lambda_um,
                                                      double T_K) {
    std::array<GasAbsorption, kGasSpeciesCount> found;
    for (std::size_t i = 0; i < kGasSpeciesCount; ++i)
        found[i] = gas_absorption(optics, kGasSpecies[i], lambda_um, T_K, gas);
    return found;
}

double transmittance(const std::array<GasAbsorption, kGasSpeciesCount>& gases, double length_m) noexcept {
    double depth = 0.0;
    for (std::size_t i = 0; i < kGasSpeciesCount; ++i) {
        GasColumn column;
        column.add(gases[i], length_m);
        depth += gas_optical_depth(kGasSpecies[i], column);
    }
    return std::exp(-depth);
}

}  // namespace

std::vector<AbsorptionPart> absorption_mix(const FlameOptics& optics, const FlameGas& gas, double lambda_um, double T_K) {
    const double continuum_per_m = soot_absorption_per_m(optics.soot, lambda_um, gas.soot_volume_fraction) +
                                   alkali_absorption_per_m(optics.alkali, lambda_um, T_K, gas);
    const auto gases = all_gases(optics.gas, gas, lambda_um, T_K);
    double mean_per_m = 0.0;
    for (const auto& g : gases) mean_per_m += g.per_m;
    if (mean_per_m * kLongest_m < 1e-4) return {{continuum_per_m, 1.0}};

    std::vector<double> k_per_m{0.0};
    const double highest = 30.0 * mean_per_m;
    for (double k = 1e-5 * highest; k < highest; k *= kRatio) k_per_m.push_back(k);
    FitColumns columns{kLengths + 1, {}};
    std::vector<double> target;
    target.reserve(kLengths + 1);
    const auto length_m = [](int i) { return kShortest_m * std::pow(kLongest_m / kShortest_m, i / (kLengths - 1.0)); };
    for (const double k : k_per_m) {
        for (int i = 0; i < kLengths; ++i) columns.values.push_back(std::exp(-k * length_m(i)));
        columns.values.push_back(kSumWeight);
    }
    for (int i = 0; i < kLengths; ++i) target.push_back(transmittance(gases, length_m(i)));
    target.push_back(kSumWeight);
    const auto fit = nonnegative_fit(columns, target, kTolerance, kMostParts);

    double sum = 0.0;
    for (const double w : fit.weight) sum += w;
    std::vector<AbsorptionPart> parts;
    for (std::size_t j = 0; j < fit.column.size(); ++j)
        parts.push_back({continuum_per_m + k_per_m[fit.column[j]], fit.weight[j] / sum});
    return parts;
}

}  // namespace pyroscene::radiometry
