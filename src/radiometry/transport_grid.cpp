#include "radiometry/transport_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "base/constants.h"
#include "radiometry/nonnegative_fit.h"
#include "radiometry/planck.h"
#include "radiometry/response.h"

namespace pyroscene::radiometry {
namespace {

using Array = std::vector<double>;

constexpr std::array<double, 11> kBlackbodies_K{300.0, 350.0,  420.0,  500.0,  600.0, 700.0,
                                                850.0, 1100.0, 1300.0, 1600.0, 2000.0};
constexpr std::array<double, 3> kFlames_K{900.0, 1150.0, 1500.0};
constexpr std::array<double, 4> kLengths_m{0.2, 1.0, 4.0, 15.0};
constexpr double kStep_per_cm = 2.5, kNarrow_per_cm = 500.0, kTolerance = 7e-4, kPlanckWeight = 15.0,
                 kDark_W_m2_sr_um = 1e-3;
constexpr double kLeastSignal_W_m2_sr_um = 1e-6;
constexpr std::size_t kMostNodes = 48;

/// Wavelengths that resolve the band, and the share of the band that each stands for.
struct Resolved {
    Array lambda_um, weight;
};

bool absorbs(const SpectralStructure& s, double lambda_um) noexcept {
    if (alkali_absorption_per_m(s.flame->alkali, lambda_um, 1200.0, s.gas) > 0.0) return true;
    return std::any_of(kGasSpecies.begin(), kGasSpecies.end(), [&](GasSpecies species) {
        return gas_absorption(s.flame->gas, species, lambda_um, 1200.0, s.gas).per_m > 0.0;
    });
}

Resolved resolve(const Spectrum& response, const SpectralStructure& s) {
    const double lower = response.lambda_um.front(), upper = response.lambda_um.back();
    Array x{lower, upper};
    const double step_per_cm = 1e4 / lower - 1e4 / upper < kNarrow_per_cm ? 1.0 : kStep_per_cm;
    for (double wavenumber = 1e4 / upper + step_per_cm; wavenumber < 1e4 / lower; wavenumber += step_per_cm)
        x.push_back(1e4 / wavenumber);
    const auto add_lines = [&](const std::vector<AlkaliLine>& lines, double ppm) {
        const double first = lines.front().wavelength_um, last = lines.back().wavelength_um;
        const double from = std::max(lower, std::min(first, last) - kAlkaliReach_um);
        const double to = std::min(upper, std::max(first, last) + kAlkaliReach_um);
        if (!(ppm > 0.0 && from < to)) return;
        const auto points = doublet_wavelengths_um(lines, from, to);
        x.insert(x.end(), points.begin(), points.end());
    };
    add_lines(s.flame->alkali.potassium, s.gas.potassium_ppm);
    add_lines(s.flame->alkali.sodium, s.gas.sodium_ppm);
    std::sort(x.begin(), x.end());
    x.erase(std::unique(x.begin(), x.end()), x.end());
    Resolved r;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double from = i > 0 ? 0.5 * (x[i - 1] + x[i]) : x[i], to = i + 1 < x.size() ? 0.5 * (x[i] + x[i + 1]) : x[i];
        const double share = response.at(x[i], false) * (to - from);
        if (!(share > 0.0)) continue;
        r.lambda_um.push_back(x[i]);
        r.weight.push_back(share);
    }
    double sum = 0.0;
    for (const double w : r.weight) sum += w;
    for (double& w : r.weight) w /= sum;
    return r;
}

/// The training set as least squares: one row per scene, divided by its band mean; targets are 1.
class Training {
public:
    explicit Training(const Resolved& r) : resolved_(&r) {}

