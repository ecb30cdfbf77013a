#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "radiometry/atmosphere_assembly.h"

/// The part of an Assembly that concerns the ground: spherical albedo, sun and sky on it, and the view terms that need them.
namespace pyroscene::radiometry {

using namespace assembly;
using Array = Assembly::Array;

namespace {

/// Emission of the sky outshines scattered sunlight beyond this wavelength; where one run holds both they are split here.
constexpr double kThermalFrom_um = 3.5;

/// S from irradiances E(A) = E(0) / (1 - A S) at two albedos.
double spherical_albedo_of(double E1, double A1, double E2, double A2) {
    const double r = E1 / E2;
    return std::clamp((1.0 - r) / (A2 - r * A1), 0.0, 1.0);
}

Array unknown(std::size_t n) { return Array(n, std::nan("")); }

bool any_known(const Array& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
}

double cosine(double angle_deg) { return std::cos(angle_deg * kDegree_rad); }

}  // namespace

bool Assembly::spherical_albedo_from_reflection(Ground& g) const {
    if (g.albedos.size() < 2 || without_sun_) return false;
    const double A1 = g.albedos.front(), A2 = g.albedos.back(), sun_deg = sun_deg_.front();
    const Array E1 = ground_irradiance(&AtmosphereRun::ground_reflected, A1, sun_deg);
    const Array E2 = ground_irradiance(&AtmosphereRun::ground_reflected, A2, sun_deg);
    for (std::size_t l = 0; l < lambda_.size(); ++l)
        if (E1[l] > 0.0 && E2[l] > 0.0) g.spherical_albedo[l] = spherical_albedo_of(E1[l], A1, E2[l], A2);
    return any_known(g.spherical_albedo);
}

bool Assembly::spherical_albedo_from_irradiance(Ground& g) const {
    if (g.albedos.empty() || without_sun_) return false;
    const auto lit = under_sun(sun_deg_.front());
    const auto bright = [&](const AtmosphereRun& r) { return !is_dark(r) && lit(r); };
    const auto dark = [&](const AtmosphereRun& r) { return is_dark(r) && lit(r); };
    if (!any(&AtmosphereRun::diffuse, bright) || !any(&AtmosphereRun::diffuse, dark)) return false;
    const Array with = collect(&AtmosphereRun::diffuse, bright, 0.0), without = collect(&AtmosphereRun::diffuse, dark, 0.0);
    const Array direct = collect(&AtmosphereRun::direct_normal, dark, 0.0);
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        const double beam = direct[l] * cosine(sun_deg_.front());
        if (beam + without[l] > 0.0)
            g.spherical_albedo[l] = spherical_albedo_of(beam + without[l], 0.0, beam + with[l], g.albedos.front());
    }
    return true;
}

void Assembly::find_spherical_albedo(Ground& g) {
    g.spherical_albedo = collect(&AtmosphereRun::spherical_albedo, looks_down, std::nan(""));
    const bool known =
        any_known(g.spherical_albedo) || spherical_albedo_from_reflection(g) || spherical_albedo_from_irradiance(g);
    if (!known) note("no spherical albedo (it needs runs with two albedos); light does not bounce between ground and sky");
    for (double& v : g.spherical_albedo) v = std::isnan(v) ? 0.0 : v;
}

/// pi times the radiance nearest to 53 deg, where an isotropic sky has its mean.
void Assembly::sky_from_looking_up(Array& sky) {
    constexpr double kMean_deg = 53.0;
    const AtmosphereRun* best = nullptr;
    const auto distance = [](const AtmosphereRun& r) { return std::abs(*r.geometry.view_zenith_deg - kMean_deg); };
    for (const auto& run : runs_)
        if (run.looks_up && !run.path_thermal.empty() && run.geometry.view_zenith_deg &&
            (best == nullptr || distance(run) < distance(*best)))
            best = &run;
    if (best == nullptr) return;
    for (std::size_t l = 0; l < lambda_.size(); ++l)
        if (std::isnan(sky[l]) && covers(*best, lambda_[l]))
            sky[l] = kPi * at_wavelength(*best, best->path_thermal, lambda_[l]);
    note(fmt::format("thermal sky: pi times the radiance at {:.4g} deg zenith", *best->geometry.view_zenith_deg));
}

