#include "render/smoke_ray.h"

#include <cmath>

namespace pyroscene::render {

SmokeRay::SmokeRay(const SceneTables& tables, const FlameColumns& flame, const FlameColumns& plume, const SmokeLight& light)
    : tables_(&tables),
      kernels_(&spectral_kernels()),
      flame_(&flame),
      plume_(&plume),
      light_(&light),
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

/// Light that reaches the part of the ray between two of its parameters.
void SmokeRay::light(SmokePiece& piece, double from, double to) const {
    const SmokeSpectra& smoke = tables_->smoke;
    const SmokeLight::Node near = light_->at(start_m_ + from * way_m_), far = light_->at(start_m_ + to * way_m_);
    const auto middle = [&](SmokeLight::Quantity q) { return 0.5F * (near[q] + far[q]); };
    piece.albedo = smoke.albedo.data();
    piece.asymmetry = smoke.asymmetry.data();
    piece.sun = sun_.data();
    piece.beam_k = smoke.beam_per_m.data();
    piece.sky = smoke.sky_radiance.data();
    piece.ground = smoke.ground_radiance.data();
    piece.ground_lit = smoke.ground_lit.data();
    piece.flame_share_m2 = light_->flame_share_m2();
    piece.flame_radiance = light_->flame_radiance();
    piece.sun_column = near[SmokeLight::ToSun];
    piece.sun_column_change = far[SmokeLight::ToSun] - near[SmokeLight::ToSun];
    if (smoke.diffusion.empty()) {
        piece.column_above = kMeanSlant * middle(SmokeLight::Above);
        piece.column_below = kMeanSlant * middle(SmokeLight::Below);
    } else {
        const auto range = [&](SmokeLight::Quantity q) { return DiffuseColumns::Range{near[q], far[q] - near[q]}; };
        kernels_->diffuse_source(smoke.diffusion.nodes,
                                 {range(SmokeLight::Above), range(SmokeLight::Below), range(SmokeLight::ToSun),
                                  range(SmokeLight::PastSun), piece.smoke.depth, static_cast<float>(-direction_.z)},
                                 piece.diffuse);
        piece.diffusion_weight = smoke.diffusion.weight.data();
        piece.irradiance = smoke.sun.data();
    }
    piece.flame_k = smoke.flame_per_m.data();
    piece.flame_spread = smoke.flame_spread_per_m.data();
    piece.flame_per_m2 = middle(SmokeLight::FlamePerM2);
    if (!(piece.flame_per_m2 > 0.0F)) return;
    piece.flame_column = middle(SmokeLight::ToFlame);
    const Vec3 bundle{middle(SmokeLight::FlameX), middle(SmokeLight::FlameY), middle(SmokeLight::FlameZ)};
    piece.flame_bundling = static_cast<float>(length(bundle));
    if (piece.flame_bundling > 0.0F)
        piece.flame_cosine = static_cast<float>(-dot(bundle, direction_)) / piece.flame_bundling;
}

SmokePiece SmokeRay::piece(const MixedPiece& from, float scale, const Spectra& out) const {
    const SceneTables& t = *tables_;
    SmokePiece piece;
    piece.n = t.stride;
    piece.flame.k = t.absorption_per_m.data();
    piece.smoke.k = t.smoke.extinction_per_m.data();
    piece.smoke.depth = static_cast<float>(from.smoke_m);
    piece.scale = scale;
    piece.tau = out.tau;
    piece.flame_out = out.flame;
    piece.smoke_out = out.smoke;
    piece.scattered_out = out.scattered;
    return piece;
}

void SmokeRay::emit(float scale, MixtureRay* mixture, const Spectra& out) {
    const SceneTables& t = *tables_;
    if (t.smoke.scatters && t.has_sun)
        kernels_->phase_product(t.stride, t.smoke.asymmetry.data(), static_cast<float>(dot(t.to_sun, direction_)),
                                t.smoke.sun.data(), sun_.data());
    for (const MixedPiece& p : pieces_) {
        const PlanckRows::Lookup hot = t.planck.at(p.flame_K), warm = t.planck.at(p.smoke_K);
        const bool flame = p.flame_m > 0.0, smoke = p.smoke_m > 0.0;
        if (!smoke) {
            if (mixture != nullptr)
                mixture->add(p.flame_K, p.flame_m, t.planck, scale, out.flame);
            else
                kernels_->emit(t.stride, t.absorption_per_m.data(), static_cast<float>(p.flame_m), t.planck.row(hot.row),
                               t.stride, hot.count, hot.weight.data(), scale, out.tau, out.flame);
            continue;
        }
        SmokePiece piece = this->piece(p, scale, out);
        piece.smoke.rows = t.planck.row(warm.row);
        piece.smoke.row_count = warm.count;
        piece.smoke.weight = warm.weight.data();
        const auto send = [&](double from, double to) {
            if (t.smoke.scatters) light(piece, from, to);
            kernels_->emit_smoke(piece);
        };
        if (flame && mixture != nullptr) {
            // Half of the smoke on either side of flame with gas, which is right to second order.
            const double middle = 0.5 * (p.from + p.to);
            piece.smoke.depth *= 0.5F;
            send(p.from, middle);
            mixture->add(p.flame_K, p.flame_m, t.planck, scale, out.flame);
            send(middle, p.to);
            continue;
        }
        if (flame)
            piece.flame = {t.absorption_per_m.data(), static_cast<float>(p.flame_m), t.planck.row(hot.row), hot.count,
                           hot.weight.data()};
        send(p.from, p.to);
    }
}

}  // namespace pyroscene::render
