#pragma once

#include "render/diffusion_nodes.h"

namespace pyroscene::render {

/// A black body between rows of Planck spectra: sum of `count` (1 or 4) rows.
struct PlanckBlend {
    const float* rows = nullptr;
    int count = 1;
    float weight[4] = {1.0F, 0.0F, 0.0F, 0.0F};
};

/// A piece of ray with smoke and perhaps flame of soot, both constant in it, and the light that reaches it.
struct SmokeStep {
    float smoke_m = 0.0F, flame_m = 0.0F;  ///< fill x length
    PlanckBlend smoke, flame;
    float sun_column = 0.0F, sun_column_far = 0.0F;  ///< fill x length towards the sun, at the near and the far end
    float column_above = 0.0F, column_below = 0.0F;  ///< along a mean slant; of light scattered once
    float flame_per_m2 = 0.0F, flame_column = 0.0F;
    float flame_cosine = 1.0F, flame_bundling = 0.0F;  ///< of the scattering angle; 1: all from one direction, 0: from all
    DiffuseSource diffuse{};                           ///< of light scattered more than once
};

/// Spectra that decide what becomes of light on its way through smoke; [n] each. Those of scattering are null when there is none.
struct SmokeWaySpectra {
    int n = 0;
    const float *extinction = nullptr, *absorption = nullptr;  ///< of smoke, of flame
    const float *asymmetry = nullptr, *beam = nullptr;         ///< what dims the sun's beam, per column
    const float *flame_k = nullptr, *flame_spread = nullptr;   ///< flames' light passes exp(-k c) / (1 + spread c)
    const float* flame_share_m2 = nullptr;
    const float* diffusion_weight = nullptr;                         ///< [diffusion node][n]; null: light is scattered once
    const int *first_diffusion = nullptr, *end_diffusion = nullptr;  ///< [block of n] nodes with weights that are not 0
};

/// Consecutive pieces of one ray. Optical depths a = k_f depth_f of flame and b = k_s depth_s of smoke, albedo w of the smoke;
/// piece by piece
///   flame     += scale tau (1 - e^(-a-b)) a B_f / (a + b)
///   smoke     += scale tau (1 - e^(-a-b)) b (1 - w) B_s / (a + b)
///   scattered += scale tau w b [ (1 - e^(-a-b)) J / (a + b) + E p(sun) int_0^1 e^(-k_s S(x)) e^(-(a+b) x) dx ]
///   tau       *= e^(-a-b)
/// S(x) is the smoke between the sun and the piece, linear from its near to its far end; J is the mean radiance of all
/// other light: sky above, ground below and flames beside, each through the smoke before it; what that smoke takes away it
/// gives back as the black body of the piece's temperature, so that J = B in a furnace. Of light scattered more than once,
/// sky, ground and sun are the answers of SmokeDiffusion, and k_s S(x) is scaled as there.
/// All this is linear in the spectra of light (sun, sky, ground, flames, black bodies), which may be as rough as they like; what
/// multiplies them is smooth along the wavelengths and is computed at a few of them (SmokeNodes), then interpolated.
struct SmokeRun {
    const SmokeStep* steps = nullptr;
    int count = 0;
    bool flame = false, flame_light = false;  ///< in any step; on any step
    SmokeWaySpectra node{};
    float* at_nodes = nullptr;  ///< scratch: kSpectra + 3 count rows of node.n
    // From the nodes to the wavelengths: those of block i (eight wavelengths) are entries first[i] to first[i + 1].
    int n = 0;
    const int *first = nullptr, *node_of = nullptr;
    const float* weight = nullptr;         ///< [entry][lane]
    const unsigned char* glows = nullptr;  ///< [block] 0: black bodies as warm as this smoke add nothing to the light around
    const float* albedo = nullptr;         ///< null: no scattering
    const float *sky = nullptr, *ground = nullptr,
                *ground_lit = nullptr;  ///< radiance from above; from below: emitted, sunlit
    const float* irradiance = nullptr;  ///< of the sun, normal to its beam
    const float* sun = nullptr;         ///< the same times the phase function per sr
    const float* flame_radiance = nullptr;
    float scale = 1.0F;
    float *tau = nullptr, *flame_out = nullptr, *smoke_out = nullptr, *scattered_out = nullptr;

    /// Rows of `at_nodes`: transmittance, then what multiplies each spectrum of light, summed over the steps. Those of black
    /// bodies follow, three for each step: emitted by smoke, scattered by it, emitted by flame.
    enum Spectrum { Through, Beam, Sky, Ground, GroundLit, Irradiance, Flames, kSpectra };
};

/// Bodies of flame and patches of front as point sources of light, [n] each, n a multiple of the kernels' lanes; weight 0 fills up.
struct FlameSources {
    int n = 0;
    const float *x_m = nullptr, *y_m = nullptr, *z_m = nullptr;
    const float *weight = nullptr, *softening_m2 = nullptr;
    const float* flat = nullptr;  ///< 1 for a patch: it shines upward with the cosine, twice its mean straight up; else 0
};

/// Their light at a point: sums over sources of q = weight / (r^2 + softening), of a patch times 2 sqrt((z^2 + softening) / (r^2 +
/// softening)) above it and 0 below, of q times the unit way from the source, and of q
/// times the place of the source.
struct FlameLightAt {
    float per_m2, way[3], place_m[3];
};

}  // namespace pyroscene::render
