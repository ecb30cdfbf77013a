// The commands as a user types them: exit codes, calc values, help.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <regex>

#include "base/csv.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

double single_result(const std::string& output) { return std::stod(output.substr(output.find('=') + 1)); }

TEST(Cli, ExitCodes) {
    EXPECT_EQ(pyroscene_cli("--help").exit_code, 0);
    EXPECT_EQ(pyroscene_cli("--version").exit_code, 0);
    EXPECT_EQ(pyroscene_cli("").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("dance").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("run").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("run nothing.yaml").exit_code, 3);
    EXPECT_EQ(pyroscene_cli("calc dance").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("calc planck --wavelength_um 4 --colour red").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("calc planck --wavelength_um four --temperature_K 1100").exit_code, 3);
}

TEST(Cli, EveryVerbHasHelpWithAnExample) {
    for (const std::string verb : {"run", "prepare", "render", "products", "check", "sensors", "calc", "fit-scar", "export",
                                   "import-atmosphere", "atmosphere-deck"}) {
        const auto help = pyroscene_cli(verb + " --help");
        EXPECT_EQ(help.exit_code, 0) << verb;
        EXPECT_NE(help.output.find("Example: pyroscene " + verb), std::string::npos) << verb << "\n" << help.output;
    }
}

// Values: CODATA Planck (thesis-case checks), eq 4.22 with the unit right, Nelson's buoyant velocity, eq 4.18 at t = 0.
TEST(Calc, KnownValues) {
    const auto value = [](const std::string& words) { return single_result(pyroscene_cli("calc " + words).output); };
    EXPECT_NEAR(value("planck --wavelength_um 4 --temperature_K 1100"), 4595.535, 0.001);
    EXPECT_NEAR(value("brightness-temperature --wavelength_um 3.96 --radiance_W_m2_sr_um 0.6726"), 300.0, 0.01);
    EXPECT_NEAR(value("band-radiance --lower_um 3 --upper_um 5 --temperature_K 1100"), 4634.83, 0.05);
    EXPECT_NEAR(value("band-radiance --sensor wasp --band MWIR --temperature_K 600"), 273.55, 0.01);
    EXPECT_NEAR(value("flame-height --heat_flux_W_m2 5.92e6"), 2.96, 1e-9);
    EXPECT_NEAR(value("flame-tilt --wind_m_s 3 --fireline_intensity_kW_m 500"), 44.79912, 1e-4);
    EXPECT_NEAR(value("scar-temperature --time_s 0"), 809.66 + 273.15, 1e-6);
    EXPECT_NEAR(value("scar-temperature --time_s 600"), 50.90711 + 273.15, 1e-5);
    EXPECT_NEAR(value("scar-temperature --time_s 100 --model single_exponential"), 315.79561 + 273.15, 1e-4);
    EXPECT_NEAR(value("scar-temperature --time_s 60 --model single_exponential --amplitude1_K 800 --floor_K 273.15"),
                439.0493 + 273.15, 1e-4);
    EXPECT_EQ(pyroscene_cli("calc scar-temperature --time_s 60 --model cubic").exit_code, 3);
    EXPECT_NEAR(value("atmosphere --wavelength_um 0.55 --altitude_m 4200"), 0.724, 0.002);
}

TEST(Calc, RefusesWhatHasNoMeaning) {
    const auto refused = [](const std::string& words, const std::string& reason) {
        const auto result = pyroscene_cli("calc " + words);
        EXPECT_EQ(result.exit_code, 3) << words;
        EXPECT_NE(result.output.find(reason), std::string::npos) << result.output;
    };
    refused("planck --wavelength_um -4 --temperature_K 1100", "--wavelength_um: found -4, expected more than 0");
    refused("planck --wavelength_um nan --temperature_K 1100", "--wavelength_um: found nan, expected more than 0");
    refused("planck --wavelength_um 4 --temperature_K -1", "--temperature_K: found -1, expected at least 0");
    refused("scar-temperature --time_s -5", "--time_s: found -5, expected at least 0");
    refused("flame-height --method byram --fireline_intensity_kW_m -5", "--fireline_intensity_kW_m: found -5");
    refused("flame-tilt --method albini --wind_m_s -3 --flame_height_m 2", "--wind_m_s: found -3");
    refused("atmosphere --wavelength_um 4 --altitude_m -3000", "--altitude_m: found -3000, expected at least 0");
    refused("atmosphere --wavelength_um 4 --altitude_m 3000 --view_zenith_deg 100",
            "--view_zenith_deg: found 100, expected 0 to 90");
    EXPECT_NE(
        pyroscene_cli("calc atmosphere --wavelength_um 4 --altitude_m 3000 --view_zenith_deg 80")
            .output.find("warning: atmosphere: view zenith 80 deg is beyond the tables; Beer's law goes on from 65 deg"),
        std::string::npos);
}

