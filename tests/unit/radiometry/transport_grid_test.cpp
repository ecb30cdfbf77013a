// Band radiances on the transport grid against sums over every 1 cm-1, for scenes the grid was not trained on.

#include "radiometry/transport_grid.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "radiometry/planck.h"
#include "radiometry/response.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

const FlameOptics& optics() {
    static const FlameOptics loaded = load_flame_optics(source_folder() / "data/optical");
    return loaded;
}

Spectrum gaussian(double centre_um, double fwhm_um) {
    Spectrum r{Quantity::Response, {}, {}};
    for (int i = -30; i <= 30; ++i) {
        r.lambda_um.push_back(centre_um + 0.05 * i * fwhm_um);
        r.value.push_back(std::exp(-4.0 * std::log(2.0) * std::pow(0.05 * i, 2)));
    }
    return r;
}

AtmosphericTerms line_of_sight(const std::string& model, double view_deg) {
    static const auto set = [](const std::string& name) { return load_atmosphere(name); };
    AtmospherePoint point;
    point.conditions.sensor_altitude_agl_m = 3000.0;
    point.conditions.sun_zenith_rad = 40.0 * kDegree_rad;
    point.view_zenith_rad = view_deg * kDegree_rad;
    point.relative_azimuth_rad = kPi / 2.0;
    return evaluate(set(model), point);
}

/// A scene nobody trained: layers of flame before warm ground that reflects the sun, seen through air.
struct Scene {
    std::vector<std::pair<double, double>> layers;  ///< length_m, T_K
    FlameGas gas;
    double ground_K = 320.0, reflectance = 0.15;
    const AtmosphericTerms* air = nullptr;

    [[nodiscard]] double radiance(double lambda_um) const {
        const auto of = [&](const std::vector<double>& y) {
            return Spectrum{Quantity::Dimensionless, air->wavelength_um, y}.at(lambda_um);
        };
        FlamePath path(optics(), lambda_um);
        for (const auto& [length_m, T_K] : layers) path.add(length_m, T_K, gas);
        double ground = (1.0 - reflectance) * planck_radiance(lambda_um, ground_K);
        if (air == nullptr) return path.emitted_radiance() + std::exp(-path.depth()) * ground;
        ground += reflectance / kPi *
                  (0.7 * of(air->direct_normal) * of(air->solar_correlation) + of(air->diffuse) + of(air->thermal_sky));
        return of(air->path_thermal) + of(air->path_solar) +
               of(air->transmittance) * (path.emitted_radiance() + std::exp(-path.depth()) * ground);
    }
};

double on_grid(const SpectralGrid& grid, int band, const Scene& scene) {
    double sum = 0.0;
    const auto range = grid.bands[static_cast<std::size_t>(band)];
    for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i)
        sum += grid.weight[i] * scene.radiance(grid.lambda_um[i]);
    return sum;
}

/// Midpoint sums over 1 cm-1; lines are resolved a thousand times finer.
double reference(const Spectrum& response, const Scene& scene, bool lines) {
    std::vector<double> x;
    const double lower = response.lambda_um.front(), upper = response.lambda_um.back();
    for (double wavenumber = 1e4 / upper; wavenumber < 1e4 / lower; wavenumber += 1.0) x.push_back(1e4 / wavenumber);
    x.push_back(lower);
    if (lines) {
        const auto fine = doublet_wavelengths_um(optics().alkali.potassium, lower, upper);
        x.insert(x.end(), fine.begin(), fine.end());
    }
    std::sort(x.begin(), x.end());
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        const double middle = 0.5 * (x[i - 1] + x[i]), share = response.at(middle, false) * (x[i] - x[i - 1]);
        if (!(share > 0.0)) continue;
        sum += share * scene.radiance(middle);
        area += share;
    }
    return sum / area;
}

struct Case {
    std::string name;
    Spectrum response;
    bool lines = false;
};

