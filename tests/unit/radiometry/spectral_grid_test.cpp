#include "radiometry/spectral_grid.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "base/error.h"
#include "radiometry/planck.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

SpectralGrid grid_of(const Spectrum& response) { return make_spectral_grid(std::span(&response, 1)); }

double quadrature(const SpectralGrid& grid, double T_K) {
    double sum = 0.0;
    for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) sum += grid.weight[i] * planck_radiance(grid.lambda_um[i], T_K);
    return sum;
}

std::vector<std::pair<std::string, Spectrum>> all_bands() {
    std::vector<std::pair<std::string, Spectrum>> bands{
        {"SWIR", boxcar(0.9, 1.8)},       {"SWIR as flown", boxcar(0.9, 1.7)}, {"MWIR", boxcar(3.0, 5.0)},
        {"LWIR", boxcar(8.0, 11.0)},      {"LWIR as flown", boxcar(8.0, 9.2)}, {"red", boxcar(0.6, 0.7)},
        {"everything", boxcar(0.4, 15.0)}};
    for (const auto& band : measured_responses()) bands.emplace_back(band.first, band.second);
    bands.emplace_back("triangle", Spectrum{Quantity::Response, {3.0, 3.9, 5.0}, {0.0, 1.0, 0.0}});
    bands.emplace_back("two lobes",
                       Spectrum{Quantity::Response, {3.4, 3.5, 3.6, 4.4, 4.5, 4.6}, {0.0, 1.0, 0.0, 0.0, 0.5, 0.0}});
    bands.emplace_back("edges",
                       Spectrum{Quantity::Response, {3.0, 3.0, 4.0, 4.0, 5.0, 5.0}, {0.0, 1.0, 1.0, 0.3, 0.3, 0.0}});
    return bands;
}

TEST(SpectralGrid, PlanckMeansAreWithinTheBound) {
    for (const auto& [name, response] : all_bands()) {
        const auto grid = grid_of(response);
        for (double T_K = 300.0; T_K <= 2000.0; T_K *= 1.07) {
            const double exact = band_mean_radiance(T_K, response);
            EXPECT_NEAR(quadrature(grid, T_K) / exact, 1.0, exact > 1e-3 ? 1e-5 : 1e-3) << name << " at " << T_K << " K";
        }
    }
}

TEST(SpectralGrid, WeightsSumToOneAndNodesLieInTheirWindows) {
    for (const auto& [name, response] : all_bands()) {
        SCOPED_TRACE(name);
        const auto grid = grid_of(response);
        EXPECT_NEAR(std::accumulate(grid.weight.begin(), grid.weight.end(), 0.0), 1.0, 1e-12);
        for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
            EXPECT_GT(grid.weight[i], 0.0);
            EXPECT_LE(response.lambda_um.front(), grid.cell_lower_um[i]);
            EXPECT_LE(grid.cell_lower_um[i], grid.lambda_um[i]);
            EXPECT_LE(grid.lambda_um[i], grid.cell_upper_um[i]);
            EXPECT_LE(grid.cell_upper_um[i], response.lambda_um.back());
            if (i > 0) {
                EXPECT_GT(grid.lambda_um[i], grid.lambda_um[i - 1]);
            }
        }
    }
}

TEST(SpectralGrid, IsExactForCubics) {
    // Gauss rule: centroid and third moment of the response come out exactly. Moments of a boxcar [a, b] in closed form.
    const double a = 3.0, b = 5.0;
    const auto grid = grid_of(boxcar(a, b));
    double first = 0.0, third = 0.0;
    for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
        first += grid.weight[i] * grid.lambda_um[i];
        third += grid.weight[i] * std::pow(grid.lambda_um[i], 3);
    }
    EXPECT_NEAR(first, (a + b) / 2.0, 1e-12);
    EXPECT_NEAR(third, (std::pow(b, 4) - std::pow(a, 4)) / (4.0 * (b - a)), 1e-10);
    // Centroids of measured responses as the sensor files list them (six digits).
    const auto responses = measured_responses();
    const std::map<std::string, double> centroid_um{
        {"modis_b20", 3.78822}, {"modis_b31", 11.0186}, {"landsat8_b7", 2.20125}};
    for (const auto& [name, expected] : centroid_um) {
        const auto measured = grid_of(responses.at(name));
        double sum = 0.0;
        for (std::size_t i = 0; i < measured.lambda_um.size(); ++i) sum += measured.weight[i] * measured.lambda_um[i];
        EXPECT_NEAR(sum / expected, 1.0, 5e-6) << name;
    }
}

