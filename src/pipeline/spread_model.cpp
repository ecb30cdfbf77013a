#include "pipeline/spread_model.h"

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
#include "pipeline/spread_weather.h"
#include "spread/landscape.h"

namespace pyroscene::pipeline {
namespace {

using scenario::QuantitySource;
using scenario::Scenario;
using scenario::ShapesSource;
using scenario::SpreadSource;
using spread::Field;

constexpr int kNoCode = -32768;
int first_band(const scenario::RasterSource& source) { return source.bands.empty() ? 1 : source.bands.front(); }

spread::FuelModels fuel_models(const SpreadSource& source) {
    constexpr int kLastAndersonModel = 13;
    spread::FuelModels models;
    const bool shipped = source.table == "fbfm13" || source.table == "fbfm40" || source.table == "fbfm53";
    if (!shipped) models = spread::read_fuel_models(source.table);
    for (const auto& [number, model] : spread::standard_fuel_models())
        if (source.table == "fbfm53" || (shipped && (number <= kLastAndersonModel) == (source.table == "fbfm13")))
            models[number] = model;
    if (source.custom)
        for (const auto& [number, model] : spread::read_fuel_models(*source.custom)) models[number] = model;
    return models;
}

/// Codes of the fuel raster as numbers of models, 0 where nothing burns.
Raster<std::uint16_t> fuel_of_cells(const SpreadSource& source, const spread::FuelModels& models, const MapGrid& grid) {
    std::set<int> bare(source.nonburnable.begin(), source.nonburnable.end());
    if (source.table.starts_with("fbfm"))
        bare.insert(spread::nonburnable_codes().begin(), spread::nonburnable_codes().end());
    const auto codes = gis::read_classes(source.fuel.files.front(), first_band(source.fuel), grid, kNoCode);
    Raster<std::uint16_t> fuel(grid, "fuel", "1");
    std::set<int> unknown;
    for (std::size_t i = 0; i < codes.values.size(); ++i) {
        const int code = codes.values[i];
        if (code == kNoCode || bare.contains(code)) continue;
        if (models.contains(code))
            fuel.values[i] = static_cast<std::uint16_t>(code);
        else
            unknown.insert(code);
    }
    if (!unknown.empty())
        throw input_error(source.fuel.files.front().string(),
                          fmt::format("band {} holds fuel codes that table '{}' does not have: {}; give their models in "
                                      "inputs.spread.fuel.custom or list them in inputs.spread.fuel.nonburnable",
                                      first_band(source.fuel), source.table, fmt::join(unknown, ", ")));
    return fuel;
}

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
        const auto shapes = shapes_of(scenario, source, "ignition", grid);
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

Field static_field(const QuantitySource& source, const char* name, const char* unit, const MapGrid& grid) {
    if (!source.raster) return {source.value};
    // With a scale the values have no unit of the file's but that of the key.
    auto raster = gis::read_band({source.raster->files.front(), first_band(*source.raster), gis::Resampling::Bilinear, name,
                                  source.scale == 1.0 ? unit : ""},
                                 grid);
    for (float& v : raster.values) v = static_cast<float>(v * source.scale);
    return compact_field(std::move(raster));
}

spread::Landscape landscape_of(const Scenario& scenario, const Raster<float>& terrain_m) {
    const auto& source = *scenario.inputs.spread;
    const MapGrid& grid = terrain_m.grid;
    spread::Landscape land;
    land.models = fuel_models(source);
    land.fuel = fuel_of_cells(source, land.models, grid);
    for (const auto& barrier : source.barriers) {
        const auto mask = gis::cells_of(shapes_of(scenario, barrier, "barriers", grid), grid, true);
        for (std::size_t i = 0; i < mask.values.size(); ++i)
            if (mask.values[i] != 0) land.fuel.values[i] = 0;
    }
    auto slope = fire::terrain_slope(terrain_m);
    land.slope_east = std::move(slope.east);
    land.slope_north = std::move(slope.north);
    land.canopy_cover = static_field(source.canopy_cover, "canopy cover", "1", grid);
    land.canopy_height_m = static_field(source.canopy_height_m, "canopy height", "m", grid);
    land.crown_ratio = {source.crown_ratio};
    return land;
}

/// What burns and how much heat it gives: the load of the fuel model with the moisture of its 1-h fuel when the fire comes.
void add_fuel(ModelledFire& fire, const spread::Landscape& land, const std::vector<spread::Weather>& weather,
              double coarse_burn_time_s) {
    const MapGrid& grid = land.fuel.grid;
    std::vector<double> times_s;
    for (const auto& w : weather) times_s.push_back(w.from_s);
    std::map<int, std::uint8_t> kinds;
    fire.fuel_load_kg_m2 = Raster<float>(grid, "fuel_load", "kg m-2");
    fire.ground.heat_J_m2 = Raster<float>(grid, "heat", "J m-2");
    fire.ground.kind = Raster<std::uint8_t>(grid, "burn_out", "1");
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const int number = land.fuel.values[i];
        if (number == 0) continue;
        const auto& model = land.models.at(number);
        fire.fuel_load_kg_m2.values[i] = static_cast<float>(model.total_load_kg_m2());
        const double arrival_s = fire.ground.arrival_time_s.values[i];
        if (std::isnan(arrival_s)) continue;
        const double moisture = weather[holding(times_s, arrival_s)].moisture[spread::kOneHour].at(i);
        fire.ground.heat_J_m2.values[i] = static_cast<float>(model.total_load_kg_m2() * fire::sensible_heat_J_kg(moisture));
        auto known = kinds.find(number);
        if (known == kinds.end()) {
            if (kinds.size() > std::numeric_limits<std::uint8_t>::max())
                throw input_error("inputs.spread.fuel", "more than 256 fuel models burn; expected fewer");
            known = kinds.emplace(number, static_cast<std::uint8_t>(kinds.size())).first;
            fire.ground.burn_out.push_back(spread::burn_out_of(model, coarse_burn_time_s));
        }
        fire.ground.kind.values[i] = known->second;
    }
}

}  // namespace

