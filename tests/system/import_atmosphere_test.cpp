// MODTRAN output in, look-up table out, scenario through it. The simulated files hold the terms of the shipped table, so the
// numbers to come back are known; real samples are in tests/data/atmosphere.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/constants.h"
#include "gis/netcdf_input.h"
#include "system/modtran_files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

void save(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

std::vector<double> variable(const std::filesystem::path& file, const std::string& name) {
    return gis::read_netcdf_variable(file, name).values;
}

/// Largest difference relative to the largest value nearby: columns are printed with five digits.
void expect_close(const std::vector<double>& found, const std::vector<double>& expected, double relative, double absolute,
                  const std::string& what) {
    ASSERT_EQ(found.size(), expected.size()) << what;
    for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_NEAR(found[i], expected[i], relative * std::abs(expected[i]) + absolute) << what << ", sample " << i;
}

void expect_terms(const std::filesystem::path& table, const SimulatedRun& run) {
    const auto& t = run.terms;
    ASSERT_NEAR(variable(table, "sensor_altitude")[0], run.sensor_altitude_km, 1e-5);
    ASSERT_NEAR(variable(table, "solar_zenith")[0], run.sun_zenith_deg, 1e-4);
    const auto angles = variable(table, "view_zenith");
    ASSERT_NEAR(angles[1], run.view_zenith_deg, 2e-3);  // nadir was put before the run's own angle
    const std::size_t n = t.wavelength_um.size();
    const auto second = [n](const std::vector<double>& v, std::size_t per_angle) {
        return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(n * per_angle),
                                   v.begin() + static_cast<std::ptrdiff_t>(n * per_angle + n));
    };
    expect_close(variable(table, "wavelength"), t.wavelength_um, 2e-6, 0.0, "wavelength");
    expect_close(second(variable(table, "transmittance"), 1), t.transmittance, 0.0, 2e-8, "transmittance");
    expect_close(second(variable(table, "path_thermal_radiance"), 1), t.path_thermal, 1e-4, 1e-9, "path thermal");
    expect_close(second(variable(table, "path_solar_radiance"), 3), t.path_solar, 1e-4, 1e-9, "path solar");
    const auto direct = variable(table, "direct_solar_irradiance"), S = variable(table, "spherical_albedo"),
               diffuse = variable(table, "diffuse_solar_irradiance"), sky = variable(table, "thermal_sky_irradiance");
    for (std::size_t l = 0; l < n; ++l) {
        if (t.transmittance[l] < 0.05) continue;  // reflected light says little there
        SCOPED_TRACE(t.wavelength_um[l]);
        const double E = t.direct_normal[l] + t.diffuse[l] + t.thermal_sky[l];
        ASSERT_NEAR(direct[l], t.direct_normal[l], 3e-4 * t.direct_normal[l] + 1e-6);
        ASSERT_NEAR(S[l], t.spherical_albedo[l], 2e-3);
        if (t.wavelength_um[l] < 3.4) {
            ASSERT_NEAR(diffuse[l], t.diffuse[l] + t.thermal_sky[l], 1e-3 * E);
        } else if (t.wavelength_um[l] > 5.0) {
            ASSERT_NEAR(sky[l], t.thermal_sky[l] + t.diffuse[l], 2e-3 * E + 1e-5);
        }
    }
}

TEST(ImportAtmosphere, TermsComeBackFromEveryModtranFormat) {
    const ScratchFolder scratch;
    const auto dark = simulate(3.0, 30.0, 40.0, 90.0, 0.0), grey = simulate(3.0, 30.0, 40.0, 90.0, 0.5),
               bright = simulate(3.0, 30.0, 40.0, 90.0, 1.0);
    const std::string folder = scratch.path().string();
    save(scratch / "dark.tp7", tape7_text(dark));
    save(scratch / "rest.tp7", tape7_text(grey) + tape7_text(bright));
    save(scratch / "dark.csv", modtran_csv_text(dark));
    save(scratch / "grey.csv", modtran_csv_text(grey));
    save(scratch / "bright.csv", modtran_csv_text(bright));
    save(scratch / "dark.json", modtran_json_text(dark));
    save(scratch / "grey.json", modtran_json_text(grey));
    save(scratch / "bright.json", modtran_json_text(bright));
    save(scratch / "runs.csv",
         "# a MODTRAN6 csv does not say where it looked from\n"
         "file,sensor_altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg,albedo,ground_elevation_km\n"
         "dark.csv,3,30,40,90,0,0\ngrey.csv,3,30,40,90,0.5,0\nbright.csv,3,30,40,90,1,0\n");
    for (const std::string files : {"dark.tp7 {}/rest.tp7", "runs.csv", "dark.json {}/grey.json {}/bright.json"}) {
        std::string list = files;
        for (auto at = list.find("{}"); at != std::string::npos; at = list.find("{}")) list.replace(at, 2, folder);
        SCOPED_TRACE(files);
        const auto result = pyroscene_cli("import-atmosphere " + folder + "/" + list + " -o " + folder + "/air.nc");
        ASSERT_EQ(result.exit_code, 0) << result.output;
        expect_terms(scratch / "air.nc", dark);
    }
}

