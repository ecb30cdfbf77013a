// Whole runs over scenes that are known: every sensor over an even plane, one fire at several resolutions.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/files.h"
#include "gis/crs.h"
#include "radiometry/planck.h"
#include "sensors/detector.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kPlane_K = 600.0;

MapGrid square_map(double edge_m, double cell_m, const std::string& crs = "EPSG:32611") {
    MapGrid grid;
    grid.cols = grid.rows = static_cast<int>(std::lround(edge_m / cell_m));
    grid.cell_m = cell_m;
    grid.west_m = 700000.0;
    grid.north_m = 5184000.0;
    grid.crs_wkt = gis::parse_map_crs(crs, "map").wkt;
    return grid;
}

void run_in(const ScratchFolder& folder, const std::string& scenario) {
    std::ofstream(folder / "scenario.yaml") << scenario;
    const auto run = pyroscene_cli("run " + (folder / "scenario.yaml").string() + " -q -o " + (folder / "out").string());
    ASSERT_EQ(run.exit_code, 0) << run.output;
}

/// Emissive bands of a sensor (beyond 3 um) and the acquisition that takes them over the middle of the map; empty if none.
std::string acquisition_of(const sensors::Sensor& sensor) {
    std::string bands;
    for (const auto& band : sensor.bands)
        if (band.centre_um > 3.0) bands += fmt::format("{}\"{}\"", bands.empty() ? "" : ", ", band.id);
    if (bands.empty()) return {};
    const bool stands = sensor.orbit && sensor.orbit->geostationary_longitude_deg;
    const std::string platform = stands            ? "{pass: geostationary}"
                                 : sensor.airborne ? "{over: centre, altitude_agl_m: 3000}"
                                                   : "{over: centre, pass: descending}";
    return fmt::format("  - {{id: {0}, sensor: {0}, time_s: 0, platform: {1}, bands: [{2}]{3}}}\n", sensor.id, platform,
                       bands, stands || sensor.scan == sensors::ScanType::Framing ? "" : ", lines: 2");
}

/// What a band reports of the plane: radiances that are 600 K but for noise and counts, or the saturation.
void expect_plane(const sensors::Band& band, const std::vector<double>& radiance, const std::string& where) {
    const double truth = radiometry::band_mean_radiance(kPlane_K, band.response);
    const double full_scale = band.saturation_radiance_W_m2_sr_um.value_or(1e30);
    const double sigma = sensors::noise_radiance(band, truth), step = band.bits ? full_scale * std::exp2(-*band.bits) : 0.0;
    double sum = 0.0, n = 0.0;
    for (const double L : radiance) {
        if (std::isnan(L)) continue;
        sum += L;
        n += 1.0;
    }
    ASSERT_GT(n, radiance.size() == 1 ? 0.0 : 3.0) << where;  // field instruments have one pixel
    if (truth > full_scale) {
        // Clipped; VIIRS I4 folds over here (267 against 8 x 4.65 W m-2 sr-1 um-1) and reads less.
        EXPECT_LE(sum / n, full_scale * (1.0 + 1e-6)) << where;
        return;
    }
    const double mean_K = radiometry::band_brightness_temperature(sum / n, band.response);
    const double slope = (radiometry::band_mean_radiance(kPlane_K + 0.5, band.response) -
                          radiometry::band_mean_radiance(kPlane_K - 0.5, band.response));
    EXPECT_NEAR(mean_K, kPlane_K, 0.05 + (5.0 * sigma / std::sqrt(n) + 0.5 * std::min(step, 1e6)) / slope) << where;
}

/// Over Montana, or over Hokkaido, which the satellites above the western Pacific see.
class EverySensor : public testing::TestWithParam<const char*> {};

