#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "base/error.h"
#include "render/ground_mix.h"
#include "render/light_at.h"
#include "render/parallel.h"
#include "render/point_sources.h"
#include "render/receiver_light.h"
#include "render/scene.h"
#include "render/scene_tables.h"
#include "render/terrain_sight.h"

namespace pyroscene::render {
namespace {

constexpr double kRough_m = 1e-3;  ///< terrain that varies less is a horizontal plane

/// Cells whose centre lies within reach of any brick column's flames, in map order; they get rows 0, 1, 2, ...
std::vector<std::size_t> receivers(const LightScene& shared, GroundIrradiance& light) {
    const RenderScene& scene = shared.scene;
    const MapGrid& grid = light.grid;
    light.row_of_cell.assign(grid.size(), -1);
    const auto mark = [&](const FlameColumns::Box& box) {
        const double reach_m = shared.settings.reach_m;
        const auto clamped = [](double at, int n) { return std::clamp(static_cast<int>(at), 0, n - 1); };
        const double west = box.west_m + scene.scene_origin_m.x, east = box.east_m + scene.scene_origin_m.x;
        const double south = box.south_m + scene.scene_origin_m.y, north = box.north_m + scene.scene_origin_m.y;
        const int first_col = clamped(grid.col_at(west - reach_m), grid.cols),
                  last_col = clamped(grid.col_at(east + reach_m), grid.cols);
        const int first_row = clamped(grid.row_at(north + reach_m), grid.rows),
                  last_row = clamped(grid.row_at(south - reach_m), grid.rows);
        for (int r = first_row; r <= last_row; ++r) {
            const double y = grid.y_centre_m(r), gap_y = std::max({south - y, y - north, 0.0});
            for (int c = first_col; c <= last_col; ++c) {
                const double x = grid.x_centre_m(c), gap_x = std::max({west - x, x - east, 0.0});
                if (gap_x * gap_x + gap_y * gap_y <= reach_m * reach_m) light.row_of_cell[grid.index(r, c)] = 0;
            }
        }
    };
    for (const auto& box : shared.flame.boxes()) mark(box);
    std::vector<std::size_t> cells;
    for (std::size_t cell = 0; cell < light.row_of_cell.size(); ++cell) {
        if (light.row_of_cell[cell] < 0) continue;
        light.row_of_cell[cell] = static_cast<std::int32_t>(cells.size());
        cells.push_back(cell);
    }
    return cells;
}

/// What the rows of GroundIrradiance become: the first look in full, and what the reflections between slopes need.
struct Rows {
    GroundIrradiance& light;
    std::vector<std::vector<TerrainPatch>> patches;  ///< [row]; empty on a plane
    std::vector<float> through;                      ///< [row][lambda] share that flames let through; only with patches
    const SmokeShadow* smoke = nullptr;              ///< null without a plume
};

/// From what a receiver sees to its irradiances on the transport grid. One per thread.
class RowWriter {
public:
    RowWriter(const LightScene& shared, const SceneTables& tables, const PointSources* points)
        : shared_(&shared),
          points_(points),
          tables_(&tables),
          kernels_(&spectral_kernels()),
          light_(shared),
          mix_(tables),
          terrain_(tables.stride),
          smoky_sky_(tables),
          through_(static_cast<std::size_t>(tables.stride)),
          opacity_(through_.size()),
          of_moment_(through_.size()) {}

    /// Irradiance by flames alone; adds to `irradiance` and leaves their opacity for write().
    void flame(const Receiver& receiver, float* irradiance) {
        if (points_ != nullptr) return points_->add(shared_->scene, receiver, irradiance);
        light_.compute(receiver);
        sum_flame(irradiance);
    }