TEST(ImportAtmosphere, ScenarioThroughAnImportedTableLooksLikeTheShippedOne) {
    const ScratchFolder scratch;
    const std::string folder = scratch.path().string();
    auto night = simulate(0.3, 0.0, 40.0, 0.0, 0.0), mirror = simulate(0.3, 0.0, 40.0, 0.0, 1.0);
    night.sun = mirror.sun = false;
    save(scratch / "night.tp7", tape7_text(night) + tape7_text(mirror));
    ASSERT_EQ(pyroscene_cli("import-atmosphere --no-sun " + folder + "/night.tp7 -o " + folder + "/air.nc").exit_code, 0);
    const auto minimal = source_folder() / "scenarios/minimal";
    std::ifstream camera(minimal / "camera.yaml");
    std::string ideal;  // without noise, saturation and counts, whose steps are larger than the differences
    for (std::string line; std::getline(camera, line);)
        if (!line.starts_with("digitisation") && !line.starts_with("  noise") && !line.starts_with("  saturation"))
            ideal += line + "\n";
    save(scratch / "camera.yaml", ideal);
    const auto scenario = [&](const std::string& name, const std::string& atmosphere) {
        save(scratch / (name + ".yaml"),
             "pyroscene: 1\ninputs:\n  terrain:   {file: " + (minimal / "dem.tif").string() +
                 "}\n  heat_flux: {file: " + (minimal / "heat_flux.tif").string() +
                 "}\nstart: 2021-08-12T20:00:00Z\nrender: {sun: false}\natmosphere: " + atmosphere +
                 "\nproducts: [radiance]\nacquisitions:\n  - {id: a, sensor: " + std::string("camera.yaml") +
                 ", time_s: 120, platform: {over: centre, altitude_agl_m: 300}}\n");
        const auto run = pyroscene_cli("run " + folder + "/" + name + ".yaml -o " + folder + "/" + name);
        EXPECT_EQ(run.exit_code, 0) << run.output;
        return gis::read_image(scratch / name / "a" / "radiance.tif");
    };
    const auto imported = scenario("imported", "{file: air.nc}");
    const auto shipped = scenario("shipped", "{model: midlatitude_summer, ground_elevation_m: 0}");
    const auto empty = scenario("empty", "{model: none}");
    ASSERT_EQ(imported.bands.size(), shipped.bands.size());
    for (std::size_t band = 0; band < imported.bands.size(); ++band) {
        const auto a = plane(imported, band), b = plane(shipped, band), none = plane(empty, band);
        double air = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            ASSERT_NEAR(a[i], b[i], 2e-3 * b[i] + 2e-7) << "band " << band << ", pixel " << i;
            air = std::max(air, std::abs(b[i] / none[i] - 1.0));
        }
        EXPECT_GT(air, 0.01) << "the air changes nothing in band " << band << ", so the comparison tells nothing";
    }
}

TEST(ImportAtmosphere, RealChannelFile) {
    const ScratchFolder scratch;
    const auto out = (scratch / "air.nc").string();
    const auto sample = (source_folder() / "tests/data/atmosphere/modtran6_channels.chn").string();
    const auto unknown = pyroscene_cli("import-atmosphere " + sample + " -o " + out);
    EXPECT_EQ(unknown.exit_code, 3);
    EXPECT_NE(unknown.output.find("where the sun stood"), std::string::npos) << unknown.output;
    const std::string geometry = " --sensor-altitude-km 100 --view-zenith-deg 0 --sun-zenith-deg 32.7 -o " + out;
    const auto result = pyroscene_cli("import-atmosphere " + sample + geometry);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    // First row of the file: width 10.4277 nm, scattered 1.308155e-5 + 2.598702e-5, transmittance 0.6517187, S 0.2501217.
    EXPECT_NEAR(variable(out, "wavelength")[0], 0.37559409, 1e-6);
    EXPECT_NEAR(variable(out, "transmittance")[0], 0.6517187, 1e-6);
    EXPECT_NEAR(variable(out, "path_solar_radiance")[0], (1.308155e-5 + 2.598702e-5) / 10.4277 * 1e7, 1e-3);
    EXPECT_NEAR(variable(out, "spherical_albedo")[0], 0.2501217, 1e-6);
    EXPECT_NEAR(variable(out, "diffuse_upward_transmittance")[0], 0.1448291 / 0.5251463 * 0.6517187, 1e-6);
    EXPECT_EQ(variable(out, "wavelength").size(), 223U);
}

