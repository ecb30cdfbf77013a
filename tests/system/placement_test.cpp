// A checkerboard of two emissivities painted on steep terrain is photographed off-nadir through the whole program; its ortho
// image, and the sensor-geometry image warped by gdalwarp -geoloc, must lie where the paint is.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "gis/crs.h"
#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

struct Place {
    const char* name;
    const char* crs;
    double lat_deg, lon_deg;
};

constexpr double kCell_m = 10.0, kSquare_m = 60.0, kGroundTemperature_K = 300.0;

double height_m(double x_m, double y_m) {
    // Slopes up to about 45 degrees.
    return 1200.0 + 150.0 * std::sin(x_m / 160.0) + 100.0 * std::cos(y_m / 140.0) + 0.1 * x_m;
}

bool painted(double x_m, double y_m) {
    return (static_cast<long>(std::floor(x_m / kSquare_m)) + static_cast<long>(std::floor(y_m / kSquare_m))) % 2 == 0;
}

void write_text(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

/// Writes rasters, sensor and scenario; returns the map grid (its paint coordinates are relative to the south-west corner).
MapGrid write_scene(const ScratchFolder& folder, const Place& place) {
    const auto centre = gis::MapProjection(place.crs).to_map(place.lat_deg, place.lon_deg);
    MapGrid grid;
    grid.cols = grid.rows = 300;
    grid.cell_m = kCell_m;
    grid.west_m = std::round(centre[0] / kCell_m) * kCell_m - 1500.0;
    grid.north_m = std::round(centre[1] / kCell_m) * kCell_m + 1500.0;
    grid.crs_wkt = gis::parse_map_crs(place.crs, place.name).wkt;
    const double x0 = grid.west_m, y0 = grid.south_m();
    write_band(folder / "dem.tif", grid, "m", [&](double x, double y) { return height_m(x - x0, y - y0); });
    write_band(folder / "flux.tif", grid, "W m-2", [](double, double) { return 0.0; }, {{"time_s", "0"}});
    write_band(folder / "cover.tif", grid, "", [&](double x, double y) { return painted(x - x0, y - y0) ? 1.0 : 2.0; });
    write_text(folder / "cover.csv", "code,surface\n1,water\n2,grass_dry\n");
    write_text(folder / "camera.yaml", R"(schema: pyroscene-sensor/1
id: camera
name: test camera
platform: {type: airborne, name: test, altitude_agl_m: 2000, ground_speed_m_s: 50.0}
geometry:
  scan_type: framing
  groups:
    main:
      nx: 300
      ny: 240
      focal_length_mm: 25.0
      pixel_pitch_um: 50.0
      principal_point_px: [149.5, 119.5]
psf:
  along_scan: {shape: none}
  along_track: {shape: none}
digitisation: {bits: null}
bands:
- {id: MWIR, group: main, center_um: 3.8, edges_um: [3.4, 4.2], srf: nominal, srf_shape: boxcar}
)");
    write_text(folder / "scenario.yaml", fmt::format(R"(pyroscene: 1
name: placement
inputs:
  terrain: {{file: dem.tif}}
  heat_flux: {{file: flux.tif}}
  cover: {{file: cover.tif, band: 1, table: cover.csv}}
start: 2020-06-01T20:00:00Z
fire: {{ambient_temperature_K: {}}}
atmosphere: {{model: none}}
acquisitions:
  - {{id: shot, sensor: camera.yaml, time_s: 0, platform: {{over: centre, altitude_agl_m: 1800, heading_deg: 37, pitch_deg: 12, roll_deg: -9}}}}
products: [radiance, truth, ortho]
)",
                                                     kGroundTemperature_K));
    return grid;
}

/// Shift (in pixels) of an ortho image against the paint along each axis: the least-squares optimum in steps of 0.025 pixel.
std::array<double, 2> shift_against_paint(const std::vector<double>& image, const MapGrid& ortho, double x0, double y0) {
    double low = 1e300, high = -1e300;
    for (const double v : image)
        if (!std::isnan(v)) low = std::min(low, v), high = std::max(high, v);
    // Share of paint in the pixel that is centred on the point, from 3 x 3 samples.
    const auto model = [&](double x, double y) {
        double share = 0.0;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                share += painted(x - x0 + i * ortho.cell_m / 3.0, y - y0 + j * ortho.cell_m / 3.0) ? 1.0 : 0.0;
        return low + (high - low) * share / 9.0;
    };
    const auto error = [&](double dx_m, double dy_m) {
        double sum = 0.0;
        for (int row = 0; row < ortho.rows; ++row)
            for (int col = 0; col < ortho.cols; ++col) {
                const double v = image[ortho.index(row, col)];
                if (std::isnan(v)) continue;
                const double d = v - model(ortho.x_centre_m(col) - dx_m, ortho.y_centre_m(row) - dy_m);
                sum += d * d;
            }
        return sum;
    };
    std::array<double, 2> best{}, least{1e300, 1e300};
    for (int k = -20; k <= 20; ++k) {
        const double shift = 0.025 * k, shift_m = shift * ortho.cell_m;
        const std::array<double, 2> errors{error(shift_m, 0.0), error(0.0, shift_m)};
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (errors[axis] < least[axis]) least[axis] = errors[axis], best[axis] = shift;
    }
    return best;
}

class Placement : public testing::TestWithParam<Place> {};

TEST_P(Placement, OrthoAndGeolocationLieOnThePaint) {
    const ScratchFolder folder;
    const auto grid = write_scene(folder, GetParam());
    const auto run = pyroscene_cli("run " + (folder / "scenario.yaml").string() + " -q -o " + (folder / "out").string());
    ASSERT_EQ(run.exit_code, 0) << run.output;

    const auto ortho_file = folder / "out/shot/ortho_radiance.tif";
    const auto image = gis::read_image(ortho_file);
    const auto ortho = gis::make_map_grid(ortho_file, {}, {});
    EXPECT_NEAR(ortho.cell_m, 3.6, 1.6);
    const auto seen = std::count_if(image.pixels.begin(), image.pixels.end(), [](double v) { return !std::isnan(v); });
    EXPECT_GT(seen, 50000);
    const auto shift = shift_against_paint(plane(image, 0), ortho, grid.west_m, grid.south_m());
    EXPECT_LE(std::hypot(shift[0], shift[1]), 0.1) << shift[0] << " " << shift[1];

    const auto warp = run_command(
        fmt::format("gdalwarp -q -geoloc -r bilinear -t_srs {} -te {} {} {} {} -tr {} {} -dstnodata nan {} {}",
                    GetParam().crs, ortho.west_m, ortho.south_m(), ortho.east_m(), ortho.north_m, ortho.cell_m, ortho.cell_m,
                    (folder / "out/shot/radiance.tif").string(), (folder / "warped.tif").string()));
    ASSERT_EQ(warp.exit_code, 0) << warp.output;
    const auto warped = gis::read_image(folder / "warped.tif");
    const auto warp_shift = shift_against_paint(plane(warped, 0), ortho, grid.west_m, grid.south_m());
    EXPECT_LE(std::hypot(warp_shift[0], warp_shift[1]), 0.5) << warp_shift[0] << " " << warp_shift[1];
}

INSTANTIATE_TEST_SUITE_P(Earth, Placement,
                         testing::Values(Place{"utm_north", "EPSG:32611", 46.69, -114.9},
                                         Place{"utm_south", "EPSG:32719", -33.4, -70.3},
                                         Place{"zone_edge", "EPSG:32611", 46.69, -114.02}),
                         [](const auto& param_info) { return param_info.param.name; });

}  // namespace
}  // namespace pyroscene::test
