// Input files for MODTRAN and libRadtran, and the way back: the "code" is played by the shipped table, which answers every run that
// the deck asks for, as the deck writes it. What import-atmosphere makes of the answers must be that table again.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "base/files.h"
#include "gis/netcdf_input.h"
#include "radiometry/planck.h"
#include "system/modtran_files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kEarth_km = 6371.23;

std::string scenario_file() { return (source_folder() / "scenarios/minimal/scenario.yaml").string(); }

void write_deck(const ScratchFolder& folder, const std::string& code) {
    const auto result = pyroscene_cli("atmosphere-deck " + scenario_file() + " --acquisition camera_150s --for " + code +
                                      " -o " + folder.path().string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
    std::istringstream in(read_text_file(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

double field(const std::string& card, std::size_t begin, std::size_t width) { return std::stod(card.substr(begin, width)); }

/// Rows of a table between the limits of card 4; its header and end stay.
std::string within(const std::string& table, const std::string& card4) {
    const double low = field(card4, 0, 10), high = field(card4, 10, 10);
    std::istringstream in(table);
    std::string text;
    for (std::string line; std::getline(in, line);) {
        double wavenumber = 0.0;
        const bool is_row = static_cast<bool>(std::istringstream(line) >> wavenumber) && wavenumber > 0.0;
        if (!is_row || (wavenumber >= low && wavenumber <= high)) text += line + "\n";
    }
    return text;
}

/// MODTRAN 5 as far as geometry goes: the cards of each run are echoed above its table as in the real files of
/// tests/data/atmosphere, without card 1A and with -99 where there is no sun.
std::string run_modtran5(const std::vector<std::string>& tape5) {
    std::string tape7;
    double sun_deg = 45.0;  // at the ground: that of the first run, which looks straight down
    for (std::size_t i = 0; i < tape5.size();) {
        const std::string &card1 = tape5[i], &card3 = tape5[i + 3];
        const bool sun = std::stoi(card1.substr(10, 5)) == 2;
        const double albedo = field(card1, card1.size() - 7, 7), h1_km = field(card3, 0, 10), h2_km = field(card3, 10, 10);
        const double nadir_rad = (180.0 - field(card3, 20, 10)) * kDegree_rad;
        const double view_deg =
            std::asin(std::min(1.0, std::sin(nadir_rad) * (kEarth_km + h1_km) / (kEarth_km + h2_km))) / kDegree_rad;
        const std::size_t cards = sun ? 8 : 6;
        if (sun && view_deg < 1e-6) sun_deg = field(tape5[i + 5], 10, 10);
        auto run = simulate(h1_km - h2_km, view_deg, sun_deg, sun ? field(tape5[i + 5], 0, 10) : 0.0, albedo);
        run.sun = sun;
        tape7 += card1 + "\n" + tape5[i + 2] + "\n" + card3 + "\n";
        tape7 += sun ? tape5[i + 4] + "\n" + tape5[i + 5] + "\n" : "  -99  -99  -99  -99\n -99.00000 -99.00000\n";
        tape7 += tape5[i + cards - 2] + "\n" + tape5[i + cards - 1] + "\n" + within(tape7_table(run), tape5[i + cards - 2]);
        i += cards;
    }
    return tape7;
}

struct Listed {
    std::string file;
    std::map<std::string, std::string> cell;
    [[nodiscard]] double number(const std::string& name, double otherwise = 0.0) const {
        const auto found = cell.find(name);
        return found == cell.end() || found->second.empty() ? otherwise : std::stod(found->second);
    }
    [[nodiscard]] SimulatedRun simulated(double sun_deg) const {
        auto run = simulate(number("sensor_altitude_km"), number("view_zenith_deg"), sun_deg, number("relative_azimuth_deg"),
                            number("albedo"));
        run.sun = !cell.at("sun_zenith_deg").empty();
        return run;
    }
};

std::vector<Listed> listed_runs(const std::filesystem::path& file) {
    const auto table = read_csv(file);
    std::vector<Listed> runs;
    for (const auto& row : table.rows) {
        Listed run{row[0], {}};
        for (std::size_t c = 0; c < row.size(); ++c) run.cell[table.columns[c]] = row[c];
        runs.push_back(run);
    }
    return runs;
}

double sun_of(const std::vector<Listed>& runs) {
    for (const auto& run : runs)
        if (run.number("sun_zenith_deg") > 0.0) return run.number("sun_zenith_deg");
    return 0.0;
}

/// uvspec: the columns that the list names, over the wavelengths of the input file.
std::string run_uvspec(const Listed& listed, const std::string& input, double sun_deg) {
    const auto run = listed.simulated(sun_deg);
    std::istringstream wavelength(input.substr(input.find("\nwavelength ") + 12));
    double low_nm = 0.0, high_nm = 0.0;
    wavelength >> low_nm >> high_nm;
    const std::string columns = listed.cell.at("columns");
    const bool thermal = listed.cell.at("source") == "thermal";
    const double A = run.albedo, T_K = listed.number("surface_temperature_K");
    std::string text;
    for (std::size_t l = 0; l < run.terms.wavelength_um.size(); ++l) {
        const auto& t = run.terms;
        const double nm = 1e3 * t.wavelength_um[l];
        if (nm < low_nm || nm > high_nm) continue;
        const double beam = t.direct_normal[l] * std::cos(sun_deg * kDegree_rad),
                     sky = (beam + t.diffuse[l]) / (1.0 - A * t.spherical_albedo[l]) - beam;
        if (columns == "lambda zout edir")
            text += fmt::format("{0:.3f} 0 {1:.8e}\n{0:.3f} {2:.6g} {3:.8e}\n", nm, 500.0 * t.transmittance[l],
                                run.sensor_altitude_km, 500.0);
        else if (columns == "lambda edir edn")
            text += fmt::format("{:.3f} {:.8e} {:.8e}\n", nm, beam, sky);
        else if (columns == "lambda edn")
            text += fmt::format("{:.3f} {:.8e}\n", nm, 1e-3 * t.thermal_sky[l]);
        else
            text += fmt::format("{:.3f} {:.8e}\n", nm,
                                thermal ? 1e-3 * (t.path_thermal[l] +
                                                  t.transmittance[l] * radiometry::planck_radiance(t.wavelength_um[l], T_K))
                                        : t.path_solar[l]);
    }
    return text;
}

/// The table against the shipped one: every view angle and azimuth of the deck.
void expect_the_table_again(const std::filesystem::path& file, double altitude_km, double sun_deg) {
    const auto variable = [&](const char* name) { return gis::read_netcdf_variable(file, name).values; };
    const auto lambda_um = variable("wavelength"), views = variable("view_zenith");
    const auto tau = variable("transmittance"), thermal = variable("path_thermal_radiance"),
               solar = variable("path_solar_radiance"), direct = variable("direct_solar_irradiance"),
               S = variable("spherical_albedo"), sky = variable("thermal_sky_irradiance");
    ASSERT_EQ(variable("solar_zenith").size(), 1U);
    EXPECT_NEAR(variable("solar_zenith")[0], sun_deg, 2e-3);
    EXPECT_NEAR(variable("sensor_altitude")[0], altitude_km, 1e-5);
    ASSERT_GE(views.size(), 2U);
    EXPECT_NEAR(views[0], 0.0, 1e-3);
    const double earth_sun = std::pow(1.0135, 2.0);  // 12 August [AU], the runs are of that day
    const std::size_t n = lambda_um.size();
    ASSERT_GT(n, 100U);
    for (std::size_t v = 0; v < views.size(); ++v)
        for (std::size_t a = 0; a < 3; ++a) {
            const auto t = simulate(altitude_km, views[v], sun_deg, 90.0 * static_cast<double>(a), 0.0).terms;
            std::size_t at = 0;
            for (std::size_t l = 0; l < n; ++l) {
                while (at + 1 < t.wavelength_um.size() && t.wavelength_um[at] < lambda_um[l] * (1.0 - 1e-4)) ++at;
                if (std::abs(t.wavelength_um[at] / lambda_um[l] - 1.0) > 1e-4) continue;
                SCOPED_TRACE(fmt::format("view {}, azimuth {}, {} um", views[v], a * 90, lambda_um[l]));
                const std::size_t i = v * n + l;
                ASSERT_NEAR(tau[i], t.transmittance[at], 1e-5);
                if (lambda_um[l] > 2.6) {
                    ASSERT_NEAR(thermal[i], t.path_thermal[at], 5e-4 * t.path_thermal[at] + 2e-5);
                }
                if (lambda_um[l] > 4.9) {
                    if (t.transmittance[at] > 0.1) {
                        ASSERT_NEAR(sky[l], t.thermal_sky[at], 6e-3 * t.thermal_sky[at] + 1e-3);
                    }
                    continue;
                }
                ASSERT_NEAR(solar[(v * 3 + a) * n + l] / earth_sun, t.path_solar[at], 2e-3 * t.path_solar[at] + 1e-8);
                if (t.transmittance[at] < 0.1) continue;
                ASSERT_NEAR(direct[l] / earth_sun, t.direct_normal[at], 2e-3 * t.direct_normal[at] + 1e-4);
                if (lambda_um[l] < 2.4) {
                    ASSERT_NEAR(S[l], t.spherical_albedo[at], 3e-3);
                }
            }
        }
}

TEST(AtmosphereDeck, ComesBackThroughModtran5) {
    const ScratchFolder folder;
    write_deck(folder, "modtran5");
    const auto tape5 = lines_of(folder / "tape5");
    std::ofstream(folder / "tape7") << run_modtran5(tape5);
    const auto result =
        pyroscene_cli("import-atmosphere " + (folder / "tape7").string() + " -o " + (folder / "air.nc").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    expect_the_table_again(folder / "air.nc", field(tape5[3], 0, 10) - field(tape5[3], 10, 10), field(tape5[5], 10, 10));
}

TEST(AtmosphereDeck, ComesBackThroughModtran6) {
    const ScratchFolder folder;
    write_deck(folder, "modtran6");
    const auto runs = listed_runs(folder / "runs.csv");
    const std::string cases = read_text_file(folder / "modtran6_input.json");
    for (const auto& run : runs) {
        EXPECT_NE(cases.find("\"JSONPRNT\": \"" + run.file + "\""), std::string::npos) << run.file;
        std::ofstream(folder / run.file) << modtran_json_text(run.simulated(sun_of(runs)));
    }
    const auto result =
        pyroscene_cli("import-atmosphere " + (folder / "runs.csv").string() + " -o " + (folder / "air.nc").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    expect_the_table_again(folder / "air.nc", runs[0].number("sensor_altitude_km"), sun_of(runs));
}

TEST(AtmosphereDeck, ComesBackThroughLibRadtran) {
    const ScratchFolder folder;
    write_deck(folder, "libradtran");
    const auto runs = listed_runs(folder / "runs.csv");
    const std::string script = read_text_file(folder / "run.sh");
    for (const auto& run : runs) {
        const std::string name = run.file.substr(0, run.file.rfind('.'));
        EXPECT_NE(script.find("uvspec < " + name + ".inp > " + run.file), std::string::npos) << run.file;
        std::ofstream(folder / run.file) << run_uvspec(run, read_text_file(folder / (name + ".inp")), sun_of(runs));
    }
    const auto result =
        pyroscene_cli("import-atmosphere " + (folder / "runs.csv").string() + " -o " + (folder / "air.nc").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    expect_the_table_again(folder / "air.nc", runs[0].number("sensor_altitude_km"), sun_of(runs));
}

}  // namespace
}  // namespace pyroscene::test
