#include "render/smoke_diffusion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/constants.h"
#include "render/spectral_kernels.h"

namespace pyroscene::render {
extern const SpectralKernels portable_spectral_kernels;

namespace {

struct Smoke {
    std::vector<double> lambda_um;
    std::vector<float> k, albedo, asymmetry;
};

SmokeDiffusion diffusion_of(const Smoke& smoke, double sun_cosine, int stride) {
    return make_smoke_diffusion(smoke.lambda_um, smoke.k, smoke.albedo, smoke.asymmetry, sun_cosine, stride);
}

SmokeDiffusion one(float k, float albedo, float g, double sun_cosine) {
    return diffusion_of({{0.55}, {k}, {albedo}, {g}}, sun_cosine, 8);
}

/// At a point of a layer of k = 1, as a fraction of its depth from the top; the piece there is infinitely thin.
DiffuseSource at(const SpectralKernels& kernels, const SmokeDiffusion& d, double depth, double place,
                 double upward_cosine = 0.0) {
    const auto above = static_cast<float>(depth * place), below = static_cast<float>(depth * (1.0 - place));
    const auto mu0 = static_cast<double>(d.nodes.sun_cosine);
    const auto slant = [&](float column) {
        return mu0 > 0.0 ? static_cast<float>(static_cast<double>(column) / mu0) : 0.0F;
    };
    DiffuseSource source{};
    kernels.diffuse_source(
        d.nodes,
        {{above, 0.0F}, {below, 0.0F}, {slant(above), 0.0F}, {slant(below), 0.0F}, 0.0F, static_cast<float>(upward_cosine)},
        source);
    return source;
}

// I0'' = decay^2 I0 - C exp(-t / mu0) in the layer, I0 - 2/3 I1 = 1 or 0 at its boundaries: by finite differences.
TEST(SmokeDiffusion, SolvesTheDiffusionEquation) {
    for (const auto* kernels : {&portable_spectral_kernels, &spectral_kernels()})
        for (const double w : {0.3, 0.9, 0.999})
            for (const double depth : {1.0, 6.0}) {
                const double g = 0.6, mu0 = 0.7, f = g * g, scale = 1.0 - w * f, ws = (1.0 - f) * w / scale,
                             gs = g / (1.0 + g);
                const auto d = one(1.0F, static_cast<float>(w), static_cast<float>(g), mu0);
                const double decay2 = 3.0 * (1.0 - ws) * (1.0 - ws * gs),
                             beam = 3.0 * ws * (1.0 + gs * (1.0 - ws)) / (4.0 * kPi);
                constexpr double kStep = 0.05;
                const double h = kStep * depth * scale;  // in scaled depth
                for (const double x : {0.2, 0.5, 0.8}) {
                    const auto before = at(*kernels, d, depth, x - kStep), here = at(*kernels, d, depth, x),
                               after = at(*kernels, d, depth, x + kStep);
                    const auto curvature = [&](const float* a, const float* b, const float* c) {
                        return (static_cast<double>(a[0]) - 2.0 * static_cast<double>(b[0]) + static_cast<double>(c[0])) /
                               (h * h);
                    };
                    const double sun = beam * std::exp(-x * depth * scale / mu0);
                    EXPECT_NEAR(curvature(before.sky, here.sky, after.sky), decay2 * static_cast<double>(here.sky[0]), 3e-3);
                    EXPECT_NEAR(curvature(before.ground, here.ground, after.ground),
                                decay2 * static_cast<double>(here.ground[0]), 3e-3);
                    EXPECT_NEAR(curvature(before.sun, here.sun, after.sun), decay2 * static_cast<double>(here.sun[0]) - sun,
                                0.02 * sun + 3e-3);
                }
                // g I1 is what the source changes by with the cosine; Marshak's boundary in it.
                const auto flux = [&](double place, const float* (*of)(const DiffuseSource&)) {
                    const auto level = at(*kernels, d, depth, place), up = at(*kernels, d, depth, place, 1.0);
                    const double I0 = static_cast<double>(of(level)[0]), I1 = (static_cast<double>(of(up)[0]) - I0) / g;
                    return std::array{I0 - 2.0 / 3.0 * I1, I0 + 2.0 / 3.0 * I1};  // down, up
                };
                const auto sky = [](const DiffuseSource& s) -> const float* { return s.sky; };
                const auto ground = [](const DiffuseSource& s) -> const float* { return s.ground; };
                EXPECT_NEAR(flux(0.0, sky)[0], 1.0, 1e-4);
                EXPECT_NEAR(flux(1.0, sky)[1], 0.0, 1e-4);
                EXPECT_NEAR(flux(0.0, ground)[0], 0.0, 1e-4);
                EXPECT_NEAR(flux(1.0, ground)[1], 1.0, 1e-4);
            }
}

// Where nothing absorbs, the sky's and the ground's light fill the sphere between them, and what does not come down goes up.
TEST(SmokeDiffusion, LosesNothingWithoutAbsorption) {
    for (const auto* kernels : {&portable_spectral_kernels, &spectral_kernels()})
        for (const float g : {0.0F, 0.7F})
            for (const double depth : {0.01, 1.0, 20.0}) {
                const auto d = one(1.0F, 1.0F, g, 0.0);
                const auto source = at(*kernels, d, depth, 0.3);
                EXPECT_NEAR(source.sky[0] + source.ground[0], 1.0F, 2e-3F) << g << " " << depth;
                DiffuseShade shade{};
                kernels->diffuse_shade(d.nodes, static_cast<float>(depth), 0.0F, shade);
                EXPECT_NEAR(shade.sky[0] + shade.ground[0], 1.0F, 2e-3F) << g << " " << depth;
                const double slab = 1.0 / (1.0 + 0.75 * depth * (1.0 - static_cast<double>(g)));  // diffuse light through it
                EXPECT_NEAR(shade.sky[0], slab, 2e-3) << g << " " << depth;
            }
}

// From the nodes to wavelengths between them: smoke whose extinction falls two hundredfold from blue to medium wave.
TEST(SmokeDiffusion, InterpolatesBetweenItsNodes) {
    Smoke smoke;
    for (double lambda = 0.4; lambda <= 4.0; lambda *= 1.01) {
        smoke.lambda_um.push_back(lambda);
        smoke.k.push_back(static_cast<float>(std::pow(lambda / 0.55, -2.3)));
        smoke.albedo.push_back(static_cast<float>(0.88 - 0.1 * std::log(lambda)));
        smoke.asymmetry.push_back(static_cast<float>(0.65 - 0.2 * std::log(lambda)));
    }
    const auto n = smoke.lambda_um.size();
    const int stride = padded(static_cast<int>(n));
    const auto all = diffusion_of(smoke, 0.7, stride);
    double sky_error = 0.0, sun_error = 0.0;
    for (const double depth : {0.3, 3.0, 30.0})
        for (const double place : {0.1, 0.5}) {
            const auto nodes = at(spectral_kernels(), all, depth, place);
            for (std::size_t l = 0; l < n; ++l) {
                double sky = 0.0, sun = 0.0;
                for (std::size_t j = 0; j < DiffusionNodes::kCount; ++j) {
                    const double weight = static_cast<double>(all.weight[j * static_cast<std::size_t>(stride) + l]);
                    sky += weight * static_cast<double>(nodes.sky[j]);
                    sun += weight * static_cast<double>(nodes.sun[j]);
                }
                const auto exact =
                    at(spectral_kernels(), one(smoke.k[l], smoke.albedo[l], smoke.asymmetry[l], 0.7), depth, place);
                sky_error = std::max(sky_error, std::abs(sky - static_cast<double>(exact.sky[0])));
                sun_error = std::max(sun_error, std::abs(sun - static_cast<double>(exact.sun[0])));
            }
        }
    std::printf("cubic between eight nodes: sky within %.1e of 1, sun within %.1e per steradian\n", sky_error, sun_error);
    EXPECT_LT(sky_error, 0.006);
    EXPECT_LT(sun_error, 0.003);
}

}  // namespace
}  // namespace pyroscene::render
