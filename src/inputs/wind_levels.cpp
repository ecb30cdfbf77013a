#include "inputs/wind_levels.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "gis/polar_wind.h"
#include "inputs/fuel_cells.h"
#include "inputs/spread_weather.h"

namespace pyroscene::inputs {
namespace {

constexpr float kWithoutFuel_m = 0.3048F;

/// The fuel that the scenario knows, whatever for.
std::optional<scenario::FuelSource> fuel_of(const scenario::Inputs& in) {
    if (in.spread) return in.spread->fuel;
    if (in.arrival_model) return in.arrival_model->fuel;
    if (in.landscape) return in.landscape->fuel;
    if (in.cover && scenario::is_shipped_fuel_table(in.cover->table))
        return scenario::FuelSource{in.cover->raster, in.cover->table, {}, {}};
    return std::nullopt;
}

Raster<float> fuel_depth_m(const scenario::Scenario& s, const MapGrid& grid) {
    Raster<float> depth(grid, "fuel depth", "m", kWithoutFuel_m);
    if (const auto& given = s.inputs.wind->fuel_depth_m) {
        std::fill(depth.values.begin(), depth.values.end(), static_cast<float>(*given));
        return depth;
    }
    const auto fuel = fuel_of(s.inputs);
    if (!fuel)
        throw input_error("inputs.wind",
                          "a wind at a height needs the depth of the fuel below it: give fuel_depth_m, or fuel models "
                          "(cover with a shipped table, landscape, spread, arrival_model)");
    const auto models = fuel_models(*fuel);
    const auto codes = fuel_of_cells(*fuel, models, grid);
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        if (codes.values[i] != 0) depth.values[i] = static_cast<float>(models.at(codes.values[i]).depth_m);
    return depth;
}

}  // namespace

std::optional<WindLevels> wind_levels(const scenario::Scenario& s, const MapGrid& grid) {
    if (!s.inputs.wind || !s.inputs.wind->level) return std::nullopt;
    const auto& wind = *s.inputs.wind;
    const auto& trees = wind.canopy.given || !s.inputs.spread ? wind.canopy : s.inputs.spread->canopy;
    const auto cover = field_of(trees.cover, "canopy cover", "1", grid),
               height_m = field_of(trees.height_m, "canopy height", "m", grid);
    const auto depth_m = fuel_depth_m(s, grid);
    const auto known = [](double v) { return std::isfinite(v) ? v : 0.0; };
    WindLevels levels{Raster<float>(grid, "wind at 20 ft", "1"), Raster<float>(grid, "midflame wind", "1")};
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const spread::Canopy canopy{known(cover.at(i)), known(height_m.at(i)), trees.crown_ratio};
        const double depth = depth_m.values[i];
        levels.to_twenty_feet.values[i] = static_cast<float>(spread::to_twenty_feet(*wind.level, depth, canopy));
        levels.to_midflame.values[i] = static_cast<float>(spread::wind_adjustment(depth, canopy));
    }
    return levels;
}

scenario::Scenario with_windninja(scenario::Scenario s) {
    if (!s.inputs.wind || !s.inputs.wind->windninja) return s;
    auto& wind = *s.inputs.wind;
    const auto& source = *wind.windninja;
    scenario::RasterSource components;
    for (std::size_t i = 0; i < source.speed.size(); ++i)
        components.files.push_back(
            gis::wind_components({source.speed[i], source.angle[i], source.unit, source.crs, source.grid_north}));
    components.bands = {1, 2};
    components.times_s = source.times_s;
    wind.raster = components;
    return s;
}

}  // namespace pyroscene::inputs