    void add(const Array& spectrum, double weight) {
        double mean = 0.0;
        for (std::size_t i = 0; i < spectrum.size(); ++i) mean += resolved_->weight[i] * spectrum[i];
        if (!(mean > kLeastSignal_W_m2_sr_um) && weight < kPlanckWeight) return;
        if (!(mean > 1e-12)) return;
        rows_.push_back(spectrum);
        for (double& v : rows_.back()) v *= weight / mean;
        target_.push_back(weight);
    }
    [[nodiscard]] NonnegativeFit fit() const {
        FitColumns columns{rows_.size(), {}};
        for (std::size_t i = 0; i < resolved_->lambda_um.size(); ++i)
            for (const auto& row : rows_) columns.values.push_back(row[i]);
        return nonnegative_fit(columns, target_, kTolerance, kMostNodes);
    }

private:
    const Resolved* resolved_;
    std::vector<Array> rows_;
    Array target_;
};

Array at_wavelengths(const Array& x, const Array& y, const Array& lambda_um) {
    const Spectrum s{Quantity::Dimensionless, x, y};
    Array out;
    for (const double l : lambda_um) out.push_back(s.at(l));
    return out;
}

Array blackbody(const Resolved& r, double T_K) {
    Array out;
    for (const double l : r.lambda_um) out.push_back(planck_radiance(l, T_K));
    return out;
}

Array times(Array a, const Array& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
    return a;
}

/// Scenes at the ground: flames of one temperature before black and hot ground, layered and lean flames, bare ground.
std::vector<Array> flame_scenes(const Resolved& r, const SpectralStructure& s) {
    std::vector<Array> scenes;
    for (const double T_K : kFlames_K) {
        for (const double length_m : kLengths_m) {
            Array dark, hot;
            for (const double l : r.lambda_um) {
                FlamePath path(*s.flame, l);
                path.add(length_m, T_K, s.gas);
                dark.push_back(path.emitted_radiance());
                hot.push_back(path.emitted_radiance() + std::exp(-path.depth()) * 0.95 * planck_radiance(l, 1073.0));
            }
            scenes.push_back(std::move(dark));
            if (T_K == kFlames_K[1]) scenes.push_back(std::move(hot));
        }
    }
    // Layers, cold or hot side first, and flame of less soot, in which gas and lines stand out.
    const auto add = [&](const std::vector<std::pair<double, double>>& layers, const FlameGas& gas) {
        Array spectrum;
        for (const double l : r.lambda_um) {
            FlamePath path(*s.flame, l);
            for (const auto& [length_m, T_K] : layers) path.add(length_m, T_K, gas);
            spectrum.push_back(path.emitted_radiance());
        }
        scenes.push_back(std::move(spectrum));
    };
    FlameGas lean = s.gas;
    lean.soot_volume_fraction *= 0.2;
    add({{0.7, 800.0}, {0.7, 1350.0}}, s.gas);
    add({{0.2, 1350.0}, {2.0, 800.0}}, s.gas);
    for (const double length_m : kLengths_m) add({{length_m, 1100.0}}, lean);
    for (const double T_K : {300.0, 600.0, 1000.0}) scenes.push_back(blackbody(r, T_K));
    return scenes;
}

/// The beam that comes back from a white mirror: its factors vary together, so it is their product that is linear between samples.
Array reflected_beam(const AtmosphericTerms& air) {
    Array beam = air.direct_normal;
    for (std::size_t i = 0; i < beam.size(); ++i) beam[i] *= air.solar_correlation[i] * air.transmittance[i];
    return beam;
}

void add_air(Training& training, const Resolved& r, const std::vector<Array>& scenes, const AtmosphericTerms& air) {
    const auto on_grid = [&](const Array& values) { return at_wavelengths(air.wavelength_um, values, r.lambda_um); };
    const Array tau = on_grid(air.transmittance);
    for (const auto& scene : scenes) training.add(times(scene, tau), 1.0);
    // Ambient ground of emissivity 0.9 by night and by day.
    const Array thermal = on_grid(air.path_thermal), solar = on_grid(air.path_solar), sky = on_grid(air.thermal_sky),
                beam = on_grid(reflected_beam(air)), diffuse = on_grid(air.diffuse);
    Array night, day, reflected;
    for (std::size_t i = 0; i < tau.size(); ++i) {
        night.push_back(thermal[i] + tau[i] * (0.9 * planck_radiance(r.lambda_um[i], 300.0) + 0.1 / kPi * sky[i]));
        reflected.push_back(0.1 / kPi * (0.7 * beam[i] + tau[i] * diffuse[i]));
        day.push_back(night[i] + reflected[i] + solar[i]);
    }
    training.add(night, 1.0);
    training.add(day, 1.0);
    training.add(reflected, 1.0);
    training.add(solar, 1.0);
}

void append_nodes(SpectralGrid& grid, const Spectrum& response, const SpectralStructure& s) {
    const Resolved r = resolve(response, s);
    Training training(r);
    training.add(Array(r.lambda_um.size(), 1.0), kPlanckWeight);
    for (const double T_K : kBlackbodies_K) {
        const bool dark = band_mean_radiance(T_K, response) < kDark_W_m2_sr_um;
        training.add(blackbody(r, T_K), dark ? 1.0 : kPlanckWeight);
    }
    const auto scenes = flame_scenes(r, s);
    for (const auto& scene : scenes) training.add(scene, 1.0);
    for (const auto& air : s.air) add_air(training, r, scenes, air);
    const auto fit = training.fit();

    std::vector<std::pair<double, double>> nodes;
    double sum = 0.0;
    for (std::size_t j = 0; j < fit.column.size(); ++j) {
        nodes.emplace_back(r.lambda_um[fit.column[j]], fit.weight[j]);
        sum += fit.weight[j];
    }
    std::sort(nodes.begin(), nodes.end());
    const int begin = grid.size();
    for (const auto& [lambda_um, weight] : nodes) {
        grid.lambda_um.push_back(lambda_um);
        grid.cell_lower_um.push_back(lambda_um);
        grid.cell_upper_um.push_back(lambda_um);
        grid.weight.push_back(weight / sum);
    }
    grid.bands.push_back({begin, grid.size()});
}

/// Largest distance of a quantity of the air from a straight line over the band.
double bend(const Array& wavelength_um, const Array& values, double lower_um, double upper_um) {
    const Spectrum polyline{Quantity::Dimensionless, wavelength_um, values};
    const double first = polyline.at(lower_um), last = polyline.at(upper_um);
    double most = 0.0;
    for (auto x = std::upper_bound(wavelength_um.begin(), wavelength_um.end(), lower_um);
         x != wavelength_um.end() && *x < upper_um; ++x) {
        const double f = (*x - lower_um) / (upper_um - lower_um);
        most = std::max(most,
                        std::abs(values[static_cast<std::size_t>(x - wavelength_um.begin())] - std::lerp(first, last, f)));
    }
    return most;
}

/// Absorption bands of the air, or lines of the sun's own spectrum, within the band.
bool has_structure(const AtmosphericTerms& air, double lower_um, double upper_um) {
    constexpr double kTransmittance = 2e-3, kSun = 0.05;
    const Spectrum sun{Quantity::Irradiance, air.wavelength_um, air.direct_normal};
    return bend(air.wavelength_um, air.transmittance, lower_um, upper_um) > kTransmittance ||
           bend(air.wavelength_um, air.direct_normal, lower_um, upper_um) > kSun * mean_over(sun, lower_um, upper_um);
}

/// Gas or lines anywhere in the band, of the flame or of the air.
bool has_structure(const Spectrum& response, const SpectralStructure& s) {
    if (s.flame == nullptr) return false;
    const double lower = response.lambda_um.front(), upper = response.lambda_um.back();
    if (std::any_of(s.air.begin(), s.air.end(), [&](const auto& air) { return has_structure(air, lower, upper); }))
        return true;
    constexpr int kProbes = 200;
    for (int i = 0; i <= kProbes; ++i)
        if (absorbs(s, lower + (upper - lower) * i / kProbes)) return true;
    return false;
}

}  // namespace

SpectralGrid make_spectral_grid(std::span<const Spectrum> responses, const SpectralStructure& structure) {
    SpectralGrid grid;
    for (std::size_t b = 0; b < responses.size(); ++b) {
        check_response(responses[b], fmt::format("response of band {} of {}", b + 1, responses.size()));
        if (has_structure(responses[b], structure)) {
            append_nodes(grid, responses[b], structure);
            continue;
        }
        const auto plain = make_spectral_grid(responses.subspan(b, 1));
        const int begin = grid.size();
        const auto append = [](Array& to, const Array& from) { to.insert(to.end(), from.begin(), from.end()); };
        append(grid.lambda_um, plain.lambda_um);
        append(grid.weight, plain.weight);
        append(grid.cell_lower_um, plain.cell_lower_um);
        append(grid.cell_upper_um, plain.cell_upper_um);
        grid.bands.push_back({begin, grid.size()});
    }
    return grid;
}

}  // namespace pyroscene::radiometry
