#include "pipeline/flame_power.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/constants.h"
#include "fire/flame_bodies.h"
#include "pipeline/optical_tables.h"
#include "pipeline/plume_scene.h"
#include "radiometry/flame_optics.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

double fourth_power(double x) { return x * x * x * x; }

double voxel_m3(const fire::FlameField& field) { return field.grid.dx_m * field.grid.dy_m * field.grid.dz_m; }

double soot_power_W(const scenario::FlameSettings& settings, const FireScene& scene) {
    double sum = 0.0;
    for (const auto& brick : scene.flame.bricks)
        for (std::size_t v = 0; v < brick.fill.size(); ++v) {
            if (!(brick.fill[v] > 0.0F)) continue;
            const double T_K = brick.temperature_K[v];
            const double k_per_m = settings.grey_absorption_per_m.value_or(
                radiometry::soot_planck_mean_per_m(scene.gas.soot_volume_fraction, T_K));
            sum += brick.fill[v] * k_per_m * fourth_power(T_K);
        }
    return 4.0 * kStefanBoltzmann_W_m2_K4 * sum * voxel_m3(scene.flame);
}

/// Emissivity that gas adds to soot over chord length and temperature: linear in ln(length) and in T between nodes.
class GasEmissivity {
public:
    GasEmissivity(const radiometry::FlameOptics& optics, const FlameGas& gas, double low_K, double high_K)
        : low_K_(low_K), step_K_((high_K - low_K) / (kTemperatures - 1)) {
        FlameGas soot = gas;
        soot.x_H2O = soot.x_CO2 = soot.x_CO = soot.x_CH4 = soot.potassium_ppm = soot.sodium_ppm = 0.0;
        for (int t = 0; t < kTemperatures; ++t)
            for (int i = 0; i < kLengths; ++i) {
                const double T_K = low_K_ + t * step_K_, length_m = kShortest_m * std::exp(i * kStep);
                values_[static_cast<std::size_t>(t * kLengths + i)] =
                    radiometry::total_emissivity(optics, gas, T_K, length_m) -
                    radiometry::total_emissivity(optics, soot, T_K, length_m);
            }
    }
    [[nodiscard]] double at(double length_m, double T_K) const {
        const double x = std::clamp(std::log(length_m / kShortest_m) / kStep, 0.0, kLengths - 1.0);
        const double y = step_K_ > 0.0 ? std::clamp((T_K - low_K_) / step_K_, 0.0, kTemperatures - 1.0) : 0.0;
        const int i = std::min(static_cast<int>(x), kLengths - 2), t = std::min(static_cast<int>(y), kTemperatures - 2);
        const auto row = [&](int r) {
            const double* v = values_.data() + static_cast<std::ptrdiff_t>(r) * kLengths + i;
            return v[0] + (x - i) * (v[1] - v[0]);
        };
        // Shorter than the first node, gas is thin: in proportion to the length.
        return std::min(1.0, length_m / kShortest_m) * (row(t) + (y - t) * (row(t + 1) - row(t)));
    }

private:
    static constexpr int kTemperatures = 3, kLengths = 16;
    static constexpr double kShortest_m = 0.01, kStep = 0.6;
    double low_K_, step_K_;
    std::array<double, static_cast<std::size_t>(kTemperatures) * kLengths> values_{};
};

double gas_power_W(const scenario::FlameSettings& settings, const FireScene& scene) {
    if (!settings.hot_gas || settings.grey_absorption_per_m || scene.flame.empty()) return 0.0;
    const auto [low_K, high_K] = scene.flame.temperature_range_K();
    const GasEmissivity gas(*shipped_flame_optics(), scene.gas, low_K, high_K);
    double sum = 0.0;
    for (const auto& body : fire::flame_bodies(scene.flame))
        sum += body.area_m2 * fourth_power(body.T_K) * gas.at(body.chord_m(), body.T_K);
    return kStefanBoltzmann_W_m2_K4 * sum;
}

/// Planck mean of the absorption of smoke of fill 1 over the table's wavelengths [1/m].
double smoke_planck_mean_per_m(const scenario::Scenario& scenario, double T_K) {
    constexpr int kWavelengths = 60;
    constexpr double kShortest_um = 0.5, kLongest_um = 14.9;
    radiometry::SpectralGrid grid;
    for (int i = 0; i < kWavelengths; ++i)
        grid.lambda_um.push_back(kShortest_um * std::pow(kLongest_um / kShortest_um, (i + 0.5) / kWavelengths));
    render::SceneOptics optics;
    set_plume_optics(scenario, grid, optics);
    double absorbed = 0.0, all = 0.0;
    for (std::size_t i = 0; i < grid.lambda_um.size(); ++i) {
        const double weight = grid.lambda_um[i] * radiometry::planck_radiance(grid.lambda_um[i], T_K);  // even in ln(lambda)
        const double albedo = optics.smoke_albedo.empty() ? 0.0 : static_cast<double>(optics.smoke_albedo[i]);
        absorbed += weight * static_cast<double>(optics.smoke_extinction_per_m[i]) * (1.0 - albedo);
        all += weight;
    }
    return absorbed / all;
}

double smoke_power_W(const scenario::Scenario& scenario, const FireScene& scene) {
    if (scene.plume.empty()) return 0.0;
    const double air4 = fourth_power(scenario.plume.parameters.air_temperature_K);
    double sum = 0.0, weight = 0.0, weighted_K = 0.0;
    for (const auto& brick : scene.plume.bricks)
        for (std::size_t v = 0; v < brick.fill.size(); ++v) {
            if (!(brick.fill[v] > 0.0F)) continue;
            const double T_K = brick.temperature_K[v];
            sum += brick.fill[v] * (fourth_power(T_K) - air4);
            weight += brick.fill[v];
            weighted_K += brick.fill[v] * T_K;
        }
    return 4.0 * kStefanBoltzmann_W_m2_K4 * smoke_planck_mean_per_m(scenario, weighted_K / weight) * sum *
           voxel_m3(scene.plume);
}

}  // namespace

FlamePower flame_power(const scenario::Scenario& scenario, const FireScene& scene) {
    FlamePower power{soot_power_W(scenario.flame, scene), gas_power_W(scenario.flame, scene),
                     smoke_power_W(scenario, scene)};
    double black_W = 0.0;
    for (const auto& body : fire::flame_bodies(scene.flame))
        black_W += kStefanBoltzmann_W_m2_K4 * body.area_m2 * fourth_power(body.T_K);
    if (black_W > 0.0) power.emissivity = std::min(1.0, power.flame_W() / black_W);
    return power;
}

}  // namespace pyroscene::pipeline
