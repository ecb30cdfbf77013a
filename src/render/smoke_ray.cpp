#include "render/smoke_ray.h"

#include <cmath>

namespace pyroscene::render {

SmokeRay::SmokeRay(const SceneTables& tables, const FlameColumns& flame, const FlameColumns& plume, const SmokeLight& light,
                   const SmokeNodes& nodes)
    : tables_(&tables),
      kernels_(&spectral_kernels()),
      flame_(&flame),
      plume_(&plume),
      light_(&light),
      nodes_(&nodes),
      sun_(static_cast<std::size_t>(tables.stride), 0.0F) {}

bool SmokeRay::march(Vec3 start_m, Vec3 end_m) {
    list_segments(*plume_, start_m, end_m, smoke_segments_);
    if (smoke_segments_.empty()) return false;
    list_segments(*flame_, start_m, end_m, flame_segments_);
    start_m_ = start_m;
    way_m_ = end_m - start_m;
    direction_ = way_m_ / length(way_m_);
    lit_until_ = -1.0;
    pieces_.clear();
    merge_segments(flame_segments_, smoke_segments_, length(way_m_),
                   [&](const MixedPiece& piece) { pieces_.push_back(piece); });
    return true;
}

/// Light that reaches the part of the ray between two of its parameters.
void SmokeRay::light(SmokeStep& step, double from, double to) {
    const SmokeSpectra& smoke = tables_->smoke;
    const SmokeLight::Node near = from == lit_until_ ? lit_ : light_->at(start_m_ + from * way_m_);
    const SmokeLight::Node far = light_->at(start_m_ + to * way_m_);
    lit_ = far, lit_until_ = to;
    const auto middle = [&](SmokeLight::Quantity q) { return 0.5F * (near[q] + far[q]); };
    step.sun_column = near[SmokeLight::ToSun];
    step.sun_column_far = far[SmokeLight::ToSun];
    if (smoke.diffusion.empty()) {
        step.column_above = kMeanSlant * middle(SmokeLight::Above);
        step.column_below = kMeanSlant * middle(SmokeLight::Below);
    } else {
        const auto range = [&](SmokeLight::Quantity q) { return DiffuseColumns::Range{near[q], far[q] - near[q]}; };
        kernels_->diffuse_source(smoke.diffusion.nodes,
                                 {range(SmokeLight::Above), range(SmokeLight::Below), range(SmokeLight::ToSun),
                                  range(SmokeLight::PastSun), step.smoke_m, static_cast<float>(-direction_.z)},
                                 step.diffuse);
    }
    step.flame_per_m2 = middle(SmokeLight::FlamePerM2);
    if (!(step.flame_per_m2 > 0.0F)) return;
    step.flame_column = middle(SmokeLight::ToFlame);
    const Vec3 bundle{middle(SmokeLight::FlameX), middle(SmokeLight::FlameY), middle(SmokeLight::FlameZ)};
    step.flame_bundling = static_cast<float>(length(bundle));
    if (step.flame_bundling > 0.0F) step.flame_cosine = static_cast<float>(-dot(bundle, direction_)) / step.flame_bundling;
}

/// Part of a piece with smoke, between two parameters of the ray; its flame only when that is soot alone.
void SmokeRay::add_step(const MixedPiece& piece, double from, double to) {
    const PlanckRows& planck = tables_->planck;
    const auto blend = [&](float T_K) {
        const PlanckRows::Lookup at = planck.at(T_K);
        return PlanckBlend{planck.row(at.row), at.count, {at.weight[0], at.weight[1], at.weight[2], at.weight[3]}};
    };
    SmokeStep& step = steps_.emplace_back();
    step.smoke_m = static_cast<float>(piece.smoke_m * (to - from) / (piece.to - piece.from));
    step.smoke = blend(piece.smoke_K);
    if (!tables_->mixture && piece.flame_m > 0.0) {
        step.flame_m = static_cast<float>(piece.flame_m);
        step.flame = blend(piece.flame_K);
    }
    if (tables_->smoke.scatters) light(step, from, to);
}

/// Sends the gathered steps to the sensor.
void SmokeRay::send(float scale, const Spectra& out) {
    if (steps_.empty()) return;
    const SmokeSpectra& smoke = tables_->smoke;
    SmokeRun run;
    nodes_->set(run);
    at_nodes_.resize(static_cast<std::size_t>(nodes_->count()) * (SmokeRun::kSpectra + 3 * steps_.size()));
    run.steps = steps_.data();
    run.count = static_cast<int>(steps_.size());
    for (const SmokeStep& step : steps_) {
        run.flame = run.flame || step.flame_m > 0.0F;
        run.flame_light = run.flame_light || step.flame_per_m2 > 0.0F;
    }
    run.at_nodes = at_nodes_.data();
    run.n = tables_->stride;
    if (smoke.scatters) {
        run.albedo = smoke.albedo.data();
        run.sky = smoke.sky_radiance.data();
        run.ground = smoke.ground_radiance.data();
        run.ground_lit = smoke.ground_lit.data();
        run.irradiance = smoke.sun.data();
        run.sun = sun_.data();
        run.flame_radiance = light_->flame_radiance();
    }
    run.scale = scale;
    run.tau = out.tau;
    run.flame_out = out.flame;
    run.smoke_out = out.smoke;
    run.scattered_out = out.scattered;
    kernels_->emit_smoke(run);
    steps_.clear();
}

void SmokeRay::emit(float scale, MixtureRay* mixture, const Spectra& out) {
    const SceneTables& t = *tables_;
    if (t.smoke.scatters && t.has_sun)
        kernels_->phase_product(t.stride, t.smoke.asymmetry.data(), static_cast<float>(dot(t.to_sun, direction_)),
                                t.smoke.sun.data(), sun_.data());
    const auto burn = [&](const MixedPiece& p) {
        send(scale, out);  // what lies before
        if (mixture != nullptr) return mixture->add(p.flame_K, p.flame_m, t.planck, scale, out.flame);
        const PlanckRows::Lookup hot = t.planck.at(p.flame_K);
        kernels_->emit(t.stride, t.absorption_per_m.data(), static_cast<float>(p.flame_m), t.planck.row(hot.row), t.stride,
                       hot.count, hot.weight.data(), scale, out.tau, out.flame);
    };
    for (const MixedPiece& p : pieces_) {
        const bool gas = mixture != nullptr && p.flame_m > 0.0;
        if (!(p.smoke_m > 0.0)) {
            burn(p);
        } else if (gas) {  // half of the smoke on either side of flame with gas, which is right to second order
            const double middle = 0.5 * (p.from + p.to);
            add_step(p, p.from, middle);
            burn(p);
            add_step(p, middle, p.to);
        } else {
            add_step(p, p.from, p.to);
        }
    }
    send(scale, out);
}

}  // namespace pyroscene::render