TEST_P(EverySensor, ReadsAPlaneOf600K) {
    const std::string crs = GetParam();
    const auto wanted = [&](const sensors::Sensor& sensor) {
        const bool pacific = sensor.orbit && sensor.orbit->geostationary_longitude_deg.value_or(-1.0) > 0.0;
        // The generic camera has a million pixels of what WASP shows.
        return sensor.id != "generic-framing" && pacific == (crs == "EPSG:32654") && !acquisition_of(sensor).empty();
    };
    const ScratchFolder folder;
    const auto grid = square_map(4000.0, 200.0, crs);
    write_band(folder / "dem.tif", grid, "m", [](double, double) { return 1000.0; });
    write_band(folder / "flux.tif", grid, "W m-2", [](double, double) { return 0.0; }, {{"time_s", "0"}});
    std::string acquisitions;
    for (const auto& id : sensors::sensor_ids())
        if (const auto sensor = sensors::load_sensor(id); wanted(sensor)) acquisitions += acquisition_of(sensor);
    run_in(folder, fmt::format(R"(pyroscene: 1
name: plane
inputs: {{terrain: {{file: dem.tif}}, heat_flux: {{file: flux.tif}}}}
start: 2021-08-12T20:00:00Z
fire: {{ambient_temperature_K: {}}}
surface: {{emissivity: 1}}
atmosphere: {{model: none}}
products: [radiance]
acquisitions:
{})",
                               kPlane_K, acquisitions));
    for (const auto& id : sensors::sensor_ids()) {
        const auto sensor = sensors::load_sensor(id);
        if (!wanted(sensor)) continue;
        int found = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "out" / id)) {
            const auto name = entry.path().filename().string();
            if (!name.starts_with("radiance") || !name.ends_with(".tif")) continue;
            const auto image = gis::read_image(entry.path());
            for (std::size_t b = 0; b < image.bands.size(); ++b) {
                const auto& band = image.bands[b].metadata.at("band_id");
                const int index = sensor.band_index(band);
                ASSERT_GE(index, 0) << id << " " << band;
                expect_plane(sensor.bands[static_cast<std::size_t>(index)], plane(image, b), id + " " + band);
                ++found;
            }
        }
        EXPECT_EQ(found, std::count_if(sensor.bands.begin(), sensor.bands.end(),
                                       [](const auto& band) { return band.centre_um > 3.0; }))
            << id;
    }
}

INSTANTIATE_TEST_SUITE_P(Maps, EverySensor, testing::Values("EPSG:32611", "EPSG:32654"),
                         [](const auto& test) { return std::string(test.param).substr(5); });

/// A camera from 20 km with pixels of this size on the ground.
std::string camera_of(double pixel_m, int edge_px) {
    return fmt::format(R"(schema: pyroscene-sensor/1
id: camera
name: camera
platform: {{type: airborne, altitude_agl_m: 20000}}
geometry:
  scan_type: framing
  groups:
    main: {{nx: {0}, ny: {0}, focal_length_mm: 100.0, pixel_pitch_um: {1}}}
psf:
  along_scan: {{shape: box, width_samples: 1.0}}
  along_track: {{shape: box, width_samples: 1.0}}
bands:
- {{id: MWIR, group: main, center_um: 3.95, edges_um: [3.9, 4.0], srf: nominal, srf_shape: boxcar,
   noise: {{kind: nedt, value_k: 0.1, at_k: 300}}}}
)",
                       edge_px, pixel_m * 0.1 / 20000.0 * 1e6);
}

