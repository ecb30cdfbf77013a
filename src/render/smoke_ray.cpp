#include "render/smoke_ray.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::render {
namespace {

// Pieces are joined up to this optical depth at any wavelength, of the smoke and of what lies between its ends and the sun; light
// is linear from end to end, so the error is its curvature over the stretch: below 2e-4 of what it scatters.
constexpr double kThin = 0.05;
constexpr float kLeastWarmer_K = 2.0F, kFlameChange = 0.2F;

}  // namespace

SmokeRay::SmokeRay(const SceneTables& tables, const FlameColumns& flame, const FlameColumns& plume, const SmokeLight& light,
                   const SmokeNodes& nodes)
    : tables_(&tables),
      kernels_(&spectral_kernels()),
      flame_(&flame),
      plume_(&plume),
      light_(&light),
      nodes_(&nodes),
      thickest_per_m_(static_cast<double>(
          *std::max_element(tables.smoke.extinction_per_m.begin(), tables.smoke.extinction_per_m.end()))),
      sun_(static_cast<std::size_t>(tables.stride), 0.0F) {}

bool SmokeRay::march(Vec3 start_m, Vec3 end_m) {
    list_segments(*plume_, start_m, end_m, smoke_segments_);
    if (smoke_segments_.empty()) return false;
    list_segments(*flame_, start_m, end_m, flame_segments_);
    start_m_ = start_m;
    way_m_ = end_m - start_m;
    direction_ = way_m_ / length(way_m_);
    pieces_.clear();
    merge_segments(flame_segments_, smoke_segments_, length(way_m_),
                   [&](const MixedPiece& piece) { pieces_.push_back(piece); });
    return true;
}

/// Light that reaches a part of the ray, from what it is at its ends.
void SmokeRay::light(SmokeStep& step, const SmokeLight::Node& near, const SmokeLight::Node& far) const {
    const SmokeSpectra& smoke = tables_->smoke;
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

bool SmokeRay::joins(const MixedPiece& piece, const SmokeLight::Node& far) const {
    if (!stretch_ || stretch_->piece.to != piece.from || stretch_->piece.flame_m > 0.0 || piece.flame_m > 0.0) return false;
    if (thickest_per_m_ * (stretch_->piece.smoke_m + piece.smoke_m) > kThin) return false;
    if (std::abs(stretch_->piece.smoke_K - piece.smoke_K) > kLeastWarmer_K) return false;
    const SmokeLight::Node& near = stretch_->near;
    const auto change = [&](SmokeLight::Quantity q) { return std::abs(far[q] - near[q]); };
    return thickest_per_m_ * static_cast<double>(change(SmokeLight::ToSun)) < kThin &&
           change(SmokeLight::FlamePerM2) <= kFlameChange * near[SmokeLight::FlamePerM2];
}

/// A piece with smoke, or part of one.
void SmokeRay::add(const MixedPiece& piece) {
    SmokeLight::Node far{};
    if (tables_->smoke.scatters) far = light_->at(start_m_ + piece.to * way_m_);
    if (joins(piece, far)) {
        MixedPiece& all = stretch_->piece;
        const double smoke_m = all.smoke_m + piece.smoke_m;
        all.smoke_K += static_cast<float>(piece.smoke_m / smoke_m) * (piece.smoke_K - all.smoke_K);
        all.smoke_m = smoke_m;
        all.to = piece.to;
        stretch_->far = far;
        return;
    }
    const bool goes_on = stretch_ && stretch_->piece.to == piece.from;
    Stretch next{piece, {}, far};
    if (goes_on)
        next.near = stretch_->far;
    else if (tables_->smoke.scatters)
        next.near = light_->at(start_m_ + piece.from * way_m_);
    close_stretch();
    stretch_ = next;
}

void SmokeRay::close_stretch() {
    if (!stretch_) return;
    const auto blend = [&](float T_K) {
        const PlanckRows::Lookup at = tables_->planck.at(T_K);
        return PlanckBlend{tables_->planck.row(at.row), at.count, {at.weight[0], at.weight[1], at.weight[2], at.weight[3]}};
    };
    const MixedPiece& piece = stretch_->piece;
    SmokeStep& step = steps_.emplace_back();
    step.smoke_m = static_cast<float>(piece.smoke_m);
    step.smoke = blend(piece.smoke_K);
    if (piece.flame_m > 0.0) {
        step.flame_m = static_cast<float>(piece.flame_m);
        step.flame = blend(piece.flame_K);
    }
    if (tables_->smoke.scatters) light(step, stretch_->near, stretch_->far);
    stretch_.reset();
}

/// Sends the gathered steps to the sensor.
void SmokeRay::send(float scale, const Spectra& out) {
    close_stretch();
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
        if (!(p.smoke_m > 0.0)) {
            burn(p);
        } else if (mixture != nullptr && p.flame_m > 0.0) {
            // Half of the smoke on either side of flame with gas, which is right to second order.
            MixedPiece half = p;
            half.flame_m = 0.0;
            half.smoke_m *= 0.5;
            half.to = 0.5 * (p.from + p.to);
            add(half);
            burn(p);
            half.from = half.to;
            half.to = p.to;
            add(half);
        } else {
            add(p);
        }
    }
    send(scale, out);
}

}  // namespace pyroscene::render
