#include "imagery/image_channels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "imagery/pixel_match.h"

namespace pyroscene::pipeline {
namespace {

imagery::Channel boxcar(double lower_um, double upper_um, std::vector<float> values,
                        const std::string& unit = "W m-2 sr-1 um-1") {
    return {1,
            "band",
            unit,
            0.5 * (lower_um + upper_um),
            {Quantity::Response, {lower_um, upper_um}, {1.0, 1.0}},
            std::move(values)};
}

TEST(Reflectances, AreThoseOfALambertianSurfaceUnderTheSun) {
    // Solar irradiances of the MODIS bands 1, 2 and 7 at 1 AU, W m-2 um-1 (level 1B calibration: 1606, 986, 93).
    const double sun_deg = 40.0, reflectance = 0.3, distance_AU = 1.015;
    for (const auto& [lower, upper, sun] : {std::array{0.62, 0.67, 1606.0}, {0.841, 0.876, 986.0}, {2.105, 2.155, 93.0}}) {
        const double L =
            reflectance * sun * std::cos(sun_deg * 3.14159265 / 180.0) / 3.14159265 / (distance_AU * distance_AU);
        const auto found =
            reflectances(boxcar(lower, upper, {static_cast<float>(L), static_cast<float>(L)}), {40.0F, 88.0F}, distance_AU);
        EXPECT_NEAR(static_cast<double>(found[0]), reflectance, 0.03 * reflectance) << lower;
        EXPECT_TRUE(std::isnan(found[1]));  // the sun is too low
    }
    EXPECT_EQ(reflectances(boxcar(0.62, 0.67, {0.25F}, "1"), {}, 1.0)[0], 0.25F);
}

TEST(Channel, FitsThePowerLawOfItsBand) {
    // Independent numbers: MODIS 21 2.9193e-9, BIRD 3.1497e-9.
    EXPECT_NEAR(boxcar(3.929, 3.989, {}).power_law_coefficient(), 2.9193e-9, 1e-13);
    EXPECT_NEAR(boxcar(3.4, 4.2, {}).power_law_coefficient(), 3.1497e-9, 1e-13);
}

/// Pixels of `cell_deg` on the equator, lines to the north.
gis::PixelPositions lattice(int samples, int lines, double cell_deg) {
    gis::PixelPositions out;
    out.samples = samples;
    out.lines = lines;
    const auto edge_m = static_cast<float>(cell_deg * 6.371e6 * 3.14159265 / 180.0);
    for (int l = 0; l < lines; ++l)
        for (int s = 0; s < samples; ++s) {
            out.lon_deg.push_back(10.0 + (s + 0.5) * cell_deg);
            out.lat_deg.push_back((l + 0.5) * cell_deg);
            out.width_m.push_back(edge_m);
            out.height_m.push_back(edge_m);
            out.area_m2.push_back(edge_m * edge_m);
        }
    return out;
}

TEST(AveragedOnto, TakesTheMeanOfFinerPixelsAndTheNearestOfCoarserOnes) {
    const auto coarse = lattice(10, 10, 0.01), fine = lattice(40, 40, 0.0025);
    std::vector<float> slope;
    for (std::size_t i = 0; i < fine.lon_deg.size(); ++i)
        slope.push_back(static_cast<float>(fine.lon_deg[i] + 2.0 * fine.lat_deg[i]));
    const auto mean = imagery::averaged_onto(coarse, fine, slope);
    for (std::size_t i = 0; i < mean.size(); ++i)
        EXPECT_NEAR(static_cast<double>(mean[i]), coarse.lon_deg[i] + 2.0 * coarse.lat_deg[i],
                    2e-6 + 1e-6 * coarse.lon_deg[i]);
    std::vector<float> stairs;
    for (std::size_t i = 0; i < coarse.lon_deg.size(); ++i) stairs.push_back(static_cast<float>(i));
    const auto nearest = imagery::averaged_onto(fine, coarse, stairs);
    EXPECT_EQ(nearest[0], 0.0F);
    EXPECT_EQ(nearest[39], 9.0F);
    EXPECT_EQ(nearest.back(), 99.0F);
    auto elsewhere = coarse;
    for (double& lon : elsewhere.lon_deg) lon += 5.0;
    EXPECT_TRUE(std::isnan(imagery::averaged_onto(elsewhere, fine, slope)[0]));
}

}  // namespace
}  // namespace pyroscene::pipeline
