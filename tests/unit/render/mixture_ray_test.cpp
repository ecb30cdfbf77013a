// The march through flame with gas, in floats from tables, against the double-precision reference path.

#include "render/mixture_ray.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "radiometry/planck.h"
#include "source_folder.h"

namespace pyroscene::render {
extern const SpectralKernels portable_spectral_kernels;

namespace {

const radiometry::FlameOptics& optics() {
    static const auto loaded = radiometry::load_flame_optics(source_folder() / "data/optical");
    return loaded;
}

const std::vector<double> kLambda_um{0.55, 0.766,  0.7667009, 0.77, 1.2, 1.38, 1.9,  2.2, 2.35, 2.7, 2.77, 3.3,  3.31,
                                     3.9,  4.1826, 4.2,       4.3,  4.5, 4.67, 4.75, 6.3, 7.6,  8.5, 10.6, 12.0, 14.9};

using Pieces = std::vector<std::pair<double, double>>;  // length_m, T_K

struct Result {
    std::vector<float> tau, flame;
};

Result march(const Pieces& pieces, const FlameGas& gas, double lowest_K, double highest_K) {
    const int stride = padded(static_cast<int>(kLambda_um.size()));
    const auto table = radiometry::make_flame_table(optics(), gas, kLambda_um, stride, lowest_K, highest_K);
    const PlanckRows planck(kLambda_um, stride, lowest_K, highest_K, std::vector<double>{lowest_K});
    MixtureRay ray(table);
    ray.begin();
    Result result{{}, std::vector<float>(static_cast<std::size_t>(stride), 0.0F)};
    for (const auto& [length_m, T_K] : pieces) ray.add(T_K, length_m, planck, 1.0F, result.flame.data());
    result.tau.assign(ray.tau(), ray.tau() + stride);
    return result;
}

void expect_reference(const Pieces& pieces, const FlameGas& gas, double lowest_K, double highest_K, double tolerance) {
    const Result found = march(pieces, gas, lowest_K, highest_K);
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
        SCOPED_TRACE(kLambda_um[l]);
        radiometry::FlamePath path(optics(), kLambda_um[l]);
        for (const auto& [length_m, T_K] : pieces) path.add(length_m, T_K, gas);
        if (path.depth() < 40.0) {
            EXPECT_NEAR(-std::log(found.tau[l]) / path.depth(), 1.0, tolerance) << path.depth();
        }
        EXPECT_NEAR(found.flame[l] / path.emitted_radiance(), 1.0, tolerance);
    }
}

TEST(MixtureRay, IsothermalPathsFollowTheReference) {
    FlameGas gas;
    gas.x_CH4 = 0.01;
    for (const double T_K : {700.0, 1100.0, 1600.0}) {
        for (const double length_m : {0.03, 1.0, 20.0}) expect_reference({{length_m, T_K}}, gas, T_K, T_K, 2e-4);
        expect_reference({{0.4, T_K}, {1e-3, T_K}, {2.0, T_K}}, gas, T_K, T_K, 3e-4);
    }
}

TEST(MixtureRay, PathsOfManyTemperaturesFollowTheReference) {
    expect_reference({{0.5, 811.0}, {0.5, 1393.0}, {2.0, 1107.0}, {0.3, 633.0}}, {}, 600.0, 1600.0, 4e-3);
    expect_reference({{0.01, 1399.0}, {0.01, 1201.0}}, {}, 600.0, 1600.0, 4e-3);
}

TEST(MixtureRay, IsothermalPathEmitsWhatItAbsorbs) {
    FlameGas gas;
    const Result found = march({{0.2, 1000.0}, {0.7, 1000.0}, {0.1, 1000.0}}, gas, 1000.0, 1000.0);
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
        const double B = radiometry::planck_radiance(kLambda_um[l], 1000.0);
        EXPECT_NEAR(found.flame[l] / B + found.tau[l], 1.0, 1e-5) << kLambda_um[l];
    }
}