ModelledFire spread_own_fire(const Scenario& scenario, const Raster<float>& terrain_m,
                             const std::function<void(double)>& on_progress) {
    const auto& source = *scenario.inputs.spread;
    const auto land = landscape_of(scenario, terrain_m);
    const auto seeds = seeds_of(scenario, terrain_m.grid);
    const auto subject = fmt::format("{}:{}: inputs.spread.ignition", scenario.path.string(),
                                     source.ignition.empty() ? source.line : source.ignition.front().line_number);
    if (seeds.empty()) throw input_error(subject, "lies outside the map; expected a place on it");
    const auto weather = spread_weather(scenario, terrain_m.grid);
    auto spread = spread::spread_fire(land, weather, source.rules, seeds, source.frames_s.back(), on_progress);
    const auto& arrival = spread.arrival_time_s.values;
    if (std::all_of(arrival.begin(), arrival.end(), [](float t) { return std::isnan(t); }))
        throw input_error(subject, "lights nothing: there is no fuel that burns, it is too wet, or the end comes before it");
    ModelledFire fire;
    fire.ground.arrival_time_s = std::move(spread.arrival_time_s);
    fire.spread_rate_m_s = std::move(spread.spread_rate_m_s);
    fire.fireline_intensity_W_m = std::move(spread.fireline_intensity_W_m);
    fire.flame_length_m = std::move(spread.flame_length_m);
    fire.cells_with_limited_wind = spread.cells_with_limited_wind;
    fire.frames_s = source.frames_s;
    fire.mean_over_s = source.mean_over_s;
    add_fuel(fire, land, weather, source.coarse_burn_time_s);
    return fire;
}

std::vector<std::filesystem::path> spread_files(const SpreadSource& source) {
    std::vector<std::filesystem::path> files = source.fuel.files;
    const auto add = [&](const std::optional<std::filesystem::path>& file) {
        if (file) files.push_back(*file);
    };
    const auto add_raster = [&](const QuantitySource& quantity) {
        if (quantity.raster) files.insert(files.end(), quantity.raster->files.begin(), quantity.raster->files.end());
    };
    if (!source.table.starts_with("fbfm")) files.emplace_back(source.table);
    add(source.custom);
    add(source.moisture_table);
    for (const auto& shapes : source.ignition) add(shapes.file);
    for (const auto& shapes : source.barriers) add(shapes.file);
    if (const auto& moisture = source.moisture_raster)
        files.insert(files.end(), moisture->files.begin(), moisture->files.end());
    add_raster(source.canopy_cover);
    add_raster(source.canopy_height_m);
    return files;
}

}  // namespace pyroscene::pipeline
