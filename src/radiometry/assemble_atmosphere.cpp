#include "radiometry/assemble_atmosphere.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/atmosphere_assembly.h"
#include "radiometry/planck.h"

namespace pyroscene::radiometry {

using Array = Assembly::Array;
using Filter = Assembly::Filter;

namespace assembly {

bool same(const std::optional<double>& a, double b) { return a && std::abs(*a - b) <= 1e-3 * std::max(1.0, std::abs(b)); }

/// Distinct values in ascending order.
Array distinct(const std::vector<AtmosphereRun>& runs, const Filter& wanted, std::optional<double> RunGeometry::*of) {
    Array values;
    for (const auto& run : runs) {
        const auto& value = run.geometry.*of;
        if (!wanted(run) || !value) continue;
        if (std::none_of(values.begin(), values.end(), [&](double v) { return same(value, v); })) values.push_back(*value);
    }
    std::sort(values.begin(), values.end());
    return values;
}

double at_wavelength(const AtmosphereRun& run, const Array& values, double lambda_um) {
    const auto& x = run.wavelength_um;
    const auto next = std::clamp<std::ptrdiff_t>(std::upper_bound(x.begin(), x.end(), lambda_um) - x.begin(), 1,
                                                 static_cast<std::ptrdiff_t>(x.size()) - 1);
    const auto high = static_cast<std::size_t>(next);
    const double f = std::clamp((lambda_um - x[high - 1]) / (x[high] - x[high - 1]), 0.0, 1.0);
    return values[high - 1] + f * (values[high] - values[high - 1]);
}

bool covers(const AtmosphereRun& run, double lambda_um) {
    return lambda_um >= run.wavelength_um.front() * (1.0 - 1e-9) && lambda_um <= run.wavelength_um.back() * (1.0 + 1e-9);
}

void append(std::vector<float>& to, const Array& values) {
    for (const double v : values) to.push_back(static_cast<float>(v));
}

}  // namespace assembly

using namespace assembly;

namespace {

/// Wavelengths of the first run, and of the others where they reach farther.
Array joined_wavelengths(const std::vector<AtmosphereRun>& runs) {
    Array all;
    for (const auto& run : runs) {
        if (run.looks_up && !all.empty()) continue;
        Array below, above;
        for (const double lambda : run.wavelength_um) {
            if (all.empty() || lambda > all.back() * (1.0 + 1e-9)) above.push_back(lambda);
            if (!all.empty() && lambda < all.front() * (1.0 - 1e-9)) below.push_back(lambda);
        }
        all.insert(all.end(), above.begin(), above.end());
        all.insert(all.begin(), below.begin(), below.end());
    }
    return all;
}

}  // namespace

Assembly::Assembly(std::vector<AtmosphereRun> runs, bool without_sun) : runs_(std::move(runs)), without_sun_(without_sun) {
    normalise();
    make_axes();
}

/// Brings solar terms to 1 AU.
void Assembly::normalise() {
    if (runs_.empty()) throw input_error("import-atmosphere", "no run was given");
    for (auto& run : runs_) {
        if (run.wavelength_um.size() < 2) throw input_error(run.source, "fewer than two wavelengths");
        const double day = run.geometry.day_of_year.value_or(0.0);
        if (!(day > 0.0)) continue;
        const double distance_AU = 1.0 - 0.01672 * std::cos(2.0 * kPi * (day - 4.0) / 365.256);
        for (const Member term :
             {&AtmosphereRun::path_solar, &AtmosphereRun::toa_irradiance, &AtmosphereRun::direct_normal,
              &AtmosphereRun::direct_reflected, &AtmosphereRun::two_way_irradiance, &AtmosphereRun::diffuse})
            for (double& value : run.*term) value *= distance_AU * distance_AU;
        if (run.includes_thermal) continue;
        for (double& value : run.ground_reflected) value *= distance_AU * distance_AU;
    }
}

void Assembly::make_path_axes() {
    for (const auto& run : runs_) {
        if (!is_path(run)) continue;
        const auto need = [&](const std::optional<double>& value, const char* name, const char* option) {
            if (!value) throw input_error(run.source, fmt::format("the {} of this run is unknown; give {}", name, option));
        };
        need(run.geometry.sensor_altitude_km, "sensor altitude", "--sensor-altitude-km");
        need(run.geometry.view_zenith_deg, "view zenith angle", "--view-zenith-deg");
        constexpr double kLevel_deg = 89.0;
        if (*run.geometry.view_zenith_deg > kLevel_deg)
            throw input_error(run.source, fmt::format("the path of this run is level (view zenith {:.4g} deg), expected one "
                                                      "from a sensor down to the ground",
                                                      *run.geometry.view_zenith_deg));
    }
    altitude_km_ = distinct(runs_, is_path, &RunGeometry::sensor_altitude_km);
    view_deg_ = distinct(runs_, is_path, &RunGeometry::view_zenith_deg);
    if (altitude_km_.empty() || view_deg_.empty())
        throw input_error(runs_.front().source,
                          "no run looks from a sensor down to the ground; the path below the sensor is what a table needs");
}

void Assembly::make_axes() {
    lambda_ = joined_wavelengths(runs_);
    make_path_axes();
    sun_deg_ = azimuth_deg_ = {0.0};
    if (without_sun_) return;
    sun_deg_ = distinct(runs_, looks_down, &RunGeometry::sun_zenith_deg);
    if (sun_deg_.empty())
        throw input_error(runs_.front().source,
                          "the sun zenith angle is unknown; give --sun-zenith-deg, or import without the sun (--no-sun)");
    const auto scatters = [](const AtmosphereRun& r) { return looks_down(r) && !r.path_solar.empty(); };
    const auto found = distinct(runs_, scatters, &RunGeometry::relative_azimuth_deg);
    if (found.size() == 3 && same(0.0, found[0]) && same(90.0, found[1]) && same(180.0, found[2]))
        azimuth_deg_ = {0.0, 90.0, 180.0};
    else if (found.size() == 1)
        azimuth_deg_ = found;
    else if (!found.empty())
        throw input_error(
            "import-atmosphere",
            fmt::format("relative azimuths {} deg; a table has 0, 90 and 180, or a single one", fmt::join(found, ", ")));
}

bool Assembly::any(Member term, const Filter& wanted) const {
    return std::any_of(runs_.begin(), runs_.end(), [&](const auto& r) { return !(r.*term).empty() && wanted(r); });
}

Array Assembly::collect(Member term, const Filter& wanted, double missing) const {
    Array out(lambda_.size(), missing);
    std::vector<bool> known(lambda_.size(), false);
    for (const auto& run : runs_) {
        if ((run.*term).empty() || !wanted(run)) continue;
        for (std::size_t l = 0; l < lambda_.size(); ++l)
            if (!known[l] && covers(run, lambda_[l])) {
                out[l] = at_wavelength(run, run.*term, lambda_[l]);
                known[l] = true;
            }
    }
    return out;
}

Filter Assembly::at_node(double altitude_km, double view_deg) const {
    return [=](const AtmosphereRun& r) {
        return !r.looks_up && same(r.geometry.sensor_altitude_km, altitude_km) && same(r.geometry.view_zenith_deg, view_deg);
    };
}

Filter Assembly::under_sun(double sun_deg) const {
    return [=](const AtmosphereRun& r) { return !r.looks_up && same(r.geometry.sun_zenith_deg, sun_deg); };
}

/// Transmittance from two runs over black ground of different temperatures: L1 - L2 = tau (B1 - B2); the rest is the path.
Array Assembly::two_temperatures(const Filter& node, Array* path_thermal) const {
    std::vector<const AtmosphereRun*> pair;
    for (const auto& run : runs_)
        if (node(run) && !run.total_radiance.empty() && run.transmittance.empty() && run.geometry.surface_temperature_K)
            pair.push_back(&run);
    Array tau(lambda_.size(), std::nan(""));
    *path_thermal = tau;
    if (pair.size() < 2) return tau;
    const double T1 = *pair[0]->geometry.surface_temperature_K, T2 = *pair[1]->geometry.surface_temperature_K;
    if (std::abs(T1 - T2) < 5.0)
        throw input_error(pair[1]->source,
                          fmt::format("surface temperatures {} and {} K are too close to tell the transmittance", T1, T2));
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        if (!covers(*pair[0], lambda_[l]) || !covers(*pair[1], lambda_[l])) continue;
        const double B1 = planck_radiance(lambda_[l], T1), B2 = planck_radiance(lambda_[l], T2);
        const double L1 = at_wavelength(*pair[0], pair[0]->total_radiance, lambda_[l]);
        const double L2 = at_wavelength(*pair[1], pair[1]->total_radiance, lambda_[l]);
        tau[l] = std::clamp((L1 - L2) / (B1 - B2), 0.0, 1.0);
        (*path_thermal)[l] = std::max(0.0, L1 - tau[l] * B1);
    }
    return tau;
}

