#pragma once

#include <span>
#include <vector>

#include "radiometry/flame_optics.h"

namespace pyroscene::radiometry {

/// Absorption of one flame mixture over wavelengths and temperatures, as floats laid out for marching: a homogeneous piece of
/// length s adds s times a row (blended between two temperatures) to running sums. Arrays over wavelength are padded with
/// zeros to `stride`; gases keep only the blocks of kLanes wavelengths in which they absorb at all.
struct FlameTable {
    static constexpr int kLanes = 8;

    struct Gas {
        GasSpecies species = GasSpecies::H2O;
        std::vector<int> first_lambda;  ///< [block] multiples of kLanes, ascending
        std::vector<float> rows;        ///< [temperature][x, x a_C, x a_D][block][lane], per metre
        [[nodiscard]] int row_stride() const noexcept { return 3 * kLanes * static_cast<int>(first_lambda.size()); }
    };
    struct Lookup {
        int row = 0, next = 0;
        float weight = 1.0F, next_weight = 0.0F;
    };

    int stride = 0, row_count = 0;
    double lowest_K = 0.0, step_K = 1.0;
    std::vector<float> continuum_per_m;  ///< [temperature][wavelength] what follows Beer's law: soot, K and Na
    std::vector<Gas> gases;              ///< those that absorb at any of the wavelengths

    /// Rows around a temperature; clamped to the table.
    [[nodiscard]] Lookup at(double T_K) const noexcept;
};

/// \param stride  floats per row, a multiple of kLanes, >= lambda_um.size()
/// \param lowest_K, highest_K  temperatures to come; equal: one row. Rows at most 20 K apart: 2e-3 of the depth or better
///        against FlamePath above 600 K.
FlameTable make_flame_table(const FlameOptics& optics, const FlameGas& gas, std::span<const double> lambda_um, int stride,
                            double lowest_K, double highest_K);

}  // namespace pyroscene::radiometry
