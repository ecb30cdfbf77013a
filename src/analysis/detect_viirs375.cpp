// VIIRS 375 m: Schroeder et al. 2014, section 3.
#include <algorithm>
#include <cmath>

#include "analysis/fire_context.h"

namespace pyroscene::analysis {
namespace {

constexpr WindowRule kWindow{11, 31, 0.25, 10};
constexpr int kSceneHalf = 250, kSceneStep = 50;  ///< median of 501 x 501 pixels, for blocks of 50 x 50

class Viirs375 : ContextualScene {
public:
    using ContextualScene::ContextualScene;

    Detection run() {
        for (std::size_t i = 0; i < n_; ++i) mask(i);
        std::vector<FireClass> found = out_.fire;
        for (int line = 0; line < s_.lines; line += kSceneStep)
            for (int sample = 0; sample < s_.samples; sample += kSceneStep) judge_block(sample, line, found);
        out_.fire = std::move(found);
        return std::move(out_);
    }

private:
    [[nodiscard]] bool saturated(std::size_t i) const { return mir(i) >= s_.mir_saturation_K; }
    [[nodiscard]] double brightness(std::size_t i) const { return reflectance(s_.red, i) + reflectance(s_.nir, i); }

    [[nodiscard]] bool cloud(std::size_t i) const {
        if (!day(i)) return tir(i) < 265.0 && mir(i) < 295.0;
        return tir(i) < 265.0 || (brightness(i) > 0.9 && tir(i) < 295.0) || (brightness(i) > 0.7 && tir(i) < 285.0);
    }
    [[nodiscard]] bool water(std::size_t i) const {
        if (!s_.water.empty()) return s_.water[i] != 0;
        return day(i) && reflectance(s_.red, i) > reflectance(s_.nir, i) && reflectance(s_.nir, i) > reflectance(s_.swir, i);
    }
    /// Bright and cool by day: reflected sun, not fire.
    [[nodiscard]] bool bright_and_cool(std::size_t i) const {
        const double nir = reflectance(s_.nir, i), swir = reflectance(s_.swir, i);
        return day(i) && brightness(i) > 0.6 && tir(i) < 285.0 && swir > 0.3 && swir > nir && nir > 0.25 && mir(i) <= 335.0;
    }

    void mask(std::size_t i) {
        if (!std::isfinite(s_.mir_K[i]) || !std::isfinite(s_.tir_K[i]))
            out_.fire[i] = FireClass::NotProcessed;
        else if (cloud(i))
            out_.fire[i] = FireClass::Cloud;
        else if (water(i) && !certain(i))
            out_.fire[i] = FireClass::Water;
        const bool looks_burning = day(i) ? mir(i) > 335.0 && difference(i) > 30.0 : mir(i) > 300.0 && difference(i) > 10.0;
        if (out_.fire[i] != FireClass::Clear)
            roles_[i] = Role::Masked;
        else if (looks_burning)
            roles_[i] = Role::BackgroundFire;
    }

    /// A MIR colder than the thermal band over hot ground is a detector that has folded over. The paper asks for a difference below 0 and
    /// for quality flags of the instrument, which images do not carry; without them noise over hot soil would be fire.
    [[nodiscard]] bool folded(std::size_t i) const {
        constexpr double kFold_K = 10.0;
        return difference(i) < -kFold_K && tir(i) > (day(i) ? 325.0 : 310.0);
    }

    /// Fixed thresholds.
    [[nodiscard]] bool certain(std::size_t i) const {
        if (!day(i)) return mir(i) > 320.0 || folded(i);
        return folded(i) || (saturated(i) && tir(i) > 290.0 && brightness(i) < 0.7);
    }

    [[nodiscard]] bool stands_out(std::size_t i, const Context& c) const {
        const double by = difference(i) - c.difference.mean;
        if (!day(i)) return by > 3.0 * c.difference.spread && by > 9.0 && mir(i) > c.mir.mean + 3.0 * c.mir.spread;
        return by > 2.0 * c.difference.spread && by > 10.0 && mir(i) > c.mir.mean + 3.5 * c.mir.spread &&
               (tir(i) > c.tir.mean + c.tir.spread - 4.0 || c.fires.spread > 5.0);
    }

    [[nodiscard]] bool glint(std::size_t i) const {
        if (s_.glint_deg.empty() || !day(i)) return false;
        return (s_.glint_deg[i] < 15.0F && brightness(i) > 0.35) || (s_.glint_deg[i] < 25.0F && brightness(i) > 0.4);
    }

    /// Median MIR of the pixels that show land around a block.
    [[nodiscard]] double median_mir(int sample, int line) const {
        std::vector<float> values;
        for (int l = std::max(line - kSceneHalf, 0); l <= std::min(line + kSceneHalf, s_.lines - 1); ++l)
            for (int p = std::max(sample - kSceneHalf, 0); p <= std::min(sample + kSceneHalf, s_.samples - 1); ++p)
                if (roles_[at(p, l)] != Role::Masked) values.push_back(s_.mir_K[at(p, l)]);
        if (values.empty()) return 0.0;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return static_cast<double>(*middle);
    }

    void judge_block(int first_sample, int first_line, std::vector<FireClass>& found) {
        const double least_K =
            std::min(330.0, std::max(325.0, median_mir(first_sample + kSceneStep / 2, first_line + kSceneStep / 2)));
        for (int line = first_line; line < std::min(first_line + kSceneStep, s_.lines); ++line)
            for (int sample = first_sample; sample < std::min(first_sample + kSceneStep, s_.samples); ++sample)
                judge(sample, line, least_K, found);
    }

    void judge(int sample, int line, double least_K, std::vector<FireClass>& found) {
        const std::size_t i = at(sample, line);
        if (out_.fire[i] != FireClass::Clear || bright_and_cool(i)) return;
        const bool candidate = day(i) ? mir(i) > least_K && difference(i) > 25.0 : mir(i) > 295.0 && difference(i) > 10.0;
        if (!certain(i) && !candidate) return;
        const Context c = context_of(s_, roles_, kWindow, sample, line);
        if (c.found) out_.background_mir_K[i] = static_cast<float>(c.mir.mean);
        if (!certain(i) && !c.found) {
            found[i] = FireClass::Unknown;
            return;
        }
        if (!certain(i) && !stands_out(i, c)) return;
        constexpr double kWeak_K = 15.0;
        const bool low = glint(i) || (c.found && !saturated(i) && mir(i) - c.mir.mean < kWeak_K && !folded(i));
        found[i] = low ? FireClass::Low : saturated(i) ? FireClass::High : FireClass::Nominal;
        out_.confidence_percent[i] = low ? 15.0F : saturated(i) ? 100.0F : 55.0F;  // middles of the classes' ranges
    }
};

}  // namespace

Detection detect_viirs375(const ThermalScene& scene) { return Viirs375(scene).run(); }

}  // namespace pyroscene::analysis
