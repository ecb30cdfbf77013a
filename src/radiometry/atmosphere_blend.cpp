#include "radiometry/atmosphere_blend.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kSmall = 1e-12;  // below this a quantity is taken as zero and keeps out of logarithms and quotients

using Array = std::vector<double>;

double geometric(double a, double b, double f) noexcept {
    if (a < kSmall && b < kSmall) return 0.0;
    return std::exp((1.0 - f) * std::log(std::max(a, kSmall)) + f * std::log(std::max(b, kSmall)));
}

/// value * numerator / denominator; without a usable denominator the value stays.
double scaled(double value, double numerator, double denominator) noexcept {
    return denominator > 1e-9 ? value * (numerator / denominator) : value;
}

/// Optical depth of the direct beam, floored like the transmittances.
double beam_depth(double irradiance, double toa) noexcept {
    return toa > 0.0 ? -std::log(std::clamp(irradiance / toa, kSmall, 1.0)) : 0.0;
}

void blend_grounds(PathTerms& t, const PathTerms& high, double f) {
    const auto linear = [f](Array& a, const Array& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += f * (b[i] - a[i]);
    };
    const auto logarithmic = [f](Array& a, const Array& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] = geometric(a[i], b[i], f);
    };
    for (std::size_t i = 0; i < t.ln_tau.size(); ++i) t.ln_tau[i] = -geometric(-t.ln_tau[i], -high.ln_tau[i], f);
    linear(t.thermal_source, high.thermal_source);
    for (std::size_t r = 0; r < 3; ++r) linear(t.solar_source[r], high.solar_source[r]);
    linear(t.correlation, high.correlation);
    linear(t.diffuse_transmittance, high.diffuse_transmittance);
    linear(t.spherical_albedo, high.spherical_albedo);
    logarithmic(t.direct, high.direct);
    logarithmic(t.diffuse, high.diffuse);
    logarithmic(t.thermal_sky, high.thermal_sky);
}

/// Between two visibilities: f in 1/V (extinction is proportional to it), g in ln V (scattered light).
void blend_visibilities(PathTerms& t, const PathTerms& high, double f, double g) {
    for (std::size_t i = 0; i < t.ln_tau.size(); ++i) {
        const double ln_tau = t.ln_tau[i] + f * (high.ln_tau[i] - t.ln_tau[i]);
        const double low_part = -std::expm1(t.ln_tau[i]), high_part = -std::expm1(high.ln_tau[i]),
                     part = -std::expm1(ln_tau);
        for (std::size_t r = 0; r < 3; ++r) {
            const double L = geometric(t.solar_source[r][i] * low_part, high.solar_source[r][i] * high_part, g);
            t.solar_source[r][i] = part > 0.0 ? L / part : t.solar_source[r][i];
        }
        t.ln_tau[i] = ln_tau;
        t.thermal_source[i] += f * (high.thermal_source[i] - t.thermal_source[i]);
        t.correlation[i] += f * (high.correlation[i] - t.correlation[i]);
        t.diffuse_transmittance[i] += f * (high.diffuse_transmittance[i] - t.diffuse_transmittance[i]);
        t.spherical_albedo[i] += f * (high.spherical_albedo[i] - t.spherical_albedo[i]);
        t.direct[i] = geometric(t.direct[i], high.direct[i], f);
        t.diffuse[i] = geometric(t.diffuse[i], high.diffuse[i], g);
        t.thermal_sky[i] = geometric(t.thermal_sky[i], high.thermal_sky[i], g);
    }
}

/// Terms that a change of visibility and a change of elevation both scale by the ratio of two other paths.
void scale_common(PathTerms& t, const PathTerms& changed, const PathTerms& base, std::size_t i) {
    t.thermal_source[i] = scaled(t.thermal_source[i], changed.thermal_source[i], base.thermal_source[i]);
    t.correlation[i] = std::max(1.0, scaled(t.correlation[i], changed.correlation[i], base.correlation[i]));
    t.diffuse_transmittance[i] =
        scaled(t.diffuse_transmittance[i], changed.diffuse_transmittance[i], base.diffuse_transmittance[i]);
    t.spherical_albedo[i] =
        std::min(1.0, scaled(t.spherical_albedo[i], changed.spherical_albedo[i], base.spherical_albedo[i]));
    t.diffuse[i] = scaled(t.diffuse[i], changed.diffuse[i], base.diffuse[i]);
    t.thermal_sky[i] = scaled(t.thermal_sky[i], changed.thermal_sky[i], base.thermal_sky[i]);
}

