#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

// Where FARSITE and LANDFIRE keep what (gis/landscape.h).
constexpr int kElevation = 1, kFuelModel = 4, kCanopyCover = 5, kCanopyHeight = 6;

RasterSource band_of(const LandscapeSource& landscape, int band, int line) {
    return {.files = {landscape.file}, .bands = {band}, .times_s = {}, .line = line};
}

}  // namespace

LandscapeSource read_landscape(const config::Node& node, const fs::path& folder) {
    LandscapeSource landscape;
    if (!node.is_map()) {
        node.finish();
        return landscape;
    }
    landscape.file = read_file_name(node.required_child("file"), folder);
    landscape.fuel.raster = band_of(landscape, kFuelModel, node.line());
    read_fuel_models(node, "scheme", folder, landscape.fuel);
    landscape.crs = node.text("crs", "");
    node.finish();
    return landscape;
}

void add_landscape(const LandscapeSource& landscape, Inputs& inputs) {
    const FuelSource& fuel = landscape.fuel;
    if (inputs.terrain.files.empty()) inputs.terrain = band_of(landscape, kElevation, fuel.raster.line);
    if (!inputs.cover && is_shipped_fuel_table(fuel.table)) inputs.cover = CoverSource{fuel.raster, fuel.table};
    if (inputs.arrival_model && inputs.arrival_model->fuel.raster.files.empty()) inputs.arrival_model->fuel = fuel;
    if (inputs.spread && inputs.spread->fuel.raster.files.empty()) inputs.spread->fuel = fuel;
    const auto add_trees = [&](CanopySource& canopy) {
        if (canopy.given) return;
        canopy.given = true;
        canopy.cover.raster = band_of(landscape, kCanopyCover, fuel.raster.line);
        canopy.height_m.raster = band_of(landscape, kCanopyHeight, fuel.raster.line);
    };
    if (inputs.spread) add_trees(inputs.spread->canopy);
    if (inputs.wind && inputs.wind->level && !inputs.spread) add_trees(inputs.wind->canopy);
}

}  // namespace pyroscene::scenario
