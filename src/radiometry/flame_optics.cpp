#include "radiometry/flame_optics.h"

#include <algorithm>
#include <cmath>

#include "radiometry/planck.h"

namespace pyroscene::radiometry {

FlameOptics load_flame_optics(const std::filesystem::path& folder) {
    return {load_soot_optics(folder / "soot_optics.csv"), load_gas_optics(folder),
            load_alkali_lines(folder / "alkali_lines.csv")};
}

void FlamePath::add(double length_m, double T_K, const FlameGas& gas) noexcept {
    const double before = depth();
    soot_ += soot_absorption_per_m(optics_->soot, lambda_um_, gas.soot_volume_fraction) * length_m;
    alkali_ += alkali_absorption_per_m(optics_->alkali, lambda_um_, T_K, gas) * length_m;
    for (const GasSpecies species : kGasSpecies) {
        columns_[static_cast<std::size_t>(species)].add(gas_absorption(optics_->gas, species, lambda_um_, T_K, gas),
                                                        length_m);
    }
    const double added = std::max(depth() - before, 0.0);
    radiance_ -= std::exp(-before) * std::expm1(-added) * planck_radiance(lambda_um_, T_K);
}

double total_emissivity(const FlameOptics& optics, const FlameGas& gas, double T_K, double length_m) noexcept {
    constexpr int kWavelengths = 400;
    constexpr double kShortest_um = 0.5, kLongest_um = 16.6;
    double emitted = 0.0, black = 0.0;
    for (int i = 0; i < kWavelengths; ++i) {
        const double lambda_um = kShortest_um * std::pow(kLongest_um / kShortest_um, (i + 0.5) / kWavelengths);
        const double weight = lambda_um * planck_radiance(lambda_um, T_K);  // even in ln(lambda)
        FlamePath path(optics, lambda_um);
        path.add(length_m, T_K, gas);
        black += weight;
        emitted -= weight * std::expm1(-path.depth());
    }
    return emitted / black;
}

double FlamePath::gas_depth(GasSpecies species) const noexcept {
    return gas_optical_depth(species, columns_[static_cast<std::size_t>(species)]);
}

double FlamePath::gas_depth() const noexcept {
    double sum = 0.0;
    for (const GasSpecies species : kGasSpecies) sum += gas_depth(species);
    return sum;
}

}  // namespace pyroscene::radiometry
