#include "render/smoke_veil.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "fire/flame_bodies.h"
#include "render/smoke_shadow.h"

namespace pyroscene::render {

SmokeVeil::SmokeVeil(const RenderScene& scene, const SceneTables& tables, const FlameColumns& plume, double reach_m)
    : scene_(&scene), tables_(&tables), plume_(&plume), kernels_(&spectral_kernels()), reach_m_(reach_m) {
    for (const fire::FlameBody& body : fire::flame_bodies(*scene.flame))
        bodies_.push_back({body.middle_m, body.area_m2 * std::pow(body.T_K, 4.0), body.area_m2 / (16.0 * kPi)});
    through_.resize(static_cast<std::size_t>(tables.stride));
    one_ = through_;
}

bool SmokeVeil::find_smoke(const Receiver& receiver, std::array<double, kSamples>& fill_length_m) {
    const Vec3 at{receiver.x_m, receiver.y_m, scene_->terrain->height_at(receiver.x_m, receiver.y_m)};
    light_.clear();
    double sum = 0.0;
    for (const Body& body : bodies_) {
        const Vec3 way = body.middle_m - at;
        const double r2 = dot(way, way), facing = dot(way, receiver.normal);
        if (facing > 0.0 && r2 < reach_m_ * reach_m_)
            sum += body.weight * facing / (std::sqrt(r2) * (r2 + body.softening_m2));
        light_.push_back(sum);
    }
    if (!(sum > 0.0)) return false;
    double all_m = 0.0;
    for (int s = 0; s < kSamples; ++s) {
        const auto found = std::upper_bound(light_.begin(), light_.end(), sum * (s + 0.5) / kSamples);
        const auto body = static_cast<std::size_t>(std::min(found, light_.end() - 1) - light_.begin());
        double& smoke = fill_length_m[static_cast<std::size_t>(s)];
        const bool again = s > 0 && found != light_.begin() && *(found - 1) <= sum * (s - 0.5) / kSamples;  // as before
        smoke = again ? fill_length_m[static_cast<std::size_t>(s - 1)] : smoke_between(*plume_, at, bodies_[body].middle_m);
        all_m += smoke;
    }
    return all_m > 0.0;
}

void SmokeVeil::dim(const Receiver& receiver, const float* opacity_sr, double smoke_K, float* irradiance) {
    std::array<double, kSamples> smoke{};
    if (!find_smoke(receiver, smoke)) return;
    const SceneTables& t = *tables_;
    const bool spreads = !t.smoke.flame_spread_per_m.empty();
    const float* k = spreads ? t.smoke.flame_per_m.data() : t.smoke.extinction_per_m.data();
    std::fill(through_.begin(), through_.end(), 0.0F);
    for (const double fill_length_m : smoke) {
        const auto length = static_cast<float>(fill_length_m);
        kernels_->transmittance(t.stride, k, length, one_.data());
        for (std::size_t l = 0; l < through_.size(); ++l)
            through_[l] += one_[l] / (spreads ? 1.0F + t.smoke.flame_spread_per_m[l] * length : 1.0F);
    }
    const PlanckRows::Lookup warm = t.planck.at(smoke_K);
    for (std::size_t l = 0; l < through_.size(); ++l) {
        float B = 0.0F;
        for (int j = 0; j < warm.count; ++j) B += warm.weight[static_cast<std::size_t>(j)] * t.planck.row(warm.row + j)[l];
        const float left = through_[l] / kSamples;
        irradiance[l] = left * irradiance[l] + (1.0F - left) * opacity_sr[l] * B;
    }
}

}  // namespace pyroscene::render
