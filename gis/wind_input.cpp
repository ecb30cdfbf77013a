#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "gis/crs.h"
#include "gis/raster_input.h"
#include "gis/resample.h"

namespace pyroscene::gis {
namespace {

/// Angle by which the y axis of the file's CRS lies clockwise of the grid's, at nodes every `step` cells.
class AxisTurn {
public:
    AxisTurn(const MapGrid& grid, const CrsInfo& file_crs, int step)
        : step_(step), nodes_across_((grid.cols - 1) / step + 2), nodes_down_((grid.rows - 1) / step + 2) {
        const CrsTransform map_to_lonlat(grid.crs_wkt, kGeographicCrs), map_to_file(grid.crs_wkt, file_crs.wkt);
        const CrsTransform file_to_lonlat(file_crs.wkt, kGeographicCrs);
        // About 30 m, in the unit of the file's axes.
        const double file_half_step = file_crs.geographic ? 2.7e-4 : 30.0 / file_crs.metres_per_unit;
        for (int j = 0; j < nodes_down_; ++j)
            for (int i = 0; i < nodes_across_; ++i) {
                const double x = grid.west_m + i * step * grid.cell_m, y = grid.north_m - j * step * grid.cell_m;
                double file_x = x, file_y = y;
                map_to_file.forward({&file_x, 1}, {&file_y, 1});
                const double turn = y_axis_azimuth_rad(file_to_lonlat, file_x, file_y, file_half_step) -
                                    y_axis_azimuth_rad(map_to_lonlat, x, y, 30.0);
                cosines_.push_back(std::cos(turn));
                sines_.push_back(std::sin(turn));
            }
    }

    /// {cos, sin} at a cell's centre: the node values interpolated, then normalised.
    [[nodiscard]] std::array<double, 2> at(int row, int col) const {
        const double u = (col + 0.5) / step_, v = (row + 0.5) / step_;
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const auto bilinear = [&](const std::vector<double>& node) {
            const auto k = static_cast<std::size_t>(j * nodes_across_ + i);
            const auto below = k + static_cast<std::size_t>(nodes_across_);
            return std::lerp(std::lerp(node[k], node[k + 1], u - i), std::lerp(node[below], node[below + 1], u - i), v - j);
        };
        const double c = bilinear(cosines_), s = bilinear(sines_), norm = std::hypot(c, s);
        return {c / norm, s / norm};
    }

private:
    int step_, nodes_across_, nodes_down_;
    std::vector<double> cosines_, sines_;
};

void rotate(Wind& wind, const AxisTurn& turn) {
    const MapGrid& grid = wind.east_m_s.grid;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const auto [c, s] = turn.at(row, col);
            float& u = wind.east_m_s.at(row, col);
            float& v = wind.north_m_s.at(row, col);
            const double east = c * u + s * v, north = -s * u + c * v;
            u = static_cast<float>(east);
            v = static_cast<float>(north);
        }
}

}  // namespace

Wind read_wind(const std::filesystem::path& file, int u_band, int v_band, const MapGrid& grid) {
    constexpr const char* kUnit = "m s-1";
    SourceBand source = open_band(file, u_band, kUnit);
    Wind wind{.east_m_s = Raster<float>(grid, "wind_east", kUnit), .north_m_s = Raster<float>(grid, "wind_north", kUnit)};
    wind.east_m_s.values = resample(source, grid, Resampling::Bilinear);
    choose_band(source, file, v_band, kUnit);
    wind.north_m_s.values = resample(source, grid, Resampling::Bilinear);
    // Cells between the nodes of the turn: it changes by about 1e-6 rad over 16 cells of 30 m.
    constexpr int kNodeStep = 16;
    if (!same_crs(source.crs.wkt, grid.crs_wkt)) rotate(wind, AxisTurn(grid, source.crs, kNodeStep));
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (std::isnan(wind.east_m_s.values[i]) || std::isnan(wind.north_m_s.values[i]))
            wind.east_m_s.values[i] = wind.north_m_s.values[i] = std::numeric_limits<float>::quiet_NaN();
    return wind;
}

}  // namespace pyroscene::gis
