#include "bench/baseline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "radiometry/planck.h"

namespace pyroscene::bench {
namespace {

constexpr int kLayers = 64;

/// Dense array of the field's temperatures.
std::vector<float> dense_temperatures(const fire::FlameField& field, int nz) {
    constexpr int kEdge = fire::FlameField::kBrickEdge;
    const int nx = field.grid.nx, ny = field.grid.ny;
    std::vector<float> dense(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz),
                             0.0F);
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const auto& column = field.columns[static_cast<std::size_t>(j / kEdge * field.brick_cols + i / kEdge)];
            for (int k = column.z_begin * kEdge; k < std::min((column.z_begin + column.brick_count) * kEdge, nz); ++k) {
                const auto& brick = field.bricks[static_cast<std::size_t>(column.first_brick + k / kEdge - column.z_begin)];
                const auto v = static_cast<std::size_t>(((k % kEdge) * kEdge + j % kEdge) * kEdge + i % kEdge);
                if (brick.fill[v] > 0.0F) {
                    dense[(static_cast<std::size_t>(k) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(j)) *
                              static_cast<std::size_t>(nx) +
                          static_cast<std::size_t>(i)] = brick.temperature_K[v];
                }
            }
        }
    }
    return dense;
}

/// Visits the voxels of a dense grid from `from` along `direction` (grid units: voxels) while inside.
template <class Visit>
void traverse(Vec3 from, Vec3 direction, int nx, int ny, int nz, double limit, Visit&& visit) {
    double enter = 0.0, leave = limit;
    const auto clip = [&](double o, double d, double hi) {
        if (d == 0.0) return o >= 0.0 && o < hi;
        const double a = -o / d, b = (hi - o) / d;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
        return enter < leave;
    };
    if (!clip(from.x, direction.x, nx) || !clip(from.y, direction.y, ny) || !clip(from.z, direction.z, nz)) return;
    const Vec3 start = from + enter * direction;
    int i = std::clamp(static_cast<int>(start.x), 0, nx - 1), j = std::clamp(static_cast<int>(start.y), 0, ny - 1),
        k = std::clamp(static_cast<int>(start.z), 0, nz - 1);
    const auto first = [&](double o, double d, int cell) {
        return d > 0.0 ? (cell + 1 - o) / d : d < 0.0 ? (cell - o) / d : std::numeric_limits<double>::infinity();
    };
    double tx = first(from.x, direction.x, i), ty = first(from.y, direction.y, j), tz = first(from.z, direction.z, k);
    const double ux = direction.x != 0.0 ? std::abs(1.0 / direction.x) : 0.0,
                 uy = direction.y != 0.0 ? std::abs(1.0 / direction.y) : 0.0,
                 uz = direction.z != 0.0 ? std::abs(1.0 / direction.z) : 0.0;
    const int si = direction.x > 0.0 ? 1 : -1, sj = direction.y > 0.0 ? 1 : -1, sk = direction.z > 0.0 ? 1 : -1;
    for (double t = enter; t < leave;) {
        const double next = std::min({tx, ty, tz, leave});
        if (!visit(i, j, k, next - t)) return;
        t = next;
        if (tx <= ty && tx <= tz) {
            i += si, tx += ux;
            if (i < 0 || i >= nx) return;
        } else if (ty <= tz) {
            j += sj, ty += uy;
            if (j < 0 || j >= ny) return;
        } else {
            k += sk, tz += uz;
            if (k < 0 || k >= nz) return;
        }
    }
}

}  // namespace

