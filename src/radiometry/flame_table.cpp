#include "radiometry/flame_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pyroscene::radiometry {
namespace {

constexpr double kLargestStep_K = 20.0;
constexpr double kLeast_per_m = 1e-12;  // keeps denormal numbers out of the loops

float stored(double value) { return value < kLeast_per_m ? 0.0F : static_cast<float>(value); }

std::vector<double> temperatures_K(const FlameTable& table) {
    std::vector<double> T_K;
    T_K.reserve(static_cast<std::size_t>(table.row_count));
    for (int row = 0; row < table.row_count; ++row) T_K.push_back(table.lowest_K + row * table.step_K);
    return T_K;
}

/// x, x a_C and x a_D of every temperature and wavelength, then only the blocks that hold something.
FlameTable::Gas make_gas(const FlameTable& table, const GasOptics& optics, GasSpecies species, const FlameGas& gas,
                         std::span<const double> lambda_um) {
    const auto stride = static_cast<std::size_t>(table.stride);
    std::vector<float> all;
    std::vector<bool> used(stride / FlameTable::kLanes, false);
    for (const double T_K : temperatures_K(table)) {
        const std::size_t row = all.size();
        all.resize(row + 3 * stride, 0.0F);
        for (std::size_t l = 0; l < lambda_um.size(); ++l) {
            const GasAbsorption a = gas_absorption(optics, species, lambda_um[l], T_K, gas);
            if (stored(a.per_m) == 0.0F) continue;
            used[l / FlameTable::kLanes] = true;
            all[row + l] = stored(a.per_m);
            all[row + stride + l] = stored(a.per_m * a.a_lorentz);
            all[row + 2 * stride + l] = stored(a.per_m * a.a_doppler);
        }
    }
    FlameTable::Gas found;
    found.species = species;
    for (std::size_t block = 0; block < used.size(); ++block)
        if (used[block]) found.first_lambda.push_back(static_cast<int>(block) * FlameTable::kLanes);
    for (std::size_t row = 0; row < all.size(); row += stride) {
        for (const int first : found.first_lambda) {
            const auto from = all.begin() + static_cast<std::ptrdiff_t>(row) + first;
            found.rows.insert(found.rows.end(), from, from + FlameTable::kLanes);
        }
    }
    return found;
}

}  // namespace

FlameTable::Lookup FlameTable::at(double T_K) const noexcept {
    if (row_count < 2) return {};
    const double position = std::clamp((T_K - lowest_K) / step_K, 0.0, row_count - 1.0);
    const int row = std::min(static_cast<int>(position), row_count - 2);
    const auto fraction = static_cast<float>(position - row);
    return {row, row + 1, 1.0F - fraction, fraction};
}

FlameTable make_flame_table(const FlameOptics& optics, const FlameGas& gas, std::span<const double> lambda_um, int stride,
                            double lowest_K, double highest_K) {
    FlameTable table;
    table.stride = stride;
    table.lowest_K = lowest_K;
    table.row_count = highest_K > lowest_K ? static_cast<int>(std::ceil((highest_K - lowest_K) / kLargestStep_K)) + 1 : 1;
    if (table.row_count > 1) table.step_K = (highest_K - lowest_K) / (table.row_count - 1);
    for (const double T_K : temperatures_K(table)) {
        for (const double lambda : lambda_um) {
            table.continuum_per_m.push_back(stored(soot_absorption_per_m(optics.soot, lambda, gas.soot_volume_fraction) +
                                                   alkali_absorption_per_m(optics.alkali, lambda, T_K, gas)));
        }
        table.continuum_per_m.resize(table.continuum_per_m.size() + static_cast<std::size_t>(stride) - lambda_um.size(),
                                     0.0F);
    }
    for (const GasSpecies species : kGasSpecies) {
        auto found = make_gas(table, optics.gas, species, gas, lambda_um);
        if (!found.first_lambda.empty()) table.gases.push_back(std::move(found));
    }
    return table;
}

}  // namespace pyroscene::radiometry
