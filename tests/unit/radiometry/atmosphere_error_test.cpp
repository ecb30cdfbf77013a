// How far interpolation between the nodes of the shipped tables is from the truth: each inner node is left out in turn and
// predicted from the others. Steps are then twice as wide as in use, so the errors are upper bounds of those in use.
// docs/physics-radiometry.md holds the numbers.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "base/constants.h"
#include "test_data.h"

namespace pyroscene::radiometry {
namespace {

/// An array of blocks [outer][n][inner] without block k.
std::vector<float> without(const std::vector<float>& values, std::size_t n, std::size_t inner, std::size_t k) {
    std::vector<float> out;
    for (std::size_t i = 0; i < values.size(); ++i)
        if ((i / inner) % n != k) out.push_back(values[i]);
    return out;
}

enum class Axis { Altitude, View, Sun };

AtmosphereTable leave_out(const AtmosphereTable& t, Axis axis, std::size_t k) {
    AtmosphereTable r = t;
    const std::size_t l = t.lambda_count(), v = t.view_zenith_deg.size(), s = t.solar_zenith_deg.size(),
                      a = t.sensor_altitude_km.size();
    const auto drop = [&](std::vector<float>& values, std::size_t below) {  // below: size of what is inside the axis
        const std::size_t n = axis == Axis::Altitude ? a : axis == Axis::View ? v : s;
        values = without(values, n, below, k);
    };
    if (axis != Axis::Sun) {
        const std::size_t inside = axis == Axis::Altitude ? v : 1;
        drop(r.transmittance, inside * l);
        drop(r.path_thermal_radiance, inside * l);
        drop(r.diffuse_upward_transmittance, inside * l);
        drop(r.path_solar_radiance, inside * s * 3 * l);
        drop(r.solar_path_correlation, inside * s * l);
    } else {
        drop(r.path_solar_radiance, 3 * l);
        drop(r.solar_path_correlation, l);
        drop(r.direct_solar_irradiance, l);
        drop(r.diffuse_solar_irradiance, l);
    }
    auto& nodes = axis == Axis::Altitude ? r.sensor_altitude_km
                  : axis == Axis::View   ? r.view_zenith_deg
                                         : r.solar_zenith_deg;
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(k));
    return r;
}

struct Window {
    const char* name;
    double lower_um, upper_um;
};
constexpr Window kWindows[] = {{"0.45-0.9", 0.45, 0.9}, {"1.5-1.8", 1.5, 1.8}, {"3.5-4.1", 3.5, 4.1}, {"8-12", 8.0, 12.0}};

struct Error {
    double sum = 0.0, largest = 0.0;
    int n = 0;
    void add(double value) {
        sum += std::abs(value);
        largest = std::max(largest, std::abs(value));
        ++n;
    }
    [[nodiscard]] double mean() const { return n > 0 ? sum / n : 0.0; }
};

struct Errors {
    Error tau, thermal, solar, direct, diffuse;  // tau absolute; the others relative to the window's mean
};

/// Errors at the left-out nodes, over a few settings of the other angles.
Errors errors(const AtmosphereTable& t, Axis axis, const Window& window) {
    Errors e;
    const AtmosphereSet whole{{t}};
    const std::size_t count = axis == Axis::Altitude ? t.sensor_altitude_km.size()
                              : axis == Axis::View   ? t.view_zenith_deg.size()
                                                     : t.solar_zenith_deg.size();
    for (std::size_t k = 1; k + 1 < count; ++k) {
        const AtmosphereSet reduced{{leave_out(t, axis, k)}};
        for (const std::size_t other : {1U, 4U}) {
            AtmospherePoint p;
            p.conditions.sensor_altitude_agl_m = 1e3 * t.sensor_altitude_km[axis == Axis::Altitude ? k : other];
            p.view_zenith_rad = kDegree_rad * t.view_zenith_deg[axis == Axis::View ? k : other];
            p.conditions.sun_zenith_rad = kDegree_rad * t.solar_zenith_deg[axis == Axis::Sun ? k : 1];
            p.relative_azimuth_rad = 60.0 * kDegree_rad;
            const auto truth = evaluate(whole, p), found = evaluate(reduced, p);
            const auto relative = [&](Error& to, const std::vector<double>& a, const std::vector<double>& b) {
                const double scale =
                    mean_over({Quantity::Dimensionless, truth.wavelength_um, b}, window.lower_um, window.upper_um);
                for (std::size_t l = 0; l < a.size(); ++l)
                    if (truth.wavelength_um[l] >= window.lower_um && truth.wavelength_um[l] <= window.upper_um &&
                        scale > 0.0)
                        to.add((a[l] - b[l]) / scale);
            };
            for (std::size_t l = 0; l < truth.wavelength_um.size(); ++l)
                if (truth.wavelength_um[l] >= window.lower_um && truth.wavelength_um[l] <= window.upper_um)
                    e.tau.add(found.transmittance[l] - truth.transmittance[l]);
            relative(e.thermal, found.path_thermal, truth.path_thermal);
            relative(e.solar, found.path_solar, truth.path_solar);
            relative(e.direct, found.direct_normal, truth.direct_normal);
            relative(e.diffuse, found.diffuse, truth.diffuse);
        }
    }
    return e;
}

void print(const char* axis, const Window& w, const Errors& e) {
    std::printf("%-8s %-8s tau %.4f / %.4f  L_pt %.4f / %.4f  L_ps %.4f / %.4f  E_dir %.4f / %.4f  E_dif %.4f / %.4f\n",
                axis, w.name, e.tau.mean(), e.tau.largest, e.thermal.mean(), e.thermal.largest, e.solar.mean(),
                e.solar.largest, e.direct.mean(), e.direct.largest, e.diffuse.mean(), e.diffuse.largest);
}

TEST(AtmosphereError, LeavingOutANode) {
    const auto t = load_table("lowtran7_midlatitude_summer_rural23_ground0.nc");
    for (const auto& window : kWindows) {
        SCOPED_TRACE(window.name);
        const auto altitude = errors(t, Axis::Altitude, window), view = errors(t, Axis::View, window),
                   sun = errors(t, Axis::Sun, window);
        print("altitude", window, altitude);
        print("view", window, view);
        print("sun", window, sun);
        const bool thermal = window.lower_um > 3.0;
        EXPECT_LT(altitude.tau.mean(), 0.012);
        EXPECT_LT(view.tau.mean(), 0.001);
        if (thermal) {
            EXPECT_LT(altitude.thermal.mean(), 0.06);
            EXPECT_LT(view.thermal.mean(), 0.005);
        } else {
            EXPECT_LT(view.solar.mean(), 0.05);
            EXPECT_LT(sun.direct.mean(), 0.005);
            EXPECT_LT(sun.diffuse.mean(), 0.04);
        }
    }
}

// Beyond its last angle a table follows Beer's law: without 55, 60 and 65 deg it finds 65 deg, where clamping it to 45 deg would
// transmit up to half as much again.
TEST(AtmosphereError, ViewsBeyondTheTable) {
    const auto t = load_table("lowtran7_midlatitude_summer_rural23_ground0.nc");
    AtmosphereTable reduced = t;
    while (reduced.view_zenith_deg.back() > 50.0)
        reduced = leave_out(reduced, Axis::View, reduced.view_zenith_deg.size() - 1);
    for (const double altitude_m : {500.0, 3000.0, 100e3}) {
        AtmospherePoint p;
        p.conditions.sensor_altitude_agl_m = altitude_m;
        p.conditions.sun_zenith_rad = 45.0 * kDegree_rad;
        p.view_zenith_rad = 65.0 * kDegree_rad;
        const auto truth = evaluate({{t}}, p), found = evaluate({{reduced}}, p);
        for (const auto& window : kWindows) {
            const auto mean = [&](const std::vector<double>& values) {
                return mean_over({Quantity::Dimensionless, truth.wavelength_um, values}, window.lower_um, window.upper_um);
            };
            EXPECT_NEAR(mean(found.transmittance) / mean(truth.transmittance), 1.0, 0.03) << window.name << altitude_m;
            if (window.lower_um > 3.0) {
                EXPECT_NEAR(mean(found.path_thermal) / mean(truth.path_thermal), 1.0, 0.06) << window.name << altitude_m;
            }
        }
    }
}

// Tables over high ground tell what opaque air sends at altitudes between the nodes of the sea-level table: the ground does not
// show through, so only the altitude above the sea counts. LOWTRAN itself takes each layer at one temperature (2 K here).
TEST(AtmosphereError, OpaqueAirBetweenTheAltitudes) {
    for (const std::string model : {"midlatitude_summer", "us_standard_1976"}) {
        const AtmosphereSet sea{{load_table("lowtran7_" + model + "_rural23_ground0.nc")}};
        Error all;
        for (int ground_km = 1; ground_km <= 3; ++ground_km) {
            const AtmosphereSet high{
                {load_table("lowtran7_" + model + "_rural23_ground" + std::to_string(ground_km) + ".nc")}};
            for (const double above_km : {0.5, 1.0, 2.0, 3.0, 4.2, 6.0, 10.0, 20.0}) {
                AtmospherePoint p;
                p.conditions.sun_zenith_rad = 2.0;
                p.conditions.sensor_altitude_agl_m = 1e3 * above_km;
                p.conditions.ground_elevation_m = 1e3 * ground_km;
                const auto truth = evaluate(high, p);
                p.conditions.sensor_altitude_agl_m = 1e3 * (above_km + ground_km);
                p.conditions.ground_elevation_m = 0.0;
                const auto found = evaluate(sea, p);
                Error e;
                for (std::size_t l = 0; l < truth.wavelength_um.size(); ++l)
                    if (truth.wavelength_um[l] > 2.5 && truth.transmittance[l] < 1e-4)
                        e.add(found.path_thermal[l] / truth.path_thermal[l] - 1.0);
                if (e.n == 0) continue;
                std::printf("%s, opaque air at %5.2f km: L_pt %.3f / %.3f of %d samples\n", model.c_str(),
                            above_km + ground_km, e.mean(), e.largest, e.n);
                all.add(e.mean());
            }
        }
        std::printf("%s: mean %.4f\n", model.c_str(), all.mean());
        EXPECT_LT(all.mean(), 0.065);
    }
}

/// Tables left out whole: visibility 23 km from 5 and 50, elevation 1 and 2 km from their neighbours.
TEST(AtmosphereError, LeavingOutATable) {
    const std::string name = "lowtran7_midlatitude_summer_rural";
    const auto compare = [](const AtmosphereSet& reduced, const AtmosphereTable& table, const char* what) {
        AtmospherePoint p;
        p.conditions.sensor_altitude_agl_m = 3000.0;
        p.conditions.visibility_km = table.visibility_km;
        p.conditions.ground_elevation_m = 1e3 * table.ground_elevation_km;
        p.conditions.sun_zenith_rad = 45.0 * kDegree_rad;
        p.view_zenith_rad = 30.0 * kDegree_rad;
        const auto truth = evaluate({{table}}, p), found = evaluate(reduced, p);
        double worst = 0.0;
        for (const auto& window : kWindows) {
            Errors e;
            for (std::size_t l = 0; l < truth.wavelength_um.size(); ++l) {
                if (truth.wavelength_um[l] < window.lower_um || truth.wavelength_um[l] > window.upper_um) continue;
                e.tau.add(found.transmittance[l] - truth.transmittance[l]);
                if (truth.path_thermal[l] > 0.0) e.thermal.add(found.path_thermal[l] / truth.path_thermal[l] - 1.0);
                if (truth.path_solar[l] > 0.0) e.solar.add(found.path_solar[l] / truth.path_solar[l] - 1.0);
                if (truth.direct_normal[l] > 0.0) e.direct.add(found.direct_normal[l] / truth.direct_normal[l] - 1.0);
                if (truth.diffuse[l] > 0.0) e.diffuse.add(found.diffuse[l] / truth.diffuse[l] - 1.0);
            }
            print(what, window, e);
            worst = std::max(worst, e.tau.mean());
        }
        return worst;
    };
    EXPECT_LT(compare({{load_table(name + "5_ground0.nc"), load_table(name + "50_ground0.nc")}},
                      load_table(name + "23_ground0.nc"), "23 km"),
              0.06);
    EXPECT_LT(compare({{load_table(name + "23_ground0.nc"), load_table(name + "23_ground2.nc")}},
                      load_table(name + "23_ground1.nc"), "1 km up"),
              0.03);
    EXPECT_LT(compare({{load_table(name + "23_ground1.nc"), load_table(name + "23_ground3.nc")}},
                      load_table(name + "23_ground2.nc"), "2 km up"),
              0.03);
}

}  // namespace
}  // namespace pyroscene::radiometry
