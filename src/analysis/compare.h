#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pyroscene::analysis {

/// How two planes of one grid agree over the pixels that both have. Differences are a - b.
struct PlaneAgreement {
    std::int64_t pixels = 0;
    double mean_a = 0.0, mean_b = 0.0, bias = 0.0, rmse = 0.0, mae = 0.0;
    double correlation = 0.0;  ///< Pearson; 0 when a plane is flat
    double ssim = 0.0;         ///< see structural_similarity()
};
PlaneAgreement agreement(std::span<const float> a, std::span<const float> b, int cols, int rows);

/// Mean structural similarity (Wang et al. 2004) with a Gaussian window of sigma 1.5 pixels (11 x 11), constants 0.01 and 0.03 of the
/// common range of values. Windows that hold no data in either plane are narrowed to what both have; pixels without data are left out.
/// \return -1 to 1; 1 for equal planes; NaN when no pixel is common
double structural_similarity(std::span<const float> a, std::span<const float> b, int cols, int rows);

/// How two masks (1 = fire) agree.
struct MaskAgreement {
    std::int64_t both = 0, only_a = 0, only_b = 0;
    double dice = 0.0;  ///< Sorensen-Dice: 2 |a and b| / (|a| + |b|); 1 when both are empty
    double front_distance_mean = 0.0,
           front_distance_95 = 0.0;  ///< pixels, from each outline of one to the other, both ways; NaN without an outline
};
MaskAgreement mask_agreement(std::span<const unsigned char> a, std::span<const unsigned char> b, int cols, int rows);

/// Euclidean distance [pixels] of each pixel from the nearest pixel of a mask (Felzenszwalb and Huttenlocher 2012, exact); infinite
/// when the mask is empty.
std::vector<float> distance_from(std::span<const unsigned char> mask, int cols, int rows);

/// The plane moved by (dx, dy) pixels, bilinear; NaN where nothing comes from.
std::vector<float> shifted(std::span<const float> plane, int cols, int rows, double dx, double dy);

}  // namespace pyroscene::analysis