/// Where no run tells the thermal sky by itself, the sky's part of what a sunlit run reflects.
void Assembly::split_sunlit_sky(Ground& g) {
    if (g.albedos.empty() || without_sun_) return;
    const double A = g.albedos.back();
    const Array whole = ground_irradiance(&AtmosphereRun::ground_reflected, A, sun_deg_.front());
    const Array beam = ground_irradiance(&AtmosphereRun::direct_reflected, A, sun_deg_.front());
    bool used = false;
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        if (!std::isnan(g.sky[l]) || lambda_[l] < kThermalFrom_um || std::isnan(whole[l]) || std::isnan(beam[l])) continue;
        g.sky[l] = std::max(0.0, whole[l] * (1.0 - A * g.spherical_albedo[l]) - beam[l]);
        g.sky_from_sunlit_run[l] = used = true;
    }
    if (used) note("no run without a sun: reflected sky light beyond 3.5 um is taken as thermal, below as sunlight");
}

void Assembly::find_sky(Ground& g) {
    const auto everything = [](const AtmosphereRun&) { return true; };
    g.sky = collect(&AtmosphereRun::thermal_sky, everything, std::nan(""));
    g.sky_from_sunlit_run.assign(lambda_.size(), false);
    for (const double A : g.albedos) {
        const Array E = ground_irradiance(&AtmosphereRun::ground_reflected, A, -1.0);
        for (std::size_t l = 0; l < lambda_.size(); ++l)
            if (std::isnan(g.sky[l])) g.sky[l] = E[l] * (1.0 - A * g.spherical_albedo[l]);
    }
    if (!any_known(g.sky)) sky_from_looking_up(g.sky);
    split_sunlit_sky(g);
    bool missing = false;
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        missing = missing || (std::isnan(g.sky[l]) && lambda_[l] > 2.5);
        if (std::isnan(g.sky[l])) g.sky[l] = 0.0;
    }
    if (missing) note("no thermal irradiance of the sky for some wavelengths beyond 2.5 um; it is 0 there");
}

void Assembly::find_sun(Ground& g, std::size_t s) {
    const std::size_t n = lambda_.size();
    Array direct(n, 0.0), diffuse(n, 0.0), seen = unknown(n);
    if (!without_sun_) {
        const auto lit = under_sun(sun_deg_[s]);
        const auto lit_dark = [&](const AtmosphereRun& r) { return lit(r) && is_dark(r); };
        const double cos_sun = cosine(sun_deg_[s]);
        for (const double A : g.albedos) {
            const Array E = ground_irradiance(&AtmosphereRun::direct_reflected, A, sun_deg_[s]);
            for (std::size_t l = 0; l < n; ++l)
                if (std::isnan(seen[l])) seen[l] = E[l] / cos_sun;
        }
        const bool named = any(&AtmosphereRun::direct_normal, lit);
        if (!named && !any_known(seen))
            throw input_error(
                "import-atmosphere",
                fmt::format("no run gives the sun at the ground for sun zenith {:.4g} deg: a run with ground "
                            "albedo above 0, or one of the direct irradiance; or import without the sun (--no-sun)",
                            sun_deg_[s]));
        direct = collect(&AtmosphereRun::direct_normal, lit, 0.0);
        for (std::size_t l = 0; l < n && !named; ++l) direct[l] = std::isnan(seen[l]) ? 0.0 : seen[l];
        if (any(&AtmosphereRun::diffuse, lit)) {
            diffuse = collect(&AtmosphereRun::diffuse, any(&AtmosphereRun::diffuse, lit_dark) ? Filter(lit_dark) : lit, 0.0);
        } else if (!g.albedos.empty()) {
            const double A = g.albedos.back();
            const Array E = ground_irradiance(&AtmosphereRun::ground_reflected, A, sun_deg_[s]);
            for (std::size_t l = 0; l < n; ++l) {
                const double beam = cos_sun * (std::isnan(seen[l]) ? direct[l] : seen[l]);
                const double rest = E[l] * (1.0 - A * g.spherical_albedo[l]) - beam - g.sky[l];
                diffuse[l] = std::isnan(rest) ? 0.0 : std::max(0.0, rest);
            }
        } else if (s == 0) {
            note("no diffuse sky light (it needs a run with ground albedo above 0)");
        }
    }
    g.direct.push_back(std::move(direct));
    g.diffuse.push_back(std::move(diffuse));
    g.direct_seen.push_back(std::move(seen));
}

