// The air's terms of whole runs where geometry decides: height of the ground, azimuth of the view to the sun, night, light of the
// surroundings. Expected from the tables at angles that follow from the pose and the sun, not from what the run says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "base/constants.h"
#include "gis/crs.h"
#include "radiometry/sun.h"
#include "system/narrow_camera.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

constexpr double kGround_m = 1600.0, kAltitude_m = 3000.0, kTilt_deg = 40.0, kReflectance = 0.3;
constexpr double kDay_unix_s = 1502316000.0, kNight_unix_s = 1502348400.0;  // 2017-08-09T22:00Z and 2017-08-10T07:00Z
constexpr double kCentre_x_m = 720000.0, kCentre_y_m = 5190000.0, kLat_deg = 46.83, kLon_deg = -114.116;

/// Truth of the middle pixel of a camera that looks 40 degrees off nadir along a heading onto level ground without fire.
class Look {
public:
    /// \param valley_m how much lower the ground lies 200 m north and south of the middle
    Look(const std::string& start, double heading_deg, const std::string& more = "", double valley_m = 0.0) {
        MapGrid grid;
        grid.cols = grid.rows = 60;
        grid.west_m = kCentre_x_m - 600.0;
        grid.north_m = kCentre_y_m + 600.0;
        grid.cell_m = 20.0;
        grid.crs_wkt = gis::parse_crs("EPSG:32611", "test").wkt;
        write_band(folder_ / "dem.tif", grid, "m", [&](double, double y_m) {
            return std::abs(y_m - kCentre_y_m) < 200.0 ? kGround_m : kGround_m - valley_m;
        });
        write_band(folder_ / "heat.tif", grid, "W m-2", [](double, double) { return 0.0; }, {{"time_s", "0"}});
        write_narrow_camera(folder_ / "camera.yaml");
        // Map north and true north differ by 2 degrees here; the middle of the view stays on the level ground.
        const double back_m = kAltitude_m * std::tan(kTilt_deg * kDegree_rad);
        const double x_m = kCentre_x_m - back_m * std::sin(heading_deg * kDegree_rad),
                     y_m = kCentre_y_m - back_m * std::cos(heading_deg * kDegree_rad);
        std::ofstream(folder_ / "scenario.yaml")
            << fmt::format(
                   "pyroscene: 1\nname: look\ninputs:\n  terrain:   {{file: dem.tif}}\n  heat_flux: {{file: "
                   "heat.tif}}\nstart: {}\n"
                   "flame: {{enabled: false}}\nsurface: {{emissivity: 0.7}}\natmosphere: {{model: midlatitude_summer}}\n"
                   "products: [radiance, truth]\nacquisitions:\n  - {{id: a, sensor: camera.yaml, time_s: 0, platform: "
                   "{{over: "
                   "{{x_m: {:.3f}, "
                   "y_m: {:.3f}}}, altitude_m: {}, heading_deg: {:.6f}, pitch_deg: {}}}}}\n",
                   start, x_m, y_m, kGround_m + kAltitude_m, heading_deg, kTilt_deg)
            << more;
        const auto run = pyroscene_cli("run " + (folder_ / "scenario.yaml").string() + " -o " + (folder_ / "out").string());
        EXPECT_EQ(run.exit_code, 0) << run.output;
        truth_ = gis::read_image(folder_ / "out" / "a" / "truth.tif");
    }
    [[nodiscard]] double term(const char* band, const char* name) const {
        return plane(truth_, std::string(band) + " term_" + name)[20 * 40 + 20];
    }

private:
    ScratchFolder folder_;
    gis::ImageFile truth_;
};

radiometry::AtmosphericTerms air_of(double azimuth_to_sun_deg, double ground_m, double unix_s) {
    const auto sun = radiometry::sun_position(unix_s, kLat_deg, kLon_deg);
    return radiometry::evaluate(shipped_atmosphere(ground_m),
                                {{kAltitude_m, ground_m, 23.0, sun.zenith_rad, sun.distance_AU},
                                 kTilt_deg * kDegree_rad,
                                 azimuth_to_sun_deg * kDegree_rad});
}

double mean_of(const radiometry::AtmosphericTerms& air, std::size_t band, const std::vector<double>& values) {
    return band_mean(air, kNarrowBands[band], [&](double, const auto& at) { return at(values); });
}

TEST(Air, PathSolarFollowsTheAzimuthToTheSun) {
    const double sun_deg = radiometry::sun_position(kDay_unix_s, kLat_deg, kLon_deg).azimuth_rad / kDegree_rad;
    std::array<double, 3> red{};
    for (const int i : {0, 1, 2}) {  // towards the sun, across, away from it
        const Look look("2017-08-09T22:00:00Z", std::fmod(sun_deg - 90.0 * i + 360.0, 360.0));
        const auto air = air_of(90.0 * i, kGround_m, kDay_unix_s);
        for (const std::size_t band : {0U, 1U, 2U})
            EXPECT_NEAR(look.term(kNarrowBands[band].id, "path_solar") / mean_of(air, band, air.path_solar), 1.0, 0.01) << i;
        red[static_cast<std::size_t>(i)] = look.term("RED", "path_solar");
    }
    // Scattering angles of about 110 degrees towards the sun, 130 across and 170 away from it: the three are far from equal.
    EXPECT_GT(red[2], 1.1 * red[0]);
    EXPECT_GT(red[0], 1.1 * red[1]);
}

