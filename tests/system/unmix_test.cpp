// `pyroscene unmix` as a user types it, on a real-looking image of its own making and on rendered ones.
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "gis/crs.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

const std::vector<double> kLambda_um{0.5, 0.66, 0.86, 1.6, 2.2, 3.9};
const std::vector<double> kFire{1.0, 4.0, 9.0, 60.0, 90.0, 40.0}, kGrass{20.0, 30.0, 90.0, 40.0, 15.0, 1.0};

/// 37 x 23 pixels of fire over grass on a map, fire growing to the east; the last column has no data.
void write_mixture(const std::filesystem::path& file, bool wavelengths) {
    gis::OutputRaster out;
    out.cols = 37, out.rows = 23;
    MapGrid grid;
    grid.cols = 37, grid.rows = 23, grid.cell_m = 4.0, grid.west_m = 700000.0, grid.north_m = 5180000.0,
    grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
    out.grid = grid;
    std::vector<float> pixels;
    for (std::size_t b = 0; b < kLambda_um.size(); ++b) {
        out.bands.push_back({"band", "W m-2 sr-1 um-1", {}, {}, {}});
        if (wavelengths) out.bands.back().wavelength_um = kLambda_um[b], out.bands.back().fwhm_um = 0.02;
        for (int p = 0; p < 37 * 23; ++p) {
            const double fire = p % 37 / 36.0;
            pixels.push_back(p % 37 == 36 ? std::nanf("") : static_cast<float>(fire * kFire[b] + (1.0 - fire) * kGrass[b]));
        }
    }
    gis::write_cog(file, out, pixels);
}

std::string table(const std::string& first_column, double scale) {
    std::string text = first_column + ",fire,grass\n";
    for (std::size_t b = 0; b < kLambda_um.size(); ++b)
        text += std::to_string(scale > 0.0 ? scale * kLambda_um[b] : static_cast<double>(b + 1)) + "," +
                std::to_string(kFire[b]) + "," + std::to_string(kGrass[b]) + "\n";
    return text;
}

TEST(UnmixCommand, FindsTheFractionsOfAnyRaster) {
    const ScratchFolder scratch;
    write_text_file(scratch / "um.csv", table("wavelength_um", 1.0));
    write_text_file(scratch / "nm.csv", table("wavelength_nm", 1000.0));
    write_text_file(scratch / "band.csv", table("band", 0.0));
    for (const bool wavelengths : {true, false}) {
        const auto image = scratch / (wavelengths ? "with.tif" : "without.tif");
        write_mixture(image, wavelengths);
        for (const std::string name : {"um", "nm", "band"}) {
            for (const std::string method : {"stepwise", "fcls"}) {
                const auto out = scratch / (name + method + ".tif");
                const auto result =
                    pyroscene_cli("unmix " + image.string() + " --endmembers " + (scratch / (name + ".csv")).string() +
                                  " --method " + method + " -o " + out.string());
                ASSERT_EQ(result.exit_code, 0) << result.output;
                const auto fractions = gis::read_image(out);
                ASSERT_EQ(fractions.bands.size(), 5U);
                EXPECT_EQ(fractions.bands[0].description, "fraction of fire");
                const auto fire = plane(fractions, 0), grass = plane(fractions, 1), unexplained = plane(fractions, 4);
                for (std::size_t p = 0; p < fire.size(); ++p) {
                    if (p % 37 == 36) {
                        EXPECT_TRUE(std::isnan(fire[p]));
                        continue;
                    }
                    const double expected = static_cast<double>(p % 37) / 36.0;
                    ASSERT_NEAR(fire[p], expected, 1e-5) << p;
                    ASSERT_NEAR(grass[p], 1.0 - expected, 1e-5) << p;
                    ASSERT_EQ(unexplained[p], 0.0);
                }
            }
        }
    }
    const auto info = run_command("gdalinfo " + (scratch / "umfcls.tif").string());
    EXPECT_NE(info.output.find("LAYOUT=COG"), std::string::npos) << info.output;
    EXPECT_NE(info.output.find("Origin = (700000"), std::string::npos) << info.output;
}

