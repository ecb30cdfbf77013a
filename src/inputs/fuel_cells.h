#pragma once

#include <cstdint>
#include <functional>

#include "inputs/modelled_fire.h"
#include "scenario/fuel_source.h"
#include "spread/fuel_model.h"

namespace pyroscene::inputs {

/// The fuel models that a scenario's fuel may name.
spread::FuelModels fuel_models(const scenario::FuelSource& source);

/// Codes of the fuel raster as numbers of models, 0 where nothing burns. Throws an input error that lists codes of no table.
Raster<std::uint16_t> fuel_of_cells(const scenario::FuelSource& source, const spread::FuelModels& models,
                                    const MapGrid& grid);

/// Fills in what burns where the fire comes (its arrival times must be set): the load of the fuel model of each cell, its heat, and how
/// it burns out. \param moisture  of 1-h fuel in a cell at a time, water / dry mass
void add_fuel(ModelledFire& fire, const Raster<std::uint16_t>& fuel, const spread::FuelModels& models,
              double coarse_burn_time_s, const std::function<double(std::size_t cell, double time_s)>& moisture);

/// Files that a fuel names.
std::vector<std::filesystem::path> files_of(const scenario::FuelSource& source);

}  // namespace pyroscene::inputs