TEST(Air, TakesTheHeightOfTheGround) {
    const Look look("2017-08-09T22:00:00Z", 0.0);
    const auto high = air_of(0.0, kGround_m, kDay_unix_s), sea = air_of(0.0, 0.0, kDay_unix_s);
    const double expected = mean_of(high, 3, high.path_thermal);
    EXPECT_NEAR(look.term("LWIR", "path_thermal") / expected, 1.0, 0.01);
    EXPECT_GT(mean_of(sea, 3, sea.path_thermal), 2.0 * expected);  // the moist lowest kilometres are not there
}

// A ridge above a wide valley: the air over the ridge is that of a sensor this high above ground this high, whatever the mean is.
TEST(Air, FollowsTheReliefOfTheScene) {
    const Look level("2017-08-09T22:00:00Z", 0.0), low("2017-08-09T22:00:00Z", 0.0, "", 300.0),
        high("2017-08-09T22:00:00Z", 0.0, "", 900.0);
    for (const char* term : {"path_thermal", "path_solar"}) {
        for (const auto& band : kNarrowBands) {
            if (!(level.term(band.id, term) > 0.01)) continue;  // next to nothing of this kind in this band
            EXPECT_NEAR(low.term(band.id, term) / level.term(band.id, term), 1.0, 0.01) << band.id << " " << term;
            EXPECT_NEAR(high.term(band.id, term) / level.term(band.id, term), 1.0, 0.01) << band.id << " " << term;
        }
    }
    EXPECT_NEAR(high.term("LWIR", "ground_emission") / level.term("LWIR", "ground_emission"), 1.0, 0.002);
}

// E' = E_dif + (E_dir mu + E_dif) A S / (1 - A S) lights the ground, A (E_dir mu C + E') t_d / pi joins the view.
TEST(Air, SurroundingsLightGroundAndView) {
    const Look look("2017-08-09T22:00:00Z", 0.0);
    const auto air = air_of(0.0, kGround_m, kDay_unix_s);
    const double mu = std::cos(radiometry::sun_position(kDay_unix_s, kLat_deg, kLon_deg).zenith_rad), A = kReflectance;
    for (const std::size_t band : {0U, 1U}) {
        const auto mean = [&](const auto& f) { return band_mean(air, kNarrowBands[band], f); };
        const auto sky = [&](const auto& at, bool bounces) {
            const double E_dir = at(air.direct_normal) * mu, E_dif = at(air.diffuse), AS = A * at(air.spherical_albedo);
            return E_dif + (bounces ? (E_dir + E_dif) * AS / (1.0 - AS) : 0.0);
        };
        const double lit = mean([&](double, const auto& at) { return sky(at, true) * at(air.transmittance) * A / kPi; });
        const double black = mean([&](double, const auto& at) { return sky(at, false) * at(air.transmittance) * A / kPi; });
        const double adjacent = mean([&](double, const auto& at) {
            return A * (at(air.direct_normal) * mu * at(air.solar_correlation) + sky(at, true)) / kPi *
                   at(air.diffuse_transmittance);
        });
        EXPECT_NEAR(look.term(kNarrowBands[band].id, "reflected_sky") / lit, 1.0, 0.01);
        EXPECT_NEAR(look.term(kNarrowBands[band].id, "adjacency") / adjacent, 1.0, 0.01);
        EXPECT_GT(lit, (band == 0 ? 1.1 : 1.02) * black);
    }
}

// A layer of white smoke under the camera: the switch of the scenario decides what becomes of its light, of optical depth 3 several
// times as much as once scattered (docs/physics-render.md), and lets sunlight down to the ground. In the long wave nothing changes.
TEST(Air, SmokeScattersAsTheScenarioSays) {
    const auto layer = [](const std::string& multiple) {
        return Look("2017-08-09T22:00:00Z", 0.0,
                    "plume: {smoke: boreal_forest, multiple_scattering: " + multiple +
                        ", layers: [{bottom_m: 2000, top_m: 2300, optical_depth_550nm: 3}]}\n");
    };
    const Look all = layer("true"), once = layer("false");
    const double ratio = all.term("RED", "smoke_scattering") / once.term("RED", "smoke_scattering");
    EXPECT_GT(ratio, 2.0);
    EXPECT_LT(ratio, 9.0);
    EXPECT_GT(all.term("RED", "reflected_sky"), 2.0 * once.term("RED", "reflected_sky"));
    EXPECT_NEAR(all.term("LWIR", "ground_emission") / once.term("LWIR", "ground_emission"), 1.0, 1e-6);
    // Neither gives back more than falls on the layer: pi L below the sun's irradiance at the ground without smoke.
    const auto air = air_of(0.0, kGround_m, kDay_unix_s);
    const double mu = std::cos(radiometry::sun_position(kDay_unix_s, kLat_deg, kLon_deg).zenith_rad);
    EXPECT_LT(kPi * all.term("RED", "smoke_scattering"),
              mean_of(air, 0, air.direct_normal) * mu + mean_of(air, 0, air.diffuse));
}

TEST(Air, NightLeavesWhatIsThermal) {
    const Look look("2017-08-10T07:00:00Z", 0.0);
    for (const auto& band : kNarrowBands)
        for (const char* solar : {"path_solar", "reflected_sun", "reflected_sky", "adjacency"})
            EXPECT_EQ(look.term(band.id, solar), 0.0) << band.id << " " << solar;
    const auto air = air_of(0.0, kGround_m, kNight_unix_s);
    EXPECT_NEAR(look.term("LWIR", "path_thermal") / mean_of(air, 3, air.path_thermal), 1.0, 0.01);
    EXPECT_GT(look.term("LWIR", "reflected_thermal_sky"), 0.1);
}

}  // namespace
}  // namespace pyroscene::test