    void write(const Receiver& receiver, std::size_t row, Rows& out) {
        GroundIrradiance& light = out.light;
        const auto at = [&](std::vector<float>& values) {
            return values.data() + row * static_cast<std::size_t>(light.stride);
        };
        flame(receiver, at(light.irradiance_W_m2_um));
        for (std::size_t l = 0; l < through_.size(); ++l) through_[l] = 1.0F - opacity_[l] / static_cast<float>(kPi);
        if (!out.through.empty()) std::copy(through_.begin(), through_.end(), at(out.through));
        terrain_.clear();
        const double hidden_sr = shared_->rough ? look_at_terrain(receiver, light.row_of_cell, out.patches[row]) : 0.0;
        const auto open = static_cast<float>(1.0 - hidden_sr / kPi);
        const radiometry::ViewAtmosphere& air = *shared_->scene.atmosphere;
        const SmokeShade shade = out.smoke != nullptr ? out.smoke->at({receiver.x_m, receiver.y_m, 0.0}) : SmokeShade{};
        const bool smoky = shade.above > 0.0F || shade.to_sun > 0.0F;
        if (smoky) smoky_sky_.look_from(shade);
        const auto sum = [&](std::vector<float>& into, const std::vector<float>& whole, const float* a, const float* b,
                             bool thermal) {
            if (into.empty()) return;
            float* irradiance = at(into);
            const float* sky = whole.data();
            if (smoky) {
                const SmokeSpectra& smoke = tables_->smoke;
                dimmed_sky_.resize(through_.size());
                smoky_sky_.dim((thermal ? smoke.thermal_sky : smoke.sky).data(), thermal, dimmed_sky_.data());
                sky = dimmed_sky_.data();
            }
            for (std::size_t l = 0; l < static_cast<std::size_t>(light.lambda_count); ++l)
                irradiance[l] = through_[l] * (open * sky[l] + a[l] + b[l]);
        };
        sum(light.sky_irradiance_W_m2_um, air.diffuse_irradiance_W_m2_um, terrain_.part(GroundSpectra::Sun),
            terrain_.part(GroundSpectra::Sky), false);
        sum(light.thermal_irradiance_W_m2_um, air.thermal_irradiance_W_m2_um, terrain_.part(GroundSpectra::Emission),
            terrain_.part(GroundSpectra::ThermalSky), true);
    }

private:
    /// Irradiance by flames, and their opacity [sr], from the moments of their emission at the absorption nodes.
    void sum_flame(float* irradiance) {
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

    /// The slopes that hide the sky: fills `terrain_` with their own emission and what they reflect of sun and open sky,
    /// and `patches` with where they are. Returns the cosine-weighted solid angle that they fill.
    double look_at_terrain(const Receiver& receiver, const std::vector<std::int32_t>& row_of_cell,
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
            if (tables_->has_sun) light.sun_cosine = sun_cosine(scene, *hit);
            add_ground(*tables_, ground, weight_sr, light, mix_);
            seen_sr += weight_sr;
            const int col =
                std::clamp(static_cast<int>(grid.col_at(hit->point_m.x + scene.scene_origin_m.x)), 0, grid.cols - 1);
            const int row =
                std::clamp(static_cast<int>(grid.row_at(hit->point_m.y + scene.scene_origin_m.y)), 0, grid.rows - 1);
            patches.push_back({row_of_cell[grid.index(row, col)], ground.base_material, static_cast<float>(weight_sr)});
        });
        mix_.resolve(nullptr, terrain_);
        return seen_sr;
    }

    const LightScene* shared_;
    const PointSources* points_;  ///< null: hemisphere quadrature
    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    ReceiverLight light_;
    GroundMix mix_;
    GroundSpectra terrain_;
    SmokySky smoky_sky_;
    std::vector<float> through_, opacity_, of_moment_, dimmed_sky_;
};

/// Reflections beyond the first look, for each kind of light. The first look took for granted that slopes in view receive
/// the whole open sky and no flame light.
void add_bounces(const LightScene& shared, const SceneTables& tables, Rows& rows) {
    const GroundLightSettings& settings = shared.settings;
    if (rows.through.empty() || settings.bounces < 2) return;
    const radiometry::ViewAtmosphere& air = *shared.scene.atmosphere;
    const auto reflect = [&](std::vector<float>& irradiance, const std::vector<float>* granted) {
        if (irradiance.empty()) return;
        std::vector<float> change = irradiance;
        const auto stride = static_cast<std::size_t>(rows.light.stride);
        for (std::size_t i = 0; granted != nullptr && i < change.size(); ++i) {
            const std::size_t l = i % stride;
            if (l < granted->size()) change[i] -= (*granted)[l];
        }
        reflect_between_slopes(tables, rows.patches, rows.through, settings.bounces, settings.decay, irradiance, change);
    };
    reflect(rows.light.irradiance_W_m2_um, nullptr);
    reflect(rows.light.sky_irradiance_W_m2_um, &air.diffuse_irradiance_W_m2_um);
    reflect(rows.light.thermal_irradiance_W_m2_um, &air.thermal_irradiance_W_m2_um);
}

/// Compares direct flame light with that of twice as many directions at up to 128 receivers, evenly spread over the rows.
LightSamplingError sampling_error(const LightScene& shared, const SceneTables& tables,
                                  const std::vector<std::size_t>& cells) {
    constexpr std::size_t kReceivers = 128;
    const std::size_t step = std::max<std::size_t>(1, cells.size() / kReceivers);
    GroundLightSettings doubled = shared.settings;
    doubled.directions *= 2;
    const LightScene finer(shared.scene, doubled);
    const std::size_t count = (cells.size() + step - 1) / step;
    std::vector<std::array<double, 2>> sums(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Receiver receiver = receiver_at(shared.scene, cells[i * step]);
        std::vector<float> irradiance(static_cast<std::size_t>(tables.stride));
        for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
            std::fill(irradiance.begin(), irradiance.end(), 0.0F);
            RowWriter(which == 0 ? shared : finer, tables, nullptr).flame(receiver, irradiance.data());
            for (const float e : irradiance) sums[i][which] += static_cast<double>(e);
        }
    });
    LightSamplingError error;
    double total = 0.0, finer_total = 0.0, squares = 0.0, weights = 0.0;
    for (const auto& [coarse, fine] : sums) {
        total += coarse;
        finer_total += fine;
        if (!(fine > 0.0)) continue;
        ++error.receivers;
        squares += (coarse - fine) * (coarse - fine) / fine;
        weights += fine;
    }
    if (finer_total > 0.0) error.total_relative = total / finer_total - 1.0;
    if (weights > 0.0) error.rms_relative = std::sqrt(squares / weights);
    return error;
}

