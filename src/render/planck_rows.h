#pragma once

#include <array>
#include <span>
#include <vector>

namespace pyroscene::render {

/// Planck spectra at nodes even in 1/T, for cubic interpolation in 1/T: a temperature becomes four weights on four
/// consecutive rows, so that many temperatures can be gathered as weights before any wavelength is touched.
/// Temperatures named as exact have a row of their own (ambient ground, the front, a flame of one temperature).
/// Against Planck's law: 1e-6 relative or better wherever B > 1e-20 W m-2 sr-1 um-1; less than that counts as zero.
class PlanckRows {
public:
    struct Lookup {
        int row = 0, count = 1;  ///< rows row .. row + count - 1, count 1 or 4
        std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};
    };

    PlanckRows() = default;
    /// \param stride  floats per row, >= lambda_um.size(); the rest of a row is zero
    /// \param lowest_K, highest_K  range of the temperatures to come; outside it `at` clamps. lowest_K is held to >= 50 K.
    PlanckRows(std::span<const double> lambda_um, int stride, double lowest_K, double highest_K,
               std::span<const double> exact_K);

    [[nodiscard]] Lookup at(double temperature_K) const noexcept;
    [[nodiscard]] const float* row(int i) const noexcept { return values_.data() + static_cast<std::size_t>(i) * stride_; }
    [[nodiscard]] int row_count() const noexcept { return rows_; }
    [[nodiscard]] int stride() const noexcept { return static_cast<int>(stride_); }

private:
    void add_nodes(std::span<const double> lambda_um);

    std::size_t stride_ = 0;
    int rows_ = 0, nodes_ = 0;
    double first_per_K_ = 0.0, nodes_per_K_ = 0.0;  ///< 1/T of node 0 (the hottest), nodes per unit of 1/T
    double lowest_K_ = 0.0, highest_K_ = 0.0;
    std::vector<double> exact_K_;  ///< their rows follow the nodes
    std::vector<float> values_;
};

}  // namespace pyroscene::render
