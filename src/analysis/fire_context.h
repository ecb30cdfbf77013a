#pragma once

#include "analysis/fire_detection.h"

namespace pyroscene::analysis {

/// Which pixels may serve as surroundings, and which cannot because they look like fires themselves.
enum class Role : unsigned char { Valid, BackgroundFire, Masked };

/// Mean and mean absolute deviation.
struct MeanAndSpread {
    double mean = 0.0, spread = 0.0;
};

/// Surroundings of a candidate.
struct Context {
    bool found = false;  ///< false: no window has enough valid pixels
    int valid = 0, background_fires = 0, water = 0, unmasked_water = 0;
    MeanAndSpread mir, tir, difference;  ///< of valid pixels, K
    MeanAndSpread fires;                 ///< MIR of the pixels that were left out as background fires, K
};

/// How large windows may grow and when one is enough.
struct WindowRule {
    int smallest = 3, largest = 21;  ///< edges, odd
    double least_share = 0.25;       ///< of the window's pixels
    int least_pixels = 8;
};

/// Grows a square window around a pixel until it holds enough valid pixels. The pixel itself and its neighbours in the line are left
/// out: their footprints overlap.
Context context_of(const ThermalScene& scene, std::span<const Role> roles, const WindowRule& rule, int sample, int line);

/// Means over a rectangle around every pixel by running sums.
class LocalMean {
public:
    /// Only pixels with use[i] != 0 count.
    LocalMean(std::span<const float> plane, std::span<const unsigned char> use, int samples, int lines);
    /// NaN when nothing counts.
    [[nodiscard]] double around(int sample, int line, int half_samples, int half_lines) const noexcept;

private:
    std::vector<double> sums_;
    std::vector<int> counts_;
    int samples_ = 0, lines_ = 0;
};

/// 0 below `low`, 1 above `high`, straight between.
double ramp(double value, double low, double high) noexcept;

/// Of the eight neighbours, how many are of this class.
int neighbours_of(std::span<const FireClass> classes, FireClass wanted, int samples, int lines, int sample,
                  int line) noexcept;

}  // namespace pyroscene::analysis
