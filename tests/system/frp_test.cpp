// `pyroscene frp` on planted fires of known area and temperature: 1 km pixels, background 300 K, two bands.
#include <gtest/gtest.h>

#include <cmath>

#include "base/csv.h"
#include "base/files.h"
#include "gis/crs.h"
#include "radiometry/planck.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr int kCols = 60, kRows = 40;

struct Planted {
    int col, row;
    double temperature_K, area_m2, power_MW, mir_MW;  ///< last two: true and by the MIR method with a = 3.0e-9
};
// Analytic pixels, computed with an independent program.
const std::vector<Planted> kPlanted{{10, 10, 1000.0, 1000.0, 56.2, 62.7},
                                    {40, 8, 1000.0, 10000.0, 562.0, 627.0},
                                    {25, 30, 800.0, 1000.0, 22.8, 24.9},
                                    {50, 31, 600.0, 10000.0, 68.9, 54.2},
                                    {5, 33, 1100.0, 1000.0, 82.6, 88.2}};

double band(double T_K, double lower_um, double upper_um) {
    return radiometry::band_radiance(T_K, lower_um, upper_um) / (upper_um - lower_um);
}

void write_image(const std::filesystem::path& file, const std::string& crs, double west, double north, double cell) {
    gis::OutputRaster out;
    out.cols = kCols, out.rows = kRows;
    MapGrid grid;
    grid.cols = kCols, grid.rows = kRows, grid.cell_m = cell, grid.west_m = west, grid.north_m = north;
    grid.crs_wkt = gis::parse_crs(crs, "test").wkt;
    out.grid = grid;
    out.acquisition_time = "2019-08-01T19:05:00Z";
    std::vector<float> pixels;
    for (const auto& [lower, upper] : {std::pair{3.929, 3.989}, {10.78, 11.28}}) {
        out.bands.push_back({"", "W m-2 sr-1 um-1", 0.5 * (lower + upper), upper - lower, {}});
        for (int row = 0; row < kRows; ++row)
            for (int col = 0; col < kCols; ++col) {
                double L = band(300.0, lower, upper);
                for (const auto& fire : kPlanted)
                    if (fire.col == col && fire.row == row)
                        L += fire.area_m2 * 1e-6 * (band(fire.temperature_K, lower, upper) - L);
                pixels.push_back(static_cast<float>(L));
            }
    }
    gis::write_cog(file, out, pixels);
}

TEST(FrpCommand, FindsThePowerOfPlantedFires) {
    const ScratchFolder scratch;
    // UTM: the scale of the map at 3 degrees from the central meridian leaves areas within 0.2 %.
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    for (const std::string method : {"mir", "bispectral"}) {
        const auto out = scratch / (method + ".tif");
        const auto result = pyroscene_cli("frp " + (scratch / "modis.tif").string() + " --coefficient modis --method " +
                                          method + " -o " + out.string());
        ASSERT_EQ(result.exit_code, 0) << result.output;
        EXPECT_NE(result.output.find("5 fire pixels, 0 without"), std::string::npos) << result.output;
        const auto image = gis::read_image(out);
        const auto power = plane(image, 1), mask = plane(image, 2);
        for (const auto& fire : kPlanted) {
            const auto i = static_cast<std::size_t>(fire.row * kCols + fire.col);
            EXPECT_EQ(mask[i], 1.0);
            EXPECT_NEAR(power[i] / (method == "mir" ? fire.mir_MW : fire.power_MW), 1.0, 0.006)
                << fire.temperature_K << ' ' << method;
            if (method == "bispectral") {
                EXPECT_NEAR(plane(image, 3)[i] * 1e6, fire.area_m2, 2e-3 * fire.area_m2);
                EXPECT_NEAR(plane(image, 4)[i], fire.temperature_K, 1.0);
            }
        }
        EXPECT_TRUE(std::isnan(power[0]));
        const auto pixels = read_csv(scratch / (method + "_pixels.csv")),
                   fires = read_csv(scratch / (method + "_fires.csv"));
        ASSERT_EQ(pixels.rows.size(), kPlanted.size());
        EXPECT_EQ(pixels.columns.front(), "latitude");
        EXPECT_EQ(pixels.rows[0][pixels.column("acq_time")], "1905");
        EXPECT_NEAR(pixels.numbers("scan")[0], 1.0, 0.002);
        EXPECT_NEAR(fires.numbers("frp_MW")[0], method == "mir" ? 627.0 : 562.0, 4.0);
        EXPECT_NEAR(fires.numbers("longitude")[0], -117.0 + 0.2684, 0.002);  // 520.5 km east: 20.5 km from the meridian
    }
}

