// Spectroradiometers before a flame, as in thesis 4.1 and 6.1, run as a user runs them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "radiometry/planck.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

struct FieldSpectrum {
    std::vector<double> wavelength_um, radiance_W_m2_sr_um;

    [[nodiscard]] double at(double lambda_um) const {
        const auto after = std::lower_bound(wavelength_um.begin() + 1, wavelength_um.end() - 1, lambda_um);
        const auto i = static_cast<std::size_t>(after - wavelength_um.begin());
        const double f = (lambda_um - wavelength_um[i - 1]) / (wavelength_um[i] - wavelength_um[i - 1]);
        return std::lerp(radiance_W_m2_sr_um[i - 1], radiance_W_m2_sr_um[i], f);
    }
};

FieldSpectrum read(const std::filesystem::path& file) {
    const auto table = read_csv(file);
    return {table.numbers("wavelength_um"), table.numbers("radiance_W_m2_sr_um")};
}

/// Runs one acquisition of a scenario of scenarios/field_flame.
std::filesystem::path run_field(const ScratchFolder& scratch, const std::string& file, const std::string& acquisition) {
    const auto out = scratch / "out";
    const auto result = pyroscene_cli("run " + (source_folder() / "scenarios/field_flame" / file).string() +
                                      " --acquisition " + acquisition + " -o " + out.string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return out / acquisition;
}

// Opacities of the soot table in the design note of the optics: fv 2e-7, 1.2 um, 0.305 and 2.44 m: 0.19 and 0.82.
TEST(FieldInstruments, FlameOverItsBedGrowsAsASlabOfSoot) {
    const ScratchFolder scratch;
    const auto shortest = read(run_field(scratch, "bed_length.yaml", "bed_0305mm") / "spectrum.csv");
    const auto longest = read(run_field(scratch, "bed_length.yaml", "bed_2438mm") / "spectrum.csv");
    const double black = radiometry::planck_radiance(1.2, 1100.0);
    EXPECT_NEAR(shortest.at(1.2) / black, 0.19, 0.005);
    EXPECT_NEAR(longest.at(1.2) / black, 0.82, 0.005);
    // The potassium doublet stands above the continuum of both sides, the more the less opaque the flame is. At 980 m the flame's
    // pressure is 0.89 atm, which takes as much off the equivalent width (it goes with pressure where lines are saturated).
    const auto ratio = [](const FieldSpectrum& s) {
        const double side = std::sqrt(s.at(0.750) * s.at(0.786));
        return s.at(0.767) / side;
    };
    EXPECT_NEAR(ratio(shortest), 1.29, 0.03);
    EXPECT_GT(ratio(shortest), 1.15 * ratio(longest));
    EXPECT_GT(ratio(longest), 1.01);
    EXPECT_TRUE(std::filesystem::exists(scratch / "out/bed_2438mm/quicklook.png"));
}

TEST(FieldInstruments, GasBandsStandWhereTheyWereMeasured) {
    const ScratchFolder scratch;
    for (const std::string acquisition : {"sideways_2m", "upward_2m"}) {
        const auto s = read(run_field(scratch, "gas_bands.yaml", acquisition) / "spectrum.csv");
        const auto opacity = [&](double lambda_um) {
            return s.at(lambda_um) / radiometry::planck_radiance(lambda_um, 1100.0);
        };
        // CO2 at 4.3 um is opaque on its long-wave side; H2O and CO2 at 2.7 um, H2O at 1.9 and 6.6 um exceed their surroundings.
        EXPECT_GT(opacity(4.4), 0.9) << acquisition;
        EXPECT_LE(opacity(4.4), 1.0);
        EXPECT_LT(opacity(3.9), 0.1);
        EXPECT_GT(opacity(2.7), 3.0 * opacity(2.3));
        EXPECT_GT(opacity(6.6), 2.0 * opacity(5.1));
        EXPECT_GT(opacity(1.9), opacity(2.2));
        EXPECT_LT(opacity(10.6), 0.12);
    }
}

}  // namespace
}  // namespace pyroscene::test
