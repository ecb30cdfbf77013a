// MODIS collection 6. Equation numbers: Giglio et al. 2003; changes of 2016 marked C6.
#include <algorithm>
#include <cmath>

#include "analysis/fire_context.h"

namespace pyroscene::analysis {
namespace {

constexpr WindowRule kWindow{3, 21, 0.25, 8};
constexpr int kSceneHalfSamples = 150, kSceneHalfLines = 15;  // C6: 301 columns x 30 lines

class Mod14 : ContextualScene {
public:
    using ContextualScene::ContextualScene;

    Detection run() {
        for (std::size_t i = 0; i < n_; ++i) mask(i);
        find_thresholds();
        std::vector<FireClass> found = out_.fire;
        for (int line = 0; line < s_.lines; ++line)
            for (int sample = 0; sample < s_.samples; ++sample) judge(sample, line, found);
        out_.fire = std::move(found);
        return std::move(out_);
    }

private:
    [[nodiscard]] bool certain(std::size_t i) const { return mir(i) > (day(i) ? 360.0 : 320.0); }  // test 1
    [[nodiscard]] bool cloud(std::size_t i) const {
        const double bright = reflectance(s_.red, i) + reflectance(s_.nir, i);
        const double T12_K = static_cast<double>(s_.cloud_K.empty() ? s_.tir_K[i] : s_.cloud_K[i]);
        if (!day(i)) return T12_K < 265.0;
        return bright > 1.2 || T12_K < 265.0 || (bright > 0.7 && T12_K < 285.0);
    }

    void mask(std::size_t i) {
        if (!std::isfinite(s_.mir_K[i]) || !std::isfinite(s_.tir_K[i])) {
            out_.fire[i] = FireClass::NotProcessed;
        } else if (!s_.water.empty() && s_.water[i] != 0) {
            out_.fire[i] = FireClass::Water;
        } else if (cloud(i)) {
            out_.fire[i] = FireClass::Cloud;
        }
        const bool looks_burning = day(i) ? mir(i) > 325.0 && difference(i) > 20.0 : mir(i) > 310.0 && difference(i) > 10.0;
        if (out_.fire[i] != FireClass::Clear)
            roles_[i] = Role::Masked;
        else if (looks_burning)
            roles_[i] = Role::BackgroundFire;
    }

    /// C6: the candidates' thresholds by day follow the scene.
    void find_thresholds() {
        std::vector<unsigned char> use(n_);
        std::vector<float> differences(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            const bool glint = !s_.glint_deg.empty() && s_.glint_deg[i] < 2.0F;
            use[i] = out_.fire[i] == FireClass::Clear && !glint && !certain(i) ? 1 : 0;
            differences[i] = static_cast<float>(difference(i));
        }
        means_.emplace_back(s_.mir_K, use, s_.samples, s_.lines);
        means_.emplace_back(differences, use, s_.samples, s_.lines);
    }

    [[nodiscard]] bool candidate(int sample, int line) const {
        const std::size_t i = at(sample, line);
        if (!day(i)) return mir(i) > 305.0 && difference(i) > 10.0;
        const double mir_K = means_[0].around(sample, line, kSceneHalfSamples, kSceneHalfLines),
                     mean_K = means_[1].around(sample, line, kSceneHalfSamples, kSceneHalfLines);
        const double least_mir_K = std::isfinite(mir_K) ? std::clamp(mir_K + 5.0, 300.0, 330.0) : 310.0;
        const double least_K = std::isfinite(mean_K) ? std::clamp(mean_K + 5.0, 10.0, 35.0) : 10.0;
        return mir(i) > least_mir_K && difference(i) > least_K && reflectance(s_.nir, i) < 0.35;
    }