TEST(FrpCommand, FitsTheCoefficientAndCorrectsForTheAir) {
    const ScratchFolder scratch;
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    const auto total = [&](const std::string& options) {
        const auto result = pyroscene_cli("frp " + (scratch / "modis.tif").string() + " " + options + " -o " +
                                          (scratch / "out.tif").string());
        EXPECT_EQ(result.exit_code, 0) << result.output;
        double sum = 0.0;
        for (const double MW : read_csv(scratch / "out_fires.csv").numbers("frp_MW")) sum += MW;
        return sum;
    };
    const double fitted = total(""), half = total("--mir-transmittance 0.5"), given = total("--coefficient 2.9193e-9");
    EXPECT_NEAR(fitted / given, 1.0, 1e-3);
    EXPECT_NEAR(half / fitted, 2.0, 1e-4);
    EXPECT_GT(total("--no-background"), fitted);
}

TEST(FrpCommand, RefusesWhatItCannotUse) {
    const ScratchFolder scratch;
    write_image(scratch / "modis.tif", "EPSG:32611", 480000.0, 5200000.0, 1000.0);
    const auto expect = [&](const std::string& arguments, int code, const std::string& text) {
        const auto result = pyroscene_cli("frp " + arguments);
        EXPECT_EQ(result.exit_code, code) << result.output;
        EXPECT_NE(result.output.find(text), std::string::npos) << result.output;
    };
    const auto image = (scratch / "modis.tif").string();
    expect(image + " --coefficient best", 2, "'best' is neither a number");
    expect(image + " --mir-band 3", 3, "no band 3; it has 2");
    expect((scratch / "none.tif").string(), 3, "none.tif");
    const auto dem = (source_folder() / "scenarios/minimal/dem.tif").string();
    expect(dem, 3, "no band between 3 and 5 um");
    EXPECT_FALSE(std::filesystem::exists(scratch / "modis_frp.tif"));
}

