// The thesis fire from a file in the layout of WRF-SFIRE and from GeoTIFFs on another grid: the same images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "gis/geodesy.h"
#include "gis/raster_input.h"
#include "gis/raster_output.h"
#include "inputs/load_scenario.h"
#include "pipeline/run.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kGain = 5.837674;               // of heat_flux.tif (its README); the WRF file has none
const std::vector<int> kFrames{1, 3, 5, 9, 10};  // of heat_flux.tif that the WRF file has

std::filesystem::path data(const std::string& file) { return source_folder() / "scenarios/thesis_grassfire" / file; }

/// heat_flux.tif without its gain, at the times of the WRF file.
void write_heat_flux(const std::filesystem::path& file) {
    const auto grid = gis::make_map_grid(data("dem.tif"), {}, {});
    gis::OutputRaster out;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.grid = grid;
    std::vector<float> values;
    for (const int band : kFrames) {
        auto frame = gis::read_band({data("heat_flux.tif"), band, gis::Resampling::Conserve, "heat flux", "W m-2"}, grid);
        for (float& v : frame.values) v = static_cast<float>(v / kGain);
        values.insert(values.end(), frame.values.begin(), frame.values.end());
        out.bands.push_back({"heat flux", "W m-2", {}, {}, {}});
    }
    gis::write_geotiff(file, out, std::span<const float>(values));
}

struct Fire {
    int cols = 0, rows = 0;
    std::vector<double> excess;  ///< radiance above the ambient ground
    double sum = 0.0;
};
Fire fire_of(const std::filesystem::path& radiance) {
    const auto image = gis::read_image(radiance);
    constexpr double kAmbient = 3.0;  // W m-2 sr-1 um-1 in 3-5 um at 305 K with sun
    Fire fire{image.cols, image.rows, plane(image, 0), 0.0};
    for (double& v : fire.excess) {
        v = v > kAmbient ? v : 0.0;
        fire.sum += v;
    }
    return fire;
}

/// {lines, samples} by which the second image must be moved to fit the first best, at most 5 pixels.
std::array<int, 2> shift_between(const Fire& a, const Fire& b) {
    constexpr int kMost = 5;
    double best = -1.0;
    std::array<int, 2> shift{};
    for (int dy = -kMost; dy <= kMost; ++dy) {
        for (int dx = -kMost; dx <= kMost; ++dx) {
            double product = 0.0;
            for (int row = kMost; row < a.rows - kMost; ++row)
                for (int col = kMost; col < a.cols - kMost; ++col)
                    product += a.excess[static_cast<std::size_t>(row * a.cols + col)] *
                               b.excess[static_cast<std::size_t>((row - dy) * a.cols + col - dx)];
            if (product > best) best = product, shift = {dy, dx};
        }
    }
    return shift;
}

Raster<float> terrain_of(const std::filesystem::path& scenario) {
    const auto loaded = inputs::load_scenario(scenario);
    const auto& file = loaded.inputs.terrain.files.front();
    return gis::read_band({file, 1, gis::Resampling::Bilinear, "terrain", "m"}, gis::make_map_grid(file, {}, {}));
}

Fire fire_from(const ScratchFolder& scratch, const std::string& name, const std::string& inputs) {
    const auto file = scratch / (name + ".yaml");
    std::ofstream(file) << "pyroscene: 1\ninputs:\n"
                        << inputs << R"(
start: 2000-08-01T18:00:00Z
render: {samples_per_axis: 1, flame_light: false}
flame: {hot_gas: false}
products: [radiance]
acquisitions:
  - {id: camera, sensor: wasp-thesis, bands: [MWIR], time_s: 3714,
     platform: {over: {lat_deg: 43, lon_deg: -88}, altitude_m: 3300}}
)";
    const auto result = pyroscene_cli("run -q " + file.string() + " -o " + (scratch / name).string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return fire_of(scratch / name / "camera" / "radiance.tif");
}

// The WRF file holds the arrays of the GeoTIFFs (dem.tif: README of the case) on a grid of its own: every cell has its value,
// whatever the order of rows and the padding.
TEST(WrfSfire, CellsHaveTheValuesOfTheirArrays) {
    const auto wrf = terrain_of(data("wrf_sfire.yaml"));
    const auto dem = gis::read_band({data("dem.tif"), 1, gis::Resampling::Bilinear, "terrain", "m"},
                                    gis::make_map_grid(data("dem.tif"), {}, {}));
    ASSERT_EQ(wrf.values.size(), dem.values.size());
    for (std::size_t i = 0; i < wrf.values.size(); ++i) ASSERT_NEAR(wrf.values[i], dem.values[i], 0.01);
}

