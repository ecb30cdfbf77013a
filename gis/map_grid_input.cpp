#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/extent.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "gis/raster_source.h"

namespace pyroscene::gis {
namespace {

/// The terrain's own pixels and CRS.
struct Terrain {
    std::string path;
    int cols = 0, rows = 0;
    std::array<double, 6> gt{};
    CrsInfo crs;
};

Terrain open_terrain(const std::filesystem::path& path) {
    const DatasetPtr dataset = open_raster(path);
    Terrain terrain;
    terrain.path = path.string();
    terrain.cols = dataset->GetRasterXSize();
    terrain.rows = dataset->GetRasterYSize();
    terrain.gt = require_geotransform(*dataset, terrain.path);
    terrain.crs = require_crs(*dataset, terrain.path);
    return terrain;
}

bool is_north_up_and_square(const Terrain& t) {
    const double drift = std::abs(t.gt[1] + t.gt[5]) * std::max(t.cols, t.rows);
    return t.gt[2] == 0.0 && t.gt[4] == 0.0 && t.gt[1] > 0.0 && drift <= 1e-6 * t.gt[1];
}

std::string own_utm_or_ups(const Terrain& t) {
    const CrsTransform to_lonlat(t.crs.wkt, kGeographicCrs);
    double x = t.gt[0] + 0.5 * (t.cols * t.gt[1] + t.rows * t.gt[2]),
           y = t.gt[3] + 0.5 * (t.cols * t.gt[4] + t.rows * t.gt[5]);
    to_lonlat.forward({&x, 1}, {&y, 1});
    if (std::isnan(x)) throw input_error(t.path, "its centre has no longitude and latitude; expected a place on the Earth");
    return parse_map_crs(utm_or_ups_crs(y, x), t.path).wkt;
}

/// The shorter edge of the terrain's central pixel on the map.
double native_cell(const Terrain& t, const CrsTransform& to_map) {
    const double c = 0.5 * t.cols, r = 0.5 * t.rows;
    std::array<double, 4> col{c - 0.5, c + 0.5, c, c}, row{r, r, r - 0.5, r + 0.5}, x{}, y{};
    for (std::size_t i = 0; i < 4; ++i) {
        x[i] = t.gt[0] + col[i] * t.gt[1] + row[i] * t.gt[2];
        y[i] = t.gt[3] + col[i] * t.gt[4] + row[i] * t.gt[5];
    }
    to_map.forward(x, y);
    return std::min(std::hypot(x[1] - x[0], y[1] - y[0]), std::hypot(x[3] - x[2], y[3] - y[2]));
}

double three_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit) : std::round(value / unit) * unit;
}

int cell_count(double extent_m, double cell_m, const std::string& path) {
    constexpr double kMost = 200000.0;
    const double count = std::floor(extent_m / cell_m + 0.5);  // cells whose centre lies inside
    if (!(count >= 1.0 && count <= kMost))
        throw input_error(path, fmt::format("spans {:.6g} m, which is {:.0f} cells of {:.6g} m; expected 1 to {:.0f}",
                                            extent_m, count, cell_m, kMost));
    return static_cast<int>(count);
}

MapGrid cover(const Extent& e, double cell_m, const std::string& crs_wkt, const std::string& path) {
    MapGrid grid{.west_m = e.west, .north_m = e.north, .cell_m = cell_m, .crs_wkt = crs_wkt};
    grid.cols = cell_count(e.east - e.west, cell_m, path);
    grid.rows = cell_count(e.north - e.south, cell_m, path);
    return grid;
}

/// Footprint on another CRS, with edges on multiples of the cell so that grids of neighbouring inputs share their lines.
MapGrid cover_on(const std::string& crs_wkt, const Terrain& t, const std::optional<double>& cell_m) {
    const CrsTransform to_map(t.crs.wkt, crs_wkt);
    Extent e = extent_of(t.gt, t.cols, t.rows, &to_map);
    const double cell = cell_m ? *cell_m : three_digits(native_cell(t, to_map));
    if (std::isnan(e.west) || !(cell > 0.0))
        throw input_error(t.path, fmt::format("cannot be drawn in the map's CRS '{}'; expected a CRS whose area covers it",
                                              parse_crs(crs_wkt, t.path).name));
    e = {.west = std::floor(e.west / cell) * cell,
         .east = std::ceil(e.east / cell) * cell,
         .south = std::floor(e.south / cell) * cell,
         .north = std::ceil(e.north / cell) * cell};
    return cover(e, cell, crs_wkt, t.path);
}

}  // namespace

MapGrid make_map_grid(const std::filesystem::path& terrain_path, const std::optional<std::string>& crs,
                      const std::optional<double>& cell_m) {
    if (cell_m && !(std::isfinite(*cell_m) && *cell_m > 0.0))
        throw input_error("map.cell_m", fmt::format("found {}, expected a length above 0", *cell_m));
    const std::optional<std::string> wanted = crs ? std::optional(parse_map_crs(*crs, "map.crs").wkt) : std::nullopt;
    const Terrain t = open_terrain(terrain_path);
    const bool own_crs = t.crs.projected_in_metres() && (!wanted || same_crs(*wanted, t.crs.wkt));
    if (!own_crs) return cover_on(wanted ? *wanted : own_utm_or_ups(t), t, cell_m);

    const double smaller = std::min(std::hypot(t.gt[1], t.gt[4]), std::hypot(t.gt[2], t.gt[5]));
    const bool other_cell = cell_m && std::abs(*cell_m - smaller) > 1e-9 * smaller;
    if (is_north_up_and_square(t) && !other_cell)
        return {
            .cols = t.cols, .rows = t.rows, .west_m = t.gt[0], .north_m = t.gt[3], .cell_m = t.gt[1], .crs_wkt = t.crs.wkt};
    return cover(extent_of(t.gt, t.cols, t.rows, nullptr), other_cell ? *cell_m : smaller, t.crs.wkt, t.path);
}

}  // namespace pyroscene::gis
