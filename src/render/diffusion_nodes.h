#pragma once

namespace pyroscene::render {

/// Constants of a smoke's diffusion (smoke_diffusion.h) at the nodes of its optics; plain arrays for the kernels.
struct DiffusionNodes {
    static constexpr int kCount = 8;
    float extinction_per_m[kCount]{};  ///< k of fill 1
    float beam_per_m[kCount]{};        ///< k'
    float decay_per_m[kCount]{};       ///< of diffuse light: decay times k'
    float boundary[kCount]{};          ///< q
    float slope[kCount]{};             ///< 3/2 g q
    // Of a sun of irradiance 1 normal to its beam.
    float sun_top[kCount]{}, sun_bottom[kCount]{};       ///< amplitudes of the solutions lit from above and from below
    float sun_beam[kCount]{}, sun_beam_slope[kCount]{};  ///< of exp(-t / mu0): in -I0, and in g I1
    float sun_cosine = 0.0F;                             ///< mu0; 0 at night
};

/// Columns of smoke (fill x length) at the near end of a piece of ray, and by how much they change to its far end.
struct DiffuseColumns {
    struct Range {
        float near = 0.0F, change = 0.0F;
    };
    Range above, below;          ///< straight up and down
    Range to_sun, past_sun;      ///< along the sun's rays, before and behind
    float depth = 0.0F;          ///< of the piece itself
    float upward_cosine = 0.0F;  ///< of the light on its way to the sensor
};

/// What a piece of smoke in such light sends on, per node: of a sky and of a ground of radiance 1, of the ground by the share
/// of the sun's light that gets down to it, and of a sun of irradiance 1.
struct DiffuseSource {
    float sky[DiffusionNodes::kCount], ground[DiffusionNodes::kCount], sunlit_ground[DiffusionNodes::kCount],
        sun[DiffusionNodes::kCount];
};

/// What reaches the ground under smoke, per node: transmittance of the sky's diffuse light, reflectance for the ground's, and
/// irradiance on level ground by a sun of irradiance 1, straight and scattered.
struct DiffuseShade {
    float sky[DiffusionNodes::kCount], ground[DiffusionNodes::kCount], sun[DiffusionNodes::kCount];
};

}  // namespace pyroscene::render
