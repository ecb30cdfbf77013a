#include "radiometry/user_spectra.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/base/temp_folder.h"

namespace pyroscene::radiometry {
namespace {

void save(const std::filesystem::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

template <class Word>
std::string big_endian(const std::vector<Word>& values) {
    std::string bytes;
    for (const Word value : values) {
        const auto* raw = reinterpret_cast<const char*>(&value);
        for (std::size_t i = sizeof(Word); i-- > 0;) bytes += raw[i];  // this machine is little-endian
    }
    return bytes;
}

void refuses(const std::filesystem::path& file, const std::string& name, const std::string& message) {
    try {
        (void)load_reflectance(file, name);
        ADD_FAILURE() << "accepted; expected: " << message;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
}

TEST(UserSpectra, CsvInEitherUnitAndQuantity) {
    const TempFolder folder;
    save(folder / "a.csv", "wavelength_um,reflectance\n0.4,0.1\n2.5,0.3\n");
    save(folder / "b.csv", "# measured\nwavelength_nm,emissivity\n400,0.9\n2500,0.7\n");
    for (const auto* name : {"a.csv", "b.csv"}) {
        const auto s = load_reflectance(folder / name, "x");
        EXPECT_NEAR(s.at(0.4), 0.1, 1e-12);
        EXPECT_NEAR(s.at(1.45), 0.2, 1e-12);
        EXPECT_EQ(s.kind, Quantity::Reflectance);
    }
}

TEST(UserSpectra, CsvErrors) {
    const TempFolder folder;
    save(folder / "percent.csv", "wavelength_um,reflectance\n0.4,10\n2.5,30\n");
    refuses(folder / "percent.csv", "x",
            "percent.csv:2: reflectance 10 at 0.4 um, expected 0 to 1 (percent must be divided by 100)");
    save(folder / "nm.csv", "wavelength_um,reflectance\n400,0.1\n2500,0.3\n");
    refuses(folder / "nm.csv", "x", "is the unit right?");
    save(folder / "order.csv", "# a jump\nwavelength_um,reflectance\n0.4,0.1\n2.5,0.1\n1.5,0.3\n3.5,0.3\n");
    refuses(folder / "order.csv", "x", "order.csv:5: wavelength 1.5 um after 2.5 um, expected ascending");
    save(folder / "turned.csv", "wavelength_um,reflectance\n3.5,0.1\n1.5,0.1\n2.5,0.3\n0.4,0.3\n");
    refuses(folder / "turned.csv", "x", "turned.csv:4: wavelength 2.5 um after 1.5 um, expected descending");
    save(folder / "both.csv", "wavelength_um,reflectance,emissivity\n0.4,0.1,0.1\n2.5,0.1,0.1\n");
    refuses(folder / "both.csv", "x", "has both reflectance and emissivity");
    save(folder / "units.csv", "wavelength_um,wavelength_nm,emissivity\n0.4,400,0.1\n2.5,2500,0.1\n");
    refuses(folder / "units.csv", "x", "has both wavelength_um and wavelength_nm");
    save(folder / "neither.csv", "wavelength_um\n0.4\n2.5\n");
    refuses(folder / "neither.csv", "x", "no column reflectance or emissivity");
    save(folder / "nan.csv", "wavelength_um,reflectance\n0.4,nan\n2.5,0.3\n");
    refuses(folder / "nan.csv", "x", "nan");
    save(folder / "other.csv", "wavelength_um,albedo\n0.4,0.1\n2.5,0.3\n");
    refuses(folder / "other.csv", "x", "column 'albedo' is unknown");
    save(folder / "one.csv", "wavelength_um,reflectance\n0.4,0.1\n");
    refuses(folder / "one.csv", "x", "expected at least 2");
}

TEST(UserSpectra, DescendingWavelengthsAreTurnedRound) {
    const TempFolder folder;
    save(folder / "a.csv", "wavelength_um,reflectance\n14,0.05\n2.5,0.3\n0.4,0.1\n");
    const auto s = load_reflectance(folder / "a.csv", "x");
    EXPECT_NEAR(s.at(0.4), 0.1, 1e-12);
    EXPECT_NEAR(s.at(1.45), 0.2, 1e-12);
    EXPECT_NEAR(s.at(14.0), 0.05, 1e-12);
}

TEST(UserSpectra, DeletedSamplesOfALibraryAreLeftOut) {
    const TempFolder folder;
    const std::string head = "ENVI\nsamples = 3\nlines = 1\ndata type = 4\nbyte order = 1\nwavelength units = Micrometers\n";
    for (const auto* name : {"a", "b"})
        save(folder / (name + std::string(".sli")), big_endian<float>({0.1F, -1.23e34F, 0.3F}));
    save(folder / "a.hdr", head + "data ignore value = -1.23e+34\nwavelength = {0.4, 1.0, 2.4}\n");
    EXPECT_NEAR(load_reflectance(folder / "a.sli", "x").at(1.4), 0.2, 1e-7);
    save(folder / "b.hdr", head + "wavelength = {0.4, 1.0, 2.4}\n");
    refuses(folder / "b.sli", "x", "b.sli, sample 2: reflectance -1.23e+34 at 1 um");
}

TEST(UserSpectra, EnviLibraryByName) {
    const TempFolder folder;
    const std::string head = "ENVI\ndescription = {\n  two grasses}\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\n";
    save(folder / "lib.hdr", head +
                                 "byte order = 1\nwavelength units = Nanometers\nreflectance scale factor = 10000\n"
                                 "spectra names = {\n green grass,\n Dry grass}\nwavelength = {400,\n 1000, 2500}\n");
    save(folder / "lib.sli", big_endian<float>({500.0F, 5000.0F, 1000.0F, 3000.0F, 4000.0F, 2000.0F}));
    const auto s = load_reflectance(folder / "lib.sli", "dry grass");
    EXPECT_NEAR(s.at(0.4), 0.3, 1e-7);
    EXPECT_NEAR(s.at(1.0), 0.4, 1e-7);
    EXPECT_NEAR(load_reflectance(folder / "lib.hdr", "green grass").at(2.5), 0.1, 1e-7);
    refuses(folder / "lib.sli", "moss", "none called 'moss'; it has green grass, Dry grass");
    save(folder / "cut.hdr", head + "wavelength units = Nanometers\nwavelength = {400, 1000, 2500}\n");
    save(folder / "cut.sli", "abc");
    refuses(folder / "cut.sli", "x", "cut off");
    save(folder / "unit.hdr", "ENVI\nsamples = 2\nlines = 1\ndata type = 5\nwavelength = {1, 2}\n");
    save(folder / "unit.sli", big_endian<double>({0.1, 0.2}));
    refuses(folder / "unit.sli", "x", "wavelength units are missing");
    save(folder / "int.hdr", "ENVI\nsamples = 2\nlines = 1\ndata type = 2\nwavelength = {1, 2}\n");
    save(folder / "int.sli", "abcd");
    refuses(folder / "int.sli", "x", "data type 2");
}

TEST(UserSpectra, GapsAreFoundButNotCoarseSampling) {
    Spectrum s{Quantity::Reflectance, {}, {}};
    for (double w = 0.4; w < 15.0; w *= 1.01)
        if (w < 2.5 || w > 7.5) s.lambda_um.push_back(w);
    s.value.assign(s.lambda_um.size(), 0.1);
    const auto gaps = gaps_um(s);
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_NEAR(gaps[0][0], 2.49, 0.02);
    EXPECT_NEAR(gaps[0][1], 7.53, 0.05);
    EXPECT_TRUE(gaps_um({Quantity::Reflectance, {0.4, 15.0}, {0.1, 0.1}}).empty());
    EXPECT_TRUE(gaps_um({Quantity::Reflectance, {0.4, 0.9, 2.5, 15.0}, {0.1, 0.1, 0.1, 0.1}}).empty());
}

TEST(UserSpectra, ReplaceAndCover) {
    const TempFolder folder;
    save(folder / "a.csv", "wavelength_um,reflectance\n0.4,0.1\n2.5,0.3\n");
    SurfaceLibrary library{"shipped", {"grass", "soil"}, {{}, {}}};
    add_spectra(library, {{"soil", folder / "a.csv"}, {"moss", folder / "a.csv"}});
    EXPECT_EQ(library.names, (std::vector<std::string>{"grass", "soil", "moss"}));
    EXPECT_NEAR(library.reflectance[1].at(0.4), 0.1, 1e-12);
    EXPECT_NO_THROW(check_coverage(library, "moss", 0.45, 2.4));
    EXPECT_THROW(check_coverage(library, "moss", 0.45, 4.0), Error);
}

}  // namespace
}  // namespace pyroscene::radiometry
