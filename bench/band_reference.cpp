#include "band_reference.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "radiometry/planck.h"
#include "radiometry/transport_grid.h"

namespace pyroscene::bench {
namespace {

using radiometry::AtmosphericTerms;
using radiometry::FlameOptics;
using radiometry::FlamePath;

/// The air's terms at one wavelength. Between the samples of the tables each is linear.
struct Air {
    double tau = 1.0, thermal = 0.0, solar = 0.0, diffuse = 0.0, sky = 0.0;
    double beam = 0.0;  ///< of the sun down, and up to the sensor: E_dir C tau
};

struct Scene {
    std::vector<std::pair<double, double>> layers;  ///< length_m, T_K
    bool moist = false;
    double ground_K = 320.0, reflectance = 0.15;
    int view = 0;  ///< of kViews_deg; -1 = no air
};

constexpr double kViews_deg[] = {0.0, 30.0, 45.0};  // nodes of the tables: what lies between is another error
constexpr double kRelativeAzimuth_rad = kPi / 2.0, kSunZenith_deg = 40.0;

const std::vector<Scene>& scenes() {
    static const std::vector<Scene> list{{{{2.3, 1080.0}}, false, 700.0, 0.15, 1},
                                         {{{0.5, 820.0}, {0.6, 1270.0}}, false, 320.0, 0.15, 1},
                                         {{{0.4, 1350.0}}, true, 900.0, 0.1, 0},
                                         {{{9.0, 1000.0}}, true, 320.0, 0.2, 1},
                                         {{}, false, 310.0, 0.3, 1},
                                         {{}, false, 650.0, 0.05, 2},
                                         {{{1.5, 1200.0}}, false, 320.0, 0.1, -1}};
    return list;
}

FlameGas gas_of(const Scene& scene) {
    FlameGas gas;
    if (!scene.moist) return gas;
    gas.x_H2O = 0.2;
    gas.x_CO2 = 0.06;
    gas.soot_volume_fraction = 5e-8;
    return gas;
}

double radiance(const FlameOptics& optics, const Scene& scene, double lambda_um, const Air& air) {
    FlamePath path(optics, lambda_um);
    const FlameGas gas = gas_of(scene);
    for (const auto& [length_m, T_K] : scene.layers) path.add(length_m, T_K, gas);
    const double facet = 0.7;  // cosine of the sun on the slope
    const double ground = (1.0 - scene.reflectance) * radiometry::planck_radiance(lambda_um, scene.ground_K) +
                          scene.reflectance / kPi * (air.diffuse + air.sky);
    const double through_flame = std::exp(-path.depth());
    return air.thermal + air.solar + air.tau * (path.emitted_radiance() + through_flame * ground) +
           through_flame * scene.reflectance / kPi * facet * air.beam;
}

/// Looks up a table of terms at ascending wavelengths.
class AirAt {
public:
    explicit AirAt(const AtmosphericTerms& terms) : terms_(&terms) {}
    Air operator()(double lambda_um) {
        const auto& x = terms_->wavelength_um;
        while (i_ + 2 < x.size() && x[i_ + 1] < lambda_um) ++i_;
        const double f = std::clamp((lambda_um - x[i_]) / (x[i_ + 1] - x[i_]), 0.0, 1.0);
        const auto at = [&](const std::vector<double>& y) { return std::lerp(y[i_], y[i_ + 1], f); };
        const auto beam = [&](std::size_t i) {
            return terms_->direct_normal[i] * terms_->solar_correlation[i] * terms_->transmittance[i];
        };
        return {at(terms_->transmittance), at(terms_->path_thermal), at(terms_->path_solar),
                at(terms_->diffuse),       at(terms_->thermal_sky),  std::lerp(beam(i_), beam(i_ + 1), f)};
    }

private:
    const AtmosphericTerms* terms_;
    std::size_t i_ = 0;
};

double reference(const Spectrum& response, const std::vector<double>& x, const FlameOptics& optics, const Scene& scene,
                 const AtmosphericTerms* terms) {
    std::optional<AirAt> air;
    if (terms != nullptr) air.emplace(*terms);
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        const double middle = 0.5 * (x[i - 1] + x[i]), share = response.at(middle, false) * (x[i] - x[i - 1]);
        if (!(share > 0.0)) continue;
        sum += share * radiance(optics, scene, middle, air ? (*air)(middle) : Air{});
        area += share;
    }
    return sum / area;
}

double on_grid(const radiometry::SpectralGrid& grid, std::size_t band, const FlameOptics& optics, const Scene& scene,
               const radiometry::ViewAtmosphere& air, const radiometry::ViewAtmosphere::View& view) {
    double sum = 0.0;
    const auto range = grid.bands[band];
    for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
        Air at;
        if (scene.view >= 0)
            at = {view.transmittance[i],
                  view.path_thermal[i],
                  view.path_solar[i],
                  air.diffuse_irradiance_W_m2_um[i],
                  air.thermal_irradiance_W_m2_um[i],
                  static_cast<double>(air.direct_normal_irradiance_W_m2_um[i]) *
                      static_cast<double>(view.solar_correlation[i]) * static_cast<double>(view.transmittance[i])};
        sum += grid.weight[i] * radiance(optics, scene, grid.lambda_um[i], at);
    }
    return sum;
}

}  // namespace

