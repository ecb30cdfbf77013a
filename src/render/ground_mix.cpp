#include "render/ground_mix.h"

#include <algorithm>
#include <array>

namespace pyroscene::render {
GroundMix::GroundMix(const SceneTables& tables)
    : tables_(&tables),
      kernels_(&spectral_kernels()),
      emission_(static_cast<std::size_t>(tables.materials) * static_cast<std::size_t>(tables.planck.row_count()), 0.0F),
      is_touched_(emission_.size(), 0),
      reflection_(tables.level_m.size() * static_cast<std::size_t>(tables.materials)),
      smoky_sky_(tables) {}

void GroundMix::add_emission(int material, double temperature_K, double weight) {
    const PlanckRows::Lookup found = tables_->planck.at(temperature_K);
    const int first = material * tables_->planck.row_count() + found.row;
    for (int j = 0; j < found.count; ++j) {
        const auto i = static_cast<std::size_t>(first + j);
        emission_[i] += static_cast<float>(weight) * found.weight[static_cast<std::size_t>(j)];
        if (is_touched_[i] == 0) {
            is_touched_[i] = 1;
            touched_.push_back(static_cast<std::int32_t>(i));
        }
    }
}

void GroundMix::add_reflection(int material, double weight, const GroundLight& light) {
    const GroundLevel level = light.level;
    const int levels = level.next > 0.0F ? 2 : 1;
    const bool none = end_level_ == first_level_;
    first_level_ = none ? level.first : std::min(first_level_, level.first);
    end_level_ = std::max(end_level_, level.first + levels);
    Reflection* reflection = &reflection_[static_cast<std::size_t>(level.first * tables_->materials + material)];
    reflection->hidden += weight * light.hidden;
    if (light.smoke.to_sun > 0.0F || light.smoke.above > 0.0F) {
        shaded_.push_back({material, level, weight * light.sun_cosine, weight * light.open, light.smoke});
    } else {
        for (int j = 0; j < levels; ++j, reflection += tables_->materials) {
            const double share = weight * static_cast<double>(j == 0 ? 1.0F - level.next : level.next);
            reflection->sun += share * light.sun_cosine;
            reflection->open += share * light.open;
        }
    }
    for (int j = 0; j < light.row_count; ++j) {
        const auto row = light.row[static_cast<std::size_t>(j)];
        const double share = weight * light.weight[static_cast<std::size_t>(j)];
        bool known = false;
        for (LitPart& part : lit_) {
            if (part.row != row || part.material != material) continue;
            part.weight += share;
            known = true;
            break;
        }
        if (!known) lit_.push_back({row, material, share});
    }
}

void GroundMix::add_sky(double zenith_cosine, double weight) noexcept {
    const auto& nodes = OpenSky::kCosine;
    const double at = std::clamp(zenith_cosine, nodes.front(), nodes.back());
    const auto above = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(nodes.begin(), nodes.end(), at) - nodes.begin()), nodes.size() - 1);
    const double f = (at - nodes[above - 1]) / (nodes[above] - nodes[above - 1]);
    sky_weight_ += static_cast<float>(weight);
    sky_node_weight_[above - 1] += static_cast<float>((1.0 - f) * weight);
    sky_node_weight_[above] += static_cast<float>(f * weight);
}

void GroundMix::resolve_lit(const LitPart& part, const GroundIrradiance& flame_light, GroundSpectra& out) const {
    const SceneTables& t = *tables_;
    const auto offset = static_cast<std::size_t>(part.row) * static_cast<std::size_t>(flame_light.stride);
    const auto weight = static_cast<float>(part.weight);
    const float* reflectance = t.reflectance_per_pi[part.material];
    const auto add = [&](const std::vector<float>& irradiance, GroundSpectra::Part into) {
        if (irradiance.empty()) return;
        kernels_->add_product(t.stride, weight, reflectance, irradiance.data() + offset, out.part(into));
    };
    add(flame_light.irradiance_W_m2_um, GroundSpectra::FlameLight);
    add(flame_light.sky_irradiance_W_m2_um, GroundSpectra::Sky);
    add(flame_light.thermal_irradiance_W_m2_um, GroundSpectra::ThermalSky);
}

void GroundMix::resolve_shaded(const ShadedPart& part, GroundSpectra& out) {
    const SceneTables& t = *tables_;
    const float* reflectance = t.reflectance_per_pi[part.material];
    for (std::vector<float>* row : {&through_, &sky_}) row->resize(static_cast<std::size_t>(t.stride));
    if (t.has_sun) {
        kernels_->transmittance(t.stride, t.smoke.extinction_per_m.data(), part.smoke.to_sun, through_.data());
        const auto sun = static_cast<float>(part.sun);
        const auto add = [&](int level, float share) {
            if (share > 0.0F)
                kernels_->add_product(t.stride, sun * share, through_.data(), t.sun[level * t.materials + part.material],
                                      out.part(GroundSpectra::Sun));
        };
        add(part.level.first, 1.0F - part.level.next);
        add(part.level.first + 1, part.level.next);
    }
    if (part.open == 0.0) return;
    smoky_sky_.look_from(part.smoke);
    const auto add = [&](const SceneTables::Rows& irradiance, bool thermal, GroundSpectra::Part into) {
        smoky_sky_.dim(t.at_level(irradiance, part.level, between_), thermal, sky_.data());
        kernels_->add_product(t.stride, static_cast<float>(part.open), reflectance, sky_.data(), out.part(into));
    };
    if (t.has_sky) add(t.sky_irradiance, false, GroundSpectra::Sky);
    add(t.thermal_sky_irradiance, true, GroundSpectra::ThermalSky);
}

