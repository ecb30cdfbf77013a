#include "inputs/fuel_cells.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "gis/raster_input.h"

namespace pyroscene::inputs {
namespace {

using scenario::FuelSource;

constexpr int kNoCode = -32768;

int first_band(const scenario::RasterSource& source) { return source.bands.empty() ? 1 : source.bands.front(); }

}  // namespace

spread::FuelModels fuel_models(const FuelSource& source) {
    spread::FuelModels models;
    const bool shipped = scenario::is_shipped_fuel_table(source.table);
    if (!shipped) models = spread::read_fuel_models(source.table);
    for (const auto& [number, model] : spread::standard_fuel_models())
        if (shipped && scenario::in_shipped_fuel_table(source.table, number)) models[number] = model;
    if (source.custom)
        for (const auto& [number, model] : spread::read_fuel_models(*source.custom)) models[number] = model;
    return models;
}

Raster<std::uint16_t> fuel_of_cells(const FuelSource& source, const spread::FuelModels& models, const MapGrid& grid) {
    std::set<int> bare(source.nonburnable.begin(), source.nonburnable.end());
    if (source.table.starts_with("fbfm"))
        bare.insert(spread::nonburnable_codes().begin(), spread::nonburnable_codes().end());
    const auto codes = gis::read_classes(source.raster.files.front(), first_band(source.raster), grid, kNoCode);
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
        throw input_error(source.raster.files.front().string(),
                          fmt::format("band {} holds fuel codes that table '{}' does not have: {}; give their models in "
                                      "'custom' of the fuel or list them in its 'nonburnable'",
                                      first_band(source.raster), source.table, fmt::join(unknown, ", ")));
    return fuel;
}

void add_fuel(ModelledFire& fire, const Raster<std::uint16_t>& fuel, const spread::FuelModels& models,
              double coarse_burn_time_s, const std::function<double(std::size_t, double)>& moisture) {
    const MapGrid& grid = fuel.grid;
    std::map<int, std::uint8_t> kinds;
    fire.fuel_load_kg_m2 = Raster<float>(grid, "fuel_load", "kg m-2");
    fire.ground.heat_J_m2 = Raster<float>(grid, "heat", "J m-2");
    fire.ground.kind = Raster<std::uint8_t>(grid, "burn_out", "1");
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (fuel.values[i] == 0) continue;
        const auto& model = models.at(fuel.values[i]);
        fire.fuel_load_kg_m2.values[i] = static_cast<float>(model.total_load_kg_m2());
        const double arrival_s = fire.ground.arrival_time_s.values[i];
        if (std::isnan(arrival_s)) continue;
        fire.ground.heat_J_m2.values[i] =
            static_cast<float>(model.total_load_kg_m2() * fire::sensible_heat_J_kg(moisture(i, arrival_s)));
        auto known = kinds.find(model.number);
        if (known == kinds.end()) {
            if (kinds.size() > std::numeric_limits<std::uint8_t>::max())
                throw input_error("fuel", "more than 256 fuel models burn; expected fewer");
            known = kinds.emplace(model.number, static_cast<std::uint8_t>(kinds.size())).first;
            fire.ground.burn_out.push_back(spread::burn_out_of(model, coarse_burn_time_s));
        }
        fire.ground.kind.values[i] = known->second;
    }
    if (fire.ground.burn_out.empty()) fire.ground.burn_out.emplace_back();  // nothing of it burns
}

std::vector<std::filesystem::path> files_of(const FuelSource& source) {
    std::vector<std::filesystem::path> files = source.raster.files;
    if (!source.table.starts_with("fbfm")) files.emplace_back(source.table);
    if (source.custom) files.push_back(*source.custom);
    return files;
}

}  // namespace pyroscene::inputs
