#include "pipeline/energy.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/csv.h"
#include "gis/raster_input.h"
#include "gis/raster_output.h"
#include "pipeline/flame_power.h"
#include "pipeline/state_file.h"

namespace pyroscene::pipeline {
namespace {

double fourth_power(double x) { return x * x * x * x; }

double front_power_W(const FireScene& scene) {
    const auto& surface = scene.surface;
    double area = 0.0;
    for (std::size_t i = 0; i < surface.front_fraction.size(); ++i)
        if (!std::isnan(surface.base_temperature_K[i])) area += surface.front_fraction[i];
    return area * scene.burnt_emissivity.at(surface.front_temperature_K) * fourth_power(surface.front_temperature_K) *
           kStefanBoltzmann_W_m2_K4 * surface.grid.cell_area_m2();
}

/// Burnt ground, above the ambient.
double scar_power_W(const FireScene& scene) {
    const auto& surface = scene.surface;
    const double ambient4 = fourth_power(surface.ambient_temperature_K);
    double sum = 0.0;
    for (std::size_t i = 0; i < surface.base_temperature_K.size(); ++i) {
        const double T_K = surface.base_temperature_K[i], rest = 1.0 - static_cast<double>(surface.front_fraction[i]);
        if (surface.burned[i] != 0 && !std::isnan(T_K))
            sum += rest * scene.burnt_emissivity.at(T_K) * (fourth_power(T_K) - ambient4);
    }
    return sum * kStefanBoltzmann_W_m2_K4 * surface.grid.cell_area_m2();
}

/// Flame, and what of the front's light it does not take up again on the way: the flame stands over the front.
double radiated_W(double front_W, const FlamePower& flame) { return front_W * (1.0 - flame.emissivity) + flame.flame_W(); }

/// Fuel that burnt up to the last frame [kg].
double fuel_consumed_kg(const scenario::RasterSource& source, const inputs::SceneInputs& in, const fire::FireState& last) {
    const auto bands = gis::read_band_list(source.files.back()).size();
    const auto read = [&](const std::filesystem::path& file, int band) {
        return gis::read_band({file, band, gis::Resampling::Conserve, "fuel load", "kg m-2"}, in.grid);
    };
    const int first_band = source.bands.empty() ? 1 : source.bands.front();
    const int last_band = source.bands.empty() ? static_cast<int>(bands) : source.bands.back();
    const bool series = source.files.size() > 1 || last_band != first_band;
    const auto before = read(source.files.front(), first_band);
    const auto after = series ? read(source.files.back(), last_band) : Raster<float>(in.grid, "none", "kg m-2", 0.0F);
    double sum = 0.0;
    for (std::size_t i = 0; i < before.values.size(); ++i) {
        const auto c = static_cast<fire::CellClass>(last.cell_class.values[i]);
        if (!series && c != fire::CellClass::Front && c != fire::CellClass::Scar) continue;
        const double burnt_kg_m2 = static_cast<double>(before.values[i]) - after.values[i];
        if (burnt_kg_m2 > 0.0) sum += burnt_kg_m2;
    }
    return sum * in.grid.cell_area_m2();
}

}  // namespace

void record_energy(RunReport& report, const scenario::Scenario& scenario, const fire::FireState& state,
                   const FireScene& scene, const std::string& acquisition_id) {
    const double front_W = front_power_W(scene);
    const FlamePower flame = flame_power(scenario, scene);
    const double released_W = state.heat_release_W;

    const auto prefix = "energy/" + acquisition_id + "/";
    report.record(prefix + "heat_release_W", released_W);
    report.record(prefix + "front_W", front_W);
    report.record(prefix + "scar_W", scar_power_W(scene));
    report.record(prefix + "flame_W", flame.soot_W);
    report.record(prefix + "flame_gas_W", flame.gas_W);
    report.record(prefix + "smoke_W", flame.smoke_W);
    if (!(released_W > 0.0)) return;
    const double fraction = radiated_W(front_W, flame) / released_W;
    report.record(prefix + "radiant_fraction", fraction);
    constexpr double kImplausible = 0.35;
    if (fraction > kImplausible && scenario.physics == fire::Physics::Default)
        report.warn(
            fmt::format("acquisition '{}': front and flame radiate {:.0f} % of the heat released (published: 10-25 %); "
                        "see fire.flaming_heat_flux_W_m2 and flame.soot_volume_fraction",
                        acquisition_id, 100.0 * fraction));
}

void meet_radiant_fraction(RunReport& report, const scenario::Scenario& scenario, const fire::FireState& state,
                           FireScene& scene, const std::string& acquisition_id) {
    const auto& flame = scenario.flame;
    if (!flame.radiant_fraction) return;
    const double wanted_W = *flame.radiant_fraction * state.heat_release_W, front_W = front_power_W(scene);
    const auto give_up = [&](const char* why) {
        report.warn(fmt::format("acquisition '{}': flame.radiant_fraction {} cannot be met: {}", acquisition_id,
                                *flame.radiant_fraction, why));
    };
    if (scene.flame.empty()) return give_up("there is no flame to scale");
    const auto prefix = "energy/" + acquisition_id + "/";
    const auto trial = scene;  // as the scenario has it
    const auto scaled = [&](double factor) -> FireScene& {
        if (!flame.adjust_temperature) {
            scene.gas.soot_volume_fraction = factor;
            return scene;
        }
        for (std::size_t b = 0; b < scene.flame.bricks.size(); ++b)
            for (std::size_t v = 0; v < scene.flame.bricks[b].temperature_K.size(); ++v)
                scene.flame.bricks[b].temperature_K[v] = static_cast<float>(trial.flame.bricks[b].temperature_K[v] * factor);
        return scene;
    };
    constexpr double kLeastSoot = 1e-12, kMostSoot = 1e-4;
    const auto [low_K, high_K] = trial.flame.temperature_range_K();
    double low = flame.adjust_temperature ? 200.0 / low_K : kLeastSoot,
           high = flame.adjust_temperature ? 3500.0 / high_K : kMostSoot;
    const auto power_W = [&](double factor) { return radiated_W(front_W, flame_power(scenario, scaled(factor))); };
    if (front_W * (1.0 - flame_power(scenario, scaled(low)).emissivity) >= wanted_W) {
        scene = trial;
        return give_up("the front alone radiates more");
    }
    const bool too_much = power_W(low) > wanted_W, too_little = power_W(high) < wanted_W;
    for (int i = 0; i < 60 && !too_much && !too_little && high > low * (1.0 + 1e-7); ++i) {
        const double middle = std::sqrt(low * high);
        (power_W(middle) < wanted_W ? low : high) = middle;
    }
    const double held = too_much ? low : high;
    scaled(held);
    report.record(prefix + (flame.adjust_temperature ? "flame_temperature_factor" : "soot_volume_fraction"), held);
    if (too_much || too_little)
        report.warn(fmt::format("acquisition '{}': flame.radiant_fraction {} cannot be met: {} {:.2g} radiates too {}",
                                acquisition_id, *flame.radiant_fraction,
                                flame.adjust_temperature ? "temperature times" : "a soot volume fraction of", held,
                                too_much ? "much" : "little"));
}

void record_inputs_energy(RunReport& report, const scenario::Scenario& scenario, const inputs::SceneInputs& in,
                          const std::filesystem::path& output) {
    if (in.modelled) return;  // its own report says it, without the error of an integral over frames
    double released_J = 0.0, before_W = 0.0;
    for (std::size_t i = 0; i < in.frames.size(); ++i) {
        const auto path = state_path(output, in.frames[i].time_s);
        const auto metadata = gis::read_metadata(path);
        const auto found =
            metadata ? metadata->find("HEAT_RELEASE_W") : std::map<std::string, std::string>::const_iterator{};
        if (!metadata || found == metadata->end()) return;
        const double now_W = parse_number(found->second, path.string() + ": HEAT_RELEASE_W");
        if (i > 0) released_J += 0.5 * (before_W + now_W) * (in.frames[i].time_s - in.frames[i - 1].time_s);
        before_W = now_W;
    }
    report.record("energy/inputs/heat_released_J", released_J);
    if (!scenario.inputs.fuel_load) return;
    const auto last = read_state(state_path(output, in.frames.back().time_s), in.grid, in.arrival_time_s);
    const double fuel_J =
        fuel_consumed_kg(*scenario.inputs.fuel_load, in, last) * scenario.fire.flames.heat_of_combustion_J_kg;
    report.record("energy/inputs/fuel_heat_J", fuel_J);
    if (fuel_J > 0.0) report.record("energy/inputs/released_per_fuel_heat", released_J / fuel_J);
    if (released_J > 1.1 * fuel_J)
        report.warn(
            fmt::format("the heat flux releases {:.3g} J, but the fuel that burnt holds {:.3g} J ({:.1f} times less); "
                        "flame sizes and powers are overstated, or frames are too far apart for the integral",
                        released_J, fuel_J, released_J / std::max(fuel_J, 1.0)));
}

}  // namespace pyroscene::pipeline
