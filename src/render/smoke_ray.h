#pragma once

#include <optional>
#include <vector>

#include "render/mixed_march.h"
#include "render/mixture_ray.h"
#include "render/scene_tables.h"
#include "render/smoke_light.h"
#include "render/smoke_nodes.h"

namespace pyroscene::render {

/// A ray through smoke, and flame in it or behind it. One per thread.
class SmokeRay {
public:
    SmokeRay(const SceneTables& tables, const FlameColumns& flame, const FlameColumns& plume, const SmokeLight& light,
             const SmokeNodes& nodes);

    /// Lists what lies on the way, from `start_m` on; false when it meets no smoke.
    bool march(Vec3 start_m, Vec3 end_m);
    [[nodiscard]] const std::vector<MixedPiece>& pieces() const noexcept { return pieces_; }

    /// Adds scale times what the pieces send to the sensor and multiplies what they let through into `tau` [stride].
    /// \param mixture  flame with gas, begun; null: soot alone. It owns `tau` then.
    struct Spectra {
        float *tau, *flame, *smoke, *scattered;
    };
    void emit(float scale, MixtureRay* mixture, const Spectra& out);

private:
    /// Neighbouring pieces of thin smoke in much the same light, taken as one.
    struct Stretch {
        MixedPiece piece;  ///< its flame is soot alone, or none
        SmokeLight::Node near{}, far{};
    };
    void add(const MixedPiece& piece);
    [[nodiscard]] bool joins(const MixedPiece& piece, const SmokeLight::Node& far) const;
    void close_stretch();
    void light(SmokeStep& step, const SmokeLight::Node& near, const SmokeLight::Node& far) const;
    void send(float scale, const Spectra& out);

    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    const FlameColumns *flame_, *plume_;
    const SmokeLight* light_;
    const SmokeNodes* nodes_;
    Vec3 start_m_, way_m_, direction_;
    std::vector<RaySegment> flame_segments_, smoke_segments_;
    std::vector<MixedPiece> pieces_;
    double thickest_per_m_ = 0.0;  ///< largest extinction of fill 1
    std::optional<Stretch> stretch_;
    std::vector<SmokeStep> steps_;  ///< gathered, not yet sent
    std::vector<float> at_nodes_;
    std::vector<float> sun_;  ///< irradiance times phase function of this ray
};

}  // namespace pyroscene::render