/// Aerosol is a factor of the transmittance: ln tau changes by the same amount, path radiance by the same ratio.
void apply_visibility(PathTerms& t, const PathTerms& changed, const PathTerms& base, const Array& toa) {
    for (std::size_t i = 0; i < t.ln_tau.size(); ++i) {
        const double ln_tau = std::min(0.0, t.ln_tau[i] + changed.ln_tau[i] - base.ln_tau[i]);
        const double part = -std::expm1(ln_tau);
        for (std::size_t r = 0; r < 3; ++r) {
            const double L = scaled(-std::expm1(t.ln_tau[i]) * t.solar_source[r][i],
                                    -std::expm1(changed.ln_tau[i]) * changed.solar_source[r][i],
                                    -std::expm1(base.ln_tau[i]) * base.solar_source[r][i]);
            if (part > 0.0) t.solar_source[r][i] = L / part;
        }
        t.ln_tau[i] = ln_tau;
        t.direct[i] = std::min(scaled(t.direct[i], changed.direct[i], base.direct[i]), toa[i]);
        scale_common(t, changed, base, i);
    }
}

/// A higher ground takes away the same share of the optical depth as in the reference atmosphere. The quotient of two
/// sea-level transmittances, tau(0 to sensor) / tau(0 to ground), fails inside absorption bands (0/0 becomes 1) and is worse
/// in windows too (docs/physics-radiometry.md gives the comparison).
void apply_elevation(PathTerms& t, const PathTerms& changed, const PathTerms& base, const Array& toa) {
    for (std::size_t i = 0; i < t.ln_tau.size(); ++i) {
        if (base.ln_tau[i] < -kSmall) t.ln_tau[i] *= changed.ln_tau[i] / base.ln_tau[i];
        for (std::size_t r = 0; r < 3; ++r)
            t.solar_source[r][i] = scaled(t.solar_source[r][i], changed.solar_source[r][i], base.solar_source[r][i]);
        const double depth = beam_depth(base.direct[i], toa[i]);
        if (depth > kSmall)
            t.direct[i] =
                toa[i] * std::exp(-beam_depth(t.direct[i], toa[i]) * beam_depth(changed.direct[i], toa[i]) / depth);
        scale_common(t, changed, base, i);
    }
}

/// Neighbours of x among tables that ascend in a coordinate (clamped), with the fraction between them.
struct Neighbours {
    const AtmosphereTable *low, *high;
    double fraction;
};
template <class Coordinate>
Neighbours neighbours(const std::vector<const AtmosphereTable*>& tables, double x, const Coordinate& coordinate) {
    if (x <= coordinate(*tables.front())) return {tables.front(), tables.front(), 0.0};
    for (std::size_t i = 1; i < tables.size(); ++i) {
        const double a = coordinate(*tables[i - 1]), b = coordinate(*tables[i]);
        if (x < b) return {tables[i - 1], tables[i], (x - a) / (b - a)};
    }
    return {tables.back(), tables.back(), 0.0};
}

double ground_km(const AtmosphereTable& t) { return t.ground_elevation_km; }
double visibility_km(const AtmosphereTable& t) { return t.visibility_km; }

}  // namespace

TableRoles sort_tables(const AtmosphereSet& set) {
    if (set.tables.empty()) throw input_error("atmosphere", "no table was given");
    const auto& first = set.tables.front();
    TableRoles roles;
    std::vector<const AtmosphereTable*> own, reference;
    for (std::size_t i = 0; i < set.tables.size(); ++i) {
        const auto& t = set.tables[i];
        if (t.wavelength_um != first.wavelength_um)
            throw input_error("atmosphere", fmt::format("table {} has other wavelengths than table 1", i + 1));
        const bool seen = std::any_of(own.begin(), own.end(), [&](const auto* o) {
            return o->visibility_km == t.visibility_km && o->ground_elevation_km == t.ground_elevation_km;
        });
        const bool is_own = !seen && reference.empty();
        (is_own ? own : reference).push_back(&t);
        if (t.visibility_km == first.visibility_km) (is_own ? roles.grounds : roles.reference_grounds).push_back(&t);
    }
    const auto by = [](auto coordinate) {
        return [coordinate](const auto* a, const auto* b) { return coordinate(*a) < coordinate(*b); };
    };
    const auto& source = reference.empty() ? own : reference;  // of the dependence on visibility
    const double lowest_km = ground_km(**std::min_element(source.begin(), source.end(), by(ground_km)));
    for (const auto* t : source)
        if (t->ground_elevation_km == lowest_km) roles.visibilities.push_back(t);
    std::sort(roles.grounds.begin(), roles.grounds.end(), by(ground_km));
    std::sort(roles.reference_grounds.begin(), roles.reference_grounds.end(), by(ground_km));
    std::sort(roles.visibilities.begin(), roles.visibilities.end(), by(visibility_km));
    return roles;
}