void check_settings(const GroundLightSettings& settings) {
    if (settings.directions < 4 || !(settings.reach_m > 0.0) || settings.bounces < 1 || settings.decay < 1 ||
        !(settings.point_source_cut >= 0.0)) {
        throw input_error("ground light",
                          "directions must be at least 4, reach_m above 0, bounces and decay at least 1, "
                          "point_source_cut not negative");
    }
}

}  // namespace

GroundIrradiance ground_irradiance(const RenderScene& scene, const GroundLightSettings& settings, const Monitor& monitor) {
    check_scene(scene);
    check_settings(settings);
    const SceneTables tables(scene);
    GroundIrradiance light;
    light.grid = scene.terrain->grid();
    light.lambda_count = tables.lambdas;
    light.stride = tables.stride;
    const auto [lowest_m, highest_m] = scene.terrain->height_range_m();
    const bool rough = highest_m - lowest_m > kRough_m;
    if (scene.flame->empty() || settings.flames == GroundLightSettings::Flames::None) {
        light.row_of_cell.assign(light.grid.size(), -1);
        if (rough) light.sky_view = std::make_shared<SkyView>(scene);
        return light;
    }
    const LightScene shared(scene, settings);
    const std::vector<std::size_t> cells = receivers(shared, light);
    if (rough) light.sky_view = std::make_shared<SkyView>(scene);
    const std::size_t values = cells.size() * static_cast<std::size_t>(light.stride);
    light.irradiance_W_m2_um.resize(values);
    if (tables.has_sky) light.sky_irradiance_W_m2_um.resize(values);
    if (tables.has_thermal_sky || rough || has_plume(scene)) light.thermal_irradiance_W_m2_um.resize(values);
    std::optional<PointSources> points;
    if (settings.flames == GroundLightSettings::Flames::PointSources)
        points.emplace(scene, tables, settings.point_source_cut, settings.reach_m);
    const std::optional<SmokeShadow> smoke = has_plume(scene) ? std::optional<SmokeShadow>(scene) : std::nullopt;
    Rows rows{light, {}, {}, smoke ? &*smoke : nullptr};
    if (rough) rows.patches.resize(cells.size());
    if (rough && settings.bounces > 1) rows.through.resize(values);

    constexpr std::size_t kCellsPerTask = 32;
    tbb::enumerable_thread_specific<RowWriter> writers(
        [&] { return RowWriter(shared, tables, points ? &*points : nullptr); });
    Progress progress(monitor, static_cast<int>((cells.size() + kCellsPerTask - 1) / kCellsPerTask));
    tbb::parallel_for(std::size_t{0}, (cells.size() + kCellsPerTask - 1) / kCellsPerTask, [&](std::size_t task) {
        progress.stop_if_cancelled();
        RowWriter& writer = writers.local();
        const std::size_t end = std::min((task + 1) * kCellsPerTask, cells.size());
        for (std::size_t row = task * kCellsPerTask; row < end; ++row)
            writer.write(receiver_at(scene, cells[row]), row, rows);
        progress.advance();
    });
    add_bounces(shared, tables, rows);
    if (settings.estimate_error && !points) light.sampling_error = sampling_error(shared, tables, cells);
    return light;
}

}  // namespace pyroscene::render
