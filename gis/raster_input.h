#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/raster.h"

namespace pyroscene::gis {

/// How a quantity goes from its own grid to the map grid.
enum class Resampling {
    Bilinear,  ///< terrain, temperatures, arrival times: the surface through pixel centres, averaged over the cell where the file
               ///< is finer; invalid neighbours drop out, and the outline of what is valid stays that of Nearest
    Conserve,  ///< heat flux, fuel load: area-weighted mean that keeps the integral over ground area; nodata and the outside
               ///< count as zero within a partly covered cell
    Nearest    ///< classes: the pixel that holds the cell's centre
};

struct BandInfo {
    std::string description, unit;
    std::optional<double> nodata;
    double scale = 1.0, offset = 0.0;
    std::map<std::string, std::string> metadata;  ///< e.g. time_s
};

/// What a raster file says of itself.
struct RasterInfo {
    std::string path;
    int cols = 0, rows = 0;
    std::array<double, 6> geotransform{};
    std::string crs_wkt;  ///< empty = none
    bool geographic = false;
    std::vector<BandInfo> bands;
    std::map<std::string, std::string> metadata;
};

/// True for names of rasters that other readers keep in memory (landscape.h, wrf_sfire.h).
bool is_in_memory(const std::filesystem::path& name);

/// Opens anything GDAL reads. Throws an input error: missing file, not a raster, no georeference.
RasterInfo read_info(const std::filesystem::path& path);
/// Only its bands, also of a raster without georeference: costs a fraction, since no CRS is looked up.
std::vector<BandInfo> read_band_list(const std::filesystem::path& path);

/// The map grid of a scene: the terrain's own when it is projected, north-up and square and neither `crs` nor `cell_m`
/// asks otherwise; else the terrain's footprint on the requested CRS (or its UTM/UPS zone) with the requested or native cell.
MapGrid make_map_grid(const std::filesystem::path& terrain, const std::optional<std::string>& crs,
                      const std::optional<double>& cell_m);

/// One band of one file as a quantity with a canonical unit.
struct BandRequest {
    std::filesystem::path file;
    int band = 1;
    Resampling resampling = Resampling::Bilinear;
    std::string name;  ///< canonical quantity, for messages and Raster::name
    std::string unit;  ///< canonical unit: "m", "W m-2", "kg m-2", "m s-1", "s", "K", "1", "kW m-1"
    double least = -std::numeric_limits<double>::infinity();  ///< values below are no data, before anything is resampled
};

/// Reads a band onto the grid: nodata -> NaN, scale/offset applied, unit converted (kW/m2, ft, min, h, lb/ft2, mph, ... ->
/// canonical; a band without unit is taken as canonical). One clear input error each, naming file and band: no CRS, too few
/// bands, a unit of another quantity (found, expected), all nodata, no overlap with the grid. Infinite values become NaN.
Raster<float> read_band(const BandRequest& request, const MapGrid& grid);

/// Integer classes, nearest; `nodata_value` marks what the file does not cover.
Raster<int> read_classes(const std::filesystem::path& file, int band, const MapGrid& grid, int nodata_value);

/// Wind components along the grid's axes: resampled as vectors (bilinear) and rotated from the axes of the file's CRS
/// (east/north of a geographic file) to those of the grid by the local convergence.
struct Wind {
    Raster<float> east_m_s, north_m_s;
};
Wind read_wind(const std::filesystem::path& file, int u_band, int v_band, const MapGrid& grid);

}  // namespace pyroscene::gis
