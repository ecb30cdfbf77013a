#include "analysis/detection_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pyroscene::analysis {
namespace {

std::vector<ScoreBin> decades(int first, int last) {
    std::vector<ScoreBin> bins;
    for (int power = first; power < last; ++power) bins.push_back({std::pow(10.0, power), std::pow(10.0, power + 1), 0, 0});
    bins.front().lower = 0.0;
    bins.back().upper = std::numeric_limits<double>::infinity();
    return bins;
}

void count(std::vector<ScoreBin>& bins, double value, bool found) {
    for (auto& bin : bins)
        if (value >= bin.lower && value < bin.upper) {
            ++bin.true_pixels;
            bin.found += found ? 1 : 0;
        }
}

bool fire_within_two_pixels(std::span<const float> fire_area_m2, std::size_t i, int samples) {
    const auto lines = static_cast<int>(fire_area_m2.size() / static_cast<std::size_t>(samples));
    const int line = static_cast<int>(i / static_cast<std::size_t>(samples)),
              sample = static_cast<int>(i % static_cast<std::size_t>(samples));
    for (int l = std::max(line - 2, 0); l <= std::min(line + 2, lines - 1); ++l)
        for (int p = std::max(sample - 2, 0); p <= std::min(sample + 2, samples - 1); ++p)
            if (fire_area_m2[static_cast<std::size_t>(l) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(p)] >
                0.0F)
                return true;
    return false;
}

}  // namespace

DetectionScore score_detection(std::span<const unsigned char> called, std::span<const float> fire_area_m2,
                               std::span<const float> frp_MW, int samples, double least_area_m2) {
    DetectionScore out;
    out.by_frp_MW = decades(-2, 4);
    out.by_area_m2 = decades(0, 6);
    for (std::size_t i = 0; i < called.size(); ++i) {
        const double area_m2 = static_cast<double>(fire_area_m2[i]);
        if (!std::isfinite(area_m2)) continue;
        const bool yes = called[i] != 0;
        out.detected += yes ? 1 : 0;
        if (area_m2 <= 0.0) {
            ++out.background;
            out.false_alarms += yes ? 1 : 0;
            out.beside += yes && fire_within_two_pixels(fire_area_m2, i, samples) ? 1 : 0;
        }
        if (area_m2 < least_area_m2) continue;
        ++out.true_pixels;
        out.found += yes ? 1 : 0;
        count(out.by_area_m2, area_m2, yes);
        if (std::isfinite(frp_MW[i])) count(out.by_frp_MW, std::max(static_cast<double>(frp_MW[i]), 0.0), yes);
    }
    return out;
}

}  // namespace pyroscene::analysis
