#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "base/error.h"
#include "render/parallel.h"
#include "render/point_sources.h"
#include "render/row_writer.h"
#include "render/scene.h"
#include "render/scene_tables.h"

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

void write_rows(const LightScene& shared, const SceneTables& tables, const PointSources* points, const FlameColumns* plume,
                const std::vector<std::size_t>& cells, const std::vector<std::vector<LatticeReceiver>>& waves, Rows& rows,
                const Monitor& monitor) {
    constexpr std::size_t kCellsPerTask = 32;
    const auto tasks_of = [](const auto& wave) { return (wave.size() + kCellsPerTask - 1) / kCellsPerTask; };
    std::size_t tasks = 0;
    for (const auto& wave : waves) tasks += tasks_of(wave);
    tbb::enumerable_thread_specific<RowWriter> writers([&] { return RowWriter(shared, tables, points, plume); });
    Progress progress(monitor, static_cast<int>(tasks));
    for (const auto& wave : waves) {
        tbb::parallel_for(std::size_t{0}, tasks_of(wave), [&](std::size_t task) {
            progress.stop_if_cancelled();
            RowWriter& writer = writers.local();
            const std::size_t end = std::min((task + 1) * kCellsPerTask, wave.size());
            for (std::size_t i = task * kCellsPerTask; i < end; ++i)
                writer.write(receiver_at(shared.scene, cells[static_cast<std::size_t>(wave[i].row)]), wave[i], rows);
            progress.advance();
        });
    }
}

/// Reflections beyond the first look, for each kind of light. The first look took for granted that slopes in view receive
/// the whole open sky and no flame light.
void add_bounces(const LightScene& shared, const SceneTables& tables, const std::vector<std::size_t>& cells, Rows& rows) {
    const GroundLightSettings& settings = shared.settings;
    if (rows.through.empty() || settings.bounces < 2) return;
    std::vector<float> between;
    const auto reflect = [&](std::vector<float>& irradiance, const SceneTables::Rows* granted) {
        if (irradiance.empty()) return;
        std::vector<float> change = irradiance;
        const auto stride = static_cast<std::size_t>(rows.light.stride);
        for (std::size_t row = 0; granted != nullptr && row < cells.size(); ++row) {
            const Receiver receiver = receiver_at(shared.scene, cells[row]);
            const GroundLevel level = tables.level_at(shared.scene.terrain->height_at(receiver.x_m, receiver.y_m));
            const float* sky = tables.at_level(*granted, level, between);
            for (std::size_t l = 0; l < stride; ++l) change[row * stride + l] -= sky[l];
        }
        reflect_between_slopes(tables, rows.patches, rows.through, settings.bounces, settings.decay, irradiance, change);
    };
    reflect(rows.light.irradiance_W_m2_um, nullptr);
    reflect(rows.light.sky_irradiance_W_m2_um, &tables.sky_irradiance);
    reflect(rows.light.thermal_irradiance_W_m2_um, &tables.thermal_sky_irradiance);
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
            RowWriter(which == 0 ? shared : finer, tables, nullptr, nullptr).flame(receiver, irradiance.data());
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
        if (rough) light.sky_view = scene.terrain->sky_view();
        return light;
    }
    const LightScene shared(scene, settings);
    const std::vector<std::size_t> cells = receivers(shared, light);
    if (rough) light.sky_view = scene.terrain->sky_view();
    const std::size_t values = cells.size() * static_cast<std::size_t>(light.stride);
    light.irradiance_W_m2_um.resize(values);
    if (tables.has_sky) light.sky_irradiance_W_m2_um.resize(values);
    if (tables.has_thermal_sky || rough || has_plume(scene)) light.thermal_irradiance_W_m2_um.resize(values);
    std::optional<PointSources> points;
    if (settings.flames == GroundLightSettings::Flames::PointSources)
        points.emplace(scene, tables, settings.point_source_cut, settings.reach_m);
    const std::optional<SmokeShadow> smoke = has_plume(scene) ? std::optional<SmokeShadow>(scene) : std::nullopt;
    Rows rows{light, {}, {}, {}, smoke ? &*smoke : nullptr};
    if (rough) rows.patches.resize(cells.size());
    if (rough && settings.bounces > 1) rows.through.resize(values);

    std::vector<std::vector<LatticeReceiver>> waves;
    if (!rough && !points) {
        rows.opacity.resize(values);
        waves = receiver_waves(light, shared.flame, scene.scene_origin_m);
    } else {
        waves.emplace_back(cells.size());
        for (std::size_t row = 0; row < cells.size(); ++row) waves[0][row].row = static_cast<std::int32_t>(row);
    }
    const std::optional<FlameColumns> plume = has_plume(scene) ? std::optional<FlameColumns>(*scene.plume) : std::nullopt;
    write_rows(shared, tables, points ? &*points : nullptr, plume ? &*plume : nullptr, cells, waves, rows, monitor);
    add_bounces(shared, tables, cells, rows);
    if (settings.estimate_error && !points) light.sampling_error = sampling_error(shared, tables, cells);
    return light;
}

}  // namespace pyroscene::render
