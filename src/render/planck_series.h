#pragma once

#include <span>
#include <vector>

namespace pyroscene::render {

/// Planck's law over a range of temperatures as a Chebyshev series in 1/T:
///   B(lambda, T) = sum_m row(m)[lambda] T_m(p),   p = reduced(T) in [-1, 1].
/// Emission of any number of voxels is then a handful of moments sum_i w_i T_m(p_i). As many terms as keep the error below
/// 1e-4 of the hottest radiance at every wavelength (at most 24).
class PlanckSeries {
public:
    /// \param stride  floats per row, >= lambda_um.size(); the rest is zero   \param lowest_K > 0; equal to highest_K: one term
    PlanckSeries(std::span<const double> lambda_um, int stride, double lowest_K, double highest_K);

    [[nodiscard]] int moments() const noexcept { return moments_; }
    [[nodiscard]] const float* row(int moment) const noexcept {
        return values_.data() + static_cast<std::size_t>(moment) * stride_;
    }
    [[nodiscard]] double reduced(double temperature_K) const noexcept;

private:
    std::size_t stride_;
    int moments_ = 1;
    double middle_per_K_, half_range_per_K_;
    std::vector<float> values_;
};

}  // namespace pyroscene::render