TEST(AtmosphereDeck, Tape5HasTheCardsInTheirColumns) {
    const ScratchFolder scratch;
    const auto scenario = (source_folder() / "scenarios/minimal/scenario.yaml").string();
    ASSERT_EQ(pyroscene_cli("atmosphere-deck " + scenario + " --acquisition camera_150s --for modtran5 -o " +
                            scratch.path().string())
                  .exit_code,
              0);
    std::ifstream in(scratch / "tape5");
    std::vector<std::string> cards;
    for (std::string line; std::getline(in, line);) cards.push_back(line);
    ASSERT_GE(cards.size(), 8U);
    EXPECT_EQ(cards[0].substr(0, 20), "TM  2    2    2    1");  // mid-latitude summer, slant path, thermal and sun
    EXPECT_EQ(cards[1].substr(0, 6), "TTF  8");                 // DISORT of 8 streams that knows the sun's azimuth
    EXPECT_NEAR(std::stod(cards[2].substr(30, 10)), 23.0, 1e-9);
    EXPECT_NEAR(std::stod(cards[3].substr(20, 10)), 180.0, 1e-4);
    EXPECT_EQ(cards[4].substr(0, 10), "    2    2");
    EXPECT_EQ(std::stoi(cards[4].substr(10, 5)), 224);  // 12 August
    EXPECT_EQ(cards[6].substr(40, 2), "RW");
    EXPECT_EQ(cards[7], "    1");
    EXPECT_EQ(cards.back(), "    0");
    const auto wrong = pyroscene_cli("atmosphere-deck " + scenario + " --acquisition nobody -o " + scratch.path().string());
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_NE(wrong.output.find("camera_150s"), std::string::npos) << wrong.output;
}

TEST(ImportAtmosphere, CheckSeesThatATableDoesNotCoverTheBands) {
    const ScratchFolder scratch;
    const auto minimal = source_folder() / "scenarios/minimal";
    save(scratch / "air.csv",
         "wavelength_um,transmittance,path_thermal_W_m2_sr_um,thermal_irradiance_W_m2_um\n7.5,0.6,3,12\n15,0.6,3,12\n");
    save(scratch / "s.yaml", "pyroscene: 1\ninputs:\n  terrain:   {file: " + (minimal / "dem.tif").string() +
                                 "}\n  heat_flux: {file: " + (minimal / "heat_flux.tif").string() +
                                 "}\nstart: 2021-08-12T20:00:00Z\natmosphere: {file: air.nc}\nacquisitions:\n  - {id: a, "
                                 "sensor: " +
                                 (minimal / "camera.yaml").string() +
                                 ", time_s: 120, platform: {over: centre, altitude_agl_m: 300}}\n");
    const auto folder = scratch.path().string();
    const auto made = pyroscene_cli("import-atmosphere " + folder + "/air.csv --no-sun --sensor-altitude-km 0.3 " +
                                    "--view-zenith-deg 0 --ground-elevation-km 0.9 -o " + folder + "/air.nc");
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const auto check = pyroscene_cli("check " + folder + "/s.yaml");
    EXPECT_EQ(check.exit_code, 3) << check.output;
    EXPECT_NE(check.output.find("air.nc: covers 7.5 to 15 um, the bands need"), std::string::npos) << check.output;
    std::filesystem::copy_file(scratch / "air.csv", scratch / "air.nc", std::filesystem::copy_options::overwrite_existing);
    const auto text = pyroscene_cli("check " + folder + "/s.yaml");
    EXPECT_EQ(text.exit_code, 3) << text.output;
    EXPECT_NE(text.output.find("(import-atmosphere makes such tables)"), std::string::npos) << text.output;
}

TEST(AtmosphereDeck, HoldsWhatTheAcquisitionTakes) {
    // WASP's infrared group alone: 0.9 to 9.2 um, not the 0.4 um of its visible camera; and no deck for a scene without air.
    const ScratchFolder scratch;
    const auto minimal = source_folder() / "scenarios/minimal";
    const auto deck = [&](const std::string& atmosphere) {
        save(scratch / "s.yaml",
             "pyroscene: 1\ninputs:\n  terrain:   {file: " + (minimal / "dem.tif").string() + "}\n  heat_flux: {file: " +
                 (minimal / "heat_flux.tif").string() + "}\nstart: 2021-08-12T20:00:00Z\natmosphere: {model: " + atmosphere +
                 "}\nacquisitions:\n  - {id: a, sensor: wasp, groups: [ir], time_s: 120, platform: {over: "
                 "centre, altitude_agl_m: 3000}}\n");
        const auto folder = scratch.path().string();
        return pyroscene_cli("atmosphere-deck " + folder + "/s.yaml --acquisition a --for libradtran -o " + folder);
    };
    ASSERT_EQ(deck("tropical").exit_code, 0);
    std::ifstream in(scratch / "path_solar_0_0.inp");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("wavelength 891 5000\n"), std::string::npos) << text;
    EXPECT_NE(text.find("mixing_ratio CO2 420\n"), std::string::npos) << text;
    const auto none = deck("none");
    EXPECT_EQ(none.exit_code, 3);
    EXPECT_NE(none.output.find("atmosphere.model"), std::string::npos) << none.output;
}

