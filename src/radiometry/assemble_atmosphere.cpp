#include "radiometry/assemble_atmosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/planck.h"

namespace pyroscene::radiometry {
namespace {

using Array = std::vector<double>;
using Member = Array AtmosphereRun::*;
using Filter = std::function<bool(const AtmosphereRun&)>;

constexpr double kSmallTau = 1e-4;  // below it reflected light says nothing about the ground

bool same(const std::optional<double>& a, double b) { return a && std::abs(*a - b) <= 1e-4 * std::max(1.0, std::abs(b)); }

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
    return Spectrum{Quantity::Dimensionless, run.wavelength_um, values}.at(lambda_um);
}

bool covers(const AtmosphereRun& run, double lambda_um) {
    return lambda_um >= run.wavelength_um.front() * (1.0 - 1e-9) && lambda_um <= run.wavelength_um.back() * (1.0 + 1e-9);
}

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

/// Everything the runs say, and the nodes on which the table needs it.
class Assembly {
public:
    Assembly(std::vector<AtmosphereRun> runs, bool without_sun) : runs_(std::move(runs)), without_sun_(without_sun) {
        normalise();
        make_axes();
    }
    AssembledAtmosphere make();

private:
    void normalise();
    void make_axes();
    void fill_paths(AtmosphereTable& t);
    void fill_ground(AtmosphereTable& t);
    void extend_view(AtmosphereTable& t) const;
    void note(std::string text) { notes_.push_back(std::move(text)); }

    [[nodiscard]] static bool is_path(const AtmosphereRun& r) { return !r.looks_up && !r.transmittance.empty(); }
    /// Values of a term on the table's wavelengths, from the first wanted run that covers each; `missing` elsewhere.
    [[nodiscard]] Array collect(Member term, const Filter& wanted, double missing) const;
    [[nodiscard]] bool any(Member term, const Filter& wanted) const;
    [[nodiscard]] Filter at_node(double altitude_km, double view_deg) const;
    [[nodiscard]] Filter under_sun(double sun_deg) const;
    [[nodiscard]] Array two_temperatures(const Filter& node, Array* path_thermal) const;
    [[nodiscard]] Array ground_irradiance(Member reflected, double albedo, double sun_deg) const;

