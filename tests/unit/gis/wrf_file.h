#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// A small history file in the layout of WRF-SFIRE: by default a Lambert grid around 105 W, 40 N on the sphere of 6370 km (the formulas of
/// its projections are written out here, without PROJ), fire grid with padding that holds plausible values.
struct WrfTestFile {
    int map_projection = 1;
    double dx_m = 90.0, dy_m = 90.0, true1 = 30.0, true2 = 60.0, centre_lat = 40.0, stand_lon = -105.0;
    double west_m = -2000.0, south_m = 1500.0;  ///< of the grid in the projection
    int cols = 7, rows = 5, refine_x = 3, refine_y = 3, layers = 3;
    std::vector<std::string> times{"2020-07-01_18:00:00", "2020-07-01_18:00:10"};
    std::string start = "2020-07-01_17:59:00";
    std::string format = "NC4";                  ///< NC: classic
    std::map<std::string, double> attributes{};  ///< instead of those above; NaN = left out
    std::vector<std::string> left_out{};         ///< variables
    double coarse_heat = 1.0;                    ///< GRNHFX / area mean of FGRNHFX
    double latent_heat = 0.0918;                 ///< FGRNQFX / FGRNHFX; FMC_G is 0.08
    double longitude_error_deg = 0.0;            ///< added to XLONG of one cell

    /// Value of a variable of the fire grid: record, column from the west, row from the SOUTH.
    static double fire_value(const std::string& variable, int record, int col, int row);
    /// Of the atmosphere: RTHFRTEN (heating_K_s times the dry air, as WRF writes it), U, V, W, PH, PHB with their staggered dimensions,
    /// MU, MUB, C1H, C2H; layer (or level) k from the ground.
    static double air_value(const std::string& variable, int record, int k, int row, int col);
    void write(const std::filesystem::path& path) const;
    /// Longitude and latitude of a place in the projection [deg].
    [[nodiscard]] std::pair<double, double> lon_lat(double x_m, double y_m) const;
};

}  // namespace pyroscene::gis
