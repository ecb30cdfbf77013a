#pragma once

#include <span>
#include <vector>

#include "render/diffusion_nodes.h"

namespace pyroscene::render {

/// Light scattered more than once by smoke, as in a homogeneous plane layer: the delta-Eddington two-stream solution (Joseph,
/// Wiscombe & Weinman 1976). The diffuse radiance is I0 + I1 mu, of which smoke sends w (I0 + g I1 mu) on. With depths scaled by
/// k' = k (1 - w g^2), w' = w (1 - g^2) / (1 - w g^2), g' = g / (1 + g), and T the layer's depth, diffuse light of radiance 1
/// from above gives
///   I0 = (sinh y + q cosh y) / ((1 + q^2) sinh K + 2 q cosh K),  y = decay (T - t),  K = decay T,  I1 = I0' / (1 - w' g')
///   decay = sqrt(3 (1 - w') (1 - w' g')),   q = 2/3 sqrt(3 (1 - w') / (1 - w' g'))  (Marshak's boundary)
/// light from below its mirror image, and the sun a combination of both and exp(-t / mu0). Computed at a few nodes of the
/// optics; `weight` [node][stride] takes the answers from there to the wavelengths.
struct SmokeDiffusion {
    DiffusionNodes nodes;
    std::vector<float> weight;
    [[nodiscard]] bool empty() const noexcept { return weight.empty(); }
};

/// Nodes lie evenly along the curve that the optics follow over wavelength (ln k, albedo, g); between them cubic.
/// \param lambda_um  in any order, the other spectra [lambda] in the same   \param sun_cosine  of the zenith angle; <= 0: night
/// \param stride     of the weights, at least the number of wavelengths
SmokeDiffusion make_smoke_diffusion(std::span<const double> lambda_um, std::span<const float> extinction_per_m,
                                    std::span<const float> albedo, std::span<const float> asymmetry, double sun_cosine,
                                    int stride);

}  // namespace pyroscene::render
