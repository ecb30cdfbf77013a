#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pyroscene::radiometry {

/// Columns of a least-squares problem, one after the other.
struct FitColumns {
    std::size_t rows = 0;
    std::vector<double> values;  ///< [column][row]
    [[nodiscard]] std::size_t count() const noexcept { return rows == 0 ? 0 : values.size() / rows; }
    [[nodiscard]] std::span<const double> operator[](std::size_t column) const noexcept {
        return {values.data() + column * rows, rows};
    }
};

struct NonnegativeFit {
    std::vector<std::size_t> column;  ///< those with a positive weight, in the order in which they were taken
    std::vector<double> weight;
    double largest_residual = 0.0;  ///< max |sum_j weight_j column_j - target|
};

/// Weights >= 0 that bring the weighted sum of columns close to a target in the least-squares sense, one column more at a
/// time (Lawson & Hanson 1974, ch. 23), until no residual exceeds `tolerance`, `most_columns` are in use, or no column helps.
NonnegativeFit nonnegative_fit(const FitColumns& columns, std::span<const double> target, double tolerance,
                               std::size_t most_columns);

}  // namespace pyroscene::radiometry
