#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gis/memory_raster.h"

/// Outputs of fire models that are no rasters, as rasters in memory: arrival times [s], NaN where the fire never came; heat fluxes [W m-2].
namespace pyroscene::gis {

/// Cell2Fire. Its cells have no place of their own: `like` is a raster of the same cells (its fuels.asc), numbered from 1 row by row from
/// the northwest. One of
///   messages: a CSV file of messages from cell, to cell, time, rate (with or without a line of names). A cell burns with the first
///             message to it; cells that send but never receive were lit at time 0.
///   grids:    ForestGridNN.csv, 0 or 1 for each cell at the end of period NN. A cell burns in the middle of the first period that ends
///             with it burnt, in grid 00 at time 0.
/// \param period_s  by which the times of messages, or the numbers of grids, are multiplied
/// Input errors: numbers that are none, a cell beyond the grid, a grid of another size, a fire that goes out, no fire.
std::filesystem::path cell2fire_messages(const std::filesystem::path& messages, const std::filesystem::path& like,
                                         double period_s);
std::filesystem::path cell2fire_grids(const std::vector<std::filesystem::path>& grids, const std::filesystem::path& like,
                                      double period_s);

/// The grid of a QUIC-Fire run.
struct QuicFireGrid {
    int cols = 0, rows = 0;
    double cell_m = 2.0;
    LocalPlacement place{};  ///< of the outer corner of the first cell
};
/// QUIC-Fire's mburnt_integ-TTTTT.bin, per cent of mass burnt at the time [s] in the name, one record of float32, x fastest, from the
/// south. A cell burns in the middle between the first file that shows it burning and the one before.
/// Input errors: a name without time, a record of another size, values outside 0 to 100, no fire.
std::filesystem::path quic_fire_arrival(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid);

/// Heat fluxes, a band for each moment.
struct FluxSeries {
    std::filesystem::path raster;
    std::vector<double> times_s;  ///< ascending, of the model's clock
};
/// Of QUIC-Fire, at the moments in the files' names [s]: surfEnergyTTTTT.bin, kW m-2, one record as above; or
/// fire-energy_to_atmos-TTTTT.bin, kW in each cell of all layers, from the ground up, summed and divided by the cell's area.
/// Input errors: names of neither, a record of another size, fluxes that are negative or above 1e5 kW m-2.
FluxSeries quic_fire_heat_flux(const std::vector<std::filesystem::path>& files, const QuicFireGrid& grid);

/// A quantity of FDS on the ground, by the index of a run (.smv): slices (.sf) with constant height or along the terrain, boundary
/// files on surfaces that face up (.bf) and on complex geometry (.be), of all meshes on one grid (fds_lattice.h); where several give a value
/// that of the finer mesh counts, of equal ones the smallest. Its last moment. Origin of FDS's coordinates at the placement. Level-set
/// runs write 'FIRE ARRIVAL TIME', above 9e5 s where the fire has not come.
/// \param labels  of the quantity; the first that the run has
/// Input errors: no such quantity (those found are listed), another unit, vertical slices alone, meshes at different times, missing files.
std::filesystem::path fds_ground_quantity(const std::filesystem::path& smv, const std::vector<std::string>& labels,
                                          const std::string& unit, const LocalPlacement& place);

/// Heat flux of FDS at all moments that it wrote: a quantity in kW/m2 on the ground as above, of equal ones the largest, per area of the
/// map where the ground slopes; or one in kW/m3 of slices that are volumes, summed over their height. Negative values are 0.
/// \param quantity  its label; empty = HRRPUA, else HRRPUV
FluxSeries fds_heat_flux(const std::filesystem::path& smv, const std::string& quantity, const LocalPlacement& place);
/// Labels that this quantity may have, in order.
std::vector<std::string> fds_flux_labels(const std::string& quantity);
/// Files of the first of the labels that a run has; none when it has none.
std::vector<std::filesystem::path> fds_files(const std::filesystem::path& smv, const std::vector<std::string>& labels);

}  // namespace pyroscene::gis