TableLimits table_limits(const TableRoles& roles) {
    const auto& t = *roles.grounds.front();
    const auto& grounds = roles.reference_grounds.size() > 1 ? roles.reference_grounds : roles.grounds;
    return {t.view_zenith_deg.back() * kDegree_rad,
            t.solar_zenith_deg.back() * kDegree_rad,
            t.sensor_altitude_km.back() * 1000.0,
            {roles.visibilities.front()->visibility_km, roles.visibilities.back()->visibility_km},
            {grounds.front()->ground_elevation_km * 1000.0, grounds.back()->ground_elevation_km * 1000.0}};
}

BlendedAtmosphere::BlendedAtmosphere(const AtmosphereSet& set, const AtmosphereConditions& conditions, LambdaRange range) {
    const auto roles = sort_tables(set);
    const double altitude_km = std::max(conditions.sensor_altitude_agl_m, 0.0) / 1000.0;
    const double elevation_km = conditions.ground_elevation_m / 1000.0;
    const auto slice = [&](const AtmosphereTable& t) {
        return TableSlice(t, range, altitude_km, conditions.sun_zenith_rad);
    };
    const auto make_pair = [&](const Neighbours& n) {
        Pair pair{{slice(*n.low)}, n.fraction, n.fraction};
        if (n.high != n.low) pair.slices.push_back(slice(*n.high));
        return pair;
    };
    ground_ = make_pair(neighbours(roles.grounds, elevation_km, ground_km));
    if (roles.reference_grounds.size() > 1) {
        const auto n = neighbours(roles.reference_grounds, elevation_km, ground_km);
        if (n.low != n.high || n.low != roles.reference_grounds.front()) {
            reference_ground_ = make_pair(n);
            reference_base_.push_back(slice(*roles.reference_grounds.front()));
        }
    }
    if (roles.visibilities.size() > 1) {
        const auto n = neighbours(roles.visibilities, conditions.visibility_km, visibility_km);
        visibility_ = make_pair(n);
        if (n.low != n.high) {
            const double v = conditions.visibility_km, a = n.low->visibility_km, b = n.high->visibility_km;
            visibility_.fraction = (1.0 / v - 1.0 / a) / (1.0 / b - 1.0 / a);
            visibility_.log_fraction = std::log(v / a) / std::log(b / a);
        }
        const double base_km = roles.grounds.front()->visibility_km;
        for (const auto* t : roles.visibilities)
            if (t->visibility_km == base_km) visibility_base_.push_back(slice(*t));
        visibility_replaces_ = roles.reference_grounds.empty() && ground_.slices.size() == 1 &&
                               neighbours(roles.grounds, elevation_km, ground_km).low->ground_elevation_km ==
                                   roles.visibilities.front()->ground_elevation_km;
    }
    const auto& toa = set.tables.front().toa_solar_irradiance;
    for (std::size_t l = range.begin; l < range.end; ++l) toa_.push_back(static_cast<double>(toa[l]));
}

void BlendedAtmosphere::at(double view_secant, PathTerms& out) const {
    PathTerms other, base;
    const auto blend = [&](const Pair& pair, PathTerms& terms, bool by_visibility) {
        pair.slices.front().at(view_secant, terms);
        if (pair.slices.size() < 2) return;
        PathTerms high;
        pair.slices.back().at(view_secant, high);
        if (by_visibility)
            blend_visibilities(terms, high, pair.fraction, pair.log_fraction);
        else
            blend_grounds(terms, high, pair.fraction);
    };
    if (visibility_replaces_) return blend(visibility_, out, true);
    blend(ground_, out, false);
    if (!reference_base_.empty()) {
        blend(reference_ground_, other, false);
        reference_base_.front().at(view_secant, base);
        apply_elevation(out, other, base, toa_);
    }
    if (!visibility_base_.empty()) {
        blend(visibility_, other, true);
        visibility_base_.front().at(view_secant, base);
        apply_visibility(out, other, base, toa_);
    }
}

}  // namespace pyroscene::radiometry
