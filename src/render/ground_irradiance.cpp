#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "render/ground_mix.h"
#include "render/parallel.h"
#include "render/receiver_light.h"
#include "render/scene.h"
#include "render/scene_tables.h"

namespace pyroscene::render {
namespace {

constexpr int kSkylinePlanes = 16;

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

Receiver receiver_at(const RenderScene& scene, std::size_t cell) {
    const MapGrid& grid = scene.terrain->grid();
    const int row = static_cast<int>(cell / static_cast<std::size_t>(grid.cols));
    const int col = static_cast<int>(cell % static_cast<std::size_t>(grid.cols));
    Receiver receiver;
    receiver.x_m = grid.x_centre_m(col) - scene.scene_origin_m.x;
    receiver.y_m = grid.y_centre_m(row) - scene.scene_origin_m.y;
    const double half_m = 0.499 * grid.cell_m;
    const auto height = [&](double dx, double dy) { return scene.terrain->height_at(receiver.x_m + dx, receiver.y_m + dy); };
    receiver.normal = normalized(Vec3{(height(-half_m, 0.0) - height(half_m, 0.0)) / (2.0 * half_m),
                                      (height(0.0, -half_m) - height(0.0, half_m)) / (2.0 * half_m), 1.0});
    return receiver;
}

/// From what a receiver sees to its irradiances on the transport grid. One per thread.
class RowWriter {
public:
    RowWriter(const LightScene& shared, const SceneTables& tables)
        : shared_(&shared),
          tables_(&tables),
          kernels_(&spectral_kernels()),
          light_(shared),
          mix_(tables),
          terrain_(tables.stride),
          through_(static_cast<std::size_t>(tables.stride)),
          opacity_(through_.size()),
          of_moment_(through_.size()) {}

    void write(const Receiver& receiver, std::size_t row, GroundIrradiance& out) {
        light_.compute(receiver);
        float* flame = out.irradiance_W_m2_um.data() + row * static_cast<std::size_t>(out.stride);
        sum_flame(flame);
        for (std::size_t l = 0; l < through_.size(); ++l) through_[l] = 1.0F - opacity_[l] / static_cast<float>(kPi);
        const radiometry::ViewAtmosphere& air = *shared_->scene.atmosphere;
        const auto n = static_cast<std::size_t>(out.lambda_count);
        if (!out.sky_irradiance_W_m2_um.empty()) {
            float* sky = out.sky_irradiance_W_m2_um.data() + row * static_cast<std::size_t>(out.stride);
            for (std::size_t l = 0; l < n; ++l) sky[l] = through_[l] * air.diffuse_irradiance_W_m2_um[l];
        }
        if (out.thermal_irradiance_W_m2_um.empty()) return;
        const double open = 1.0 - (shared_->rough ? look_at_terrain(receiver) : 0.0) / kPi;
        float* thermal = out.thermal_irradiance_W_m2_um.data() + row * static_cast<std::size_t>(out.stride);
        const float* emission = terrain_.part(GroundSpectra::Emission);
        const float* reflection = terrain_.part(GroundSpectra::ThermalSky);
        for (std::size_t l = 0; l < n; ++l) {
            thermal[l] =
                through_[l] * (static_cast<float>(open) * air.thermal_irradiance_W_m2_um[l] + emission[l] + reflection[l]);
        }
    }

private:
    /// Irradiance by flames, and their opacity [sr], from the moments of their emission at the absorption nodes.
    void sum_flame(float* irradiance) {
        const int moments = shared_->planck.moments();
        const float* emitted = light_.emitted().data();
        const std::span<float> lambdas(of_moment_.data(), static_cast<std::size_t>(tables_->lambdas));
        shared_->nodes.interpolate(emitted, moments, {opacity_.data(), lambdas.size()});
        if (std::all_of(opacity_.begin(), opacity_.end(), [](float o) { return o == 0.0F; })) return;
        for (int m = 0; m < moments; ++m) {
            shared_->nodes.interpolate(emitted + m, moments, lambdas);
            kernels_->add_product(tables_->stride, 1.0F, of_moment_.data(), shared_->planck.row(m), irradiance);
        }
        // Where only much colder flame than the hottest is seen, the series may err to below zero at short wavelengths.
        for (std::size_t l = 0; l < lambdas.size(); ++l) irradiance[l] = std::max(irradiance[l], 0.0F);
    }

    /// First order light of the slopes that hide the sky: their own emission and the open sky they reflect.
    double look_at_terrain(const Receiver& receiver) {
        const RenderScene& scene = shared_->scene;
        const TerrainMesh& terrain = *scene.terrain;
        terrain_.clear();
        double seen_sr = 0.0;
        light_.hidden_by_terrain(receiver, kSkylinePlanes, [&](Vec3 direction, double weight_sr) {
            const Vec3 from{receiver.x_m, receiver.y_m, terrain.height_at(receiver.x_m, receiver.y_m) + 0.1};
            const auto hit = terrain.intersect(from, from + 4.0 * shared_->settings.reach_m * direction);
            if (!hit) return;
            const GroundCell ground = ground_cell(scene, *tables_, hit->point_m);
            if (!(ground.base_K > 0.0)) return;
            add_ground(*tables_, ground, weight_sr, {}, mix_);
            seen_sr += weight_sr;
        });
        mix_.resolve(nullptr, terrain_);
        return seen_sr;
    }

    const LightScene* shared_;
    const SceneTables* tables_;
    const SpectralKernels* kernels_;
    ReceiverLight light_;
    GroundMix mix_;
    GroundSpectra terrain_;
    std::vector<float> through_, opacity_, of_moment_;
};

}  // namespace

GroundIrradiance ground_irradiance(const RenderScene& scene, const GroundLightSettings& settings, const Monitor& monitor) {
    check_scene(scene);
    if (settings.directions < 4 || !(settings.reach_m > 0.0)) {
        throw input_error("ground light", "directions must be at least 4 and reach_m above 0");
    }
    const SceneTables tables(scene);
    GroundIrradiance light;
    light.grid = scene.terrain->grid();
    light.lambda_count = tables.lambdas;
    light.stride = tables.stride;
    if (scene.flame->empty()) {
        light.row_of_cell.assign(light.grid.size(), -1);
        return light;
    }
    const LightScene shared(scene, settings);
    const std::vector<std::size_t> cells = receivers(shared, light);
    const std::size_t values = cells.size() * static_cast<std::size_t>(light.stride);
    light.irradiance_W_m2_um.resize(values);
    if (tables.has_sky) light.sky_irradiance_W_m2_um.resize(values);
    if (tables.has_thermal_sky || shared.rough) light.thermal_irradiance_W_m2_um.resize(values);

    constexpr std::size_t kCellsPerTask = 32;
    tbb::enumerable_thread_specific<RowWriter> writers([&] { return RowWriter(shared, tables); });
    Progress progress(monitor, static_cast<int>((cells.size() + kCellsPerTask - 1) / kCellsPerTask));
    tbb::parallel_for(std::size_t{0}, (cells.size() + kCellsPerTask - 1) / kCellsPerTask, [&](std::size_t task) {
        progress.stop_if_cancelled();
        RowWriter& writer = writers.local();
        const std::size_t end = std::min((task + 1) * kCellsPerTask, cells.size());
        for (std::size_t row = task * kCellsPerTask; row < end; ++row)
            writer.write(receiver_at(scene, cells[row]), row, light);
        progress.advance();
    });
    return light;
}

}  // namespace pyroscene::render
