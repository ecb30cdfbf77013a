#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "gis/memory_raster.h"

/// History files of WRF-SFIRE and WRF-Fire (wrfout_dNN_...) as ordinary rasters. Names, units and layout: WRF-SFIRE's
/// Registry/registry.fire and phys/module_fr_sfire_phys.F (openwfm/WRF-SFIRE, commit e2bb84f1).
namespace pyroscene::gis {

/// One record of a history file.
struct WrfMoment {
    std::filesystem::path file;
    int record = 0;       ///< from 0
    double unix_s = 0.0;  ///< of its `Times`
};

/// What a series of files is about. The fire grid refines every cell of the atmosphere's grid; both share their outer corner.
struct WrfSfire {
    std::vector<WrfMoment> moments;        ///< ascending, without repetition
    double simulation_start_unix_s = 0.0;  ///< TIGN_G counts from it
    std::string crs_wkt;                   ///< on WRF's sphere of 6370 km, or of the placement
    double west_m = 0.0, north_m = 0.0;    ///< outer corner
    double dx_m = 0.0, dy_m = 0.0;         ///< cell of the atmosphere
    int cols = 0, rows = 0;                ///< cells of the atmosphere
    int refine_x = 1, refine_y = 1;        ///< fire cells per cell of the atmosphere
    double placement_residual_m = 0.0;     ///< largest distance of XLONG, XLAT from the regular grid
    std::set<std::string> variables;       ///< in every file

    [[nodiscard]] bool has(const std::string& variable) const { return variables.count(variable) != 0; }
};

/// Opens files in any order. Map projections 1 (Lambert), 2 (polar), 3 (Mercator) from the files; the corner is the mean over
/// all cells of XLONG, XLAT, whose float32 scatter must not exceed twice its resolution. Projection 0 (idealised) takes the
/// placement. Input errors, naming the file: no fire grid, no `Times`, another grid or projection than the first file,
/// projection 6 or unknown, coordinates that do not fit the projection, placement missing (or given for a run with a map).
WrfSfire open_wrf_sfire(const std::vector<std::filesystem::path>& files, const std::optional<LocalPlacement>& placement);

/// One band of a virtual raster: variables of one moment, summed or multiplied where there are several.
struct WrfBand {
    const WrfMoment* moment = nullptr;
    std::vector<std::string> variables;
    double time_s = 0.0;  ///< band metadata `time_s`
};
enum class WrfGrid { Fire, Atmosphere };
enum class WrfCombine { Sum, Product };

/// Name of a raster in memory that reads the variables from their files when it is read: georeferenced, north up, without the
/// fire grid's padding. It lives as long as the process. \param name  distinguishes rasters of one series
std::filesystem::path wrf_raster(const WrfSfire& wrf, const std::string& name, const std::string& unit, WrfGrid grid,
                                 std::span<const WrfBand> bands, WrfCombine combine = WrfCombine::Sum);

/// Name of a raster in memory with the ignition times of the last moment [s after `epoch_unix_s`], NaN where the fire had not
/// come but for the next cell, whose time goes on from those behind it. Throws an input error when the fire is older than the epoch.
std::filesystem::path wrf_arrival(const WrfSfire& wrf, double epoch_unix_s);

/// Sum over the grid of a variable times the area of a cell (W for fluxes).
double wrf_integral(const WrfSfire& wrf, const WrfMoment& moment, const std::string& variable, WrfGrid grid);

}  // namespace pyroscene::gis
