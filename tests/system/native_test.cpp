// Native forms of the instruments, opened by the programs that their users have (native_readers.py).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "gis/crs.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

/// A run of a shipped scenario's fire with other acquisitions.
void run_native(const ScratchFolder& scratch, const std::string& acquisitions, const char* scenario = "minimal") {
    const auto inputs = source_folder() / "scenarios" / scenario;
    std::ofstream(scratch / "scenario.yaml") << fmt::format(R"(pyroscene: 1
name: native
inputs:
  terrain:   {{file: {0}/dem.tif}}
  heat_flux: {{file: {0}/heat_flux.tif}}
start: 2017-07-15T22:00:00Z
acquisitions:
{1}products: [radiance, brightness_temperature, ortho, native]
)",
                                                            inputs.string(), acquisitions);
    const auto done = pyroscene_cli("run " + (scratch / "scenario.yaml").string() + " -q -o " + (scratch / "out").string());
    ASSERT_EQ(done.exit_code, 0) << done.output;
}

/// Debian's interpreter, not one that a version manager puts first: the bindings belong to it.
void read_by(const std::string& arguments) {
    const auto script = source_folder() / "tests" / "system" / "native_readers.py";
    const auto read = run_command("/usr/bin/python3 " + script.string() + " " + arguments);
    constexpr int kAbsent = 77;
    if (read.exit_code == kAbsent) GTEST_SKIP() << "the program to read it with is not installed";
    EXPECT_EQ(read.exit_code, 0) << read.output;
}

/// Every native file is linked in the STAC item of its image.
void expect_linked(const std::filesystem::path& acquisition) {
    std::string items;
    for (const auto& entry : std::filesystem::directory_iterator(acquisition))
        if (entry.path().filename().string().starts_with("item")) items += file_bytes(entry.path());
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(acquisition / "native")) {
        ++files;
        const auto link = "\"href\": \"./native/" + entry.path().filename().string() + "\"";
        EXPECT_NE(items.find(link), std::string::npos) << link;
    }
    EXPECT_GT(files, 1);
}

TEST(NativeForms, AvirisCubeOpensInSpectralPython) {
    const ScratchFolder scratch;
    run_native(scratch, R"(  - {id: line, sensor: aviris-classic, time_s: 120, bands: ['30', '120', '200'],
     platform: {over: centre, altitude_agl_m: 4000, heading_deg: 30, ground_speed_m_s: 41}}
)");
    if (HasFatalFailure()) return;
    expect_linked(scratch / "out/line");
    read_by("aviris " + (scratch / "out/line").string() + " line_rdn");
}

TEST(NativeForms, ViirsFilesOpenInSatpy) {
    const ScratchFolder scratch;
    run_native(scratch, R"(  - {id: pass, sensor: viirs-snpp, time_s: 3600, bands: [I04, I05, M11, M13],
     platform: {over: centre, pass: ascending, scan_angle_deg: -35}}
)",
               "lolo_peak");
    if (HasFatalFailure()) return;
    expect_linked(scratch / "out/pass");
    read_by("viirs " + (scratch / "out/pass").string());
}

TEST(NativeForms, ModisFilesOpenInSatpy) {
    const ScratchFolder scratch;
    run_native(scratch, R"(  - {id: pass, sensor: modis-terra, time_s: 3600, bands: [B21, B31],
     platform: {over: centre, pass: descending, scan_angle_deg: 25}}
)",
               "lolo_peak");
    if (HasFatalFailure()) return;
    read_by("modis " + (scratch / "out/pass").string());
}

TEST(NativeForms, FramesAreOrientedAndRectifiedByGdal) {
    const ScratchFolder scratch;
    const auto minimal = source_folder() / "scenarios" / "minimal";
    std::ofstream(scratch / "camera.yaml") << file_bytes(minimal / "camera.yaml") << "distribution: {native_form: frames}\n";
    run_native(scratch, R"(  - {id: shot, sensor: camera.yaml, time_s: 120,
     platform: {over: centre, altitude_agl_m: 300, heading_deg: 37, pitch_deg: 8, roll_deg: -6}}
)");
    if (HasFatalFailure()) return;
    read_by("frame " + (scratch / "out/shot").string() + " shot " + (minimal / "dem.tif").string());
}

