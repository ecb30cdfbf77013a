#pragma once

#include <span>
#include <vector>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Transport wavelengths and their weights to each band. Every wavelength belongs to one band; a band's wavelengths are
/// contiguous and its weights sum to 1, so  L_band = sum_{i in band} weight[i] L(lambda_um[i])  approximates
/// int L R dl / int R dl.  Each band's response is cut into cells; a cell carries the two-point Gauss rule of the response
/// itself (exact for cubics times the response), and quantities with fine structure (the atmosphere) are averaged over
/// the cell that the node lies in.
struct SpectralGrid {
    struct Range {
        int begin = 0, end = 0;
    };
    std::vector<double> lambda_um;                    ///< nodes, band after band
    std::vector<double> weight;                       ///< per node, sums to 1 within a band
    std::vector<double> cell_lower_um, cell_upper_um; ///< cell of each node (equal for a monochromatic band)
    std::vector<Range> bands;

    [[nodiscard]] int size() const noexcept { return static_cast<int>(lambda_um.size()); }
    [[nodiscard]] int band_count() const noexcept { return static_cast<int>(bands.size()); }
    /// Weighted sum of node values of one band.
    [[nodiscard]] double band_mean(int band, std::span<const float> node_values) const noexcept;
};

/// Grid for bands given by their responses (Quantity::Response, any positive scale).
/// \param maximum_relative_cell  a cell is at most this fraction of its wavelength wide (0.025 keeps Planck from 300 to
///        2000 K within 1e-5 of the band integral)
/// Throws an input error for a response that is empty, negative or zero everywhere.
SpectralGrid make_spectral_grid(std::span<const Spectrum> responses, double maximum_relative_cell = 0.025);

/// One node per band, weight 1.
SpectralGrid monochromatic_grid(std::span<const double> lambda_um);

}  // namespace pyroscene::radiometry
