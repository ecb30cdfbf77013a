#include "render/row_writer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "render/light_at.h"

namespace pyroscene::render {

RowWriter::RowWriter(const LightScene& shared, const SceneTables& tables, const PointSources* points,
                     const FlameColumns* plume)
    : shared_(&shared),
      points_(points),
      tables_(&tables),
      kernels_(&spectral_kernels()),
      light_(shared),
      mix_(tables),
      fire_mix_(tables),
      terrain_(tables.stride),
      fire_(tables.stride),
      smoky_sky_(tables),
      through_(static_cast<std::size_t>(tables.stride)),
      opacity_(through_.size()),
      of_moment_(through_.size()) {
    if (plume != nullptr) veil_.emplace(shared.scene, tables, *plume, shared.settings.reach_m);
}

void RowWriter::flame(const Receiver& receiver, float* irradiance) {
    if (points_ != nullptr) return points_->add(shared_->scene, receiver, irradiance);
    light_.compute(receiver);
    sum_flame(irradiance);
}

void RowWriter::write(const Receiver& receiver, const LatticeReceiver& place, Rows& out) {
    GroundIrradiance& light = out.light;
    const auto row = static_cast<std::size_t>(place.row);
    const auto at = [&](std::vector<float>& values) { return values.data() + row * static_cast<std::size_t>(light.stride); };
    const SmokeShade shade = out.smoke != nullptr ? out.smoke->at({receiver.x_m, receiver.y_m, 0.0}) : SmokeShade{};
    if (place.traced || !interpolate(place, out)) {  // between places in smoke lies the light in smoke
        flame(receiver, at(light.irradiance_W_m2_um));
        const double smoke_K = shade.above > 0.0F ? static_cast<double>(shade.temperature_K) : tables_->ambient_K;
        if (veil_ && points_ == nullptr) veil_->dim(receiver, opacity_.data(), smoke_K, at(light.irradiance_W_m2_um));
    }
    if (!out.opacity.empty()) std::copy(opacity_.begin(), opacity_.end(), at(out.opacity));
    for (std::size_t l = 0; l < through_.size(); ++l) through_[l] = 1.0F - opacity_[l] / static_cast<float>(kPi);
    if (!out.through.empty()) std::copy(through_.begin(), through_.end(), at(out.through));
    terrain_.clear();
    const double hidden_sr = shared_->rough ? look_at_terrain(receiver, light.row_of_cell, out.patches[row]) : 0.0;
    if (!fire_mix_.empty()) {
        fire_.clear();
        fire_mix_.resolve(nullptr, fire_);
        kernels_->add_product(tables_->stride, 1.0F, through_.data(), fire_.part(GroundSpectra::Emission),
                              at(light.irradiance_W_m2_um));
    }
    const auto open = static_cast<float>(1.0 - hidden_sr / kPi);
    const bool smoky = shade.above > 0.0F || shade.to_sun > 0.0F;
    if (smoky) smoky_sky_.look_from(shade);
    const GroundLevel level = tables_->level_at(shared_->scene.terrain->height_at(receiver.x_m, receiver.y_m));
    const auto sum = [&](std::vector<float>& into, const float* a, const float* b, bool thermal) {
        if (into.empty()) return;
        float* irradiance = at(into);
        const float* sky =
            tables_->at_level(thermal ? tables_->thermal_sky_irradiance : tables_->sky_irradiance, level, sky_);
        if (smoky) {
            dimmed_sky_.resize(through_.size());
            smoky_sky_.dim(sky, thermal, dimmed_sky_.data());
            sky = dimmed_sky_.data();
        }
        for (std::size_t l = 0; l < static_cast<std::size_t>(light.lambda_count); ++l)
            irradiance[l] = through_[l] * (open * sky[l] + a[l] + b[l]);
    };
    sum(light.sky_irradiance_W_m2_um, terrain_.part(GroundSpectra::Sun), terrain_.part(GroundSpectra::Sky), false);
    sum(light.thermal_irradiance_W_m2_um, terrain_.part(GroundSpectra::Emission), terrain_.part(GroundSpectra::ThermalSky),
        true);
}

/// Flame light and opacity between other rows; false if it must be traced, and the row holds zeros then.
bool RowWriter::interpolate(const LatticeReceiver& place, Rows& out) {
    const auto stride = static_cast<std::size_t>(out.light.stride);
    std::array<const float*, 4> from{};
    const auto between = [&](std::vector<float>& values, float* into) {
        for (std::size_t j = 0; j < from.size(); ++j)
            from[j] = values.data() + static_cast<std::size_t>(place.from[j]) * stride;
        return kernels_->light_between(tables_->stride, from.data(), place.weight.data(), into);
    };
    float* irradiance = out.light.irradiance_W_m2_um.data() + static_cast<std::size_t>(place.row) * stride;
    if (between(out.opacity, opacity_.data()) && between(out.light.irradiance_W_m2_um, irradiance)) return true;
    std::fill(irradiance, irradiance + stride, 0.0F);
    return false;
}

/// Irradiance by flames, and their opacity [sr], from the moments of their emission at the absorption nodes.
void RowWriter::sum_flame(float* irradiance) {
    const int moments = shared_->planck.moments();
    const float* emitted = light_.emitted().data();
    shared_->nodes.interpolate(emitted, moments, opacity_.data());
    if (std::all_of(opacity_.begin(), opacity_.end(), [](float o) { return o == 0.0F; })) return;
    for (int m = 0; m < moments; ++m) {
        shared_->nodes.interpolate(emitted + m, moments, of_moment_.data());
        kernels_->add_product(tables_->stride, 1.0F, of_moment_.data(), shared_->planck.row(m), irradiance);
    }
    // Where only much colder flame than the hottest is seen, the series may err to below zero at short wavelengths.
    for (int l = 0; l < tables_->lambdas; ++l) irradiance[l] = std::max(irradiance[l], 0.0F);
}

/// The glow of the front, and of a scar above the ambient, counts with the light of the flames.
void RowWriter::add_slope(const GroundCell& ground, double weight_sr, const GroundLight& light) {
    const double front = weight_sr * ground.front_fraction, rest = weight_sr - front;
    if (front > 0.0) {
        fire_mix_.add_emission(tables_->burnt_material, tables_->front_K, front);
        mix_.add_reflection(tables_->burnt_material, front, light);
    }
    if (!(rest > 0.0)) return;
    if (!ground.burned) return mix_.add(ground.base_material, ground.base_K, rest, light);
    fire_mix_.add_emission(ground.base_material, ground.base_K, rest);
    fire_mix_.add_emission(ground.base_material, tables_->ambient_K, -rest);
    mix_.add(ground.base_material, tables_->ambient_K, rest, light);
}

/// The slopes that hide the sky: fills `terrain_` with their own emission and what they reflect of sun and open sky, `fire_mix_`
/// with the glow of what burns or has burnt, and `patches` with where they are. Returns the cosine-weighted solid angle that they fill.
double RowWriter::look_at_terrain(const Receiver& receiver, const std::vector<std::int32_t>& row_of_cell,
                                  std::vector<TerrainPatch>& patches) {
    const RenderScene& scene = shared_->scene;
    const TerrainMesh& terrain = *scene.terrain;
    const MapGrid& grid = terrain.grid();
    const double far_m = std::hypot(grid.cols * grid.cell_m, grid.rows * grid.cell_m);
    double seen_sr = 0.0;
    hidden_by_terrain(terrain, receiver, shared_->settings.directions, [&](Vec3 direction, double weight_sr) {
        const Vec3 from{receiver.x_m, receiver.y_m, terrain.height_at(receiver.x_m, receiver.y_m) + 0.1};
        const auto hit = terrain.intersect(from, from + far_m * direction);
        if (!hit) return;
        const GroundCell ground = ground_cell(scene, *tables_, hit->point_m);
        if (!(ground.base_K > 0.0)) return;
        GroundLight light;
        light.level = tables_->level_at(hit->point_m.z);
        if (tables_->has_sun) light.sun_cosine = sun_cosine(scene, *hit);
        add_slope(ground, weight_sr, light);
        seen_sr += weight_sr;
        const int col = std::clamp(static_cast<int>(grid.col_at(hit->point_m.x + scene.scene_origin_m.x)), 0, grid.cols - 1);
        const int row = std::clamp(static_cast<int>(grid.row_at(hit->point_m.y + scene.scene_origin_m.y)), 0, grid.rows - 1);
        patches.push_back({row_of_cell[grid.index(row, col)], ground.base_material, static_cast<float>(weight_sr)});
    });
    mix_.resolve(nullptr, terrain_);
    return seen_sr;
}

}  // namespace pyroscene::render
