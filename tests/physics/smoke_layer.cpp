#include "physics/smoke_layer.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "radiometry/smoke.h"

namespace pyroscene::test {

TestScene smoke_layer(const SmokeLayer& layer, const std::vector<double>& lambda_um) {
    TestScene scene({.ground_K = layer.ground_K, .lambda_um = lambda_um, .reflectance = layer.reflectance});
    const fire::VoxelGrid grid{
        .corner_m = {-5e4, -5e4, 100.0}, .nx = 1, .ny = 1, .dx_m = 1e5, .dy_m = 1e5, .dz_m = 200.0 / layer.slices};
    scene.plume = fire::make_flame_field(grid, box_of_voxels(1, 1, layer.slices, layer.smoke_K));
    const auto n = lambda_um.size();
    scene.optics.smoke_extinction_per_m.assign(n, static_cast<float>(layer.smoke.extinction_per_m));
    scene.optics.smoke_albedo.assign(n, static_cast<float>(layer.smoke.albedo));
    scene.optics.smoke_asymmetry.assign(n, static_cast<float>(layer.smoke.asymmetry));
    return scene;
}

Vec3 direction(double zenith_rad, double azimuth_rad) {
    return {std::sin(zenith_rad) * std::sin(azimuth_rad), std::sin(zenith_rad) * std::cos(azimuth_rad),
            std::cos(zenith_rad)};
}

render::SceneRay ray_from(double zenith_rad, double azimuth_rad) {
    const Vec3 target{80.0, 80.0, 0.0}, up = direction(zenith_rad, azimuth_rad);
    return {target + (1000.0 / up.z) * up, target - (1.0 / up.z) * up};
}

namespace {

/// A new direction after Henyey and Greenstein from two uniform numbers.
Vec3 scatter(Vec3 along, double g, double u, double v) {
    const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u), cosine = (1.0 + g * g - s * s) / (2.0 * g);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), phi = 2.0 * kPi * v;
    const Vec3 side = normalized(std::abs(along.z) < 0.9 ? Vec3{-along.y, along.x, 0.0} : Vec3{0.0, -along.z, along.y});
    const Vec3 other{along.y * side.z - along.z * side.y, along.z * side.x - along.x * side.z,
                     along.x * side.y - along.y * side.x};
    return cosine * along + sine * std::cos(phi) * side + sine * std::sin(phi) * other;
}

}  // namespace

Orders orders_of_scattering(double depth, double albedo, double g, double mu0) {
    constexpr std::uint64_t kPhotons = 60000;
    const RandomKey key{7, 0, 0};
    const double hit = -std::expm1(-depth / mu0);
    Orders sum;
    for (std::uint64_t n = 0; n < kPhotons; ++n) {
        Vec3 along{std::sqrt(1.0 - mu0 * mu0), 0.0, -mu0};
        double t = -mu0 * std::log(1.0 - hit * uniform01(key, n, 3)), weight = hit;  // optical depth below the top
        for (std::uint32_t event = 0; event < 400 && weight > 1e-4; ++event) {
            const auto random = [&](std::uint32_t i) { return uniform01(key, n, 4 * event + i); };
            if (event > 0) t += along.z * std::log(1.0 - random(0));
            if (t < 0.0 || t > depth) break;
            weight *= albedo;
            const double seen = weight * radiometry::henyey_greenstein_per_sr(along.z, g) * std::exp(-t);
            sum.all += seen;
            if (event == 0) sum.first += seen;
            along = scatter(along, g, random(1), random(2));
        }
    }
    const double per_photon = mu0 / static_cast<double>(kPhotons);
    return {per_photon * sum.first, per_photon * sum.all};
}

Orders orders_in_cube(double depth, double albedo, double g, double mu0) {
    constexpr std::uint64_t kPhotons = 30000;
    const RandomKey key{11, 0, 0};
    const double sine = std::sqrt(1.0 - mu0 * mu0), all_flux = mu0 + sine;  // through the top and the east side
    Orders sum;
    for (std::uint64_t n = 0; n < kPhotons; ++n) {
        const double u = uniform01(key, n, 4), v = uniform01(key, n, 5);
        Vec3 at = uniform01(key, n, 6) * all_flux < mu0 ? Vec3{u, v, 1.0} : Vec3{1.0, u, v};  // in edges of the cube
        Vec3 along{-sine, 0.0, -mu0};
        double weight = 1.0;
        for (std::uint32_t event = 0; event < 400 && weight > 1e-3; ++event) {
            const auto random = [&](std::uint32_t i) { return uniform01(key, n, 8 + 4 * event + i); };
            at = at + (-std::log(1.0 - random(0)) / depth) * along;
            if (std::min({at.x, at.y, at.z}) < 0.0 || std::max({at.x, at.y, at.z}) > 1.0) break;
            weight *= albedo;
            const double seen = weight * radiometry::henyey_greenstein_per_sr(along.z, g) * std::exp(-depth * (1.0 - at.z));
            sum.all += seen;
            if (event == 0) sum.first += seen;
            along = scatter(along, g, random(1), random(2));
        }
    }
    const double per_photon = all_flux / static_cast<double>(kPhotons);
    return {per_photon * sum.first, per_photon * sum.all};
}

}  // namespace pyroscene::test
