// `pyroscene unmix` as a user types it, on a real-looking image of its own making and on rendered ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/csv.h"
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

/// An ENVI library of kFire and kGrass, big-endian doubles behind a header, in nanometres from long to short.
void write_envi_library(const ScratchFolder& scratch) {
    std::string data(16, 'x'), wavelengths;
    const auto append = [&](const std::vector<double>& spectrum) {
        for (auto v = spectrum.rbegin(); v != spectrum.rend(); ++v) {
            char raw[sizeof(double)];
            std::memcpy(raw, &*v, sizeof raw);
            if (std::endian::native == std::endian::little) std::reverse(raw, raw + sizeof raw);
            data.append(raw, sizeof raw);
        }
    };
    append(kFire);
    append(kGrass);
    write_text_file(scratch / "library.sli", data);
    for (auto w = kLambda_um.rbegin(); w != kLambda_um.rend(); ++w)
        wavelengths += (wavelengths.empty() ? "" : ",\n  ") + std::to_string(1e3 * *w);
    write_text_file(scratch / "library.hdr",
                    "ENVI\ndescription = {\n  Two spectra, a = b}\nsamples = 6\nlines = 2\nbands = 1\nheader offset = 16\n"
                    "file type = ENVI Spectral Library\ndata type = 5\ninterleave = bsq\nbyte order = 1\n"
                    "wavelength units = Nanometers\nspectra names = {fire, grass}\nwavelength = {\n  " +
                        wavelengths + "}\n");
}

TEST(UnmixCommand, ReadsEnviLibraries) {
    const ScratchFolder scratch;
    write_mixture(scratch / "image.tif", true);
    write_envi_library(scratch);
    const auto command =
        "unmix " + (scratch / "image.tif").string() + " --method fcls --endmembers " + scratch.path().string();
    for (const std::string name : {"library.sli", "library.hdr"}) {
        const auto result = pyroscene_cli(command + "/" + name + " -o " + (scratch / "f.tif").string());
        ASSERT_EQ(result.exit_code, 0) << result.output;
        const auto fractions = gis::read_image(scratch / "f.tif");
        EXPECT_EQ(fractions.bands[1].description, "fraction of grass");
        const auto fire = plane(fractions, 0);
        for (std::size_t p = 0; p < 36; ++p) ASSERT_NEAR(fire[p], static_cast<double>(p) / 36.0, 1e-5) << p;
    }
    const auto header = read_text_file(scratch / "library.hdr");
    const auto refused = [&](const std::string& what, const std::string& by) {
        auto changed = header;
        changed.replace(changed.find(what), what.size(), by);
        write_text_file(scratch / "library.hdr", changed);
        const auto result = pyroscene_cli(command + "/library.sli -o " + (scratch / "f.tif").string());
        EXPECT_EQ(result.exit_code, 3) << result.output;
        return result.output;
    };
    EXPECT_NE(refused("data type = 5", "data type = 6").find("data type 6 is not supported"), std::string::npos);
    EXPECT_NE(refused("lines = 2", "lines = 3").find("6 wavelengths and 2 names for 6 samples and 3 lines"),
              std::string::npos);
    EXPECT_NE(refused("offset = 16", "offset = 17").find("112 bytes, the header asks for 113"), std::string::npos);
    EXPECT_NE(refused("Nanometers", "Wavenumber").find("expected nanometers or micrometers"), std::string::npos);
}

// A straight line has over a symmetric response its value at the centre. The spike of 40 on a base of 0.1 um adds 0.5 * 0.1 * 40 / 2 = 1 to the
// mean over the boxcar from 3 to 5 um of the WASP's mid-wave band, and nothing to that over the 0.05 um that the image tells.
TEST(UnmixCommand, AveragesFineSpectraOverTheSensorsResponses) {
    const ScratchFolder scratch;
    gis::OutputRaster out;
    out.cols = 5, out.rows = 1;
    const std::vector<double> centre_um{1.35, 4.0, 9.5};
    std::vector<float> pixels;
    for (const double w : centre_um) {
        out.bands.push_back({"band", "W m-2 sr-1 um-1", w, 0.05, {}});
        for (int p = 0; p < 5; ++p)
            pixels.push_back(static_cast<float>(0.25 * p * (w == 4.0 ? 41.0 : 10.0 * w) + (1.0 - 0.25 * p) * 20.0));
    }
    gis::write_geotiff(scratch / "image.tif", out, pixels);
    // A line and a constant, the line with a spike between 3.2 and 3.3 um that only a wide response sees.
    std::string text = "wavelength_um,line,flat\n";
    for (const double w : {0.5, 3.19, 3.2, 3.25, 3.3, 3.31, 12.0})
        text += std::to_string(w) + "," + std::to_string(10.0 * w + (w == 3.25 ? 40.0 : 0.0)) + ",20\n";
    write_text_file(scratch / "fine.csv", text);
    const auto line_at = [&](const std::string& options) {
        const auto result = pyroscene_cli("unmix " + (scratch / "image.tif").string() + " --method ucls --endmembers " +
                                          (scratch / "fine.csv").string() + options + " -o " + (scratch / "f.tif").string());
        EXPECT_EQ(result.exit_code, 0) << result.output;
        return gis::read_image(scratch / "f.tif");
    };
    const auto narrow = plane(line_at(""), 0), wide = plane(line_at(" --sensor wasp-thesis"), 0);
    for (std::size_t p = 0; p < 5; ++p) EXPECT_NEAR(wide[p], 0.25 * static_cast<double>(p), 1e-5);
    EXPECT_GT(std::abs(narrow[4] - 1.0), 1e-4);
    const auto refused =
        pyroscene_cli("unmix " + (scratch / "image.tif").string() + " --endmembers " + (scratch / "fine.csv").string() +
                      " --sensor modis-terra -o " + (scratch / "f.tif").string());
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.output.find("sensor modis-terra has no band at"), std::string::npos) << refused.output;
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
    EXPECT_EQ(result.output.find("flame"), std::string::npos) << "no pixel is all flame";
    // The truth lies beside the fractions, and the table of errors follows from the two.
    const auto fractions = gis::read_image(scratch / "f.tif"), truth = gis::read_image(acquisition / "truth.tif");
    ASSERT_EQ(fractions.bands.size(), 7U);
    EXPECT_EQ(fractions.bands[0].description, "fraction of scar");
    EXPECT_EQ(fractions.bands[5].description, "truth: fraction of scar");
    const auto scar = plane(fractions, 0), beside = plane(fractions, 5), scar_truth = plane(truth, 2);
    double squares = 0.0, count = 0.0;
    for (std::size_t p = 0; p < scar.size(); ++p) {
        if (!std::isfinite(scar[p]) || !std::isfinite(scar_truth[p])) continue;
        ASSERT_EQ(beside[p], scar_truth[p]);
        squares += (scar[p] - scar_truth[p]) * (scar[p] - scar_truth[p]);
        count += 1.0;
    }
    const auto scores = read_csv(scratch / "f_scores.csv");
    EXPECT_EQ(scores.rows[0][0], "scar");
    EXPECT_NEAR(scores.numbers("rms_error")[0], std::sqrt(squares / count), 1e-6);
    const auto purest = pyroscene_cli("unmix " + (acquisition / "radiance.tif").string() + " --method fcls --truth " +
                                      (acquisition / "truth.tif").string() + " --pure 1 --purest 0.02 -o " + out + "/f.tif");
    // Flame and front join scar and background, which is one too many for three bands.
    EXPECT_NE(purest.output.find("3 bands for 4 spectra"), std::string::npos) << purest.output;
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
