#pragma once

#include <array>
#include <vector>

#include "render/pixel.h"
#include "render/scene.h"

namespace pyroscene::render {

/// From the spectra of a pixel to its bands: atmosphere, terms, weights of the spectral grid. One per thread.
class BandOutput {
public:
    BandOutput(const PreparedScene& prepared, bool with_terms);

    /// At-sensor radiance (eq 4.44 with thermal path and thermal sky) of a finished pixel that covers something:
    /// `total` [band] and, when asked for, `terms` [term][band].
    void compute(const Pixel& pixel, const PixelView& view, float* total, float* terms);
    [[nodiscard]] bool needs_view() const noexcept { return !vacuum_; }

private:
    void compute_terms(const Pixel& pixel, float scale, float* terms);

    const PreparedScene* prepared_;
    const SpectralKernels* kernels_;
    bool with_terms_, vacuum_;
    int bands_;
    std::vector<int> begin_;     ///< [band + 1] first node of a band
    std::vector<float> weight_;  ///< [node]
    radiometry::ViewAtmosphere::View view_;
    std::vector<float> path_, at_sensor_, through_;
    std::vector<float> zero_;
};

}  // namespace pyroscene::render