/// A fire of 2000 m2 and 900 K whose light the two bands spread differently over four pixels.
TEST(FrpCommand, SolvesGroupsOfPixelsByTheirMeans) {
    const ScratchFolder scratch;
    gis::OutputRaster out;
    out.cols = kCols, out.rows = kRows;
    MapGrid grid;
    grid.cols = kCols, grid.rows = kRows, grid.cell_m = 1000.0, grid.west_m = 480000.0, grid.north_m = 5200000.0;
    grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
    out.grid = grid;
    std::vector<float> pixels;
    constexpr double kShare = 2000e-6;
    const std::array<std::array<double, 4>, 2> spread{{{0.43, 0.3, 0.15, 0.12}, {0.3, 0.4, 0.1, 0.2}}};
    std::size_t number = 0;
    for (const auto& [lower, upper] : {std::pair{3.929, 3.989}, {10.78, 11.28}}) {
        out.bands.push_back({"", "W m-2 sr-1 um-1", 0.5 * (lower + upper), upper - lower, {}});
        const std::size_t first = pixels.size();
        pixels.resize(first + kCols * kRows, static_cast<float>(band(300.0, lower, upper)));
        for (std::size_t k = 0; k < 4; ++k)
            pixels[first + (20 + k / 2) * kCols + 30 + k % 2] +=
                static_cast<float>(kShare * spread[number][k] * (band(900.0, lower, upper) - band(300.0, lower, upper)));
        ++number;
    }
    gis::write_cog(scratch / "spread.tif", out, pixels);
    const auto result =
        pyroscene_cli("frp " + (scratch / "spread.tif").string() +
                      " --method bispectral --mir-noise 0.002 --tir-noise 0.007 -o " + (scratch / "out.tif").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto fires = read_csv(scratch / "out_fires.csv");
    ASSERT_EQ(fires.rows.size(), 1u);
    EXPECT_EQ(fires.numbers("pixels")[0], 4.0);
    EXPECT_NEAR(fires.numbers("mean_fire_area_m2")[0], 2000.0, 15.0);  // the map's scale is 0.2 % here
    EXPECT_NEAR(fires.numbers("mean_temperature_K")[0], 900.0, 2.0);
    EXPECT_NEAR(fires.numbers("mean_frp_MW")[0], 2000.0 * 5.670374e-8 * (std::pow(900.0, 4) - std::pow(300.0, 4)) * 1e-6,
                0.4);
    EXPECT_LT(fires.numbers("correlation")[0], -0.5);  // more area or more heat explain the same radiance
    EXPECT_GT(fires.numbers("mean_temperature_sd_K")[0], 0.5);
    EXPECT_LT(fires.numbers("mean_temperature_sd_K")[0], 100.0);
}

/// A scene that burns all over at one temperature, black, without air: ratio of the power by the MIR method with a = 3.0e-9 to the true
/// one, for a narrow band at 3.96 um.
double rendered_ratio(const ScratchFolder& scratch, int T_K) {
    const auto folder = scratch / std::to_string(T_K);
    std::filesystem::create_directories(folder);
    const auto furnace = (source_folder() / "scenarios" / "furnace").string();
    write_text_file(folder / "camera.yaml", R"(schema: pyroscene-sensor/1
id: mir
name: one band
platform: {type: airborne, name: generic, altitude_agl_m: 120, ground_speed_m_s: 30.0}
geometry:
  scan_type: framing
  frame_interval_s: 2.0
  boresight_offset_deg: [0.0, 0.0, 0.0]
  groups:
    main: {nx: 8, ny: 8, focal_length_mm: 20.0, pixel_pitch_um: 400.0, principal_point_px: [3.5, 3.5], distortion: {model: brown, k: [0, 0, 0], p: [0, 0]}}
bands:
- {id: MIR, group: main, center_um: 3.96, edges_um: [3.955, 3.965], srf: nominal, srf_shape: boxcar}
)");
    write_text_file(
        folder / "scenario.yaml",
        "pyroscene: 1\nname: pure\ninputs:\n  terrain: {file: " + furnace + "/dem.tif}\n  heat_flux: {file: " + furnace +
            "/heat_flux.tif}\nstart: 2000-08-01T18:00:00Z\nfire: {front_temperature_K: " + std::to_string(T_K) +
            ", ambient_temperature_K: 300}\nphysics: thesis\nflame: {enabled: false}\nsurface: {emissivity: 1.0}\n"
            "atmosphere: {model: none}\nrender: {sun: false}\nproducts: [radiance, truth]\nacquisitions:\n"
            "  - {id: nadir, sensor: ./camera.yaml, time_s: 0, platform: {over: fire, altitude_agl_m: 120}}\n");
    auto result = pyroscene_cli("run -q " + (folder / "scenario.yaml").string() + " -o " + (folder / "out").string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    result = pyroscene_cli("frp -q --no-background --coefficient modis " + (folder / "out/nadir/radiance.tif").string() +
                           " -o " + (folder / "frp.tif").string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const auto mir = plane(gis::read_image(folder / "frp.tif"), 0);
    const auto truth = gis::read_image(folder / "out/nadir/truth.tif");
    const auto exitance = plane(truth, "fire_radiant_exitance"), front = plane(truth, "fraction_front");
    double sum_mir = 0.0, sum_true = 0.0;
    for (std::size_t i = 0; i < mir.size(); ++i) {
        if (!(front[i] > 0.999)) continue;
        sum_mir += mir[i];
        sum_true += exitance[i];
    }
    EXPECT_GT(sum_true, 0.0);
    return sum_mir / sum_true;
}

TEST(FrpCommand, FollowsTheTheoreticalCurveOnRenderedScenes) {
    // B(3.96 um) / (3.0e-9 T^4), from an independent program.
    const ScratchFolder scratch;
    for (const auto& [T_K, ratio] :
         {std::pair{700, 0.95}, {800, 1.07}, {900, 1.12}, {1000, 1.11}, {1100, 1.06}, {1200, 1.00}})
        EXPECT_NEAR(rendered_ratio(scratch, T_K) / ratio, 1.0, 0.02) << T_K;
    for (const int T_K : {650, 1350})
        EXPECT_NEAR(rendered_ratio(scratch, T_K) / (radiometry::planck_radiance(3.96, T_K) / (3.0e-9 * std::pow(T_K, 4.0))),
                    1.0, 0.002)
            << T_K;
}

/// A map of power in which a square of 2 x 2 km burns with `power_W_m2`.
void write_power(const std::filesystem::path& file, double cell_m, const std::string& time, double power_W_m2) {
    gis::OutputRaster out;
    const int n = static_cast<int>(10000.0 / cell_m);
    out.cols = out.rows = n;
    MapGrid grid;
    grid.cols = grid.rows = n, grid.cell_m = cell_m, grid.west_m = 480000.0, grid.north_m = 5200000.0;
    grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
    out.grid = grid;
    out.acquisition_time = time;
    out.bands = {{"fire radiative power per area", "W m-2", {}, {}, {}}};
    std::vector<float> pixels(grid.size(), std::nanf(""));
    for (int row = 0; row < n; ++row)
        for (int col = 0; col < n; ++col)
            if (row * cell_m < 2000.0 && col * cell_m < 2000.0)
                pixels[grid.index(row, col)] = static_cast<float>(power_W_m2);
    gis::write_cog(file, out, pixels);
}

TEST(FreCommand, IntegratesPowerOverFramesOfAnyCell) {
    const ScratchFolder scratch;
    write_power(scratch / "b.tif", 500.0, "2019-08-01T19:10:00Z", 30.0);
    write_power(scratch / "a.tif", 1000.0, "2019-08-01T19:00:00Z", 10.0);
    write_power(scratch / "c.tif", 250.0, "2019-08-01T19:40:00Z", 0.0);
    const auto frames =
        (scratch / "b.tif").string() + " " + (scratch / "a.tif").string() + " " + (scratch / "c.tif").string();
    const auto result = pyroscene_cli("fre " + frames + " -o " + (scratch / "fre.tif").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    // 4 km2: 40 MW, 120 MW, 0; 600 s x 80 MW + 1800 s x 60 MW
    const auto series = read_csv(scratch / "fre_series.csv");
    EXPECT_NEAR(series.numbers("frp_MW")[1], 120.0, 1e-3);
    EXPECT_NEAR(series.numbers("fre_MJ")[1], 48000.0, 1.0);
    EXPECT_NEAR(series.numbers("fre_MJ")[2], 156000.0, 3.0);
    const auto map = gis::read_image(scratch / "fre.tif");
    EXPECT_EQ(map.cols, 10);  // of the earliest frame
    EXPECT_NEAR(plane(map, 0)[0], 156000.0 / 4e6, 1e-6);
    EXPECT_NEAR(plane(map, 1)[11], 156000.0 / 4.0, 1.0);
    EXPECT_EQ(plane(map, 0)[5], 0.0);
    EXPECT_EQ(plane(map, 2)[0], 600.0);
    const auto one = pyroscene_cli("fre " + (scratch / "a.tif").string() + " -o " + (scratch / "x.tif").string());
    EXPECT_EQ(one.exit_code, 3);
    const auto twice =
        pyroscene_cli("fre " + (scratch / "a.tif").string() + " " + (scratch / "a.tif").string() + " -o x.tif");
    EXPECT_EQ(twice.exit_code, 3);
    EXPECT_NE(twice.output.find("of the same time"), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::test
