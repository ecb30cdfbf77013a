#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiometry/absorption_mix.h"

namespace pyroscene::render {

/// A few absorption coefficients that stand for all wavelengths: the light of a flame on a place is a smooth function of
/// its absorption coefficient alone (for given temperatures), so it is traced at nodes even in log k and interpolated by
/// cubics. Between nodes a factor of 1.4 apart a transmittance is off by less than 5e-4.
class AbsorptionNodes {
public:
    explicit AbsorptionNodes(std::span<const float> absorption_per_m);
    /// With gas: a wavelength is a mixture of absorption coefficients. Nodes are a factor of 1.55 apart (1.5e-3).
    explicit AbsorptionNodes(std::span<const std::vector<radiometry::AbsorptionPart>> mixes);

    /// Node values of k, ascending; a single one when all wavelengths have the same.
    [[nodiscard]] const std::vector<float>& k_per_m() const noexcept { return k_per_m_; }
    [[nodiscard]] int count() const noexcept { return static_cast<int>(k_per_m_.size()); }
    /// out[l] = value at wavelength l, from the values at the nodes, at_nodes[i * spacing]. `out` has room for the wavelengths
    /// padded to whole vectors.
    void interpolate(const float* at_nodes, int spacing, float* out) const noexcept;

private:
    struct Place {
        int first = 0;
        float weight[4] = {1.0F, 0.0F, 0.0F, 0.0F};
    };
    void make_nodes(double lowest_per_m, double highest_per_m, double ratio);
    [[nodiscard]] Place place(double k_per_m) const noexcept;
    /// Makes wavelength l depend on the nodes around k with the given share.
    void add(std::size_t l, double k_per_m, double share);

    std::vector<float> k_per_m_;
    int stride_ = 0;                                                ///< wavelengths padded to whole vectors
    std::vector<float> weight_;                                     ///< [node][wavelength]
    double lowest_per_m_ = 0.0, highest_per_m_ = 0.0, step_ = 0.0;  ///< of ln k between nodes
};

}  // namespace pyroscene::render