// The curve of growth in floats against its closed form, for lines of any overlap, up to twice as wide by motion as by collisions.
TEST(MixtureRay, CurveOfGrowthIsThatOfTheBandModel) {
    constexpr int n = 8;
    for (const double a_lorentz : {0.003, 0.1, 1.0, 30.0}) {
        for (const double width_ratio : {0.01, 0.3, 1.0, 2.0}) {
            const int first = 0;
            const float per_m = 0.5F, one = 1.0F;
            std::vector<float> rows, nothing(n, 0.0F), sums(3 * n, 0.0F), state(5 * n, 0.0F);
            for (const double factor : {1.0, a_lorentz, a_lorentz * width_ratio})
                rows.insert(rows.end(), n, per_m * static_cast<float>(factor));
            MixtureGas gas{false, 1, &first, rows.data(), 3 * n, sums.data()};
            unsigned char opaque = 0;
            MixturePiece piece;
            piece.n = n;
            piece.continuum = piece.planck = nothing.data();
            piece.planck_weight = &one;
            piece.gases = &gas;
            piece.gas_count = 1;
            piece.continuum_depth = state.data();
            piece.depth = state.data() + n;
            piece.ahead = state.data() + 2 * n;
            piece.tau = state.data() + 3 * n;
            piece.flame = state.data() + 4 * n;
            piece.opaque = &opaque;
            for (double x = 1e-6; x < 1e4; x *= 1.7) {
                std::fill(sums.begin(), sums.end(), 0.0F);
                piece.length_m = static_cast<float>(x / 0.5);
                opaque = 0;
                spectral_kernels().emit_mixture(piece);
                radiometry::GasColumn column;
                column.add({1.0, a_lorentz, a_lorentz * width_ratio}, x);
                const double expected = radiometry::gas_optical_depth(radiometry::GasSpecies::H2O, column);
                EXPECT_NEAR(piece.depth[0] / expected, 1.0, width_ratio > 1.0 ? 2e-4 : 1e-4) << x << ' ' << a_lorentz;
            }
        }
    }
}

// Pieces behind what lets less than a millionth through change nothing.
TEST(MixtureRay, OpaqueFlameHidesWhatIsBehindIt) {
    const Pieces thick{{60.0, 1100.0}, {60.0, 1000.0}};
    Pieces more = thick;
    more.insert(more.end(), 3, {100.0, 1500.0});
    const Result front = march(thick, {}, 900.0, 1500.0), all = march(more, {}, 900.0, 1500.0);
    int hidden = 0;
    for (std::size_t l = 0; l < kLambda_um.size(); ++l) {
        if (front.tau[l] > 1e-7F) continue;
        ++hidden;
        const double change = radiometry::planck_radiance(kLambda_um[l], 1500.0) * 1.1e-6;
        EXPECT_NEAR(all.flame[l], front.flame[l], change + 1e-6 * front.flame[l]) << kLambda_um[l];
    }
    EXPECT_GT(hidden, 4);
}

TEST(MixtureRay, PortableKernelAgreesWithTheChosenOne) {
    const int stride = 8;
    const std::vector<double> lambda_um{2.7, 4.3, 4.67, 10.6};
    const auto table = radiometry::make_flame_table(optics(), {}, lambda_um, stride, 900.0, 900.0);
    std::vector<float> row(stride, 1.0F), flame[2], tau[2];
    for (int version = 0; version < 2; ++version) {
        const SpectralKernels& kernels = version == 0 ? portable_spectral_kernels : spectral_kernels();
        std::vector<float> state(3 * stride, 0.0F), sums(static_cast<std::size_t>(24 * table.gases.size()), 0.0F);
        std::vector<MixtureGas> gases;
        for (const auto& gas : table.gases)
            gases.push_back({false, 1, gas.first_lambda.data(), gas.rows.data(), 24, sums.data() + 24 * gases.size()});
        flame[version].assign(stride, 0.0F);
        tau[version].assign(stride, 1.0F);
        const float one = 1.0F;
        unsigned char opaque = 0;
        MixturePiece piece;
        piece.n = stride;
        piece.continuum = table.continuum_per_m.data();
        piece.gases = gases.data();
        piece.gas_count = static_cast<int>(gases.size());
        piece.planck = row.data();
        piece.planck_weight = &one;
        piece.continuum_depth = state.data();
        piece.depth = state.data() + stride;
        piece.ahead = state.data() + 2 * stride;
        piece.tau = tau[version].data();
        piece.opaque = &opaque;
        piece.flame = flame[version].data();
        for (const float length_m : {0.2F, 1.3F}) {
            piece.length_m = length_m;
            kernels.emit_mixture(piece);
        }
    }
    for (std::size_t l = 0; l < lambda_um.size(); ++l) {
        EXPECT_NEAR(flame[0][l], flame[1][l], 2e-6);
        EXPECT_NEAR(tau[0][l], tau[1][l], 2e-6);
        EXPECT_GT(flame[0][l], 0.1);
    }
}

}  // namespace
}  // namespace pyroscene::render