TEST(Calc, TableKeepsItsColumnsAndAppendsResults) {
    const ScratchFolder scratch;
    std::ofstream(scratch / "in.csv") << "# points\nname,wavelength_um,temperature_K\na,4,1100\nb,11,300\n";
    const auto result =
        pyroscene_cli("calc planck --csv " + (scratch / "in.csv").string() + " -o " + (scratch / "out.csv").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto table = read_csv(scratch / "out.csv");
    EXPECT_EQ(table.columns, (std::vector<std::string>{"name", "wavelength_um", "temperature_K", "radiance_W_m2_sr_um"}));
    const auto radiance = table.numbers("radiance_W_m2_sr_um");
    EXPECT_NEAR(radiance[0], 4595.535, 0.001);
    EXPECT_NEAR(radiance[1], 9.573, 0.001);
}

// Reference flame (H2O 0.14, CO2 0.10, CO 0.02), 1100 K, 1 m: radiances of the independent check program for fv 1e-7; depth of
// the gas alone at 4.3 and 10.6 um against RADCAL; potassium: 1042 1/m at the centre of D2 with 1 ppm makes any flame black.
TEST(Calc, FlameEmissivity) {
    const ScratchFolder scratch;
    std::ofstream(scratch / "in.csv") << "wavelength_um,soot_volume_fraction,potassium_ppm\n0.77,1e-7,0\n1.2,1e-7,0\n"
                                         "2.2,1e-7,0\n3.9,1e-7,0\n4.3,1e-7,0\n10.6,1e-7,0\n10.6,0,0\n0.766700922,1e-7,1\n";
    const auto result = pyroscene_cli("calc flame-emissivity --temperature_K 1100 --path_m 1 --csv " +
                                      (scratch / "in.csv").string() + " -o " + (scratch / "out.csv").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto table = read_csv(scratch / "out.csv");
    const auto radiance = table.numbers("radiance_W_m2_sr_um"), emissivity = table.numbers("emissivity");
    const std::vector<double> expected{7.676, 263.8, 1228.0, 624.7, 4062.0, 60.07};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(radiance[i], expected[i], 1e-3 * expected[i]);
    EXPECT_NEAR(-std::log1p(-emissivity[6]), 0.142, 0.0006);
    EXPECT_GT(emissivity[7], 0.9999999);
    // Not told otherwise, the flame is that of a scenario: 1 ppm of potassium.
    const auto usual = pyroscene_cli("calc flame-emissivity --temperature_K 1100 --path_m 1 --wavelength_um 0.766700922");
    EXPECT_NE(usual.output.find("emissivity = 1\n"), std::string::npos) << usual.output;

    const auto too_much =
        pyroscene_cli("calc flame-emissivity --wavelength_um 4 --temperature_K 1100 --path_m 1 --x_h2o 0.95");
    EXPECT_EQ(too_much.exit_code, 3);
    EXPECT_NE(too_much.output.find("x_co2"), std::string::npos) << too_much.output;
    const auto cold = pyroscene_cli("calc flame-emissivity --wavelength_um 4 --temperature_K 0 --path_m 1");
    EXPECT_EQ(cold.exit_code, 3);
    EXPECT_NE(cold.output.find("temperature_K"), std::string::npos) << cold.output;
}

// --plot needs no wavelength and draws emissivity above radiance.
TEST(Calc, FlameEmissivityPlotsItsSpectrum) {
    const ScratchFolder scratch;
    const auto file = (scratch / "flame.png").string();
    const auto drawn = pyroscene_cli("calc flame-emissivity --temperature_K 1100 --path_m 1 --plot " + file);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    EXPECT_TRUE(drawn.output.empty()) << drawn.output;
    const auto bytes = file_bytes(file);
    ASSERT_EQ(bytes.substr(1, 3), "PNG");
    EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\3\x84\0\0\3\xC0", 8));  // 900 x 960 pixels: two diagrams
    EXPECT_EQ(pyroscene_cli("calc flame-emissivity --temperature_K 1100 --plot " + file).exit_code, 3);
    const auto low = pyroscene_cli("calc atmosphere --altitude_m 3000 --view_zenith_deg 80 --plot " + file);
    EXPECT_NE(low.output.find("warning: atmosphere: view zenith 80 deg"), std::string::npos) << low.output;
}

TEST(Calc, EveryNameHasHelpWithAnExampleThatWorks) {
    for (const std::string name :
         {"planck", "brightness-temperature", "band-radiance", "band-temperature", "atmosphere", "flame-emissivity",
          "flame-height", "flame-tilt", "thesis-potassium", "alkali-width", "spread", "scar-temperature"}) {
        const auto help = pyroscene_cli("calc " + name + " --help");
        ASSERT_EQ(help.exit_code, 0) << name;
        const std::string tag = "Example: pyroscene ";
        const auto at = help.output.find(tag + "calc " + name);
        ASSERT_NE(at, std::string::npos) << help.output;
        EXPECT_EQ(help.output.find("planck") == std::string::npos, name != "planck") << "help of others:\n" << help.output;
        const auto words = help.output.substr(at + tag.size());
        const auto result = pyroscene_cli(words.substr(0, words.find('\n')));
        EXPECT_EQ(result.exit_code, 0) << words << result.output;
    }
    EXPECT_NE(pyroscene_cli("calc atmosphere --help").output.find("--plot FILE"), std::string::npos);
}

TEST(Calc, PrintsSpectraAndWritesTablesAndJson) {
    const ScratchFolder scratch;
    const std::string flame = "calc flame-emissivity --temperature_K 1100 --path_m 1 --soot_volume_fraction 1e-7 ";
    ASSERT_EQ(pyroscene_cli(flame + "-o " + (scratch / "flame.csv").string()).exit_code, 0);
    const auto spectrum = read_csv(scratch / "flame.csv");
    EXPECT_EQ(spectrum.columns, (std::vector<std::string>{"wavelength_um", "emissivity", "radiance_W_m2_sr_um"}));
    EXPECT_GT(spectrum.rows.size(), 3000U);
    EXPECT_NEAR(spectrum.numbers("wavelength_um").back(), 15.0, 0.02);
    ASSERT_EQ(pyroscene_cli("calc atmosphere --altitude_m 4200 -o " + (scratch / "air.csv").string()).exit_code, 0);
    EXPECT_EQ(read_csv(scratch / "air.csv").rows.size(), 1047U);
    ASSERT_EQ(pyroscene_cli(flame + "--wavelength_um 3.9 -o " + (scratch / "one.csv").string()).exit_code, 0);
    const auto one = read_csv(scratch / "one.csv");
    EXPECT_NEAR(one.numbers("radiance_W_m2_sr_um").at(0), 624.7, 0.7);
    EXPECT_EQ(one.numbers("path_m").at(0), 1.0);
    const auto json = pyroscene_cli("calc planck --wavelength_um 4 --temperature_K 1100 --json");
    EXPECT_NE(json.output.find("\"radiance_W_m2_sr_um\": 4595.5"), std::string::npos) << json.output;
}

// 855 m of VIIRS hold whole cells of 30 m, 3 m of WASP do not: the estimate says which images take more where fire burns.
TEST(Check, SaysWhatItsEstimateLeavesOut) {
    const auto scenario = [](const char* file) { return (source_folder() / "scenarios" / file).string(); };
    const auto output = pyroscene_cli("check " + scenario("lolo_peak/scanners.yaml")).output;
    const auto line_of = [&](const std::string& text) {
        const auto at = output.find(text);
        return at == std::string::npos ? "" : output.substr(at, output.find('\n', at) - at);
    };
    EXPECT_NE(line_of("viirs-snpp group m").find("9 rays per pixel and many more where fire burns in its 8"),
              std::string::npos)
        << output;
    EXPECT_EQ(line_of("wasp group ir").find("many more"), std::string::npos) << output;
    EXPECT_NE(line_of("estimated rendering time").find("not counted: more rays for fire in wide pixels, light of flames"),
              std::string::npos)
        << output;
    const auto narrow = pyroscene_cli("check " + scenario("minimal/scenario.yaml"));
    EXPECT_EQ(narrow.exit_code, 0) << narrow.output;
    EXPECT_EQ(narrow.output.find("wide pixels"), std::string::npos) << narrow.output;
    // Few bands are told one by one.
    EXPECT_TRUE(std::regex_search(narrow.output,
                                  std::regex(R"(3 bands on \d+ transport wavelengths \(SWIR: \d+, MWIR: \d+, LWIR: \d+)")))
        << narrow.output;
}

// What a run warns of, check says before: here the sun, lower than the tables go.
TEST(Check, WarnsWhereTheTablesOfTheAirEnd) {
    const auto low_sun = pyroscene_cli("check " + (source_folder() / "scenarios/field_flame/gas_bands.yaml").string());
    EXPECT_EQ(low_sun.exit_code, 0) << low_sun.output;
    EXPECT_NE(low_sun.output.find("warning: atmosphere: sun zenith"), std::string::npos) << low_sun.output;
}

TEST(Sensors, ListAndDetails) {
    const auto list = pyroscene_cli("sensors");
    EXPECT_EQ(list.exit_code, 0);
    for (const std::string id : {"wasp", "wasp-thesis", "generic-framing"})
        EXPECT_NE(list.output.find(id), std::string::npos);
    const auto one = pyroscene_cli("sensors wasp");
    EXPECT_NE(one.output.find("MWIR"), std::string::npos);
    EXPECT_NE(pyroscene_cli("sensors wasp --json").output.find("\"saturation_radiance_W_m2_sr_um\""), std::string::npos);
    const auto wrong = pyroscene_cli("sensors wsap");
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_NE(wrong.output.find("wasp"), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::test
