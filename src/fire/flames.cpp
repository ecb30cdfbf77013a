#include "fire/flames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "fire/flame_height.h"
#include "fire/flame_tilt.h"

namespace pyroscene::fire {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Value of a raster that may not have been given.
double value_of(const std::optional<Raster<float>>& raster, std::size_t cell) noexcept {
    return raster ? static_cast<double>(raster->values[cell]) : kNaN;
}

/// What holds for all cells of one frame.
struct Rules {
    const FireParameters& parameters;
    const FlameHeightMethod& height;
    const FlameTiltMethod& tilt;
    FlameHeightInputs height_inputs;
    TiltInputs tilt_inputs;
};

template <class Method>
const Method& row(const Method* found, const std::string& name, const char* key) {
    if (found == nullptr) throw input_error(key, fmt::format("there is no method '{}'", name));
    return *found;
}

void require_positive(double value, const char* key) {
    if (!(value > 0.0 && std::isfinite(value))) throw input_error(key, fmt::format("is {}, must be above 0", value));
}

void check(const FlameRelations& f) {
    require_positive(f.heat_of_combustion_J_kg, "fire.heat_of_combustion_J_kg");
    require_positive(f.consumed_fraction, "fire.fireline_intensity.consumed_fraction");
    require_positive(f.height.air_fuel_ratio, "fire.flame_height.air_fuel_ratio");
    require_positive(f.height.constant_m, "fire.flame_height.constant_m");
    require_positive(f.tilt.fuel_vapour_density_kg_m3, "fire.air.fuel_vapour_density_kg_m3");
    if (f.residence_time_s) require_positive(*f.residence_time_s, "fire.front_depth.residence_time_s");
}

void check(const FrontInputs& front, const MapGrid& grid) {
    for (const auto* raster : {&front.spread_rate_m_s, &front.fuel_load_kg_m2, &front.fireline_intensity_W_m,
                               &front.flame_length_m, &front.residence_time_s, &front.slope_east, &front.slope_north})
        if (*raster && !((*raster)->grid == grid))
            throw input_error((*raster)->name, "its grid is not that of the heat flux");
}

Rules make_rules(const FireParameters& p) {
    const FlameRelations& f = p.flames;
    check(f);
    Rules rules{p,
                row(find_flame_height_method(f.height.method), f.height.method, "fire.flame_height.method"),
                row(find_flame_tilt_method(f.tilt.method), f.tilt.method, "fire.tilt.method"),
                {},
                {}};
    rules.height_inputs.alpha = p.height_alpha;
    rules.height_inputs.volumetric_heat_release_W_m3 = p.volumetric_heat_release_W_m3;
    rules.height_inputs.constant_m = f.height.constant_m;
    rules.height_inputs.plume_coefficient_m_kW = f.height.plume_coefficient_m_kW.value_or(
        plume_coefficient_m_kW(p.air_temperature_K, p.air_density_kg_m3, p.air_heat_capacity_J_kg_K,
                               f.heat_of_combustion_J_kg / f.height.air_fuel_ratio, p.physics));
    rules.tilt_inputs.air_density_kg_m3 = p.air_density_kg_m3;
    rules.tilt_inputs.air_heat_capacity_J_kg_K = p.air_heat_capacity_J_kg_K;
    rules.tilt_inputs.air_temperature_K = p.air_temperature_K;
    rules.tilt_inputs.fuel_vapour_density_kg_m3 = f.tilt.fuel_vapour_density_kg_m3;
    rules.tilt_inputs.heat_of_combustion_J_kg = f.heat_of_combustion_J_kg;
    rules.tilt_inputs.extent = rules.height.extent;
    rules.tilt_inputs.physics = p.physics;
    return rules;
}

/// Residence time x spread rate, or NaN where it is unknown or where the last flames have left the cell.
double depth_by_residence_m(const FrameInputs& frame, std::size_t cell, double arrival_s, const FireParameters& p) noexcept {
    if (frame.front == nullptr) return kNaN;
    const double spread_m_s = value_of(frame.front->spread_rate_m_s, cell);
    const double residence_s = p.flames.residence_time_s.value_or(value_of(frame.front->residence_time_s, cell));
    if (!(spread_m_s > 0.0 && residence_s > 0.0)) return kNaN;
    const double half_crossing_s = 0.5 * frame.heat_flux_W_m2.grid.cell_m / spread_m_s;
    const bool passed = frame.time_s - arrival_s > half_crossing_s + residence_s;
    return passed ? kNaN : residence_s * spread_m_s;
}

/// Load x heat of combustion x spread rate, or NaN where one of them is unknown.
double intensity_by_fuel_W_m(const FrameInputs& frame, std::size_t cell, const FlameRelations& f) noexcept {
    if (frame.front == nullptr) return kNaN;
    return value_of(frame.front->fuel_load_kg_m2, cell) * f.consumed_fraction * f.heat_of_combustion_J_kg *
           value_of(frame.front->spread_rate_m_s, cell);
}

bool wants_fuel(const FireParameters& p) noexcept {
    if (p.flames.intensity != IntensityRule::Auto) return p.flames.intensity == IntensityRule::Fuel;
    const auto* method = find_flame_height_method(p.flames.height.method);
    return method != nullptr && method->driver == FlameDriver::FirelineIntensity;
}

double fireline_intensity_W_m(const FrameInputs& frame, std::size_t cell, const FireParameters& p, FlameCounts& counts) {
    if (frame.front != nullptr)
        if (const double given_W_m = value_of(frame.front->fireline_intensity_W_m, cell); given_W_m >= 0.0) return given_W_m;
    if (wants_fuel(p)) {
        if (const double by_fuel_W_m = intensity_by_fuel_W_m(frame, cell, p.flames); by_fuel_W_m >= 0.0) return by_fuel_W_m;
        ++counts.intensity_by_heat_flux;
    }
    return frame.heat_flux_W_m2.values[cell] * frame.heat_flux_W_m2.grid.cell_m;
}

/// Slope angle of the ground along the wind, > 0 uphill.
double slope_along_wind_rad(const FrameInputs& frame, std::size_t cell, double east_m_s, double north_m_s) noexcept {
    const double speed_m_s = std::hypot(east_m_s, north_m_s);
    if (frame.front == nullptr || !frame.front->slope_east || !(speed_m_s > 0.0)) return 0.0;
    return std::atan(
        (frame.front->slope_east->values[cell] * east_m_s + frame.front->slope_north->values[cell] * north_m_s) / speed_m_s);
}

/// Tilt and azimuth of a front cell; upright where the wind is unknown.
void set_tilt(FireState& state, std::size_t i, const FrameInputs& frame, const Rules& rules, const CellFront& front,
              double size_m) {
    const double east_m_s = frame.wind_east_m_s.values[i], north_m_s = frame.wind_north_m_s.values[i];
    if (!std::isfinite(east_m_s) || !std::isfinite(north_m_s)) return;
    TiltInputs in = rules.tilt_inputs;
    in.wind_m_s = std::hypot(east_m_s, north_m_s);
    if (frame.front != nullptr && frame.front->midflame_wind) in.wind_m_s *= frame.front->midflame_wind->values[i];
    in.fireline_intensity_W_m = front.fireline_intensity_W_m;
    in.burning_rate_kg_m_s = front.fireline_intensity_W_m / in.heat_of_combustion_J_kg;
    in.heat_release_W = front.heat_release_W;
    in.flame_size_m = size_m;
    if (rules.parameters.flames.tilt.slope && rules.tilt.has_slope)
        in.slope_rad = slope_along_wind_rad(frame, i, east_m_s, north_m_s);
    state.flame_tilt_rad.set(i, static_cast<float>(std::min(rules.tilt.tilt_rad(in), rules.parameters.maximum_tilt_rad)));
    const auto azimuth_rad = static_cast<float>(downwind_azimuth_rad(east_m_s, north_m_s));
    // Rounding to float may lift a value just below the full turn onto it.
    state.flame_azimuth_rad.set(i, static_cast<double>(azimuth_rad) < 2.0 * kPi ? azimuth_rad : 0.0F);
}

/// Size by the method of the scenario, as the method gives it: a height or a length.
double flame_size_m(const Rules& rules, const FrameInputs& frame, std::size_t cell, const CellFront& front) noexcept {
    FlameHeightInputs in = rules.height_inputs;
    in.heat_flux_W_m2 = frame.heat_flux_W_m2.values[cell];
    in.heat_release_W = front.heat_release_W;
    in.diameter_m = front.diameter_m;
    in.fireline_intensity_W_m = front.fireline_intensity_W_m;
    in.front_depth_m = front.depth_m;
    if (frame.front != nullptr) in.given_length_m = value_of(frame.front->flame_length_m, cell);
    return rules.height.size_m(in);
}

void set_flame(FireState& state, std::size_t i, const FrameInputs& frame, const Rules& rules,
               const RunningStatistics& earlier) {
    const FireParameters& p = rules.parameters;
    const double arrival_s =
        state.predicted_arrival_time_s == nullptr ? state.arrival_time_s[i] : state.predicted_arrival_time_s->values[i];
    const CellFront front = front_of_cell(frame, i, arrival_s, p, state.flame_counts);
    state.front_fraction.set(i, static_cast<float>(front.fraction));

    const bool mean_over_cell = rules.height.driver == FlameDriver::HeatFlux;
    const double size_m = flame_size_m(rules, frame, i, front);
    // Tilts that depend on the flame's size see that of the flame that stands there, not its mean over the cell.
    set_tilt(state, i, frame, rules, front, mean_over_cell ? size_m / front.fraction : size_m);
    const double height_m = vertical_height_m(rules.height.extent, size_m, static_cast<double>(state.flame_tilt_rad[i]),
                                              p.flames.height.stand_height_m);
    if (!(height_m > 0.0)) {
        ++state.flame_counts.without_height;
        return;
    }
    const LimitedHeight limited =
        p.one_sigma_rule ? limit_height(height_m, earlier, p.physics) : LimitedHeight{height_m, 0.0};
    const double share = mean_over_cell ? 1.0 : front.fraction;
    state.flame_height_m.set(i, static_cast<float>(share * limited.flame_m));
    state.ember_height_m.set(i, static_cast<float>(share * limited.ember_m));
    state.height_statistics.add(height_m);
}

}  // namespace

