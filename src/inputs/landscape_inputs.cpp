#include "inputs/landscape_inputs.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "gis/landscape.h"
#include "inputs/fuel_cells.h"

namespace pyroscene::inputs {
namespace {

std::vector<scenario::CanopySource*> canopies_of(scenario::Inputs& in) {
    std::vector<scenario::CanopySource*> canopies;
    if (in.spread) canopies.push_back(&in.spread->canopy);
    if (in.wind) canopies.push_back(&in.wind->canopy);
    return canopies;
}

/// The sources that name the landscape's file, by whichever key.
std::vector<scenario::RasterSource*> sources_of(scenario::Inputs& in) {
    std::vector<scenario::RasterSource*> sources{&in.terrain};
    if (in.cover) sources.push_back(&in.cover->raster);
    if (in.arrival_model) sources.push_back(&in.arrival_model->fuel.raster);
    if (in.spread) {
        sources.push_back(&in.spread->fuel.raster);
    }
    for (auto* canopy : canopies_of(in))
        for (auto* quantity : {&canopy->cover, &canopy->height_m})
            if (quantity->raster) sources.push_back(&*quantity->raster);
    return sources;
}

void check_codes(const scenario::LandscapeSource& source, const gis::Landscape& land, const spread::FuelModels& models) {
    std::set<int> unknown;
    for (const int code : land.fuel_codes)
        if (!models.contains(code) &&
            std::count(source.fuel.nonburnable.begin(), source.fuel.nonburnable.end(), code) == 0 &&
            !(scenario::is_shipped_fuel_table(source.fuel.table) && spread::nonburnable_codes().contains(code)))
            unknown.insert(code);
    if (!unknown.empty())
        throw input_error(source.file.string(),
                          fmt::format("band {} holds fuel codes that scheme '{}' does not have: {}; give their models in "
                                      "inputs.landscape.custom or list them in inputs.landscape.nonburnable",
                                      static_cast<int>(gis::kFuelModel), source.fuel.table, fmt::join(unknown, ", ")));
}

}  // namespace

scenario::Scenario with_landscape(scenario::Scenario s) {
    if (!s.inputs.landscape) return s;
    const auto& source = *s.inputs.landscape;
    const auto land = gis::open_landscape(source.file, source.crs);
    const auto models = fuel_models(source.fuel);
    check_codes(source, land, models);
    if (!land.slope_note.empty()) s.notes.push_back(fmt::format("{}: {}", source.file.string(), land.slope_note));
    auto& in = s.inputs;
    for (auto* canopy : canopies_of(in)) {
        if (!canopy->height_m.raster || canopy->height_m.raster->files.front() != source.file ||
            land.bands >= gis::kCanopyHeight)
            continue;
        *canopy = {};
        s.notes.push_back(fmt::format("{}: has no canopy height: its trees do not shelter the fuel", source.file.string()));
    }
    for (auto* raster : sources_of(in))
        if (raster->files.size() == 1 && raster->files.front() == source.file) raster->files = {land.raster};
    if (in.fuel_load || in.spread || in.arrival_model) return s;
    std::map<int, double> load_kg_m2;
    for (const auto& [number, model] : models) load_kg_m2[number] = model.total_load_kg_m2();
    in.fuel_load =
        scenario::RasterSource{.files = {gis::raster_of_codes(land, load_kg_m2, "kg m-2")}, .bands = {1}, .times_s = {}};
    s.notes.push_back("fuel load is that of the fuel models: all classes, dead and live, before the fire");
    return s;
}

}  // namespace pyroscene::inputs