    std::vector<AtmosphereRun> runs_;
    bool without_sun_;
    std::vector<std::string> notes_;
    Array lambda_, altitude_km_, view_deg_, sun_deg_, azimuth_deg_;
};

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

void Assembly::make_axes() {
    lambda_ = joined_wavelengths(runs_);
    const auto down = [](const AtmosphereRun& r) { return !r.looks_up; };
    for (const auto& run : runs_) {
        if (!is_path(run)) continue;
        const auto need = [&](const std::optional<double>& value, const char* name) {
            if (!value) throw input_error(run.source, fmt::format("the {} of this run is unknown; give it", name));
        };
        need(run.geometry.sensor_altitude_km, "sensor altitude");
        need(run.geometry.view_zenith_deg, "view zenith angle");
    }
    altitude_km_ = distinct(runs_, is_path, &RunGeometry::sensor_altitude_km);
    view_deg_ = distinct(runs_, is_path, &RunGeometry::view_zenith_deg);
    if (altitude_km_.empty() || view_deg_.empty())
        throw input_error(runs_.front().source,
                          "no run looks from a sensor down to the ground; the path below the sensor is what a table needs");
    if (without_sun_) {
        sun_deg_ = {0.0};
        azimuth_deg_ = {0.0};
        return;
    }
    sun_deg_ = distinct(runs_, down, &RunGeometry::sun_zenith_deg);
    azimuth_deg_ = distinct(
        runs_, [](const AtmosphereRun& r) { return !r.looks_up && !r.path_solar.empty(); },
        &RunGeometry::relative_azimuth_deg);
    if (sun_deg_.empty())
        throw input_error(runs_.front().source, "the sun zenith angle is unknown; give it, or import without the sun");
    if (azimuth_deg_.empty()) azimuth_deg_ = {0.0};
    if (azimuth_deg_.size() > 1 && azimuth_deg_ != Array{0.0, 90.0, 180.0})
        throw input_error("import-atmosphere",
                          fmt::format("relative azimuths {} deg; a table has 0, 90 and 180, or a single one",
                                      fmt::join(azimuth_deg_, ", ")));
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

void append(std::vector<float>& to, const Array& values) {
    for (const double v : values) to.push_back(static_cast<float>(v));
}

void Assembly::fill_paths(AtmosphereTable& t) {
    for (const double altitude_km : altitude_km_)
        for (const double view_deg : view_deg_) {
            const auto node = at_node(altitude_km, view_deg);
            const auto where = fmt::format("sensor {:.6g} km above ground, view zenith {:.4g} deg", altitude_km, view_deg);
            // Terms that depend on the albedo are taken where it is smallest: nothing of the surroundings is in them then.
            const Array albedos = distinct(runs_, node, &RunGeometry::albedo);
            const auto dark = [&](const AtmosphereRun& r) {
                return node(r) && (albedos.empty() || !r.geometry.albedo || same(r.geometry.albedo, albedos.front()));
            };
            Array thermal2;
            const Array tau2 = two_temperatures(node, &thermal2);
            Array tau = collect(&AtmosphereRun::transmittance, node, std::nan(""));
            Array thermal = collect(&AtmosphereRun::path_thermal, dark, std::nan(""));
            std::size_t dark_samples = 0;
            for (std::size_t l = 0; l < lambda_.size(); ++l) {
                if (std::isnan(thermal[l])) thermal[l] = thermal2[l];
                if (!std::isnan(thermal2[l])) tau[l] = tau2[l];
                if (std::isnan(tau[l]))
                    throw input_error(where, fmt::format("no run gives the transmittance at {:.6g} um", lambda_[l]));
                if (!std::isnan(thermal[l])) continue;
                thermal[l] = 0.0;
                dark_samples += lambda_[l] > 2.5 ? 1 : 0;
            }
            if (dark_samples > 0) note(fmt::format("{}: no path thermal radiance beyond 2.5 um; it is 0", where));
            append(t.transmittance, tau);
            append(t.path_thermal_radiance, thermal);
            const Array E = collect(&AtmosphereRun::ground_reflected, node, 0.0);
            for (const double sun_deg : sun_deg_)
                for (std::size_t k = 0; k < 3; ++k) {
                    const double azimuth_deg = azimuth_deg_.size() == 3 ? azimuth_deg_[k] : azimuth_deg_[0];
                    const auto lit = [&](const AtmosphereRun& r) {
                        return dark(r) && same(r.geometry.sun_zenith_deg, sun_deg) &&
                               (azimuth_deg_.size() == 1 || sun_deg < 1e-6 || view_deg < 1e-6 ||
                                same(r.geometry.relative_azimuth_deg, azimuth_deg));
                    };
                    if (!without_sun_ && !any(&AtmosphereRun::path_solar, lit))
                        throw input_error(where,
                                          fmt::format("no run gives the path solar radiance for sun zenith {:.4g} deg, "
                                                      "relative azimuth {:.4g} deg",
                                                      sun_deg, azimuth_deg));
                    append(t.path_solar_radiance,
                           without_sun_ ? Array(lambda_.size(), 0.0) : collect(&AtmosphereRun::path_solar, lit, 0.0));
                }
        }
}

/// pi L / (A tau) at the first node that has it: what the ground receives when its albedo is A.
Array Assembly::ground_irradiance(Member reflected, double albedo, double sun_deg) const {
    Array out(lambda_.size(), std::nan(""));
    for (const auto& run : runs_) {
        if (!is_path(run) || (run.*reflected).empty() || !same(run.geometry.albedo, albedo)) continue;
        if (sun_deg >= 0.0 ? !same(run.geometry.sun_zenith_deg, sun_deg) : run.includes_sun) continue;
        for (std::size_t l = 0; l < lambda_.size(); ++l) {
            if (!std::isnan(out[l]) || !covers(run, lambda_[l])) continue;
            const double tau = at_wavelength(run, run.transmittance, lambda_[l]);
            out[l] = tau > kSmallTau ? kPi * at_wavelength(run, run.*reflected, lambda_[l]) / (albedo * tau) : 0.0;
        }
    }
    return out;
}

void Assembly::fill_ground(AtmosphereTable& t) {
    const std::size_t n = lambda_.size();
    const auto down = [](const AtmosphereRun& r) { return !r.looks_up; };
    const auto everything = [](const AtmosphereRun&) { return true; };
    Array albedos = distinct(runs_, down, &RunGeometry::albedo);
    std::erase_if(albedos, [](double A) { return !(A > 1e-6); });
    const auto is_dark = [](const AtmosphereRun& r) { return !r.geometry.albedo || *r.geometry.albedo <= 1e-6; };

    // Spherical albedo and sky: from runs that name them, from irradiances at two albedos, or none.
    Array S = collect(&AtmosphereRun::spherical_albedo, down, std::nan(""));
    const double sun0 = sun_deg_.front();
    const auto ratio_S = [](double E1, double A1, double E2, double A2) {
        const double r = E1 / E2;
        return std::clamp((1.0 - r) / (A2 - r * A1), 0.0, 1.0);
    };
    bool have_S = any(&AtmosphereRun::spherical_albedo, down);
    if (!have_S && albedos.size() > 1 && !without_sun_) {
        const Array E1 = ground_irradiance(&AtmosphereRun::ground_reflected, albedos.front(), sun0);
        const Array E2 = ground_irradiance(&AtmosphereRun::ground_reflected, albedos.back(), sun0);
        for (std::size_t l = 0; l < n; ++l)
            if (E1[l] > 0.0 && E2[l] > 0.0) S[l] = ratio_S(E1[l], albedos.front(), E2[l], albedos.back());
        have_S = std::any_of(S.begin(), S.end(), [](double v) { return !std::isnan(v); });
    }
    if (!have_S && !without_sun_) {  // irradiances of the ground that name themselves, over dark and bright ground
        const auto bright = [&](const AtmosphereRun& r) { return down(r) && !is_dark(r) && under_sun(sun0)(r); };
        const auto dark = [&](const AtmosphereRun& r) { return down(r) && is_dark(r) && under_sun(sun0)(r); };
        if (any(&AtmosphereRun::diffuse, bright) && any(&AtmosphereRun::diffuse, dark) && !albedos.empty()) {
            const double cosine = std::cos(sun0 * kDegree_rad);
            const Array b = collect(&AtmosphereRun::diffuse, bright, 0.0), d = collect(&AtmosphereRun::diffuse, dark, 0.0);
            const Array direct = collect(&AtmosphereRun::direct_normal, dark, 0.0);
            for (std::size_t l = 0; l < n; ++l) {
                const double E0 = direct[l] * cosine + d[l], EA = direct[l] * cosine + b[l];
                if (E0 > 0.0 && EA > 0.0) S[l] = ratio_S(E0, 0.0, EA, albedos.front());
            }
            have_S = true;
        }
    }
    for (double& v : S) v = std::isnan(v) ? 0.0 : v;
    if (!have_S) note("no spherical albedo (it needs runs with two albedos); light does not bounce between ground and sky");
    append(t.spherical_albedo, S);

    Array sky = collect(&AtmosphereRun::thermal_sky, everything, std::nan(""));
    if (!any(&AtmosphereRun::thermal_sky, everything)) {
        for (const double A : albedos) {
            const Array E = ground_irradiance(&AtmosphereRun::ground_reflected, A, -1.0);
            for (std::size_t l = 0; l < n; ++l)
                if (std::isnan(sky[l]) && !std::isnan(E[l])) sky[l] = E[l] * (1.0 - A * S[l]);
        }
        // Looking up from the ground: pi times the radiance nearest to the diffuse angle, 53 deg.
        const AtmosphereRun* best = nullptr;
        for (const auto& run : runs_)
            if (run.looks_up && !run.path_thermal.empty() && run.geometry.view_zenith_deg &&
                (best == nullptr ||
                 std::abs(*run.geometry.view_zenith_deg - 53.0) < std::abs(*best->geometry.view_zenith_deg - 53.0)))
                best = &run;
        if (best != nullptr) {
            bool used = false;
            for (std::size_t l = 0; l < n; ++l)
                if (std::isnan(sky[l]) && covers(*best, lambda_[l])) {
                    sky[l] = kPi * at_wavelength(*best, best->path_thermal, lambda_[l]);
                    used = true;
                }
            if (used)
                note(
                    fmt::format("thermal sky: pi times the radiance at {:.4g} deg zenith", *best->geometry.view_zenith_deg));
        }
    }
    // One run with sun and reflecting ground holds both skies; the sun's part ends where the thermal one takes over.
    constexpr double kThermalFrom_um = 3.5;
    bool split = false, missing_sky = false;
    const double A0 = albedos.empty() ? 0.0 : albedos.back();
    const Array mixed = albedos.empty() || without_sun_ ? Array(n, std::nan(""))
                                                        : ground_irradiance(&AtmosphereRun::ground_reflected, A0, sun0);
    const Array mixed_direct = albedos.empty() || without_sun_
                                   ? Array(n, std::nan(""))
                                   : ground_irradiance(&AtmosphereRun::direct_reflected, A0, sun0);
    std::vector<bool> sky_from_mixed(n, false);
    for (std::size_t l = 0; l < n; ++l) {
        if (!std::isnan(sky[l])) continue;
        if (lambda_[l] >= kThermalFrom_um && !std::isnan(mixed[l]) && !std::isnan(mixed_direct[l])) {
            sky[l] = std::max(0.0, mixed[l] * (1.0 - A0 * S[l]) - mixed_direct[l]);
            sky_from_mixed[l] = split = true;
        } else {
            missing_sky = missing_sky || lambda_[l] > 2.5;
            sky[l] = 0.0;
        }
    }
    if (split) note("no run without a sun: reflected sky light beyond 3.5 um is taken as thermal, below as sunlight");
    if (missing_sky) note("no thermal irradiance of the sky beyond 2.5 um; it is 0 there");
    append(t.thermal_sky_irradiance, sky);

    Array toa = collect(&AtmosphereRun::toa_irradiance, everything, 0.0);
    std::vector<Array> direct_of(sun_deg_.size()), product_of(sun_deg_.size()), E0_of(sun_deg_.size());
    for (std::size_t s = 0; s < sun_deg_.size(); ++s) {
        Array direct(n, 0.0), diffuse(n, 0.0), product(n, std::nan(""));
        if (!without_sun_) {
            const auto lit = under_sun(sun_deg_[s]);
            const auto lit_dark = [&](const AtmosphereRun& r) { return lit(r) && is_dark(r); };
            const double cosine = std::cos(sun_deg_[s] * kDegree_rad);
            const bool named = any(&AtmosphereRun::direct_normal, lit);
            direct = collect(&AtmosphereRun::direct_normal, lit, 0.0);
            for (const double A : albedos) {
                const Array E = ground_irradiance(&AtmosphereRun::direct_reflected, A, sun_deg_[s]);
                for (std::size_t l = 0; l < n; ++l)
                    if (std::isnan(product[l]) && !std::isnan(E[l])) product[l] = E[l] / cosine;
            }
            const bool reflected = std::any_of(product.begin(), product.end(), [](double v) { return !std::isnan(v); });
            if (!named && !reflected)
                throw input_error(
                    "import-atmosphere",
                    fmt::format("no run gives the sun at the ground for sun zenith {:.4g} deg: a run with ground "
                                "albedo above 0, or one of the direct irradiance; or import without the sun",
                                sun_deg_[s]));
            if (!named)
                for (std::size_t l = 0; l < n; ++l) direct[l] = std::isnan(product[l]) ? 0.0 : product[l];
            diffuse = collect(&AtmosphereRun::diffuse, any(&AtmosphereRun::diffuse, lit_dark) ? Filter(lit_dark) : lit, 0.0);
            if (!any(&AtmosphereRun::diffuse, lit)) {
                Array E = albedos.empty() ? Array(n, std::nan(""))
                                          : ground_irradiance(&AtmosphereRun::ground_reflected, A0, sun_deg_[s]);
                for (std::size_t l = 0; l < n; ++l) {
                    const double beam = std::isnan(product[l]) ? direct[l] * cosine : product[l] * cosine;
                    const double thermal = sky_from_mixed[l] || lambda_[l] >= kThermalFrom_um ? sky[l] : 0.0;
                    diffuse[l] = std::isnan(E[l]) ? 0.0 : std::max(0.0, E[l] * (1.0 - A0 * S[l]) - beam - thermal);
                }
                if (s == 0 && albedos.empty()) note("no diffuse sky light (it needs a run with ground albedo above 0)");
            }
        }
        append(t.direct_solar_irradiance, direct);
        append(t.diffuse_solar_irradiance, diffuse);
        direct_of[s] = direct;
        product_of[s] = product;
        E0_of[s] = diffuse;
    }
    for (std::size_t l = 0; l < n; ++l) {
        float strongest = 0.0F;
        for (const auto& direct : direct_of) strongest = std::max(strongest, static_cast<float>(direct[l]));
        t.toa_solar_irradiance.push_back(std::max(static_cast<float>(toa[l]), strongest));
    }

    // View terms that need the ground's irradiance: correlation and upward diffuse transmittance.
    bool have_td = any(&AtmosphereRun::diffuse_transmittance, down), have_C = any(&AtmosphereRun::correlation, down);
    for (const double altitude_km : altitude_km_)
        for (const double view_deg : view_deg_) {
            const auto node = at_node(altitude_km, view_deg);
            Array td = collect(&AtmosphereRun::diffuse_transmittance, node, std::nan(""));
            for (const double A : albedos) {
                const auto bright = [&](const AtmosphereRun& r) {
                    return node(r) && same(r.geometry.albedo, A) && same(r.geometry.sun_zenith_deg, sun0);
                };
                const auto dark = [&](const AtmosphereRun& r) {
                    return node(r) && is_dark(r) && r.geometry.albedo && same(r.geometry.sun_zenith_deg, sun0);
                };
                if (without_sun_ || !any(&AtmosphereRun::path_solar, bright) || !any(&AtmosphereRun::path_solar, dark))
                    continue;
                const Array with = collect(&AtmosphereRun::path_solar, bright, 0.0);
                const Array without = collect(&AtmosphereRun::path_solar, dark, 0.0);
                for (std::size_t l = 0; l < n; ++l) {
                    const double E = (direct_of[0][l] * std::cos(sun0 * kDegree_rad) + E0_of[0][l]) / (1.0 - A * S[l]);
                    if (std::isnan(td[l]) && E > 1e-3) {
                        td[l] = std::clamp(kPi * (with[l] - without[l]) / (A * E), 0.0, 1.0);
                        have_td = true;
                    }
                }
            }
            for (double& v : td) v = std::isnan(v) ? 0.0 : v;
            append(t.diffuse_upward_transmittance, td);
            const Array tau = collect(&AtmosphereRun::transmittance, node, 0.0);
            for (std::size_t s = 0; s < sun_deg_.size(); ++s) {
                const auto lit = [&](const AtmosphereRun& r) {
                    return node(r) && same(r.geometry.sun_zenith_deg, sun_deg_[s]);
                };
                Array C = collect(&AtmosphereRun::correlation, lit, std::nan(""));
                const Array two_way = collect(&AtmosphereRun::two_way_irradiance, lit, std::nan(""));
                for (std::size_t l = 0; l < n; ++l) {
                    const double beam = direct_of[s][l];
                    const double bent =
                        !std::isnan(two_way[l]) && tau[l] > kSmallTau ? two_way[l] / tau[l] : product_of[s][l];
                    if (std::isnan(C[l]) && !std::isnan(bent) && beam > 1e-6 && bent > 0.0) {
                        C[l] = std::clamp(bent / beam, 1.0, 100.0);
                        have_C = have_C || std::abs(C[l] - 1.0) > 1e-3;
                    }
                    if (std::isnan(C[l])) C[l] = 1.0;
                }
                append(t.solar_path_correlation, C);
            }
        }
    if (!have_td && !without_sun_)
        note("no upward diffuse transmittance (it needs albedo 0 and another one at the same node); adjacency is 0");
    if (!have_C && !without_sun_)
        note("the correlation of sun and view path is inside the direct irradiance, or unknown (1)");
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

}  // namespace

AssembledAtmosphere assemble_atmosphere(std::vector<AtmosphereRun> runs, bool without_sun) {
    return Assembly(std::move(runs), without_sun).make();
}

}  // namespace pyroscene::radiometry
