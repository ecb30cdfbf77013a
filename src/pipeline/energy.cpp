#include "pipeline/energy.h"

#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"

namespace pyroscene::pipeline {
namespace {

double fourth_power(double x) { return x * x * x * x; }

double heat_release_W(const scenario::Scenario& scenario, const SceneInputs& in, double time_s) {
    const auto frame = load_frame(scenario, in, frame_at(in.frames, time_s, "energy"));
    double sum = 0.0;
    for (const float flux : frame.heat_flux_W_m2.values)
        if (flux > 0.0F) sum += flux;
    return sum * in.grid.cell_area_m2();
}

/// Planck-mean absorption of soot, 1340 fv T [1/m] near 1000-1100 K, or the grey value of the scenario.
double mean_absorption_per_m(const scenario::FlameSettings& flame, double temperature_K) {
    constexpr double kSootPlanckMean_per_m_K = 1340.0;
    return flame.grey_absorption_per_m.value_or(kSootPlanckMean_per_m_K * flame.gas.soot_volume_fraction * temperature_K);
}

}  // namespace

void record_energy(RunReport& report, const scenario::Scenario& scenario, const SceneInputs& in,
                   const fire::FireState& state, const FireScene& scene, const std::string& acquisition_id) {
    const auto& surface = scene.surface;
    double front_W = 0.0, scar_W = 0.0;
    const double ambient4 = fourth_power(surface.ambient_temperature_K), front4 = fourth_power(surface.front_temperature_K);
    for (std::size_t i = 0; i < surface.base_temperature_K.size(); ++i) {
        if (std::isnan(surface.base_temperature_K[i])) continue;
        const double f = surface.front_fraction[i];
        front_W += f * front4;
        if (surface.burned[i] != 0) scar_W += (1.0 - f) * (fourth_power(surface.base_temperature_K[i]) - ambient4);
    }
    front_W *= kStefanBoltzmann_W_m2_K4 * surface.grid.cell_area_m2();
    scar_W *= kStefanBoltzmann_W_m2_K4 * surface.grid.cell_area_m2();
    const double flame_K = scenario.flame.parameters.temperature_K;
    const double flame_W = 4.0 * mean_absorption_per_m(scenario.flame, flame_K) * kStefanBoltzmann_W_m2_K4 *
                           fourth_power(flame_K) * scene.flame.emissive_volume_m3();
    const double released_W = heat_release_W(scenario, in, state.time_s);

    const auto prefix = "energy/" + acquisition_id + "/";
    report.record(prefix + "heat_release_W", released_W);
    report.record(prefix + "front_W", front_W);
    report.record(prefix + "scar_W", scar_W);
    report.record(prefix + "flame_W", flame_W);
    if (!(released_W > 0.0)) return;
    const double fraction = (front_W + flame_W) / released_W;
    report.record(prefix + "radiant_fraction", fraction);
    constexpr double kImplausible = 0.35;
    if (fraction > kImplausible && scenario.physics == fire::Physics::Default)
        report.warn(
            fmt::format("acquisition '{}': front and flame radiate {:.0f} % of the heat released (published: 10-25 %); "
                        "see fire.flaming_heat_flux_W_m2 and flame.soot_volume_fraction",
                        acquisition_id, 100.0 * fraction));
}

}  // namespace pyroscene::pipeline