Baseline::Baseline(const W0Scene& scene, double reflectance) : reflectance_(reflectance) {
    const fire::FlameField& field = scene.flame();
    const render::RenderScene s = scene.scene();
    nx_ = field.grid.nx, ny_ = field.grid.ny, nz_ = kLayers;
    dx_m_ = field.grid.dx_m, dz_m_ = field.grid.dz_m;
    corner_m_ = field.grid.corner_m;
    voxel_K_ = dense_temperatures(field, nz_);
    ground_K_ = scene.surface().base_temperature_K;
    ground_grid_ = scene.surface().grid;
    origin_m_ = s.scene_origin_m;
    absorption_per_m_ = s.optics->flame_absorption_per_m.front();
    bands_ = s.optics->lambda_count;
    lowest_K_ = 300.0;
    for (int T_K = 300; T_K <= 1110; ++T_K) {
        for (const double lambda : s.optics->lambda_um)
            planck_.push_back(static_cast<float>(radiometry::planck_radiance(lambda, T_K)));
    }
}

void Baseline::add_planck(float temperature_K, float weight, float* radiance) const {
    const double place = temperature_K - lowest_K_;
    const int row = static_cast<int>(place);
    const float f = static_cast<float>(place - row), low = weight * (1.0F - f), high = weight * f;
    const float* a = planck_.data() + static_cast<std::ptrdiff_t>(row) * bands_;
    const float* b = a + bands_;
    for (int i = 0; i < bands_; ++i) radiance[i] += low * a[i] + high * b[i];
}

float Baseline::march(Vec3 from_m, Vec3 direction, float* radiance) const {
    const Vec3 from = from_m - corner_m_;
    float tau = 1.0F;
    traverse({from.x / dx_m_, from.y / dx_m_, from.z / dz_m_},
             {direction.x / dx_m_, direction.y / dx_m_, direction.z / dz_m_}, nx_, ny_, nz_, 1e9,
             [&](int i, int j, int k, double length_m) {
                 const float T_K =
                     voxel_K_[(static_cast<std::size_t>(k) * static_cast<std::size_t>(ny_) + static_cast<std::size_t>(j)) *
                                  static_cast<std::size_t>(nx_) +
                              static_cast<std::size_t>(i)];
                 if (T_K == 0.0F) return true;
                 const float through = std::exp(static_cast<float>(-absorption_per_m_ * length_m));
                 add_planck(T_K, tau * (1.0F - through), radiance);
                 tau *= through;
                 return tau > 1e-5F;
             });
    return tau;
}

std::vector<float> Baseline::cell_irradiance(int count) const {
    const int across = static_cast<int>(std::lround(std::sqrt(count)));
    std::vector<Vec3> directions;
    for (int n = 0; n < count; ++n) {  // strata of (sin^2 elevation, azimuth)
        const double s = (n / across + 0.5) / across, azimuth = 2.0 * kPi * (n % across + s) / across;
        directions.push_back({std::sqrt(1.0 - s) * std::cos(azimuth), std::sqrt(1.0 - s) * std::sin(azimuth), std::sqrt(s)});
    }
    std::vector<float> irradiance(ground_grid_.size() * static_cast<std::size_t>(bands_), 0.0F);
    for (int row = 0; row < ground_grid_.rows; ++row) {
        for (int col = 0; col < ground_grid_.cols; ++col) {
            float* out = irradiance.data() + ground_grid_.index(row, col) * static_cast<std::size_t>(bands_);
            const Vec3 at{ground_grid_.x_centre_m(col) - origin_m_.x, ground_grid_.y_centre_m(row) - origin_m_.y, 1e-3};
            for (const Vec3& direction : directions) march(at, direction, out);
            for (int b = 0; b < bands_; ++b) out[b] *= static_cast<float>(kPi / count);
        }
    }
    return irradiance;
}

