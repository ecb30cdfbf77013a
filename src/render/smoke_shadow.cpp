#include "render/smoke_shadow.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "render/flame_march.h"

namespace pyroscene::render {
namespace {

constexpr double kFarthestSun_m = 1e5;

double top_m(const FlameColumns& plume) { return plume.grid().corner_m.z + plume.height_range()[1] * plume.grid().dz_m; }

}  // namespace

double smoke_between(const FlameColumns& plume, Vec3 from_m, Vec3 to_m) {
    double sum = 0.0;
    march_flame(plume, from_m, to_m, [&](float, float fill, double piece_m) {
        sum += fill * piece_m;
        return true;
    });
    return sum;
}

double smoke_to_sun(const FlameColumns& plume, Vec3 from_m, Vec3 to_sun) {
    const double climb_m = top_m(plume) - from_m.z;
    if (!(to_sun.z > 0.0 && climb_m > 0.0)) return 0.0;
    return smoke_between(plume, from_m, from_m + std::min(climb_m / to_sun.z, kFarthestSun_m) * to_sun);
}

SmokeShadow::SmokeShadow(const RenderScene& scene)
    : grid_(scene.terrain->grid()), origin_m_(scene.scene_origin_m), cells_(grid_.size()) {
    const FlameColumns plume(*scene.plume);
    const double highest_m = top_m(plume);
    tbb::parallel_for(0, grid_.rows, [&](int row) {
        for (int col = 0; col < grid_.cols; ++col) {
            const double x_m = grid_.x_centre_m(col) - origin_m_.x, y_m = grid_.y_centre_m(row) - origin_m_.y;
            const Vec3 from{x_m, y_m, scene.terrain->height_at(x_m, y_m)};
            if (!std::isfinite(from.z) || from.z >= highest_m) continue;
            SmokeShade& shade = cells_[grid_.index(row, col)];
            double above = 0.0, heat = 0.0;
            march_flame(plume, from, {x_m, y_m, highest_m}, [&](float T_K, float fill, double piece_m) {
                above += fill * piece_m;
                heat += fill * piece_m * T_K;
                return true;
            });
            shade.above = static_cast<float>(above);
            shade.temperature_K = above > 0.0 ? static_cast<float>(heat / above) : 0.0F;
            shade.to_sun = static_cast<float>(smoke_to_sun(plume, from, scene.to_sun));
        }
    });
}

SmokeShade SmokeShadow::at(Vec3 ground_m) const noexcept {
    const double col = std::clamp(grid_.col_at(ground_m.x + origin_m_.x) - 0.5, 0.0, grid_.cols - 1.0);
    const double row = std::clamp(grid_.row_at(ground_m.y + origin_m_.y) - 0.5, 0.0, grid_.rows - 1.0);
    const int c = std::min(static_cast<int>(col), std::max(grid_.cols - 2, 0)),
              r = std::min(static_cast<int>(row), std::max(grid_.rows - 2, 0));
    SmokeShade out;
    for (int j = 0; j < 4; ++j) {
        const int dr = j / 2, dc = j % 2;
        const double weight = (dr != 0 ? row - r : 1.0 - (row - r)) * (dc != 0 ? col - c : 1.0 - (col - c));
        if (weight == 0.0) continue;
        const SmokeShade& cell = cells_[grid_.index(r + dr, c + dc)];
        const auto w = static_cast<float>(weight);
        out.to_sun += w * cell.to_sun;
        out.above += w * cell.above;
        out.temperature_K += w * cell.above * cell.temperature_K;
    }
    if (out.above > 0.0F) out.temperature_K /= out.above;
    return out;
}

SmokySky::SmokySky(const SceneTables& tables)
    : tables_(&tables), kernels_(&spectral_kernels()), through_(static_cast<std::size_t>(tables.stride)) {
    if (diffuse()) back_ = sun_ = through_;
}

void SmokySky::look_from(const SmokeShade& shade) {
    shade_ = shade;
    const SceneTables& t = *tables_;
    if (!diffuse())
        return kernels_->transmittance(t.stride, t.smoke.extinction_per_m.data(), kMeanSlant * shade.above, through_.data());
    const SmokeDiffusion& diffusion = t.smoke.diffusion;
    DiffuseShade at_nodes{};
    kernels_->diffuse_shade(diffusion.nodes, shade.above, shade.to_sun, at_nodes);
    const auto spread = [&](const float* nodes, std::vector<float>& out) {
        std::fill(out.begin(), out.end(), 0.0F);
        kernels_->add_rows(t.stride, diffusion.weight.data(), t.stride, DiffusionNodes::kCount, nodes, out.data());
        for (float& share : out) share = std::max(share, 0.0F);  // cubics may undershoot where there is nothing
    };
    spread(at_nodes.sky, through_);
    spread(at_nodes.ground, back_);
    spread(at_nodes.sun, sun_);
}

void SmokySky::dim(const float* sky, bool thermal, float* out) const {
    const SceneTables& t = *tables_;
    const SmokeSpectra& smoke = t.smoke;
    const auto pi = static_cast<float>(kPi);
    kernels_->product(t.stride, 1.0F, through_.data(), sky, out);
    const auto add_back = [&](std::size_t l, float ground) { out[l] += back_[l] * pi * ground; };
    const float mu0 = smoke.diffusion.nodes.sun_cosine;
    if (!thermal && diffuse() && mu0 > 0.0F)
        for (std::size_t l = 0; l < through_.size(); ++l) {
            const float straight = mu0 * std::exp(-smoke.extinction_per_m[l] * shade_.to_sun);
            add_back(l, smoke.ground_lit[l] * sun_[l] / mu0);
            out[l] += std::max(sun_[l] - straight, 0.0F) * smoke.sun[l];
        }
    if (!thermal || !(shade_.above > 0.0F)) return;
    const PlanckRows::Lookup warm = t.planck.at(shade_.temperature_K);
    for (std::size_t l = 0; l < through_.size(); ++l) {
        float B = 0.0F;
        for (int j = 0; j < warm.count; ++j) B += warm.weight[static_cast<std::size_t>(j)] * t.planck.row(warm.row + j)[l];
        const float back = diffuse() ? back_[l] : 0.0F;
        out[l] += (1.0F - through_[l] - back) * pi * B;
        if (back > 0.0F) add_back(l, smoke.ground_radiance[l]);
    }
}

}  // namespace pyroscene::render
