#pragma once

#include "analysis/fire_detection.h"

namespace pyroscene::analysis {

/// Which pixels may serve as surroundings, and which cannot because they look like fires themselves.
enum class Role : unsigned char { Valid, BackgroundFire, Masked };

/// Pixels of a scene, and what a detector says of them: what the contextual detectors have in common.
class ContextualScene {
public:
    explicit ContextualScene(const ThermalScene& scene);

protected:
    [[nodiscard]] std::size_t at(int sample, int line) const noexcept {
        return static_cast<std::size_t>(line) * static_cast<std::size_t>(s_.samples) + static_cast<std::size_t>(sample);
    }
    /// The sun is higher than 5 degrees.
    [[nodiscard]] bool day(std::size_t i) const noexcept {
        return !s_.sun_zenith_deg.empty() && s_.sun_zenith_deg[i] < 85.0F;
    }
    [[nodiscard]] double mir(std::size_t i) const noexcept { return static_cast<double>(s_.mir_K[i]); }
    [[nodiscard]] double tir(std::size_t i) const noexcept { return static_cast<double>(s_.tir_K[i]); }
    [[nodiscard]] double difference(std::size_t i) const noexcept { return mir(i) - tir(i); }
    /// A reflectance, or 0, which passes no test for brightness.
    [[nodiscard]] static double reflectance(std::span<const float> plane, std::size_t i) noexcept;

    const ThermalScene& s_;
    std::size_t n_;
    Detection out_;            ///< all clear to begin with
    std::vector<Role> roles_;  ///< all valid to begin with
};

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
