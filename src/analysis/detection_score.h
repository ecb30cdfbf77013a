#pragma once

#include <span>
#include <vector>

namespace pyroscene::analysis {

/// How many true fires of one size were found.
struct ScoreBin {
    double lower = 0.0, upper = 0.0;  ///< [lower, upper) of the quantity
    int true_pixels = 0, found = 0;

    [[nodiscard]] double omission() const noexcept {
        return true_pixels > 0 ? 1.0 - static_cast<double>(found) / true_pixels : 0.0;
    }
};

/// A detection against the truth of its pixels.
struct DetectionScore {
    int true_pixels = 0;   ///< with at least the least fire area
    int found = 0;         ///< of these
    int detected = 0;      ///< pixels called fire
    int false_alarms = 0;  ///< of these, without any fire
    int beside = 0;        ///< of these, with fire within two pixels: its light on the ground, or the point spread
    int background = 0;    ///< pixels without any fire
    std::vector<ScoreBin> by_frp_MW, by_area_m2;

    [[nodiscard]] double omission() const noexcept {
        return true_pixels > 0 ? 1.0 - static_cast<double>(found) / true_pixels : 0.0;
    }
    [[nodiscard]] double commission() const noexcept {
        return detected > 0 ? static_cast<double>(false_alarms) / detected : 0.0;
    }
};

/// \param called      1 = called fire, 0 = not, per pixel
/// \param fire_area_m2, frp_MW  of the truth, per pixel; NaN = pixel not rendered, left out
/// \param samples  pixels of a line
/// \param least_area_m2  from which on a pixel counts as a true fire; those with less are neither fire nor false alarm
/// Bins are decades, 0.01 MW to 10^4 MW and 1 m2 to 10^6 m2; the first and the last one are open.
DetectionScore score_detection(std::span<const unsigned char> called, std::span<const float> fire_area_m2,
                               std::span<const float> frp_MW, int samples, double least_area_m2);

}  // namespace pyroscene::analysis