TEST(OneFire, HasTheSamePowerAtEveryResolution) {
    const ScratchFolder folder;
    const auto grid = square_map(2400.0, 20.0);
    write_band(folder / "dem.tif", grid, "m",
               [](double x, double y) { return 900.0 + 40.0 * std::sin((x - 700000.0) / 300.0) + 0.03 * (y - 5181600.0); });
    // A bowed front three cells wide.
    write_band(folder / "flux.tif", grid, "W m-2",
               [](double x, double y) {
                   const double radius = std::hypot(x - 701100.0, y - 5182700.0);
                   return radius > 330.0 && radius < 390.0 && x > 701000.0 ? 60000.0 + 100.0 * (y - 5182700.0) : 0.0;
               },
               {{"time_s", "0"}});
    std::string acquisitions;
    const std::vector<std::pair<double, int>> cameras{{3.0, 400}, {30.0, 72}, {150.0, 24}, {800.0, 10}};
    for (const auto& [pixel_m, edge_px] : cameras) {
        std::ofstream(folder / fmt::format("camera{:g}.yaml", pixel_m)) << camera_of(pixel_m, edge_px);
        acquisitions += fmt::format(
            "  - {{id: at_{0:g}, sensor: camera{0:g}.yaml, time_s: 0, platform: {{over: centre, altitude_agl_m: 20000}}}}\n",
            pixel_m);
    }
    run_in(folder, R"(pyroscene: 1
name: one_fire
inputs: {terrain: {file: dem.tif}, heat_flux: {file: flux.tif}}
start: 2021-08-12T06:00:00Z
atmosphere: {model: none}
render: {noise: false}
products: [radiance]
acquisitions:
)" + acquisitions);
    std::vector<double> power;
    for (const auto& [pixel_m, edge_px] : cameras) {
        const auto image = gis::read_image(folder / fmt::format("out/at_{:g}/radiance.tif", pixel_m));
        const auto radiance = plane(image, 0);
        const double background = radiance.front();  // ambient, of the scene and around it
        double sum = 0.0;
        for (const double L : radiance) sum += L - background;
        power.push_back(sum * pixel_m * pixel_m);
    }
    EXPECT_GT(power.front(), 1e5);
    for (const double p : power) EXPECT_NEAR(p / power.front(), 1.0, 0.01);
}

/// A sensor of today or of the thesis, its band for fire and where it flies.
struct Eye {
    const char *sensor, *band, *platform;
};
constexpr Eye kSeven[] = {
    {"aviris-classic", "223", "{over: centre, altitude_agl_m: 20000, heading_deg: 70}, lines: 110"},
    {"master", "30", "{over: centre, altitude_agl_m: 5000, heading_deg: 200, ground_speed_m_s: 120}, lines: 170"},
    {"modis-terra", "B21", "{over: centre, pass: descending, scan_angle_deg: 4}"},
    {"viirs-snpp", "M13", "{over: centre, pass: ascending, scan_angle_deg: -3}"},
    {"abi-goes16", "B07", "{pass: geostationary}"},
    {"wasp", "MWIR", "{over: centre, altitude_agl_m: 4500, heading_deg: 20}"},
    {"phoenix", "MWIR", "{over: centre, altitude_agl_m: 3000, heading_deg: 160}, lines: 300"},
};

