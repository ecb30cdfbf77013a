#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/planck.h"
#include "radiometry/soot.h"
#include "radiometry/surfaces.h"
#include "radiometry/total_emissivity.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

namespace fs = std::filesystem;

/// A small file that is removed at the end of the test.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& text)
        : path_(fs::temp_directory_path() / (std::string("pyroscene_optics_") +
                                             testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv")) {
        std::ofstream(path_) << text;
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

template <class Function>
std::string message_of(const Function& f) {
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

SootOptics shipped_soot() { return load_soot_optics(source_folder() / "data/optical/soot_optics.csv"); }

TEST(Soot, AbsorptionMatchesThePublishedTable) {
    // k(0.77), k(1.2), k(3.9), k(10.6) in 1/m for each volume fraction, two decimals (some rounded twice).
    const std::map<double, std::array<double, 4>> expected{
        {5e-8, {0.27, 0.18, 0.07, 0.02}}, {8.5e-8, {0.46, 0.30, 0.12, 0.03}}, {1e-7, {0.54, 0.35, 0.14, 0.04}},
        {2e-7, {1.08, 0.71, 0.28, 0.08}}, {2.8e-7, {1.51, 0.99, 0.39, 0.10}}, {5e-7, {2.69, 1.77, 0.69, 0.19}}};
    const auto soot = shipped_soot();
    const std::array<double, 4> lambda_um{0.77, 1.2, 3.9, 10.6};
    for (const auto& [fv, k] : expected)
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(soot_absorption_per_m(soot, lambda_um[i], fv), k[i], 0.006) << fv;
}

TEST(Soot, ConstantMatchesTheQuotedValues) {
    const auto soot = shipped_soot();
    const std::map<double, double> expected{{0.77, 4.14}, {1.2, 4.24}, {2.2, 4.94}, {3.9, 5.38}, {10.0, 4.08}};
    for (const auto& [lambda_um, C] : expected)
        EXPECT_NEAR(soot_absorption_constant(soot, lambda_um), C, 0.008) << lambda_um;
}

TEST(Soot, EmissivityOfSlabsAt1200nm) {
    const auto soot = shipped_soot();
    const std::array<double, 4> length_m{0.305, 1.22, 2.44, 2.74}, at_1e7{0.10, 0.35, 0.58, 0.62},
        at_2e7{0.19, 0.58, 0.82, 0.86};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(1.0 - std::exp(-soot_absorption_per_m(soot, 1.2, 1e-7) * length_m[i]), at_1e7[i], 0.0051);
        EXPECT_NEAR(1.0 - std::exp(-soot_absorption_per_m(soot, 1.2, 2e-7) * length_m[i]), at_2e7[i], 0.0051);
    }
}

TEST(Soot, IsProportionalToVolumeFractionAndContinuousBeyondTheTable) {
    const auto soot = shipped_soot();
    EXPECT_EQ(soot_absorption_per_m(soot, 4.0, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(soot_absorption_per_m(soot, 4.0, 4e-7), 2.0 * soot_absorption_per_m(soot, 4.0, 2e-7));
    EXPECT_NEAR(soot_absorption_constant(soot, 0.4 - 1e-9), soot_absorption_constant(soot, 0.4), 1e-6);
    EXPECT_NEAR(soot_absorption_constant(soot, 15.0 + 1e-9), soot_absorption_constant(soot, 15.0), 1e-6);
    // Power law: equal ratios of wavelength give equal ratios of C.
    const double a = soot_absorption_constant(soot, 20.0), b = soot_absorption_constant(soot, 22.0),
                 c = soot_absorption_constant(soot, 24.2);
    EXPECT_NEAR(b / a, c / b, 1e-12);
    EXPECT_GT(c, 0.0);
}

TEST(Soot, RefusesUnusableTables) {
    const TemporaryFile descending("wavelength_um,C\n1.0,4\n0.9,4\n");
    EXPECT_NE(message_of([&] { (void)load_soot_optics(descending.path()); }).find(":3"), std::string::npos);
    const TemporaryFile negative("wavelength_um,C\n1.0,4\n1.5,-4\n");
    EXPECT_NE(message_of([&] { (void)load_soot_optics(negative.path()); }).find("-4"), std::string::npos);
    const TemporaryFile single("wavelength_um,C\n1.0,4\n");
    EXPECT_NE(message_of([&] { (void)load_soot_optics(single.path()); }).find("1 rows"), std::string::npos);
}

TEST(Surfaces, ShippedLibraryHasTheQuotedReflectances) {
    const auto library = load_surfaces(source_folder() / "data/optical/surface_reflectance.csv");
    EXPECT_EQ(library.names.size(), 15U);
    // 0.66, 0.86, 2.13, 3.96, 11 um (optics note, three decimals).
    const std::array<double, 5> lambda_um{0.66, 0.86, 2.13, 3.96, 11.0};
    const std::map<std::string, std::array<double, 5>> expected{
        {"grass_green", {.045, .529, .149, .015, .014}}, {"char_black", {.049, .062, .202, .090, .045}},
        {"grass_dry", {.301, .441, .286, .168, .080}},   {"ash_gray", {.132, .164, .292, .209, .068}},
        {"soil_bare", {.249, .310, .378, .159, .028}},   {"water", {.024, .020, .017, .023, .007}}};
    for (const auto& [name, reflectance] : expected) {
        const auto& spectrum = library.reflectance[static_cast<std::size_t>(library.index_of(name))];
        EXPECT_EQ(spectrum.kind, Quantity::Reflectance);
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_NEAR(spectrum.at(lambda_um[i]), reflectance[i], 0.0011) << name << lambda_um[i];
    }
}

TEST(Surfaces, UnknownNameListsTheLibrary) {
    const auto library = load_surfaces(source_folder() / "data/optical/surface_reflectance.csv");
    const auto message = message_of([&] { (void)library.index_of("gras_dry"); });
    EXPECT_NE(message.find("'gras_dry'"), std::string::npos);
    EXPECT_NE(message.find("grass_dry"), std::string::npos);
}

TEST(Surfaces, RefusesReflectanceBeyondOne) {
    const TemporaryFile file("wavelength_um,snow\n0.5,0.9\n0.6,1.2\n");
    const auto message = message_of([&] { (void)load_surfaces(file.path()); });
    EXPECT_NE(message.find(":3"), std::string::npos) << message;
    EXPECT_NE(message.find("1.2"), std::string::npos) << message;
}

TEST(TotalEmissivity, IsThePlanckMeanOfTheSpectrum) {
    // Reflectance 0.1 below 4 um and 0.5 above: the share of each by the band integral.
    const Spectrum step{Quantity::Reflectance, {0.4, 4.0, 4.0 + 1e-9, 14.0}, {0.1, 0.1, 0.5, 0.5}};
    const auto emissivity = total_emissivity(step);
    for (const double T_K : {500.0, 1000.0, 1500.0}) {
        const double below = band_radiance(T_K, 1e-3, 4.0) * kPi / (kStefanBoltzmann_W_m2_K4 * std::pow(T_K, 4.0));
        EXPECT_NEAR(emissivity.at(T_K), 0.9 * below + 0.5 * (1.0 - below), 2e-3) << T_K;
    }
    EXPECT_NEAR(emissivity.at(1125.0), 0.5 * (emissivity.at(1000.0) + emissivity.at(1250.0)), 1e-12);
    EXPECT_EQ(emissivity.at(100.0), emissivity.value.front());
    EXPECT_EQ(emissivity.at(5000.0), emissivity.value.back());
    const auto grey = total_emissivity({Quantity::Reflectance, {3.0, 5.0}, {0.2, 0.2}});
    for (const double value : grey.value) EXPECT_NEAR(value, 0.8, 1e-12);
}

TEST(FuelSurfaces, EveryFuelModelHasASpectrum) {
    const auto library = load_surfaces(source_folder() / "data/optical/surface_reflectance.csv");
    const auto surfaces = load_fuel_surfaces(source_folder() / "data/fuel/surface_of_fuel.csv");
    std::set<int> anderson{91, 92, 93, 98, 99}, scott_burgan = anderson;
    for (int code = 1; code <= 13; ++code) anderson.insert(code);
    for (const auto& [first, last] : {std::pair{101, 109}, {121, 124}, {141, 149}, {161, 165}, {181, 189}, {201, 204}})
        for (int code = first; code <= last; ++code) scott_burgan.insert(code);
    EXPECT_EQ(scott_burgan.size(), 45U);
    EXPECT_EQ(surfaces.entries.size(), anderson.size() + scott_burgan.size());
    for (int code : anderson) EXPECT_NO_THROW((void)library.index_of(surface_of_fuel(surfaces, "fbfm13", code))) << code;
    for (int code : scott_burgan) EXPECT_NO_THROW((void)library.index_of(surface_of_fuel(surfaces, "fbfm40", code))) << code;
}

TEST(FuelSurfaces, LooksUpByTable) {
    const auto surfaces = load_fuel_surfaces(source_folder() / "data/fuel/surface_of_fuel.csv");
    EXPECT_EQ(surface_of_fuel(surfaces, "fbfm40", 98), "water");
    EXPECT_EQ(surface_of_fuel(surfaces, "fbfm13", 4), "chaparral");
    EXPECT_EQ(surface_of_fuel(surfaces, "fbfm40", 4), "");
    EXPECT_EQ(surface_of_fuel(surfaces, "fbfm40", -9999), "");
    EXPECT_EQ(surface_of_fuel(surfaces, "", 98), "");
}

TEST(FuelSurfaces, AUsersTableNeedsNoTableColumn) {
    const TemporaryFile file("code,surface\n7,asphalt\n-1,water\n");
    const auto surfaces = load_fuel_surfaces(file.path());
    EXPECT_EQ(surface_of_fuel(surfaces, "", 7), "asphalt");
    EXPECT_EQ(surface_of_fuel(surfaces, "anything", -1), "water");
    const TemporaryFile twice("code,surface\n7,asphalt\n7,water\n");
    EXPECT_NE(message_of([&] { (void)load_fuel_surfaces(twice.path()); }).find("twice"), std::string::npos);
    const TemporaryFile fraction("code,surface\n7.5,asphalt\n");
    EXPECT_NE(message_of([&] { (void)load_fuel_surfaces(fraction.path()); }).find("7.5"), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::radiometry