/// t_d from what bright ground adds to the path radiance: L_ps(A) - L_ps(0) = A E(A) t_d / pi.
Array Assembly::upward_transmittance(const Ground& g, const Filter& node) const {
    Array td = collect(&AtmosphereRun::diffuse_transmittance, node, std::nan(""));
    const auto lit = under_sun(sun_deg_.front());
    const auto dark = [&](const AtmosphereRun& r) { return node(r) && lit(r) && r.geometry.albedo && is_dark(r); };
    for (const double A : g.albedos) {
        const auto bright = [&](const AtmosphereRun& r) { return node(r) && lit(r) && same(r.geometry.albedo, A); };
        if (without_sun_ || !any(&AtmosphereRun::path_solar, bright) || !any(&AtmosphereRun::path_solar, dark)) continue;
        const Array with = collect(&AtmosphereRun::path_solar, bright, 0.0),
                    without = collect(&AtmosphereRun::path_solar, dark, 0.0);
        for (std::size_t l = 0; l < lambda_.size(); ++l) {
            const double E0 = g.direct.front()[l] * cosine(sun_deg_.front()) + g.diffuse.front()[l];
            const double E = E0 / (1.0 - A * g.spherical_albedo[l]);
            if (std::isnan(td[l]) && E > 1e-3) td[l] = std::clamp(kPi * (with[l] - without[l]) / (A * E), 0.0, 1.0);
        }
    }
    return td;
}

/// C: the path sun - ground - sensor transmits more than the product of its two parts.
Array Assembly::correlation(const Ground& g, const Filter& node, std::size_t s) const {
    const auto lit = [&](const AtmosphereRun& r) { return node(r) && same(r.geometry.sun_zenith_deg, sun_deg_[s]); };
    Array C = collect(&AtmosphereRun::correlation, lit, std::nan(""));
    const Array two_way = collect(&AtmosphereRun::two_way_irradiance, lit, std::nan(""));
    const Array tau = collect(&AtmosphereRun::transmittance, node, 0.0);
    for (std::size_t l = 0; l < lambda_.size(); ++l) {
        const bool bent_path = two_way[l] > 0.0 && tau[l] > kSmallTau;
        const double seen = bent_path ? two_way[l] / tau[l] : g.direct_seen[s][l], beam = g.direct[s][l];
        if (std::isnan(C[l]) && seen > 0.0 && beam > 1e-6) C[l] = std::clamp(seen / beam, 1.0, 100.0);
    }
    return C;
}

void Assembly::fill_view_terms(AtmosphereTable& t, const Ground& g) {
    bool have_td = false, have_C = false;
    for (const double altitude_km : altitude_km_)
        for (const double view_deg : view_deg_) {
            const auto node = at_node(altitude_km, view_deg);
            Array td = upward_transmittance(g, node);
            have_td = have_td || any_known(td);
            for (double& v : td) v = std::isnan(v) ? 0.0 : v;
            append(t.diffuse_upward_transmittance, td);
            for (std::size_t s = 0; s < sun_deg_.size(); ++s) {
                Array C = correlation(g, node, s);
                for (double& v : C) {
                    have_C = have_C || v > 1.001;
                    v = std::isnan(v) ? 1.0 : v;
                }
                append(t.solar_path_correlation, C);
            }
        }
    if (without_sun_) return;
    if (!have_td)
        note("no upward diffuse transmittance (it needs albedo 0 and another one at the same node); adjacency is 0");
    if (!have_C) note("the correlation of sun and view path is inside the direct irradiance, or unknown (1)");
}

void Assembly::fill_ground(AtmosphereTable& t) {
    Ground g;
    g.albedos = distinct(runs_, looks_down, &RunGeometry::albedo);
    std::erase_if(g.albedos, [](double A) { return !(A > 1e-6); });
    find_spherical_albedo(g);
    find_sky(g);
    for (std::size_t s = 0; s < sun_deg_.size(); ++s) find_sun(g, s);
    append(t.spherical_albedo, g.spherical_albedo);
    append(t.thermal_sky_irradiance, g.sky);
    for (std::size_t s = 0; s < sun_deg_.size(); ++s) {
        append(t.direct_solar_irradiance, g.direct[s]);
        append(t.diffuse_solar_irradiance, g.diffuse[s]);
    }
    // The sun at the top is at least what arrives at the ground, should no run tell it.
    Array top = collect(
        &AtmosphereRun::toa_irradiance, [](const AtmosphereRun&) { return true; }, 0.0);
    for (const auto& direct : g.direct)
        for (std::size_t l = 0; l < top.size(); ++l) top[l] = std::max(top[l], direct[l]);
    append(t.toa_solar_irradiance, top);
    fill_view_terms(t, g);
}

}  // namespace pyroscene::radiometry
