#pragma once

namespace pyroscene::render {

/// One gas of a flame on one ray: where it absorbs, its table, and what the ray has gathered of it so far.
struct MixtureGas {
    bool evenly_spaced = false;         ///< CH4: another band model
    int blocks = 0;                     ///< of eight wavelengths
    const int* first_lambda = nullptr;  ///< [block]
    const float* rows = nullptr;        ///< [temperature][x, x a_C, x a_D][block][lane] per metre (FlameTable::Gas)
    long row_stride = 0;
    float* sums = nullptr;  ///< [x, x a_C, x a_D][block][lane] Curtis-Godson sums
};

/// A homogeneous piece of flame on a ray, of soot, atoms (Beer's law) and gases (narrow-band model); eq 4.10 voxel by voxel with
/// transmittances from the ray's running sums.
struct MixturePiece {
    static constexpr float kLeastSeen = 1e-6F;  ///< blocks of eight wavelengths that let less through are left as they are

    int n = 0;              ///< wavelengths, a multiple of the kernels' lanes
    float length_m = 0.0F;  ///< times filled fraction
    int row = 0, next = 0;  ///< of the tables, blended
    float weight = 1.0F, next_weight = 0.0F;
    const float* continuum = nullptr;  ///< [temperature][n] per metre
    const MixtureGas* gases = nullptr;
    int gas_count = 0;
    const float* planck = nullptr;  ///< emission = sum of planck_count rows
    const float* planck_weight = nullptr;
    int planck_count = 1;  ///< 1 or 4
    float scale = 1.0F;
    // State of the ray, [n] each; zero at its start but for tau = 1.
    float* continuum_depth = nullptr;
    float* depth = nullptr;  ///< total so far
    float* ahead = nullptr;  ///< scratch
    float* tau = nullptr;
    unsigned char* opaque = nullptr;  ///< [n / 8] 1: see kLeastSeen; zero at the start
    float* flame = nullptr;           ///< += scale (tau before - tau after) B
};

}  // namespace pyroscene::render