TEST(WrfSfire, GivesTheImagesOfTheSameFireInGeoTiffs) {
    const ScratchFolder scratch;
    write_heat_flux(scratch / "heat_flux.tif");
    const auto wrf = fire_from(
        scratch, "wrf", fmt::format("  wrf_sfire: {{file: {}, fuel_table: fbfm13}}", data("wrfout_layout_d01.nc").string()));
    const auto tif =
        fire_from(scratch, "tif",
                  fmt::format(R"(  terrain: {{file: {0}}}
  heat_flux: {{file: {1}, times_s: [6, 1800, 3672, 3714, 3816]}}
  fuel_load: {{file: {2}, bands: [1, 3, 5, 9, 10], times_s: [6, 1800, 3672, 3714, 3816]}}
  wind: {{file: {3}, bands: [1, 2, 5, 6, 9, 10, 17, 18, 19, 20], times_s: [6, 1800, 3672, 3714, 3816]}}
  arrival: {{file: {4}}}
  cover: {{file: {5}, table: fbfm13}})",
                              data("dem.tif").string(), (scratch / "heat_flux.tif").string(), data("fuel_load.tif").string(),
                              data("wind.tif").string(), data("arrival.tif").string(), data("fuel_model.tif").string()));
    EXPECT_NEAR(wrf.sum / tif.sum, 1.0, 0.05);
    // Same arrays, so the fires differ by how far the cells of the two grids lie apart, here in the middle of the map. Pixels are
    // 3 m, lines run south.
    const auto grid = terrain_of(data("wrf_sfire.yaml")).grid, utm = gis::make_map_grid(data("dem.tif"), {}, {});
    const int col = 70, row = 70;
    const auto place = gis::MapProjection(grid.crs_wkt).to_geodetic(grid.x_centre_m(col), grid.y_centre_m(row));
    const auto [x_m, y_m] = gis::MapProjection(utm.crs_wkt).to_map(place.lat_deg, place.lon_deg);
    const auto [lines, samples] = shift_between(wrf, tif);
    EXPECT_NEAR(samples, (x_m - utm.x_centre_m(col)) / 3.0, 1.5);
    EXPECT_NEAR(lines, -(y_m - utm.y_centre_m(row)) / 3.0, 1.5);
}

TEST(WrfSfire, OnAnotherMapItIsStillInItsPlace) {
    const ScratchFolder scratch;
    const std::string inputs = fmt::format("  wrf_sfire: {}\n", data("wrfout_layout_d01.nc").string());
    const auto own = fire_from(scratch, "own", inputs);
    const auto utm = fire_from(scratch, "utm", inputs + "map: {crs: EPSG:32616, cell_m: 20}");
    EXPECT_NEAR(own.sum / utm.sum, 1.0, 0.1);
    // Fronts are known to a cell of 20 m: within half of one.
    for (const int pixels : shift_between(own, utm)) EXPECT_LE(std::abs(pixels), 3);
}

// A run whose file has the heating of the air: smoke and hot air over the fire; none without `plume`.
TEST(WrfSfire, HeatingOfTheFileBecomesSmokeInTheImage) {
    const auto sample = source_folder() / "scenarios" / "fire_models" / "wrf_plume.yaml";
    const ScratchFolder scratch;
    const auto run = [&](const char* name, const std::filesystem::path& yaml) {
        pipeline::RunOptions options;
        options.output = scratch / name;
        options.threads = 2;
        RunReport report;
        const auto scenario = inputs::load_scenario(yaml);
        for (const auto& note : scenario.notes) EXPECT_EQ(note.find("RTHFRTEN"), std::string::npos) << note;
        pipeline::run(scenario, options, report);
        const auto truth = gis::read_image(scratch / name / "camera" / "truth.tif");
        const auto smoke = plane(truth, "fraction_smoke");
        return std::pair{smoke, plane(gis::read_image(scratch / name / "camera" / "radiance.tif"), 2)};
    };
    const auto [smoke, lwir] = run("with", sample);
    const auto plain = scratch / "plain.yaml";
    {
        std::ifstream in(sample);
        std::string text((std::istreambuf_iterator<char>(in)), {});
        const auto folder = sample.parent_path().string();
        const auto replace = [&](const std::string& what, const std::string& by) {
            const auto at = text.find(what);
            ASSERT_NE(at, std::string::npos) << what;
            text.replace(at, what.size(), by);
        };
        replace(", plume: true", "");
        replace("wrfout_plume_d01", folder + "/wrfout_plume_d01");
        replace("../minimal", folder + "/../minimal");
        std::ofstream(plain) << text;
    }
    const auto [none, bare] = run("without", plain);
    EXPECT_EQ(*std::max_element(none.begin(), none.end()), 0.0);
    EXPECT_GT(*std::max_element(smoke.begin(), smoke.end()), 0.05);
    // Part of the image only, and every pixel of it with a radiance.
    const auto smoky = std::count_if(smoke.begin(), smoke.end(), [](double f) { return f > 0.02; });
    EXPECT_GT(smoky, 50);
    EXPECT_LT(smoky, static_cast<std::ptrdiff_t>(smoke.size()) / 2);
    std::size_t changed_outside = 0;
    for (std::size_t i = 0; i < smoke.size(); ++i) {
        EXPECT_TRUE(lwir[i] > 0.0) << i;
        if (smoke[i] == 0.0 && std::abs(lwir[i] - bare[i]) > 0.01 * bare[i]) ++changed_outside;
    }
    EXPECT_LT(changed_outside, smoke.size() / 100);
    // It stands where the fire is.
    const auto centre = [](const std::vector<double>& weight) {
        double sum = 0.0, down = 0.0, across = 0.0;
        for (std::size_t i = 0; i < weight.size(); ++i) {
            sum += weight[i];
            down += weight[i] * static_cast<double>(i / 160);
            across += weight[i] * static_cast<double>(i % 160);
        }
        return std::array{down / sum, across / sum};
    };
    auto hot = bare;
    for (double& v : hot) v = std::max(0.0, v - 20.0);
    EXPECT_NEAR(centre(smoke)[0], centre(hot)[0], 10.0);
    EXPECT_NEAR(centre(smoke)[1], centre(hot)[1], 10.0);
}

}  // namespace
}  // namespace pyroscene::test