void Assembly::fill_paths(AtmosphereTable& t) {
    for (const double altitude_km : altitude_km_)
        for (const double view_deg : view_deg_) append_path_node(t, altitude_km, view_deg);
}

namespace {

std::string node_name(double altitude_km, double view_deg) {
    return fmt::format("sensor {:.6g} km above ground, view zenith {:.4g} deg", altitude_km, view_deg);
}

}  // namespace

void Assembly::append_path_node(AtmosphereTable& t, double altitude_km, double view_deg) {
    const auto node = at_node(altitude_km, view_deg);
    const auto where = node_name(altitude_km, view_deg);
    // Terms that depend on the albedo are taken where it is smallest: nothing of the surroundings is in them then.
    const Array albedos = distinct(runs_, node, &RunGeometry::albedo);
    const auto dark = [&](const AtmosphereRun& r) {
        return node(r) && (albedos.empty() || !r.geometry.albedo || same(r.geometry.albedo, albedos.front()));
    };
    Array thermal_of_pair;
    const Array tau_of_pair = two_temperatures(node, &thermal_of_pair);
    Array tau = collect(&AtmosphereRun::transmittance, node, std::nan(""));
    Array thermal = collect(&AtmosphereRun::path_thermal, dark, std::nan(""));
    bool missing = false;
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        if (std::isnan(thermal[l])) thermal[l] = thermal_of_pair[l];
        if (!std::isnan(tau_of_pair[l])) tau[l] = tau_of_pair[l];
        if (std::isnan(tau[l]))
            throw input_error(where, fmt::format("no run gives the transmittance at {:.6g} um", lambda_[l]));
        missing = missing || (std::isnan(thermal[l]) && lambda_[l] > 2.5);
        if (std::isnan(thermal[l])) thermal[l] = 0.0;
    }
    if (missing) note(fmt::format("{}: no path thermal radiance beyond 2.5 um; it is 0", where));
    append(t.transmittance, tau);
    append(t.path_thermal_radiance, thermal);
    append_path_solar(t, altitude_km, view_deg, dark);
}