TEST(UnmixCommand, TheThreadsDoNotMatter) {
    const ScratchFolder scratch;
    write_mixture(scratch / "image.tif", true);
    write_text_file(scratch / "um.csv", table("wavelength_um", 1.0));
    for (const std::string threads : {"1", "4"})
        ASSERT_EQ(
            pyroscene_cli("unmix " + (scratch / "image.tif").string() + " --endmembers " + (scratch / "um.csv").string() +
                          " -o " + (scratch / threads).string() + ".tif --threads " + threads)
                .exit_code,
            0);
    EXPECT_EQ(file_bytes(scratch / "1.tif"), file_bytes(scratch / "4.tif"));
}

TEST(UnmixCommand, TakesEndmembersFromTheTruthOfARenderedImage) {
    const ScratchFolder scratch;
    const auto out = scratch.path().string();
    ASSERT_EQ(
        pyroscene_cli("run " + (source_folder() / "scenarios/minimal/scenario.yaml").string() + " -q -o " + out).exit_code,
        0);
    std::filesystem::path acquisition;
    for (const auto& entry : std::filesystem::directory_iterator(out))
        if (std::filesystem::exists(entry.path() / "radiance.tif")) acquisition = entry.path();
    ASSERT_FALSE(acquisition.empty());
    const auto result = pyroscene_cli("unmix " + (acquisition / "radiance.tif").string() + " --method fcls --truth " +
                                      (acquisition / "truth.tif").string() + " --pure 1 -o " + out + "/f.tif");
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("background"), std::string::npos) << result.output;
    EXPECT_NE(read_text_file(scratch / "f_endmembers.csv").find("wavelength_um"), std::string::npos);
    // In sensor geometry the geolocation arrays of the image are taken over.
    const auto info = run_command("gdalinfo " + out + "/f.tif");
    EXPECT_NE(info.output.find("X_DATASET="), std::string::npos) << info.output;
    EXPECT_NE(info.output.find("synthetic=true"), std::string::npos) << info.output;
}

TEST(UnmixCommand, RefusesWhatDoesNotFit) {
    const ScratchFolder scratch;
    write_mixture(scratch / "image.tif", true);
    const auto unmix = [&](const std::string& text) {
        write_text_file(scratch / "t.csv", text);
        return pyroscene_cli("unmix " + (scratch / "image.tif").string() + " --endmembers " + (scratch / "t.csv").string());
    };
    const auto expect = [](const CommandResult& result, int code, const std::string& text) {
        EXPECT_EQ(result.exit_code, code) << result.output;
        EXPECT_NE(result.output.find(text), std::string::npos) << result.output;
    };
    expect(pyroscene_cli("unmix " + (scratch / "image.tif").string()), 2, "--endmembers or --truth");
    expect(pyroscene_cli("unmix " + (scratch / "none.tif").string() + " --endmembers t.csv"), 3, "none.tif");
    expect(unmix("wavelength_um,fire\n0.5,1\n0.7,2\n"), 3, "does not cover band 3");
    expect(unmix("lambda,fire\n0.5,1\n"), 3, "no column 'wavelength_um'");
    expect(unmix("band,fire\n1,1\n2,2\n"), 3, "2 bands, the image has 6");
    expect(unmix("band\n1\n2\n3\n4\n5\n6\n"), 3, "no column with a spectrum");
    expect(unmix("band,a,b\n1,1,2\n2,1,2\n3,1,2\n4,1,2\n5,1,2\n6,1,2\n"), 3, "'b' is a mixture");
    EXPECT_FALSE(std::filesystem::exists(scratch / "image_fractions.tif"));
}

}  // namespace
}  // namespace pyroscene::test
