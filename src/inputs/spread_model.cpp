#include "inputs/spread_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "fire/gradients.h"
#include "gis/raster_input.h"
#include "gis/vector_input.h"
#include "inputs/fuel_cells.h"
#include "inputs/spread_weather.h"
#include "spread/landscape.h"

namespace pyroscene::inputs {
namespace {

using scenario::Scenario;
using scenario::ShapesSource;
using scenario::SpreadSource;
using spread::Field;

gis::Shapes shapes_of(const Scenario& scenario, const ShapesSource& source, const char* key, const MapGrid& grid) {
    if (source.file) return gis::read_shapes({*source.file, source.layer, source.crs}, grid);
    gis::Shapes shapes;
    shapes.points = source.points;
    if (!source.line.empty()) shapes.lines.push_back(source.line);
    if (!source.polygon.empty()) shapes.polygons.push_back({source.polygon});
    if (!source.crs.empty())
        gis::shapes_to_map(shapes, source.crs, grid,
                           fmt::format("{}:{}: inputs.spread.{}", scenario.path.string(), source.line_number, key));
    return shapes;
}

/// Seeds every quarter of a cell.
void seed_path(std::vector<spread::Seed>& seeds, const gis::Path& path, bool closed, const MapGrid& grid, double time_s) {
    constexpr double kPerCell = 4.0;
    const std::size_t edges = path.size() - (closed ? 0 : 1);
    for (std::size_t i = 0; i < edges; ++i) {
        const auto &a = path[i], &b = path[(i + 1) % path.size()];
        const int steps = 1 + static_cast<int>(kPerCell * std::hypot(b[0] - a[0], b[1] - a[1]) / grid.cell_m);
        for (int k = 0; k <= steps; ++k) {
            const double along = static_cast<double>(k) / steps;
            seeds.push_back({grid.col_at(std::lerp(a[0], b[0], along)), grid.row_at(std::lerp(a[1], b[1], along)), time_s});
        }
    }
}

std::vector<spread::Seed> seeds_of(const Scenario& scenario, const MapGrid& grid) {
    std::vector<spread::Seed> seeds;
    for (const auto& source : scenario.inputs.spread->ignition) {
        auto shapes = shapes_of(scenario, source, "ignition", grid);
        if (source.area && gis::close_lines(shapes, grid.cell_m) == 0)
            throw input_error(
                fmt::format("{}:{}: inputs.spread.ignition", scenario.path.string(), source.line_number),
                fmt::format("has no line that closes within {:g} m; without 'area' it burns as a line", grid.cell_m));
        for (const auto& p : shapes.points) seeds.push_back({grid.col_at(p[0]), grid.row_at(p[1]), source.time_s});
        for (const auto& line : shapes.lines) seed_path(seeds, line, false, grid, source.time_s);
        for (const auto& polygon : shapes.polygons)
            for (const auto& ring : polygon) seed_path(seeds, ring, true, grid, source.time_s);
        const auto inside = gis::cells_of(shapes, grid, false);
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col)
                if (inside.at(row, col) != 0) seeds.push_back({col + 0.5, row + 0.5, source.time_s});
    }
    std::erase_if(seeds, [&](const spread::Seed& s) {
        return !(s.col >= 0.0 && s.col < grid.cols && s.row >= 0.0 && s.row < grid.rows);
    });
    return seeds;
}

spread::Landscape landscape_of(const Scenario& scenario, const Raster<float>& terrain_m) {
    const auto& source = *scenario.inputs.spread;
    const MapGrid& grid = terrain_m.grid;
    spread::Landscape land;
    land.models = fuel_models(source.fuel);
    land.fuel = fuel_of_cells(source.fuel, land.models, grid);
    for (const auto& barrier : source.barriers) {
        const auto mask = gis::cells_of(shapes_of(scenario, barrier, "barriers", grid), grid, true);
        for (std::size_t i = 0; i < mask.values.size(); ++i)
            if (mask.values[i] != 0) land.fuel.values[i] = 0;
    }
    auto slope = fire::terrain_slope(terrain_m);
    land.slope_east = std::move(slope.east);
    land.slope_north = std::move(slope.north);
    land.canopy_cover = field_of(source.canopy.cover, "canopy cover", "1", grid);
    land.canopy_height_m = field_of(source.canopy.height_m, "canopy height", "m", grid);
    land.crown_ratio = {source.canopy.crown_ratio};
    return land;
}

}  // namespace

ModelledFire spread_own_fire(const Scenario& scenario, const Raster<float>& terrain_m, const WindLevels* levels,
                             const std::function<void(double)>& on_progress) {
    const auto& source = *scenario.inputs.spread;
    const auto land = landscape_of(scenario, terrain_m);
    const auto seeds = seeds_of(scenario, terrain_m.grid);
    const auto subject = fmt::format("{}:{}: inputs.spread.ignition", scenario.path.string(),
                                     source.ignition.empty() ? source.line : source.ignition.front().line_number);
    if (seeds.empty()) throw input_error(subject, "lies outside the map; expected a place on it");
    const auto weather = spread_weather(scenario, terrain_m.grid, levels);
    auto spread = spread::spread_fire(land, weather, source.rules, seeds, source.frames.times_s.back(), on_progress);
    const auto& arrival = spread.arrival_time_s.values;
    if (std::all_of(arrival.begin(), arrival.end(), [](float t) { return std::isnan(t); }))
        throw input_error(subject, "lights nothing: there is no fuel that burns, it is too wet, or the end comes before it");
    ModelledFire fire;
    fire.ground.arrival_time_s = std::move(spread.arrival_time_s);
    fire.spread_rate_m_s = std::move(spread.spread_rate_m_s);
    fire.fireline_intensity_W_m = std::move(spread.fireline_intensity_W_m);
    fire.flame_length_m = std::move(spread.flame_length_m);
    fire.cells_with_limited_wind = spread.cells_with_limited_wind;
    fire.frames_s = source.frames.times_s;
    fire.mean_over_s = source.frames.mean_over_s;
    std::vector<double> times_s;
    for (const auto& w : weather) times_s.push_back(w.from_s);
    add_fuel(fire, land.fuel, land.models, source.frames.coarse_burn_time_s, [&](std::size_t cell, double time_s) {
        return weather[holding(times_s, time_s)].moisture[spread::kOneHour].at(cell);
    });
    return fire;
}

std::vector<std::filesystem::path> spread_files(const SpreadSource& source) {
    auto files = files_of(source.fuel);
    const auto add = [&](const std::optional<std::filesystem::path>& file) {
        if (file) files.push_back(*file);
    };
    const auto add_raster = [&](const scenario::QuantitySource& quantity) {
        if (quantity.raster) files.insert(files.end(), quantity.raster->files.begin(), quantity.raster->files.end());
    };
    add(source.moisture_table);
    for (const auto& shapes : source.ignition) add(shapes.file);
    for (const auto& shapes : source.barriers) add(shapes.file);
    if (const auto& moisture = source.moisture_raster)
        files.insert(files.end(), moisture->files.begin(), moisture->files.end());
    add_raster(source.canopy.cover);
    add_raster(source.canopy.height_m);
    return files;
}

}  // namespace pyroscene::inputs
