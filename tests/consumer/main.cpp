// Uses an installed Pyroscene as another project would: headers, static libraries and data, none from the source tree.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "analysis/ortho.h"
#include "base/files.h"
#include "gis/raster_input.h"
#include "pipeline/run.h"
#include "radiometry/planck.h"
#include "scenario/scenario.h"
#include "sensors/sensor.h"

namespace {

int failures = 0;

void expect(bool ok, const char* what) {
    std::printf("%s  %s\n", ok ? "ok    " : "FAILED", what);
    failures += ok ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace pyroscene;
    if (argc != 2) return 2;
    try {
        const MapGrid grid = gis::make_map_grid(argv[1], {}, {});
        expect(grid.cols == 4 && grid.rows == 3 && grid.cell_m == 30.0 && grid.west_m == 714000.0,
               "grid of a raster (GDAL)");

        const auto temperature = gis::read_band({argv[1], 1, gis::Resampling::Nearest, "temperature", "K"}, grid);
        expect(std::isnan(temperature.at(1, 3)), "no data is NaN");
        const float hottest_K = temperature.at(1, 1);
        // B(4 um, 1100 K) = 4595.5 W m-2 sr-1 um-1, worked out by hand with the CODATA 2018 constants.
        expect(std::abs(radiometry::planck_radiance(4.0, hottest_K) - 4595.5) < 0.1, "Planck radiance of its hottest cell");

        const auto fine = analysis::ortho_grid(grid, 10.0, std::vector{714005.0}, std::vector{5170005.0});
        expect(fine.cell_m == 10.0 && fine.cols >= 1, "ortho grid");

        expect(sensors::load_sensor("wasp").band_index("MWIR") >= 0, "sensor file of the installation");
        const auto scenario = scenario::load(data_folder() / "scenarios" / "minimal" / "scenario.yaml");
        const auto result = pipeline::check(scenario);
        for (const auto& problem : result.problems) std::printf("        %s\n", problem.c_str());
        expect(result.problems.empty(), "scenario of the installation passes its checks");
        expect(!pipeline::version().empty(), "version");
    } catch (const std::exception& error) {
        std::printf("FAILED  %s\n", error.what());
        return 1;
    }
    return failures == 0 ? 0 : 1;
}
