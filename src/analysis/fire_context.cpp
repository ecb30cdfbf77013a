#include "analysis/fire_context.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pyroscene::analysis {
namespace {

/// Mean, then mean distance from it, over what `each` visits.
template <class Each>
MeanAndSpread mean_and_spread(int count, const Each& each) {
    MeanAndSpread out;
    if (count == 0) return out;
    each([&](double v) { out.mean += v; });
    out.mean /= count;
    each([&](double v) { out.spread += std::abs(v - out.mean); });
    out.spread /= count;
    return out;
}

bool looks_like_water(const ThermalScene& s, std::size_t i) {
    if (s.red.empty() || s.nir.empty() || s.swir.empty()) return false;
    return s.nir[i] < s.red[i] && s.swir[i] < 0.05F && s.nir[i] < 0.15F;
}

}  // namespace

ContextualScene::ContextualScene(const ThermalScene& scene)
    : s_(scene), n_(scene.mir_K.size()), roles_(scene.mir_K.size(), Role::Valid) {
    out_.fire.assign(n_, FireClass::Clear);
    out_.confidence_percent.assign(n_, std::nanf(""));
    out_.background_mir_K.assign(n_, std::nanf(""));
}

double ContextualScene::reflectance(std::span<const float> plane, std::size_t i) noexcept {
    return plane.empty() || !std::isfinite(plane[i]) ? 0.0 : static_cast<double>(plane[i]);
}

Context context_of(const ThermalScene& s, std::span<const Role> roles, const WindowRule& rule, int sample, int line) {
    std::vector<std::size_t> valid, fires;
    for (int edge = rule.smallest; edge <= rule.largest; edge += 2) {
        const int half = edge / 2;
        Context out;
        valid.clear();
        fires.clear();
        for (int l = std::max(line - half, 0); l <= std::min(line + half, s.lines - 1); ++l)
            for (int p = std::max(sample - half, 0); p <= std::min(sample + half, s.samples - 1); ++p) {
                if (l == line && std::abs(p - sample) <= 1) continue;
                const auto i =
                    static_cast<std::size_t>(l) * static_cast<std::size_t>(s.samples) + static_cast<std::size_t>(p);
                if (!s.water.empty() && s.water[i] != 0) ++out.water;
                if (roles[i] == Role::Valid) {
                    valid.push_back(i);
                    if (looks_like_water(s, i)) ++out.unmasked_water;
                } else if (roles[i] == Role::BackgroundFire) {
                    fires.push_back(i);
                }
            }
        out.valid = static_cast<int>(valid.size());
        out.background_fires = static_cast<int>(fires.size());
        if (out.valid < rule.least_pixels || out.valid < rule.least_share * edge * edge) continue;
        const auto over = [](const std::vector<std::size_t>& pixels, const auto& value) {
            return mean_and_spread(static_cast<int>(pixels.size()), [&](const auto& use) {
                for (const std::size_t i : pixels) use(value(i));
            });
        };
        const auto mir = [&](std::size_t i) { return static_cast<double>(s.mir_K[i]); };
        const auto tir = [&](std::size_t i) { return static_cast<double>(s.tir_K[i]); };
        out.mir = over(valid, mir);
        out.tir = over(valid, tir);
        out.difference = over(valid, [&](std::size_t i) { return mir(i) - tir(i); });
        out.fires = over(fires, mir);
        out.found = true;
        return out;
    }
    return {};
}

LocalMean::LocalMean(std::span<const float> plane, std::span<const unsigned char> use, int samples, int lines)
    : samples_(samples), lines_(lines) {
    const auto width = static_cast<std::size_t>(samples) + 1;
    sums_.assign(width * (static_cast<std::size_t>(lines) + 1), 0.0);
    counts_.assign(sums_.size(), 0);
    for (std::size_t l = 0; l < static_cast<std::size_t>(lines); ++l) {
        double sum = 0.0;
        int count = 0;
        for (std::size_t p = 0; p < static_cast<std::size_t>(samples); ++p) {
            const std::size_t i = l * static_cast<std::size_t>(samples) + p;
            if (use[i] != 0) {
                sum += static_cast<double>(plane[i]);
                ++count;
            }
            sums_[(l + 1) * width + p + 1] = sums_[l * width + p + 1] + sum;
            counts_[(l + 1) * width + p + 1] = counts_[l * width + p + 1] + count;
        }
    }
}

double LocalMean::around(int sample, int line, int half_samples, int half_lines) const noexcept {
    const auto width = static_cast<std::size_t>(samples_) + 1;
    const auto left = static_cast<std::size_t>(std::max(sample - half_samples, 0)),
               right = static_cast<std::size_t>(std::min(sample + half_samples + 1, samples_)),
               top = static_cast<std::size_t>(std::max(line - half_lines, 0)),
               bottom = static_cast<std::size_t>(std::min(line + half_lines + 1, lines_));
    const auto box = [&](const auto& table) {
        return table[bottom * width + right] - table[top * width + right] - table[bottom * width + left] +
               table[top * width + left];
    };
    const int count = box(counts_);
    return count > 0 ? box(sums_) / count : std::nan("");
}

double ramp(double value, double low, double high) noexcept {
    return value >= high ? 1.0 : value <= low ? 0.0 : (value - low) / (high - low);
}

int neighbours_of(std::span<const FireClass> classes, FireClass wanted, int samples, int lines, int sample,
                  int line) noexcept {
    int count = 0;
    for (int l = std::max(line - 1, 0); l <= std::min(line + 1, lines - 1); ++l)
        for (int p = std::max(sample - 1, 0); p <= std::min(sample + 1, samples - 1); ++p)
            if ((l != line || p != sample) &&
                classes[static_cast<std::size_t>(l) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(p)] ==
                    wanted)
                ++count;
    return count;
}

double glint_angle_deg(double view_zenith_deg, double view_azimuth_deg, double sun_zenith_deg,
                       double sun_azimuth_deg) noexcept {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const double view = view_zenith_deg * kDegree, sun = sun_zenith_deg * kDegree;
    const double cosine = std::cos(view) * std::cos(sun) -
                          std::sin(view) * std::sin(sun) * std::cos((view_azimuth_deg - sun_azimuth_deg) * kDegree);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree;
}

}  // namespace pyroscene::analysis