CellFront front_of_cell(const FrameInputs& frame, std::size_t cell, double arrival_s, const FireParameters& parameters,
                        FlameCounts& counts) {
    const MapGrid& grid = frame.heat_flux_W_m2.grid;
    const double heat_flux_W_m2 = frame.heat_flux_W_m2.values[cell];
    CellFront front;
    front.fraction = std::min(1.0, heat_flux_W_m2 / parameters.flaming_heat_flux_W_m2);
    front.depth_m = front.fraction * grid.cell_m;
    if (parameters.flames.depth == DepthRule::ResidenceTime) {
        if (const double depth_m = depth_by_residence_m(frame, cell, arrival_s, parameters); depth_m > 0.0) {
            front.depth_m = depth_m;
            front.fraction = std::min(1.0, depth_m / grid.cell_m);
        } else {
            ++counts.depth_by_heat_flux;
        }
    }
    if (parameters.physics == Physics::Thesis) front.fraction = 1.0;
    front.fireline_intensity_W_m = fireline_intensity_W_m(frame, cell, parameters, counts);
    front.heat_release_W = heat_flux_W_m2 * grid.cell_area_m2();
    const double burning = parameters.flames.height.burning_area_fraction.value_or(front.fraction);
    front.diameter_m = std::sqrt(4.0 / kPi * burning * grid.cell_area_m2());
    return front;
}

void set_flames(FireState& state, const FrameInputs& frame, const FireParameters& parameters) {
    const Rules rules = make_rules(parameters);
    if (frame.front != nullptr) check(*frame.front, frame.heat_flux_W_m2.grid);
    const RunningStatistics earlier = state.height_statistics;
    for (std::size_t i = 0; i < state.cell_class.values.size(); ++i)
        if (state.cell_class.values[i] == static_cast<std::uint8_t>(CellClass::Front))
            set_flame(state, i, frame, rules, earlier);
}

}  // namespace pyroscene::fire