void Assembly::append_path_solar(AtmosphereTable& t, double altitude_km, double view_deg, const Filter& dark) {
    for (const double sun_deg : sun_deg_)
        for (std::size_t k = 0; k < 3; ++k) {
            const double azimuth_deg = azimuth_deg_.size() == 3 ? azimuth_deg_[k] : azimuth_deg_[0];
            const bool any_azimuth = azimuth_deg_.size() == 1 || sun_deg < 1e-6 || view_deg < 1e-6;
            const auto lit = [&](const AtmosphereRun& r) {
                return dark(r) && same(r.geometry.sun_zenith_deg, sun_deg) &&
                       (any_azimuth || same(r.geometry.relative_azimuth_deg, azimuth_deg));
            };
            if (!without_sun_ && !any(&AtmosphereRun::path_solar, lit))
                throw input_error(node_name(altitude_km, view_deg),
                                  fmt::format("no run gives the path solar radiance for sun zenith {:.4g} deg, relative "
                                              "azimuth {:.4g} deg",
                                              sun_deg, azimuth_deg));
            append(t.path_solar_radiance,
                   without_sun_ ? Array(lambda_.size(), 0.0) : collect(&AtmosphereRun::path_solar, lit, 0.0));
        }
}

Array Assembly::ground_irradiance(Member reflected, double albedo, double sun_deg) const {
    Array out(lambda_.size(), std::nan(""));
    for (const auto& run : runs_) {
        if (run.looks_up || run.transmittance.empty() || (run.*reflected).empty() || !same(run.geometry.albedo, albedo))
            continue;
        if (sun_deg >= 0.0 ? !same(run.geometry.sun_zenith_deg, sun_deg) : run.includes_sun) continue;
        for (std::size_t l = 0; l < lambda_.size(); ++l) {
            if (!std::isnan(out[l]) || !covers(run, lambda_[l])) continue;
            const double tau = at_wavelength(run, run.transmittance, lambda_[l]);
            out[l] = tau > kSmallTau ? kPi * at_wavelength(run, run.*reflected, lambda_[l]) / (albedo * tau) : 0.0;
        }
    }
    return out;
}