std::vector<Case> cases() {
    return {{"0.9-1.8 um", boxcar(0.9, 1.8)},
            {"3-5 um", boxcar(3.0, 5.0)},
            {"8-11 um", boxcar(8.0, 11.0)},
            {"ASD 766.7 nm", gaussian(0.7667, 0.003), true},
            {"AVIRIS 768.7 nm", gaussian(0.7687, 0.010), true},
            {"AVIRIS 759.1 nm", gaussian(0.7591, 0.0096), true},
            {"MODIS 23, 4.05 um", boxcar(4.020, 4.080)},
            {"4.15-4.5 um", boxcar(4.15, 4.5)},
            {"MODIS 25, 4.52 um", boxcar(4.482, 4.549)},
            {"2.4-2.6 um", boxcar(2.4, 2.6)},
            {"AVIRIS 2.0 um", gaussian(2.0, 0.010)},
            {"10.78-11.28 um", boxcar(10.78, 11.28)}};
}

TEST(TransportGrid, BandsAgreeWithOneWavenumberWithinHalfAPercent) {
    const AtmosphericTerms nadir = line_of_sight("midlatitude_summer", 0.0),
                           slant = line_of_sight("midlatitude_summer", 45.0),
                           between = line_of_sight("midlatitude_summer", 30.0);
    SpectralStructure structure{&optics(), {}, {nadir, line_of_sight("midlatitude_summer", 20.0), slant}};
    FlameGas moist;
    moist.x_H2O = 0.2;
    moist.x_CO2 = 0.06;
    moist.soot_volume_fraction = 5e-8;
    const std::vector<Scene> scenes{{{{2.3, 1080.0}}, {}, 700.0, 0.15, &between},
                                    {{{0.5, 820.0}, {0.6, 1270.0}}, {}, 320.0, 0.15, &between},
                                    {{{0.4, 1350.0}}, moist, 900.0, 0.1, &nadir},
                                    {{{9.0, 1000.0}}, moist, 320.0, 0.2, &between},
                                    {{}, {}, 310.0, 0.3, &between},
                                    {{}, {}, 650.0, 0.05, &slant},
                                    {{{1.5, 1200.0}}, {}, 320.0, 0.1, nullptr}};
    for (const auto& test : cases()) {
        const auto grid = make_spectral_grid(std::span(&test.response, 1), structure);
        double sum = 0.0, worst = 0.0;
        for (const double w : grid.weight) sum += w;
        EXPECT_NEAR(sum, 1.0, 1e-9);
        for (std::size_t s = 0; s < scenes.size(); ++s) {
            const double expected = reference(test.response, scenes[s], test.lines);
            const double error = on_grid(grid, 0, scenes[s]) / expected - 1.0;
            worst = std::max(worst, std::abs(error));
            EXPECT_LT(std::abs(error), 5e-3) << test.name << ", scene " << s;
        }
        RecordProperty(test.name, std::to_string(grid.size()) + " nodes, " + std::to_string(100.0 * worst) + " %");
        if (std::getenv("PYROSCENE_PRINT") != nullptr)
            std::printf("%-20s %3d nodes  worst %.3f %%\n", test.name.c_str(), grid.size(), 100.0 * worst);
    }
}

TEST(TransportGrid, BlackbodiesStayExact) {
    const SpectralStructure structure{&optics(), {}, {}};
    for (const auto& response : {boxcar(3.0, 5.0), boxcar(8.0, 11.0), boxcar(0.9, 1.8)}) {
        const auto grid = make_spectral_grid(std::span(&response, 1), structure);
        for (const double T_K : {310.0, 650.0, 1000.0, 1400.0}) {
            const double expected = band_mean_radiance(T_K, response);
            if (expected < 1e-3) continue;
            double sum = 0.0;
            for (std::size_t i = 0; i < grid.weight.size(); ++i)
                sum += grid.weight[i] * planck_radiance(grid.lambda_um[i], T_K);
            EXPECT_NEAR(sum / expected, 1.0, 2e-4) << T_K;
        }
    }
}

TEST(TransportGrid, BandsWithoutGasAreCutAsBefore) {
    const Spectrum green = boxcar(0.53, 0.58);
    const auto plain = make_spectral_grid(std::span(&green, 1));
    const auto grid = make_spectral_grid(std::span(&green, 1), SpectralStructure{&optics(), {}, {}});
    EXPECT_EQ(grid.lambda_um, plain.lambda_um);
    EXPECT_EQ(grid.weight, plain.weight);
}

}  // namespace
}  // namespace pyroscene::radiometry
