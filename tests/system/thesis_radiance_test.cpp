// Eq 4.44 of the thesis term by term, written out here from the atmosphere's tables wavelength by wavelength, against the truth
// layers of a run under `physics: thesis`:
//   L = E's cos(sigma') tau1 tau2 r / pi + E_ds tau2 r / pi + L_us + L_adj + L_target eps tau2
// The run keeps two more terms that the equation leaves out (thermal path, reflected thermal sky), each by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/constants.h"
#include "radiometry/atmosphere.h"
#include "radiometry/planck.h"
#include "radiometry/sun.h"
#include "system/narrow_camera.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kReflectance = 0.3, kAmbient_K = 307.15, kFront_K = 1100.0, kAltitude_m = 3000.0;

gis::ImageFile run_thesis(const ScratchFolder& folder, gis::ImageFile& geolocation) {
    write_narrow_camera(folder / "camera.yaml");
    const auto inputs = source_folder() / "scenarios" / "furnace";
    std::ofstream(folder / "scenario.yaml")
        << "pyroscene: 1\nname: equation\ninputs:\n  terrain:   {file: " << (inputs / "dem.tif").string()
        << "}\n  heat_flux: {file: " << (inputs / "heat_flux.tif").string()
        << "}\nstart: 2000-08-01T20:00:00Z\nphysics: thesis\nfire: {front_temperature_K: 1100}\nflame: {enabled: false}\n"
           "surface: {emissivity: 0.7}\natmosphere: {model: midlatitude_summer, ground_elevation_m: 0}\n"
           "products: [radiance, truth]\nacquisitions:\n"
           "  - {id: a, sensor: camera.yaml, time_s: 0, platform: {over: centre, altitude_agl_m: 3000}}\n";
    const auto result = pyroscene_cli("run " + (folder / "scenario.yaml").string() + " -o " + (folder / "out").string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    geolocation = gis::read_image(folder / "out" / "a" / "geolocation.tif");
    return gis::read_image(folder / "out" / "a" / "truth.tif");
}

double value(const gis::ImageFile& image, const std::string& name, std::size_t pixel) { return plane(image, name)[pixel]; }

TEST(ThesisPhysics, ReproducesEquation444TermByTerm) {
    const ScratchFolder folder;
    gis::ImageFile geolocation;
    const auto truth = run_thesis(folder, geolocation);
    ASSERT_FALSE(truth.pixels.empty());
    const auto set = shipped_atmosphere(0.0);
    int fronts = 0, backgrounds = 0;
    for (const std::size_t pixel : {std::size_t{3 * 40 + 20}, std::size_t{20 * 40 + 20}}) {
        const bool front = value(truth, "fraction_front", pixel) > 0.5;
        (front ? fronts : backgrounds) += 1;
        const double sun_zenith = value(geolocation, "sun_zenith", pixel) * kDegree_rad;
        radiometry::AtmosphereConditions conditions{kAltitude_m, 0.0, 23.0, sun_zenith, 1.0};
        conditions.sun_distance_AU = radiometry::sun_position(965160000.0, 43.0, -88.0).distance_AU;  // 2000-08-01T20:00Z
        const double view_zenith = value(geolocation, "view_zenith", pixel) * kDegree_rad;
        const double azimuth =
            (value(geolocation, "sun_azimuth", pixel) - value(geolocation, "view_azimuth", pixel) - 180.0) * kDegree_rad;
        const auto air = radiometry::evaluate(set, {conditions, view_zenith, azimuth});
        const double mu = std::cos(sun_zenith), r = kReflectance, target_K = front ? kFront_K : kAmbient_K;
        for (const auto& band : kNarrowBands) {
            SCOPED_TRACE(std::string(band.id) + (front ? " front" : " background"));
            const auto mean = [&](const auto& f) { return band_mean(air, band, f); };
            // Sky light on the ground: that of black surroundings, and what surroundings of albedo r send up and air returns.
            const auto E_ds = [&](const auto& at) {
                const double E_dir = at(air.direct_normal) * mu, E_dif = at(air.diffuse), rS = r * at(air.spherical_albedo);
                return E_dif + (E_dir + E_dif) * rS / (1.0 - rS);
            };
            const double sun = mean([&](double, const auto& at) {
                return at(air.direct_normal) * mu * at(air.solar_correlation) * at(air.transmittance) * r / kPi;
            });
            const double sky = mean([&](double, const auto& at) { return E_ds(at) * at(air.transmittance) * r / kPi; });
            const double path = mean([&](double, const auto& at) { return at(air.path_solar); });
            const double adjacent = mean([&](double, const auto& at) {
                return r * (at(air.direct_normal) * mu * at(air.solar_correlation) + E_ds(at)) / kPi *
                       at(air.diffuse_transmittance);
            });
            const double target = mean([&](double lambda_um, const auto& at) {
                return radiometry::planck_radiance(lambda_um, target_K) * (1.0 - r) * at(air.transmittance);
            });
            const auto term = [&](const char* name) { return value(truth, std::string(band.id) + " term_" + name, pixel); };
            const double total = sun + sky + path + adjacent + target;
            // Half a percent of the term, or what of the total is below notice.
            const auto expect = [&](const char* name, double expected) {
                EXPECT_NEAR(term(name), expected, 5e-3 * expected + 1e-5 * total) << name;
            };
            expect("reflected_sun", sun);
            expect("reflected_sky", sky);
            expect("path_solar", path);
            expect("adjacency", adjacent);
            expect("ground_emission", target);
            EXPECT_EQ(term("reflected_flame"), 0.0);
            EXPECT_EQ(term("flame_emission"), 0.0);
            const double left_out = term("path_thermal") + term("reflected_thermal_sky");
            EXPECT_NEAR(value(truth, std::string(band.id) + " radiance_noise_free", pixel) - left_out, total, 5e-3 * total);
        }
    }
    EXPECT_EQ(fronts, 1);
    EXPECT_EQ(backgrounds, 1);
}

}  // namespace
}  // namespace pyroscene::test
