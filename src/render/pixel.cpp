#include "render/pixel.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "render/light_at.h"

namespace pyroscene::render {
namespace {

/// Flame of this optical depth hides what lies behind it: exp(-17) = 4e-8.
constexpr double kOpaqueDepth = 17.0;

double fourth_power(double x) { return x * x * x * x; }

}  // namespace

Pixel::Pixel(const PreparedScene& prepared)
    : prepared_(&prepared),
      kernels_(&spectral_kernels()),
      flame_weight_(static_cast<std::size_t>(prepared.tables.planck.row_count()), 0.0),
      mix_(prepared.tables),
      mix_of_ray_(prepared.tables),
      ground_(prepared.tables.stride),
      ground_of_ray_(prepared.tables.stride),
      flame_(static_cast<std::size_t>(prepared.tables.stride), 0.0F),
      smoke_(static_cast<std::size_t>(prepared.tables.stride), 0.0F),
      scattered_(smoke_.size(), 0.0F),
      tau_(static_cast<std::size_t>(prepared.tables.stride), 1.0F) {
    if (prepared.tables.mixture) mixture_.emplace(*prepared.tables.mixture);
    if (prepared.smoke)
        smoke_ray_.emplace(prepared.tables, prepared.flame, prepared.smoke->columns, prepared.smoke->light,
                           prepared.smoke->nodes);
}

void Pixel::begin() {
    truth_ = {};
    if (flame_used_) std::fill(flame_.begin(), flame_.end(), 0.0F);
    if (flame_used_ && smoke_ray_) {
        std::fill(smoke_.begin(), smoke_.end(), 0.0F);
        std::fill(scattered_.begin(), scattered_.end(), 0.0F);
    }
    if (ground_used_) ground_.clear();
    flame_used_ = ground_used_ = false;
}

std::optional<Pixel::Met> Pixel::meet(const SceneRay& ray, const std::optional<TerrainMesh::Hit>& terrain) const {
    const PreparedScene& p = *prepared_;
    if (terrain) {
        const GroundCell ground = ground_cell(p.scene, p.tables, terrain->point_m);
        if (ground.base_K > 0.0) return Met{*terrain, ground, true};
    }
    const Vec3 way_m = ray.end_m - ray.start_m;
    if (p.scene.surroundings) {
        const auto& level = *p.scene.surroundings;
        const double f = (level.height_m - ray.start_m.z) / way_m.z;
        if (f >= 0.0 && (f <= 1.0 || (ray.open && std::isfinite(f))))
            return Met{{f * length(way_m), ray.start_m + f * way_m, {0.0, 0.0, 1.0}},
                       {.base_material = level.material, .base_K = static_cast<double>(p.tables.ambient_K)},
                       false};
    }
    if (!ray.open) return std::nullopt;  // looks nowhere, or never comes down
    return Met{{length(way_m), ray.end_m, {}}, {.sky = true, .zenith_cosine = normalized(way_m).z}, false};
}

void Pixel::add(const SceneRay& ray, const Met& met, double weight) {
    const PreparedScene& p = *prepared_;
    const Vec3 hit_m = met.hit.point_m;
    const GroundCell& ground = met.ground;
    truth_.seen += weight;
    if (met.scene) truth_.coverage += weight;
    if (ground.sky)
        truth_.sky += weight;
    else
        truth_.hit_m = truth_.hit_m + weight * hit_m;

    if (smoke_ray_ && smoke_ray_->march(ray.start_m, hit_m)) {
        add_ground_truth(ground, weight, mixed_truth(weight));
        add_mixed(weight, ground, light_at(met));
        return;
    }
    march(ray.start_m, hit_m);
    const GroundLight light = light_at(met);
    if (pieces_.empty()) {
        add_ground_truth(ground, weight, {});
        add_ground(p.tables, ground, weight, light, mix_);
        return;
    }
    const Through through = flame_truth(weight);
    add_ground_truth(ground, weight, through);
    if (p.tables.grey) {
        add_grey_flame(weight);
        add_ground(p.tables, ground, weight * through.at_4um, light, mix_);
    } else {
        add_flame_spectrally(weight, ground, light);
    }
}

GroundLight Pixel::light_at(const Met& met) const {
    const RenderScene& scene = prepared_->scene;
    GroundLight light;
    light.level = prepared_->tables.level_at(met.hit.point_m.z);
    if (!met.scene) {
        if (prepared_->tables.has_sun) light.sun_cosine = std::max(0.0, scene.to_sun.z);
        return light;
    }
    const Vec3 point_m = met.hit.point_m;
    if (prepared_->flame_light != nullptr) {
        light_around(*prepared_->flame_light, point_m.x + scene.scene_origin_m.x, point_m.y + scene.scene_origin_m.y, light);
    }
    if (prepared_->tables.has_sun) light.sun_cosine = sun_cosine(scene, met.hit);
    if (prepared_->smoke) light.smoke = prepared_->smoke->shadow.at(point_m);
    return light;
}

void Pixel::march(Vec3 start_m, Vec3 end_m) {
    pieces_.clear();
    double depth = 0.0;
    const double least = prepared_->tables.least_absorption_per_m;
    march_flame(prepared_->flame, start_m, end_m, [&](float T_K, float fill, double length_m) {
        const double fill_length_m = fill * length_m;
        if (!pieces_.empty() && pieces_.back().temperature_K == T_K)
            pieces_.back().fill_length_m += fill_length_m;
        else
            pieces_.push_back({T_K, fill_length_m, 0.0});
        depth += least * fill_length_m;
        return depth < kOpaqueDepth;
    });
}

/// Opacity, temperature and exitance of the flame on this ray.
Pixel::Through Pixel::flame_truth(double weight) {
    const bool grey = prepared_->tables.total_transmittance.empty();
    double tau = 1.0, total = 1.0, passed_m = 0.0;
    for (FlamePiece& piece : pieces_) {
        const double T4 = fourth_power(piece.temperature_K);
        const double emitted = -tau * std::expm1(-prepared_->tables.truth_absorption_per_m * piece.fill_length_m);
        tau -= emitted;
        piece.emitted = emitted;
        truth_.flame += weight * emitted;
        truth_.flame_T4 += weight * emitted * T4;
        passed_m += piece.fill_length_m;
        const double left = grey ? tau : prepared_->tables.total_transmittance_at(passed_m);
        truth_.exitance_W_m2 += weight * kStefanBoltzmann_W_m2_K4 * (total - left) * T4;
        total = left;
    }
    return {tau, total};
}

/// Absorption equal at all wavelengths: emission becomes weights of Planck rows. Follows flame_truth().
void Pixel::add_grey_flame(double weight) {
    const SceneTables& t = prepared_->tables;
    for (const FlamePiece& piece : pieces_) {
        const PlanckRows::Lookup found = t.planck.at(piece.temperature_K);
        for (int j = 0; j < found.count; ++j) {
            flame_weight_[static_cast<std::size_t>(found.row + j)] +=
                weight * piece.emitted * static_cast<double>(found.weight[static_cast<std::size_t>(j)]);
        }
        const bool first = end_flame_row_ == first_flame_row_;
        first_flame_row_ = first ? found.row : std::min(first_flame_row_, found.row);
        end_flame_row_ = std::max(end_flame_row_, found.row + found.count);
    }
}

void Pixel::emit_soot(double weight) {
    const SceneTables& t = prepared_->tables;
    std::fill(tau_.begin(), tau_.end(), 1.0F);
    for (const FlamePiece& piece : pieces_) {
        const PlanckRows::Lookup found = t.planck.at(piece.temperature_K);
        kernels_->emit(t.stride, t.absorption_per_m.data(), static_cast<float>(piece.fill_length_m), t.planck.row(found.row),
                       t.stride, found.count, found.weight.data(), static_cast<float>(weight), tau_.data(), flame_.data());
    }
}

void Pixel::add_flame_spectrally(double weight, const GroundCell& ground, const GroundLight& light) {
    flame_used_ = true;
    if (!mixture_) {
        emit_soot(weight);
        add_ground_behind(weight, ground, light, tau_.data());
        return;
    }
    mixture_->begin();
    for (const FlamePiece& piece : pieces_) {
        mixture_->add(piece.temperature_K, piece.fill_length_m, prepared_->tables.planck, static_cast<float>(weight),
                      flame_.data());
    }
    add_ground_behind(weight, ground, light, mixture_->tau());
}

/// Ground seen through the transmittance of the current ray.
void Pixel::add_ground_behind(double weight, const GroundCell& ground, const GroundLight& light, const float* tau) {
    const SceneTables& t = prepared_->tables;
    ground_used_ = true;
    ground_of_ray_.clear();
    add_ground(t, ground, weight, light, mix_of_ray_);
    mix_of_ray_.resolve(prepared_->flame_light, ground_of_ray_);
    for (int p = 0; p < GroundSpectra::kParts; ++p) {
        kernels_->add_product(t.stride, 1.0F, tau, ground_of_ray_.part(p), ground_.part(p));
    }
}

/// What flame_truth() is for flame alone. Exitance is that of the fire without the smoke.
Pixel::Through Pixel::mixed_truth(double weight) {
    const SceneTables& t = prepared_->tables;
    const bool grey = t.total_transmittance.empty();
    double tau = 1.0, total = 1.0, passed_m = 0.0;
    for (const MixedPiece& piece : smoke_ray_->pieces()) {
        const double flame = t.truth_absorption_per_m * piece.flame_m,
                     smoke = t.truth_smoke_extinction_per_m * piece.smoke_m;
        if (!(flame + smoke > 0.0)) continue;
        const double emitted = -tau * std::expm1(-(flame + smoke)), by_flame = emitted * flame / (flame + smoke);
        tau -= emitted;
        truth_.flame += weight * by_flame;
        truth_.flame_T4 += weight * by_flame * fourth_power(piece.flame_K);
        passed_m += piece.flame_m;
        const double left = grey ? total * std::exp(-flame) : t.total_transmittance_at(passed_m);
        truth_.exitance_W_m2 += weight * kStefanBoltzmann_W_m2_K4 * (total - left) * fourth_power(piece.flame_K);
        total = left;
        truth_.smoke += weight * (emitted - by_flame);
    }
    return {tau, total};
}

void Pixel::add_mixed(double weight, const GroundCell& ground, const GroundLight& light) {
    flame_used_ = true;
    if (mixture_)
        mixture_->begin();
    else
        std::fill(tau_.begin(), tau_.end(), 1.0F);
    float* tau = mixture_ ? mixture_->tau() : tau_.data();
    smoke_ray_->emit(static_cast<float>(weight), mixture_ ? &*mixture_ : nullptr,
                     {tau, flame_.data(), smoke_.data(), scattered_.data()});
    add_ground_behind(weight, ground, light, tau);
}

void Pixel::add_ground_truth(const GroundCell& ground, double weight, const Through& through) {
    if (ground.sky) return;
    const SceneTables& t = prepared_->tables;
    const double seen = weight * through.at_4um, front = seen * ground.front_fraction, rest = seen - front;
    const auto radiates = [&](double share, double T_K, double cold_K) {
        truth_.exitance_W_m2 += weight * through.total * share * prepared_->scene.optics->burnt_emissivity.at(T_K) *
                                kStefanBoltzmann_W_m2_K4 * (fourth_power(T_K) - fourth_power(cold_K));
    };
    truth_.front += front;
    radiates(ground.front_fraction, t.front_K, 0.0);
    if (ground.burned) {
        truth_.scar += rest;
        radiates(1.0 - ground.front_fraction, ground.base_K, t.ambient_K);
    } else {
        truth_.background += rest;
    }
    truth_.ground_T4 += front * fourth_power(t.front_K) + rest * fourth_power(ground.base_K);
}

void Pixel::finish() {
    const SceneTables& t = prepared_->tables;
    flame_used_ = flame_used_ || end_flame_row_ > first_flame_row_;
    for (int row = first_flame_row_; row < end_flame_row_; ++row) {
        auto& weight = flame_weight_[static_cast<std::size_t>(row)];
        if (weight == 0.0) continue;
        const auto w = static_cast<float>(weight);
        kernels_->add_rows(t.stride, t.planck.row(row), t.stride, 1, &w, flame_.data());
        weight = 0.0;
    }
    first_flame_row_ = end_flame_row_ = 0;
    if (!mix_.empty()) {
        ground_used_ = true;
        mix_.resolve(prepared_->flame_light, ground_);
    }
}

}  // namespace pyroscene::render