    /// Tests 2 to 6.
    [[nodiscard]] bool stands_out(std::size_t i, const Context& c) const {
        const double mir_K = mir(i), tir_K = tir(i);
        const bool by_contrast = difference(i) > c.difference.mean + 3.5 * c.difference.spread &&
                                 difference(i) > c.difference.mean + 6.0 && mir_K > c.mir.mean + 3.0 * c.mir.spread;
        const bool warm_enough = tir_K > c.tir.mean + c.tir.spread - 4.0 || c.fires.spread > 5.0;
        return by_contrast && (!day(i) || warm_enough);
    }

    [[nodiscard]] bool glint(std::size_t i, const Context& c, int water_beside) const {
        if (s_.glint_deg.empty()) return false;
        const double angle_deg = static_cast<double>(s_.glint_deg[i]);
        return angle_deg < 2.0 ||
               (angle_deg < 10.0 && reflectance(s_.red, i) > 0.1 && reflectance(s_.nir, i) > 0.2 &&
                reflectance(s_.swir, i) > 0.12) ||
               (angle_deg < 15.0 && water_beside + c.water > 0);
    }
    [[nodiscard]] bool desert_edge(std::size_t i, const Context& c) const {
        return c.background_fires > 0.1 * c.valid && c.background_fires >= 4 && reflectance(s_.nir, i) > 0.15 &&
               c.fires.mean < 345.0 && c.fires.spread < 3.0 && mir(i) < c.fires.mean + 6.0 * c.fires.spread;
    }
    [[nodiscard]] bool clearing(std::size_t i, const Context& c) const {  // C6: clearings in tropical forest
        return tir(i) > c.tir.mean + 3.7 * c.tir.spread && reflectance(s_.nir, i) > 0.28 && mir(i) < 325.0;
    }

    void judge(int sample, int line, std::vector<FireClass>& found) {
        const std::size_t i = at(sample, line);
        if (out_.fire[i] != FireClass::Clear || (!certain(i) && !candidate(sample, line))) return;
        const Context c = context_of(s_, roles_, kWindow, sample, line);
        const auto beside = [&](FireClass of) { return neighbours_of(out_.fire, of, s_.samples, s_.lines, sample, line); };
        if (c.found) out_.background_mir_K[i] = static_cast<float>(c.mir.mean);
        if (!certain(i) && !c.found) {
            found[i] = FireClass::Unknown;
            return;
        }
        if (!certain(i) && !stands_out(i, c)) return;
        if (day(i)) {
            if (glint(i, c, beside(FireClass::Water))) {
                found[i] = FireClass::Glint;
                return;
            }
            if (desert_edge(i, c) || (!certain(i) && (c.unmasked_water > 0 || clearing(i, c)))) return;
        }
        const double confidence = rate(i, c, beside(FireClass::Cloud), beside(FireClass::Water));
        out_.confidence_percent[i] = static_cast<float>(100.0 * confidence);
        found[i] = confidence < 0.3 ? FireClass::Low : confidence < 0.8 ? FireClass::Nominal : FireClass::High;
    }

    /// Detection confidence: geometric mean of ramps (eq 17 to 22 of 2003).
    [[nodiscard]] double rate(std::size_t i, const Context& c, int clouds, int waters) const {
        const double mir_K = mir(i);
        const double heat = day(i) ? ramp(mir_K, 310.0, 340.0) : ramp(mir_K, 305.0, 320.0);
        if (!c.found) return heat;
        const double contrast = ramp(mir_K - c.mir.mean, 2.5 * c.mir.spread, 6.0 * c.mir.spread),
                     difference_contrast =
                         ramp(difference(i) - c.difference.mean, 3.0 * c.difference.spread, 6.0 * c.difference.spread);
        if (!day(i)) return std::cbrt(heat * contrast * difference_contrast);
        return std::pow(
            heat * contrast * difference_contrast * (1.0 - ramp(clouds, 0.0, 6.0)) * (1.0 - ramp(waters, 0.0, 6.0)), 0.2);
    }

    std::vector<LocalMean> means_;  ///< of the MIR, of the difference
};

}  // namespace

Detection detect_mod14(const ThermalScene& scene) { return Mod14(scene).run(); }

}  // namespace pyroscene::analysis