/// Inserts nadir and 65 deg around a single view angle.
void Assembly::extend_view(AtmosphereTable& t) const {
    const double own_deg = t.view_zenith_deg.front();
    Array angles = own_deg > 1.0 ? Array{0.0, own_deg} : Array{own_deg};
    if (own_deg < 64.0) angles.push_back(65.0);
    const auto old = t;
    const std::size_t n = t.lambda_count(), ns = t.solar_zenith_deg.size();
    t.view_zenith_deg = angles;
    for (auto* array : {&t.transmittance, &t.path_thermal_radiance, &t.path_solar_radiance, &t.diffuse_upward_transmittance,
                        &t.solar_path_correlation})
        array->clear();
    for (std::size_t a = 0; a < t.sensor_altitude_km.size(); ++a)
        for (const double angle : angles) {
            const double stretch = std::cos(own_deg * kDegree_rad) / std::cos(angle * kDegree_rad);
            Array absorbed(n);  // ratio of the absorptances
            for (std::size_t l = 0; l < n; ++l) {
                const double tau = old.transmittance[a * n + l], stretched = std::pow(tau, stretch);
                absorbed[l] = tau < 1.0 ? (1.0 - stretched) / (1.0 - tau) : stretch;
                t.transmittance.push_back(static_cast<float>(stretched));
                t.path_thermal_radiance.push_back(static_cast<float>(absorbed[l] * old.path_thermal_radiance[a * n + l]));
                t.diffuse_upward_transmittance.push_back(
                    std::min(1.0F, static_cast<float>(absorbed[l] * old.diffuse_upward_transmittance[a * n + l])));
            }
            for (std::size_t sr = 0; sr < ns * 3; ++sr)
                for (std::size_t l = 0; l < n; ++l)
                    t.path_solar_radiance.push_back(
                        static_cast<float>(absorbed[l] * old.path_solar_radiance[(a * ns * 3 + sr) * n + l]));
            for (std::size_t s = 0; s < ns; ++s)
                for (std::size_t l = 0; l < n; ++l)
                    t.solar_path_correlation.push_back(old.solar_path_correlation[(a * ns + s) * n + l]);
        }
}

AssembledAtmosphere Assembly::make() {
    AtmosphereTable t;
    t.wavelength_um = lambda_;
    t.sensor_altitude_km = altitude_km_;
    t.view_zenith_deg = view_deg_;
    t.solar_zenith_deg = sun_deg_;
    t.relative_azimuth_deg = {0.0, 90.0, 180.0};
    for (const auto& run : runs_) {
        if (run.geometry.visibility_km) t.visibility_km = *run.geometry.visibility_km;
        if (run.geometry.ground_elevation_km) t.ground_elevation_km = *run.geometry.ground_elevation_km;
    }
    fill_paths(t);
    fill_ground(t);
    if (!without_sun_ && azimuth_deg_.size() == 1)
        note(fmt::format("one relative azimuth ({:.4g} deg) stands for all", azimuth_deg_[0]));
    if (!without_sun_ && sun_deg_.size() == 1)
        note(fmt::format("one sun zenith ({:.4g} deg): use the table for that sun only", sun_deg_[0]));
    if (view_deg_.size() == 1) {
        extend_view(t);
        note(fmt::format("one view zenith ({:.4g} deg); others by Beer's law", view_deg_[0]));
    }
    check(t);
    return {std::move(t), std::move(notes_)};
}

AssembledAtmosphere assemble_atmosphere(std::vector<AtmosphereRun> runs, bool without_sun) {
    return Assembly(std::move(runs), without_sun).make();
}

}  // namespace pyroscene::radiometry
