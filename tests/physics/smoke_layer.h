#pragma once

#include "physics/test_scene.h"

namespace pyroscene::test {

struct Smoke {
    double extinction_per_m, albedo, asymmetry;
};

/// A layer of smoke from 100 to 300 m over everything, cut into `slices` voxels; black ground at 300 K unless told.
struct SmokeLayer {
    Smoke smoke;
    int slices = 1;
    double smoke_K = 300.0, ground_K = 300.0, reflectance = 0.0;
};
TestScene smoke_layer(const SmokeLayer& layer, const std::vector<double>& lambda_um);

/// Unit vector to a zenith angle and an azimuth east of north.
Vec3 direction(double zenith_rad, double azimuth_rad);

/// Down onto the middle of the scene from such a direction, 1 km high.
render::SceneRay ray_from(double zenith_rad, double azimuth_rad);

inline float term(const render::RadianceImage& image, render::Term which, std::size_t band) {
    return image.terms[static_cast<std::size_t>(which)][band];
}

/// Radiance of a slab in sunlight per irradiance normal to it, seen from straight above, by Monte Carlo with a contribution from
/// every collision (black ground); the first collision is forced into the slab.
struct Orders {
    double first = 0.0, all = 0.0;
};
Orders orders_of_scattering(double depth, double albedo, double asymmetry, double sun_cosine);

/// The same for a cube of smoke in the sun from the east at zenith angle acos(sun_cosine): mean over the cube's top.
/// \param depth of an edge
Orders orders_in_cube(double depth, double albedo, double asymmetry, double sun_cosine);

}  // namespace pyroscene::test
