#pragma once

#include <span>
#include <vector>

namespace pyroscene::render {

/// A few absorption coefficients that stand for all wavelengths: the light of a flame on a place is a smooth function of
/// its absorption coefficient alone (for given temperatures), so it is traced at nodes even in log k and interpolated by
/// cubics. Between nodes a factor of 1.4 apart a transmittance is off by less than 5e-4.
class AbsorptionNodes {
public:
    explicit AbsorptionNodes(std::span<const float> absorption_per_m);

    /// Node values of k, ascending; a single one when all wavelengths have the same.
    [[nodiscard]] const std::vector<float>& k_per_m() const noexcept { return k_per_m_; }
    [[nodiscard]] int count() const noexcept { return static_cast<int>(k_per_m_.size()); }
    /// out[l] = value at wavelength l, from the values at the nodes, at_nodes[i * spacing].
    void interpolate(const float* at_nodes, int spacing, std::span<float> out) const noexcept;

private:
    struct Place {
        int first = 0;
        float weight[4] = {1.0F, 0.0F, 0.0F, 0.0F};
    };
    std::vector<float> k_per_m_;
    std::vector<Place> places_;  ///< per wavelength
};

}  // namespace pyroscene::render