BaselineResult Baseline::render(const W0Camera& camera, int directions) const {
    BaselineResult result{camera.samples, camera.lines, bands_, {}};
    const std::size_t plane = static_cast<std::size_t>(camera.samples) * static_cast<std::size_t>(camera.lines);
    result.radiance_W_m2_sr_um.resize(plane * static_cast<std::size_t>(bands_));
    const std::vector<float> irradiance = directions > 0 ? cell_irradiance(directions) : std::vector<float>();
    constexpr int kTile = 64;
    std::vector<float> tile(static_cast<std::size_t>(kTile * bands_));
    const auto emissivity = static_cast<float>(1.0 - reflectance_), per_pi = static_cast<float>(reflectance_ / kPi);
    for (int line = 0; line < camera.lines; ++line) {
        for (int first = 0; first < camera.samples; first += kTile) {
            const int count = std::min(kTile, camera.samples - first);
            std::fill(tile.begin(), tile.end(), 0.0F);
            for (int p = 0; p < count; ++p) {
                float* radiance = tile.data() + static_cast<std::ptrdiff_t>(p) * bands_;
                const render::SceneRay ray = camera.ray(line, first + p);
                const Vec3 direction = normalized(ray.end_m - ray.start_m);
                const float tau = march(ray.start_m, direction, radiance);
                const Vec3 ground = ray.start_m - (ray.start_m.z / direction.z) * direction;
                const std::size_t cell = ground_grid_.index(static_cast<int>(ground_grid_.row_at(ground.y + origin_m_.y)),
                                                            static_cast<int>(ground_grid_.col_at(ground.x + origin_m_.x)));
                add_planck(ground_K_[cell], tau * emissivity, radiance);
                if (directions > 0) {
                    const float* light = irradiance.data() + cell * static_cast<std::size_t>(bands_);
                    for (int b = 0; b < bands_; ++b) radiance[b] += tau * per_pi * light[b];
                }
            }
            for (int b = 0; b < bands_; ++b) {
                float* out = result.radiance_W_m2_sr_um.data() + static_cast<std::size_t>(b) * plane +
                             static_cast<std::size_t>(line) * static_cast<std::size_t>(camera.samples) +
                             static_cast<std::size_t>(first);
                for (int p = 0; p < count; ++p) out[p] = tile[static_cast<std::size_t>(p * bands_ + b)];
            }
        }
    }
    return result;
}

ExactMarch::ExactMarch(const W0Scene& scene, double reflectance)
    : scene_(&scene),
      reflectance_(reflectance),
      voxel_K_(dense_temperatures(scene.flame(), kLayers * scene.voxel_split())) {}

double ExactMarch::radiance(const render::SceneRay& ray, double lambda_um) const {
    const fire::VoxelGrid& g = scene_->flame().grid;
    const Vec3 direction = normalized(ray.end_m - ray.start_m), from = ray.start_m - g.corner_m;
    const double absorption_per_m = scene_->scene().optics->flame_absorption_per_m.front();
    double tau = 1.0, radiance = 0.0;
    traverse({from.x / g.dx_m, from.y / g.dy_m, from.z / g.dz_m},
             {direction.x / g.dx_m, direction.y / g.dy_m, direction.z / g.dz_m}, g.nx, g.ny, kLayers * scene_->voxel_split(),
             1e9, [&](int i, int j, int k, double length_m) {
                 const float T_K = voxel_K_[static_cast<std::size_t>((k * g.ny + j) * g.nx + i)];
                 if (T_K == 0.0F) return true;
                 const double opacity = -std::expm1(-absorption_per_m * length_m);
                 radiance += tau * opacity * radiometry::planck_radiance(lambda_um, T_K);
                 tau *= 1.0 - opacity;
                 return true;
             });
    const Vec3 ground = ray.start_m - (ray.start_m.z / direction.z) * direction + scene_->scene().scene_origin_m;
    const MapGrid& grid = scene_->surface().grid;
    const std::size_t cell = grid.index(static_cast<int>(grid.row_at(ground.y)), static_cast<int>(grid.col_at(ground.x)));
    return radiance +
           tau * (1.0 - reflectance_) * radiometry::planck_radiance(lambda_um, scene_->surface().base_temperature_K[cell]);
}

}  // namespace pyroscene::bench