/// Between a background and a front of known temperatures, power above background / (B(front) - B(background)) is the area that
/// flames, whatever the pixel and the band. It is known from the inputs: heat flux over that of flaming ground. The fire is large
/// enough for the rays of fine pixels, and the map for the response of a geostationary one.
TEST(OneFire, HasTheSameAreaInSevenSensors) {
    const ScratchFolder folder;
    const auto grid = square_map(9000.0, 20.0);
    const auto flux = [](double x, double y) {
        const double radius = std::hypot(x - 704500.0, y - 5179500.0);
        return radius > 560.0 && radius < 640.0 && x > 704000.0 ? 120000.0 + 100.0 * (y - 5179500.0) : 0.0;
    };
    write_band(folder / "dem.tif", grid, "m", [](double, double) { return 900.0; });
    write_band(folder / "flux.tif", grid, "W m-2", flux, {{"time_s", "0"}});
    std::string acquisitions;
    for (const auto& eye : kSeven)
        acquisitions += fmt::format("  - {{id: {0}, sensor: {0}, time_s: 0, platform: {1}, bands: [\"{2}\"]}}\n", eye.sensor,
                                    eye.platform, eye.band);
    run_in(folder, R"(pyroscene: 1
name: seven
inputs: {terrain: {file: dem.tif}, heat_flux: {file: flux.tif}}
start: 2021-08-12T18:00:00Z
atmosphere: {model: none}
surface: {emissivity: 1}
flame: {enabled: false}
fire: {ambient_temperature_K: 300, front_temperature_K: 1073.15}
render: {noise: false, sun: false}
products: [radiance, truth, frp]
acquisitions:
)" + acquisitions);
    constexpr double kFlaming_W_m2 = 5e5, kLeast_W_m2 = 1000.0, kFront_K = 1073.15, kAmbient_K = 300.0;
    double flaming_m2 = 0.0;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            if (const double f = flux(grid.x_centre_m(col), grid.y_centre_m(row)); f > kLeast_W_m2)
                flaming_m2 += f / kFlaming_W_m2 * grid.cell_area_m2();
    for (const auto& eye : kSeven) {
        const auto sensor = sensors::load_sensor(eye.sensor);
        const auto& band = sensor.bands[static_cast<std::size_t>(sensor.band_index(eye.band))];
        const auto folder_of = folder / "out" / eye.sensor;
        std::filesystem::path truth_file, frp_file;
        for (const auto& entry : std::filesystem::directory_iterator(folder_of)) {
            const auto name = entry.path().filename().string();
            if (name.starts_with("truth") && name.ends_with(".tif")) truth_file = entry.path();
            if (name.starts_with("frp") && name.ends_with(".tif")) frp_file = entry.path();
        }
        const auto truth = gis::read_image(truth_file), frp = gis::read_image(frp_file);
        std::size_t noise_free = 0;
        while (!truth.bands[noise_free].description.ends_with("radiance_noise_free")) ++noise_free;
        const auto radiance = plane(truth, noise_free), exitance = plane(frp, 0), power_MW = plane(frp, 1);
        const double background = radiometry::band_mean_radiance(kAmbient_K, band.response);
        double sum = 0.0;
        for (std::size_t i = 0; i < radiance.size(); ++i)
            if (exitance[i] > 0.0) sum += (radiance[i] - background) * 1e6 * power_MW[i] / exitance[i];  // x area
        const double area_m2 = sum / (radiometry::band_mean_radiance(kFront_K, band.response) - background);
        EXPECT_NEAR(area_m2 / flaming_m2, 1.0, 0.01) << eye.sensor;
    }
}

// MODIS 50 degrees off nadir, from 705 km: the ground sees it farther from its zenith, by the sine rule.
TEST(Catalog, OffNadirIsAtTheSensorAndIncidenceAtTheGround) {
    const ScratchFolder folder;
    const auto grid = square_map(20000.0, 500.0);
    write_band(folder / "dem.tif", grid, "m", [](double, double) { return 500.0; });
    write_band(folder / "flux.tif", grid, "W m-2", [](double, double) { return 0.0; }, {{"time_s", "0"}});
    run_in(folder, R"(pyroscene: 1
inputs: {terrain: {file: dem.tif}, heat_flux: {file: flux.tif}}
start: 2021-08-12T18:00:00Z
atmosphere: {model: none}
products: [radiance]
acquisitions:
  - {id: edge, sensor: modis-aqua, time_s: 0, groups: [1km], bands: [B31], platform: {over: centre, pass: ascending, scan_angle_deg: 50}}
)");
    std::string item;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out" / "edge"))
        if (entry.path().filename().string().starts_with("item")) item = read_text_file(entry.path());
    const auto angle_deg = [&](const std::string& name) {
        std::smatch found;
        EXPECT_TRUE(std::regex_search(item, found, std::regex("\"view:" + name + "\": ([-0-9.e]+)"))) << item;
        return std::stod(found[1]);
    };
    EXPECT_NEAR(angle_deg("off_nadir"), 50.0, 0.5);
    const double altitude_m = 705e3, radius_m = 6371e3;
    EXPECT_NEAR(angle_deg("incidence_angle"),
                std::asin((radius_m + altitude_m) / radius_m * std::sin(50.0 * kDegree_rad)) / kDegree_rad, 1.0);
}

}  // namespace
}  // namespace pyroscene::test
