#pragma once

namespace pyroscene::render {

/// The arithmetic over wavelengths (and over strata of a hemisphere), compiled twice: for any x86-64 and for AVX2 with FMA; `spectral_kernels()` picks once,
/// at run time. Arrays are contiguous floats whose length `n` is a multiple of kLanes (pad them); no alignment is asked for.
/// Both versions give the same numbers within rounding; one machine always uses one of them.
struct PlaneTrace;
struct MixturePiece;
struct SmokeRun;
struct FlameSources;
struct FlameLightAt;
struct DiffusionNodes;
struct DiffuseColumns;
struct DiffuseSource;
struct DiffuseShade;

struct SpectralKernels {
    static constexpr int kLanes = 8;

    /// out = exp(-k depth); arguments below -60 count as -60. Relative error < 2e-7.
    void (*transmittance)(int n, const float* k, float depth, float* out);
    /// One homogeneous piece of flame of optical depth k * depth, emission B = sum_j weight[j] row_j:
    ///   flame += scale tau (1 - exp(-k depth)) B,   tau *= exp(-k depth)      (eq 4.10, voxel by voxel)
    /// tau is kept above 1e-20: denormal numbers cost ten times as much.
    void (*emit)(int n, const float* k, float depth, const float* rows, int row_stride, int row_count, const float* weight,
                 float scale, float* tau, float* flame);
    /// Consecutive pieces with smoke and perhaps flame: see SmokeRun.
    void (*emit_smoke)(const SmokeRun& run);
    /// Point sources of light at a point {x, y, z}: see FlameLightAt.
    void (*light_of_flames)(const FlameSources& sources, const float* at_m, FlameLightAt& out);
    /// Light scattered more than once: what a piece of smoke sends on, and what reaches the ground below (smoke_diffusion.h).
    void (*diffuse_source)(const DiffusionNodes& nodes, const DiffuseColumns& columns, DiffuseSource& out);
    void (*diffuse_shade)(const DiffusionNodes& nodes, float above, float to_sun, DiffuseShade& out);
    /// out = irradiance times the Henyey-Greenstein phase function [1/sr] at one cosine of the scattering angle.
    void (*phase_product)(int n, const float* asymmetry, float cosine, const float* irradiance, float* out);
    /// One homogeneous piece of flame with gas: see MixturePiece.
    void (*emit_mixture)(const MixturePiece& piece);
    /// out += sum_j weight[j] row_j
    void (*add_rows)(int n, const float* rows, int row_stride, int row_count, const float* weight, float* out);
    /// out += a x y
    void (*add_product)(int n, float a, const float* x, const float* y, float* out);
    /// out += x y z
    void (*add_product3)(int n, const float* x, const float* y, const float* z, float* out);
    /// Light between four places, 1 / sqrt(out) = sum_j weight[j] / sqrt(row_j), 0 where all are dark (below 1e-30); false where
    /// that has no meaning: some are dark, or the sum is not positive.
    bool (*light_between)(int n, const float* const* rows, const float* weight, float* out);
    /// out = a x y
    void (*product)(int n, float a, const float* x, const float* y, float* out);
    /// out = (sum of the `count` spectra in `parts` + sun correlation) transmittance scale + path   (eq 4.44)
    void (*at_sensor)(int n, int count, const float* const* parts, const float* sun, const float* correlation,
                      const float* transmittance, float scale, const float* path, float* out);
    /// out[b] = sum_{i in [begin[b], begin[b + 1])} weight[i] x[i]; band by band without gaps, each with at least one i.
    void (*band_sums)(int bands, const int* begin, const float* weight, const float* x, float* out);
    /// to[c][r] = from[r][c]
    void (*transpose)(int rows, int cols, const float* from, int from_stride, float* to, long to_stride);
    /// Light of the flame in one vertical plane, eight strata of elevation at a time: see PlaneTrace.
    void (*trace_plane)(const PlaneTrace& plane);
};

const SpectralKernels& spectral_kernels() noexcept;

/// n rounded up to whole vectors.
constexpr int padded(int n) noexcept {
    return (n + SpectralKernels::kLanes - 1) / SpectralKernels::kLanes * SpectralKernels::kLanes;
}

}  // namespace pyroscene::render
