#pragma once

namespace pyroscene::render {

/// A column of voxels with flame in a vertical plane through a receiver.
struct PlaneColumn {
    float enter_m, leave_m;  ///< horizontal distances from the receiver
    float horizon;           ///< slope below which terrain in front hides the column
    int first_voxel;         ///< of k = 0, see FlameColumns::voxel
    int k_begin, k_end;      ///< voxels with flame
};

/// One vertical plane through a receiver, cut into eight strata of elevation: one ray through the middle of each. Emission is
/// gathered as moments: the Planck radiance of a voxel is a Chebyshev series in the reduced inverse temperature p of the voxel
/// (-1 to 1), so that a step costs the same for any number of wavelengths, and no table is written in disorder.
struct PlaneTrace {
    static constexpr int kLanes = 8;
    static constexpr int kMaximumMoments = 24, kMaximumNodes = 48, kVoxelStride = 64;

    const PlaneColumn* columns = nullptr;
    int column_count = 0;
    const float* voxels = nullptr;   ///< [voxel]{fill, p}
    const float* slope = nullptr;    ///< [stratum] tangent of the elevation, not zero
    const float* weight = nullptr;   ///< [stratum] cosine-weighted solid angle [sr]
    float receiver_height = 0.0F;    ///< above the voxel grid's corner, in voxels
    float voxels_per_m = 1.0F;       ///< 1 / height of a voxel
    const float* k_per_m = nullptr;  ///< [node] absorption coefficients
    int nodes = 1, moments = 1;      ///< one moment: all flame has one temperature
    float opaque_m = 0.0F;           ///< fill x length beyond which nothing more is seen
    /// [node][moment][stratum] += weight tau (1 - exp(-k fill length)) T_moment(p)
    float* sums = nullptr;
    /// [node][stratum], where all strata meet the hottest flame (p = -1) or none: most voxels of most fires. Its moments,
    /// T_m(-1) = (-1)^m, are left to the caller. Unused with one moment.
    float* hottest = nullptr;
};

}  // namespace pyroscene::render
