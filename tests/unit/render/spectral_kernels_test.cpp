#include "render/spectral_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace pyroscene::render {
extern const SpectralKernels portable_spectral_kernels;

namespace {

/// Both versions of the arithmetic: the portable one and the one this machine uses.
class EveryKernel : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] const SpectralKernels& kernels() const {
        return GetParam() ? spectral_kernels() : portable_spectral_kernels;
    }
};
INSTANTIATE_TEST_SUITE_P(, EveryKernel, testing::Values(false, true),
                         [](const auto& tested) { return tested.param ? "chosen" : "portable"; });

TEST_P(EveryKernel, ExponentialIsAccurate) {
    constexpr int n = 4096;
    std::vector<float> k(n), out(n);
    for (int i = 0; i < n; ++i) k[static_cast<std::size_t>(i)] = static_cast<float>(55.0 * i / n);
    kernels().transmittance(n, k.data(), 1.0F, out.data());
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(out[i] / std::exp(-static_cast<double>(k[i])), 1.0, 2e-7) << k[i];
}

TEST_P(EveryKernel, ThinFlameKeepsItsDigits) {
    constexpr int n = 8;
    const std::vector<float> k{1e-6F, 1e-5F, 1e-4F, 1e-3F, 1e-2F, 0.1F, 1.0F, 10.0F}, row(n, 2000.0F);
    std::vector<float> tau(n, 0.5F), flame(n, 0.0F);
    const std::array<float, 4> weight{1.0F, 0.0F, 0.0F, 0.0F};
    kernels().emit(n, k.data(), 0.7F, row.data(), n, 1, weight.data(), 0.25F, tau.data(), flame.data());
    for (std::size_t i = 0; i < n; ++i) {
        const double depth = static_cast<double>(k[i]) * 0.7F;
        EXPECT_NEAR(flame[i] / (-0.25 * 0.5 * 2000.0 * std::expm1(-depth)), 1.0, 1e-6) << k[i];
        EXPECT_NEAR(tau[i] / (0.5 * std::exp(-depth)), 1.0, 1e-6) << k[i];
    }
}

TEST_P(EveryKernel, OpaqueFlameLeavesNoDenormalNumbers) {
    constexpr int n = 8;
    const std::vector<float> k(n, 30.0F), row(n, 1.0F);
    std::vector<float> tau(n, 1.0F), flame(n, 0.0F);
    const float weight = 1.0F;
    for (int step = 0; step < 10; ++step)
        kernels().emit(n, k.data(), 1.0F, row.data(), n, 1, &weight, 1.0F, tau.data(), flame.data());
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_GE(tau[i], 1e-20F);
        EXPECT_LT(tau[i], 1e-12F);
        EXPECT_FLOAT_EQ(flame[i], 1.0F);
    }
}

TEST_P(EveryKernel, RowsAreBlended) {
    constexpr int n = 16, rows = 5;
    std::vector<float> table(n * rows), out(n, 1.0F);
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<float>(i);
    const std::array<float, rows> weight{1.0F, -2.0F, 0.5F, 4.0F, 0.25F};
    kernels().add_rows(n, table.data(), n, rows, weight.data(), out.data());
    for (int i = 0; i < n; ++i) {
        double expected = 1.0;
        for (int j = 0; j < rows; ++j) expected += static_cast<double>(weight[static_cast<std::size_t>(j)]) * (j * n + i);
        EXPECT_FLOAT_EQ(out[static_cast<std::size_t>(i)], static_cast<float>(expected));
    }
}

TEST_P(EveryKernel, BandSumsHonourUnevenBands) {
    // Bands of 1, 8, 13 and 20 wavelengths of the value 2 with weights 1/count: each mean is 2.
    const std::vector<int> begin{0, 1, 9, 22, 42};
    std::vector<float> weight(42), x(42, 2.0F), out(4);
    for (std::size_t b = 0; b < 4; ++b) {
        for (int i = begin[b]; i < begin[b + 1]; ++i)
            weight[static_cast<std::size_t>(i)] = 1.0F / static_cast<float>(begin[b + 1] - begin[b]);
    }
    kernels().band_sums(4, begin.data(), weight.data(), x.data(), out.data());
    for (const float mean : out) EXPECT_NEAR(mean, 2.0F, 1e-6F);
    const std::vector<int> single{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    std::vector<float> sums(10);
    kernels().band_sums(10, single.data(), weight.data(), x.data(), sums.data());
    for (std::size_t i = 0; i < 10; ++i) EXPECT_FLOAT_EQ(sums[i], 2.0F * weight[i]);
}

TEST_P(EveryKernel, AtSensorIsEquation444) {
    constexpr int n = 8;
    const std::vector<float> a(n, 1.0F), b(n, 2.0F), sun(n, 3.0F), correlation(n, 0.5F), tau(n, 0.8F), path(n, 10.0F);
    std::vector<float> out(n);
    const std::array<const float*, 2> parts{a.data(), b.data()};
    kernels().at_sensor(n, 2, parts.data(), sun.data(), correlation.data(), tau.data(), 2.0F, path.data(), out.data());
    for (const float v : out) EXPECT_FLOAT_EQ(v, (1.0F + 2.0F + 1.5F) * 0.8F * 2.0F + 10.0F);
}

}  // namespace
}  // namespace pyroscene::render
