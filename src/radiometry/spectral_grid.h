#pragma once

#include <span>
#include <vector>

#include "base/spectrum.h"

namespace pyroscene::radiometry {

/// Transport wavelengths and their weights to each band. Every wavelength belongs to one band; a band's wavelengths are
/// contiguous and its weights sum to 1, so  L_band = sum_{i in band} weight[i] L(lambda_um[i])  approximates
/// int L R dl / int R dl.  Each band's response is cut into cells; a cell carries the two-point Gauss rule of the response
/// itself (exact for cubics times the response), and quantities with fine structure (the atmosphere) are averaged over
/// the window of the node.
struct SpectralGrid {
    struct Range {
        int begin = 0, end = 0;
    };
    std::vector<double> lambda_um;  ///< nodes, band after band
    std::vector<double> weight;     ///< per node, sums to 1 within a band
    /// Averaging window of each node (equal for a monochromatic band). A node's share of its cell is the part that holds
    /// its weight; the window has the mean and the variance that the response has in the share, so that a plain mean over
    /// it is right to second order. It contains the node and stays within the cell.
    std::vector<double> cell_lower_um, cell_upper_um;
    std::vector<Range> bands;

    [[nodiscard]] int size() const noexcept { return static_cast<int>(lambda_um.size()); }
    [[nodiscard]] int band_count() const noexcept { return static_cast<int>(bands.size()); }
    /// Weighted sum of node values of one band.
    [[nodiscard]] double band_mean(int band, std::span<const float> node_values) const noexcept;
};

/// Grid for bands given by their responses (Quantity::Response, any positive scale; two points at one wavelength are a
/// vertical edge, outside the points the response is zero).
/// Cells are refined until the Planck means from 300 to 2000 K are within 6e-6 of band_mean_radiance; where the mean
/// is below 1e-3 W m-2 sr-1 um-1 (ambient temperatures in the short-wave infrared) the bound grows with its inverse, to
/// 5e-4. \param maximum_relative_cell  a cell is at most this fraction of its wavelength wide: resolves the atmosphere's
/// bands Throws an input error for a response that is empty, negative or zero everywhere.
SpectralGrid make_spectral_grid(std::span<const Spectrum> responses, double maximum_relative_cell = 0.05);

/// One node per band, weight 1.
SpectralGrid monochromatic_grid(std::span<const double> lambda_um);

}  // namespace pyroscene::radiometry