TEST(ImportAtmosphere, RefusesWhatItCannotUse) {
    const ScratchFolder scratch;
    const std::string folder = scratch.path().string(), samples = (source_folder() / "tests/data/atmosphere").string();
    const auto dark = tape7_text(simulate(3.0, 30.0, 40.0, 90.0, 0.0));
    const auto refuses = [&](const std::string& arguments, const std::string& message) {
        const auto result = pyroscene_cli("import-atmosphere " + arguments + " -o " + folder + "/no.nc");
        EXPECT_EQ(result.exit_code, 3) << arguments << "\n" << result.output;
        EXPECT_NE(result.output.find(message), std::string::npos) << arguments << "\n" << result.output;
        EXPECT_FALSE(std::filesystem::exists(scratch / "no.nc"));
    };
    const auto with = [&](const std::string& name, std::string text, const std::string& what, const std::string& by) {
        const auto at = text.rfind(what);
        EXPECT_NE(at, std::string::npos) << what;
        text.replace(at, what.size(), by);
        save(scratch / name, text);
        return folder + "/" + name;
    };
    refuses(folder + "/nothing.tp7", "no such file");
    save(scratch / "prose.tp7", "This is no table.\n");
    refuses(folder + "/prose.tp7", "no MODTRAN tape7 table");
    refuses(with("cut.tp7", dark, " -9999.", ""), "cut off");
    refuses(with("stars.tp7", dark, "0.00E+00 0.00E+00", "******** 0.00E+00"), "expected a number");
    refuses(samples + "/modtran5_tape7_iemsct2_imult1.txt", "no run looks from a sensor down");
    refuses(samples + "/modtran5_tape7_iemsct0.txt",
            "the sensor altitude of this run is unknown; give --sensor-altitude-km");
    refuses(samples + "/modtran5_tape7_iemsct3.txt --sun-zenith-deg 30", "the path of this run is level");
    save(scratch / "dark.tp7", dark);
    refuses(folder + "/dark.tp7", "no run gives the sun at the ground");
    refuses(folder + "/dark.tp7 --unit uW_cm2_nm", "with W_cm2_cm-1 it would fit");
    const std::string uvspec = " --format uvspec --columns lambda,edir,edn --source solar --sun-zenith-deg 40";
    save(scratch / "watts.out", "500 1.2 0.1\n600 1.1 0.1\n");  // W m-2 nm-1
    refuses(folder + "/watts.out" + uvspec, "the direct sun is at most");
    save(scratch / "milliwatts.out", "500 1200 100\n600 1100 100\n");
    refuses(folder + "/milliwatts.out" + uvspec + " --unit W_m2_nm", "is the unit right?");
    save(scratch / "units.csv", "file,unit\ndark.tp7,furlong\n");
    refuses(folder + "/units.csv", "units.csv:2, unit: 'furlong' is unknown");
    refuses(folder + "/dark.tp7 --unit parsec", "'parsec' is unknown");
    save(scratch / "broken.json", "{\"MODTRAN\": [");
    refuses(folder + "/broken.json", "is no JSON");
    save(scratch / "input.json", "{\"MODTRAN\": [{\"MODTRANINPUT\": {}}]}");
    refuses(folder + "/input.json", "has no MODTRANOUTPUT");
    save(scratch / "short.csv", "FREQ,TOT_TRANS,TOTAL_RAD\n1000,0.5\n");
    refuses(folder + "/short.csv", "short.csv:2: 2 fields, expected 3");
    save(scratch / "high.csv", "FREQ,TOT_TRANS\n1000,1.5\n1001,0.5\n");
    refuses(folder + "/high.csv", "transmittance 1.5");
    save(scratch / "list.csv", "file,colour\ndark.tp7,red\n");
    refuses(folder + "/list.csv", "column 'colour' is unknown");
    save(scratch / "table.csv", "wavelength_um,transmittance\n1,0.5\n2,1.5\n");
    refuses(folder + "/table.csv", "transmittance is 1.5");
    save(scratch / "uvspec.out", "500 1 2 3\n501 1 2\n");
    refuses(folder + "/uvspec.out --format uvspec", "name their columns");
    refuses(folder + "/uvspec.out --columns lambda,edir,edn,eup", "uvspec.out:2: 3 numbers");
}

}  // namespace
}  // namespace pyroscene::test