std::vector<double> fine_wavelengths_um(const Spectrum& response, const FlameOptics& optics) {
    const double lower = response.lambda_um.front(), upper = response.lambda_um.back();
    std::vector<double> x = response.lambda_um;
    for (double wavenumber = 1e4 / upper; wavenumber < 1e4 / lower; wavenumber += 1.0) x.push_back(1e4 / wavenumber);
    const auto& lines = optics.alkali.potassium;
    constexpr double kReach_um = 0.04;
    if (lower < lines.front().wavelength_um + kReach_um && upper > lines.back().wavelength_um - kReach_um) {
        const auto fine = radiometry::doublet_wavelengths_um(lines, lower, upper);
        x.insert(x.end(), fine.begin(), fine.end());
    }
    std::sort(x.begin(), x.end());
    x.erase(std::unique(x.begin(), x.end()), x.end());
    return x;
}

std::vector<BandError> quadrature_errors(const sensors::Sensor& sensor, const FlameOptics& optics,
                                         const radiometry::AtmosphereSet& set,
                                         const std::function<bool(const sensors::Band&)>& wanted) {
    std::vector<BandError> errors;
    std::vector<Spectrum> responses;
    for (const auto& band : sensor.bands)
        if (!wanted || wanted(band)) {
            errors.push_back({&band});
            responses.push_back(band.response);
        }
    if (responses.empty()) return errors;

    radiometry::AtmosphereConditions conditions;
    conditions.sensor_altitude_agl_m = sensor.airborne ? 3000.0 : 1e5;
    conditions.sun_zenith_rad = kSunZenith_deg * kDegree_rad;
    const auto terms = [&](double view_deg) {
        return radiometry::evaluate(set, {conditions, view_deg * kDegree_rad, kRelativeAzimuth_rad});
    };
    const auto grid = radiometry::make_spectral_grid(responses, {&optics, {}, {terms(0.0), terms(25.0), terms(50.0)}});
    const std::vector<double> black(static_cast<std::size_t>(grid.size()), 0.0);
    const auto air = radiometry::make_view_atmosphere(set, conditions, grid, black);

    std::vector<AtmosphericTerms> exact;
    std::vector<radiometry::ViewAtmosphere::View> views(std::size(kViews_deg));
    for (std::size_t v = 0; v < views.size(); ++v) {
        exact.push_back(terms(kViews_deg[v]));
        views[v].resize(grid.size());
        air.at(kViews_deg[v] * kDegree_rad, kRelativeAzimuth_rad, 0.0, views[v]);
    }
    for (std::size_t b = 0; b < errors.size(); ++b) {
        errors[b].nodes = grid.bands[b].end - grid.bands[b].begin;
        const auto x = fine_wavelengths_um(responses[b], optics);
        for (std::size_t s = 0; s < scenes().size(); ++s) {
            const Scene& scene = scenes()[s];
            const auto v = static_cast<std::size_t>(std::max(scene.view, 0));
            const double expected = reference(responses[b], x, optics, scene, scene.view < 0 ? nullptr : &exact[v]);
            constexpr double kDark_W_m2_sr_um = 1e-6;
            if (!(expected > kDark_W_m2_sr_um)) continue;
            const double error = on_grid(grid, b, optics, scene, air, views[v]) / expected - 1.0;
            if (std::abs(error) <= std::abs(errors[b].worst)) continue;
            errors[b].worst = error;
            errors[b].scene = static_cast<int>(s);
        }
    }
    return errors;
}

}  // namespace pyroscene::bench
