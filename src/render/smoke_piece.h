#pragma once

#include "render/diffusion_nodes.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {

/// A piece of ray with smoke and perhaps flame, both constant in it, and the light that reaches it. Optical depths a = k_f
/// depth_f of flame and b = k_s depth_s of smoke, albedo w of the smoke:
///   flame     += scale tau (1 - e^(-a-b)) a B_f / (a + b)
///   smoke     += scale tau (1 - e^(-a-b)) b (1 - w) B_s / (a + b)
///   scattered += scale tau w b [ (1 - e^(-a-b)) J / (a + b) + E p(sun) int_0^1 e^(-k_s S(x)) e^(-(a+b) x) dx ]
///   tau       *= e^(-a-b)
/// S(x) is the smoke between the sun and the piece, linear from its near to its far end; J is the mean radiance of all
/// other light: sky above, ground below and flames beside, each through the smoke before it; what that smoke takes away it
/// gives back as the black body of the piece's temperature, so that J = B in a furnace. Of light scattered more than once,
/// sky, ground and sun are the answers of SmokeDiffusion, and k_s S(x) is scaled as there.
struct SmokePiece {
    int n = 0;
    Emitter flame{}, smoke{};  ///< their rows have the stride n; depth of what is absent is 0, its k must still be readable
    float scale = 1.0F;
    float *tau = nullptr, *flame_out = nullptr, *smoke_out = nullptr;
    // Scattering; albedo null: none.
    const float *albedo = nullptr, *asymmetry = nullptr;
    const float* sun = nullptr;                     ///< irradiance times phase function per sr
    const float* beam_k = nullptr;                  ///< what dims the sun's beam, per column
    const float *sky = nullptr, *ground = nullptr;  ///< radiance from above; from below, emitted
    const float* ground_lit = nullptr;              ///< from below, reflected sunlight
    const float *flame_share_m2 = nullptr, *flame_radiance = nullptr;
    float sun_column = 0.0F, sun_column_change = 0.0F;  ///< fill x length at the near end, far minus near
    float column_above = 0.0F, column_below = 0.0F;     ///< along a mean slant; of light scattered once
    float flame_per_m2 = 0.0F, flame_column = 0.0F;
    float flame_cosine = 1.0F, flame_bundling = 0.0F;  ///< of the scattering angle; 1: all from one direction, 0: from all
    const float *flame_k = nullptr, *flame_spread = nullptr;  ///< flames' light passes exp(-k c) / (1 + spread c)
    // Light scattered more than once; weight null: only once.
    const float* diffusion_weight = nullptr;  ///< [node][n]
    const float* irradiance = nullptr;        ///< of the sun, normal to its beam
    DiffuseSource diffuse{};
    float* scattered_out = nullptr;
};

}  // namespace pyroscene::render