TEST(SpectralGrid, WindowsOfABoxcarTileIt) {
    const auto grid = grid_of(boxcar(8.0, 11.0));
    EXPECT_NEAR(grid.cell_lower_um.front(), 8.0, 1e-9);
    EXPECT_NEAR(grid.cell_upper_um.back(), 11.0, 1e-9);
    for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
        EXPECT_NEAR((grid.cell_upper_um[i] - grid.cell_lower_um[i]) / 3.0, grid.weight[i], 1e-9);
        if (i > 0) {
            EXPECT_NEAR(grid.cell_lower_um[i], grid.cell_upper_um[i - 1], 1e-9);
        }
    }
}

TEST(SpectralGrid, WindowsHaveTheCentroidOfTheResponse) {
    // The weighted mean of window centres is the centroid: averages over windows keep every linear trend.
    for (const auto& [name, response] : measured_responses()) {
        const auto grid = grid_of(response);
        double windows = 0.0, nodes = 0.0;
        for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
            windows += grid.weight[i] * 0.5 * (grid.cell_lower_um[i] + grid.cell_upper_um[i]);
            nodes += grid.weight[i] * grid.lambda_um[i];
        }
        const double width_um = response.lambda_um.back() - response.lambda_um.front();
        EXPECT_NEAR(windows, nodes, 0.02 * width_um) << name;
    }
}

TEST(SpectralGrid, StaysSmall) {
    const std::vector<Spectrum> wasp{boxcar(0.9, 1.8), boxcar(3.0, 5.0), boxcar(8.0, 11.0)};
    const auto grid = make_spectral_grid(wasp);
    EXPECT_EQ(grid.band_count(), 3);
    EXPECT_LE(grid.size(), 100);
    for (const auto& [name, response] : measured_responses()) EXPECT_LE(grid_of(response).size(), 8) << name;
    EXPECT_EQ(grid_of(measured_responses().at("modis_b21")).size(), 2);
}

TEST(SpectralGrid, HonoursTheCellWidth) {
    const auto response = boxcar(8.0, 11.0);
    for (double cap : {0.02, 0.05}) {
        const auto grid = make_spectral_grid(std::span(&response, 1), cap);
        for (std::size_t i = 0; i < grid.lambda_um.size(); ++i)  // a window is half a cell
            EXPECT_LE((grid.cell_upper_um[i] - grid.cell_lower_um[i]) / grid.lambda_um[i], 0.55 * cap);
    }
}

TEST(SpectralGrid, ScaleOfTheResponseDoesNotMatter) {
    auto response = measured_responses().at("modis_b20");
    const auto grid = grid_of(response);
    for (double& r : response.value) r *= 1e-3;
    const auto scaled = grid_of(response);
    ASSERT_EQ(scaled.size(), grid.size());
    for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
        EXPECT_NEAR(scaled.lambda_um[i], grid.lambda_um[i], 1e-9);
        EXPECT_NEAR(scaled.weight[i], grid.weight[i], 1e-9);
    }
}

TEST(SpectralGrid, BandMeanAddsUpOneBand) {
    const std::vector<Spectrum> bands{boxcar(3.0, 5.0), boxcar(8.0, 11.0)};
    const auto grid = make_spectral_grid(bands);
    std::vector<float> values(static_cast<std::size_t>(grid.size()), 2.0F);
    for (auto i = static_cast<std::size_t>(grid.bands[1].begin); i < values.size(); ++i) values[i] = 5.0F;
    EXPECT_NEAR(grid.band_mean(0, values), 2.0, 1e-9);
    EXPECT_NEAR(grid.band_mean(1, values), 5.0, 1e-9);
}

TEST(SpectralGrid, Monochromatic) {
    const auto grid = monochromatic_grid(std::vector{3.9, 11.0});
    EXPECT_EQ(grid.band_count(), 2);
    EXPECT_EQ(grid.lambda_um, (std::vector{3.9, 11.0}));
    EXPECT_EQ(grid.cell_lower_um, grid.cell_upper_um);
    EXPECT_DOUBLE_EQ(grid.band_mean(1, std::vector{1.0F, 7.0F}), 7.0);
}

TEST(SpectralGrid, NarrowPeakGetsFewNodes) {
    const Spectrum line{Quantity::Response, {0.7664, 0.7665, 0.7666}, {0.0, 1.0, 0.0}};
    const auto grid = grid_of(line);
    EXPECT_LE(grid.size(), 2);
    EXPECT_NEAR(quadrature(grid, 1100.0) / planck_radiance(0.7665, 1100.0), 1.0, 1e-4);
}

TEST(SpectralGrid, NamesTheBandItRefuses) {
    const std::vector<Spectrum> bands{boxcar(3.0, 5.0), {Quantity::Response, {8.0, 11.0}, {0.0, 0.0}}};
    try {
        (void)make_spectral_grid(bands);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(e.what()).find("band 2"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace pyroscene::radiometry