void GroundMix::resolve_reflection(GroundSpectra& out) {
    const SceneTables& t = *tables_;
    for (int row = first_level_ * t.materials; row < end_level_ * t.materials; ++row) {
        Reflection& reflection = reflection_[static_cast<std::size_t>(row)];
        const auto add = [&](const float* spectrum, double weight, GroundSpectra::Part into) {
            const auto w = static_cast<float>(weight);
            if (w != 0.0F) kernels_->add_rows(t.stride, spectrum, t.stride, 1, &w, out.part(into));
        };
        const int material = row % t.materials;
        if (t.has_sun) add(t.sun[row], reflection.sun, GroundSpectra::Sun);
        if (t.has_sky) add(t.sky[row], reflection.open, GroundSpectra::Sky);
        if (t.has_thermal_sky) add(t.thermal_sky[row], reflection.open, GroundSpectra::ThermalSky);
        add(t.slopes_solar[material], reflection.hidden, GroundSpectra::Sky);
        add(t.slopes_thermal[material], reflection.hidden, GroundSpectra::ThermalSky);
        reflection = {};
    }
    first_level_ = end_level_ = 0;
}

void GroundMix::resolve(const GroundIrradiance* flame_light, GroundSpectra& out) {
    const SceneTables& t = *tables_;
    const int rows = t.planck.row_count();
    for (const std::int32_t i : touched_) {
        kernels_->add_product(t.stride, emission_[static_cast<std::size_t>(i)], t.emissivity[i / rows],
                              t.planck.row(i % rows), out.part(GroundSpectra::Emission));
        emission_[static_cast<std::size_t>(i)] = 0.0F;
        is_touched_[static_cast<std::size_t>(i)] = 0;
    }
    touched_.clear();
    resolve_reflection(out);
    if (sky_weight_ != 0.0F) {
        kernels_->add_rows(t.stride, t.open_sky.sunlit.data(), t.stride, 1, &sky_weight_, out.part(GroundSpectra::Sky));
        kernels_->add_rows(t.stride, t.open_sky.thermal.data(), t.stride, static_cast<int>(sky_node_weight_.size()),
                           sky_node_weight_.data(), out.part(GroundSpectra::ThermalSky));
        sky_weight_ = 0.0F;
        sky_node_weight_ = {};
    }
    if (flame_light != nullptr) {
        for (const LitPart& part : lit_) resolve_lit(part, *flame_light, out);
    }
    lit_.clear();
    for (const ShadedPart& part : shaded_) resolve_shaded(part, out);
    shaded_.clear();
}

GroundCell ground_cell(const RenderScene& scene, const SceneTables& tables, Vec3 point_m) noexcept {
    const double x_m = point_m.x + scene.scene_origin_m.x, y_m = point_m.y + scene.scene_origin_m.y;
    const auto cell = [&](const MapGrid& grid) {  // a hit on the very rim may round to the outside
        return std::array{std::clamp(static_cast<int>(grid.row_at(y_m)), 0, grid.rows - 1),
                          std::clamp(static_cast<int>(grid.col_at(x_m)), 0, grid.cols - 1)};
    };
    const fire::SurfaceField& surface = *scene.surface;
    const auto [row, col] = cell(surface.grid);
    const std::size_t fine = surface.index(row, col);
    GroundCell ground;
    ground.base_K = surface.base_temperature_K[fine];
    ground.front_fraction = std::clamp(surface.front_fraction[fine], 0.0F, 1.0F);
    ground.burned = surface.burned[fine] != 0;
    const auto [cover_row, cover_col] = cell(scene.cover->grid);
    ground.base_material = ground.burned ? tables.burnt_material : scene.cover->at(cover_row, cover_col);
    return ground;
}

void add_ground(const SceneTables& tables, const GroundCell& ground, double weight, const GroundLight& light,
                GroundMix& mix) {
    if (ground.sky) return mix.add_sky(ground.zenith_cosine, weight);
    const double f = ground.front_fraction;
    if (f > 0.0) mix.add(tables.burnt_material, tables.front_K, weight * f, light);
    if (f < 1.0) mix.add(ground.base_material, ground.base_K, weight * (1.0 - f), light);
}

}  // namespace pyroscene::render