TEST(NativeForms, SwathsLandOnTheirOrthoImagesByGdalwarp) {
    const ScratchFolder scratch;
    run_native(
        scratch,
        R"(  - {id: whisk, sensor: phoenix, time_s: 120, platform: {over: centre, altitude_agl_m: 1500, heading_deg: 20}}
  - {id: push, sensor: aviris-ng, time_s: 120, bands: ['100'], platform: {over: centre, altitude_agl_m: 5000, heading_deg: 250}}
)");
    if (HasFatalFailure()) return;
    read_by("geoloc " + (scratch / "out/whisk").string());
    read_by("geoloc " + (scratch / "out/push").string());
    expect_linked(scratch / "out/whisk");
    EXPECT_TRUE(std::filesystem::exists(scratch / "out/whisk/native/whisk_orthomosaic.tif"));
    const auto lines = file_bytes(scratch / "out/whisk/native/whisk_lines.csv");
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), gis::read_image(scratch / "out/whisk/radiance.tif").rows + 1);
}

/// Sunlit hills of some pixels over 45 km, seen aslant: scans overlap and pixels grow.
TEST(NativeForms, SatelliteSwathsLandOnTheirOrthoImagesByGdalwarp) {
    const ScratchFolder scratch;
    MapGrid grid{300, 300, 650000.0, 5210000.0, 150.0, gis::parse_map_crs("EPSG:32611", "map").wkt};
    write_band(scratch / "dem.tif", grid, "m", [](double x, double y) {
        return 1200.0 + 500.0 * std::sin(x / 1900.0) * std::cos(y / 2300.0) + 300.0 * std::sin((x + y) / 3100.0);
    });
    write_band(scratch / "heat_flux.tif", grid, "W m-2", [](double, double) { return 0.0; }, {{"time_s", "0"}});
    std::ofstream(scratch / "scenario.yaml") << R"(pyroscene: 1
name: swaths
inputs: {terrain: {file: dem.tif}, heat_flux: {file: heat_flux.tif}}
start: 2017-07-15T16:00:00Z
render: {noise: false}
acquisitions:
  - {id: modis, sensor: modis-terra, time_s: 0, bands: [B17], platform: {over: centre, pass: descending, scan_angle_deg: 35}}
  - {id: viirs, sensor: viirs-snpp, time_s: 0, bands: [M11], platform: {over: centre, pass: ascending, scan_angle_deg: -20}}
products: [radiance, ortho]
)";
    const auto done = pyroscene_cli("run " + (scratch / "scenario.yaml").string() + " -q -o " + (scratch / "out").string());
    ASSERT_EQ(done.exit_code, 0) << done.output;
    read_by("geoloc " + (scratch / "out/modis").string() + " '' 1");
    read_by("geoloc " + (scratch / "out/viirs").string() + " '' 1");
}

/// Two crossing lines: each cell of the mosaic is one of the two ortho images where both have the mosaic's cells.
TEST(Mosaics, AreMadeOfTheImagesTheyName) {
    const ScratchFolder scratch;
    run_native(
        scratch,
        R"(  - {id: one, sensor: phoenix, time_s: 100, bands: [LWIR], platform: {over: centre, altitude_agl_m: 1500, heading_deg: 0}}
  - {id: two, sensor: phoenix, time_s: 140, bands: [LWIR], platform: {over: centre, altitude_agl_m: 1500, heading_deg: 180}}
mosaics:
  - {id: both, of: [one, two], rule: latest}
)");
    if (HasFatalFailure()) return;
    const auto mosaic = gis::read_image(scratch / "out/both/mosaic_radiance.tif");
    ASSERT_EQ(mosaic.bands.size(), 4U);
    const auto time_s = plane(mosaic, 1), member = plane(mosaic, 2);
    std::size_t seen = 0, second = 0;
    for (std::size_t i = 0; i < member.size(); ++i) {
        if (std::isnan(member[i])) continue;
        ++seen;
        second += member[i] == 2.0 ? 1 : 0;
        EXPECT_NEAR(time_s[i], member[i] == 1.0 ? 100.0 : 140.0, 30.0);
    }
    EXPECT_GT(seen, member.size() / 3);
    EXPECT_GT(static_cast<double>(second), 0.9 * static_cast<double>(seen));
}

}  // namespace
}  // namespace pyroscene::test
