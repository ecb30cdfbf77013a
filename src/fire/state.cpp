#include "fire/state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "fire/flames.h"
#include "fire/scar.h"

namespace pyroscene::fire {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
/// Fluxes below this are rounding of the fire model, not fire [W m-2].
constexpr double kZeroFlux_W_m2 = 1e-3;

void require_grid(const MapGrid& grid, std::size_t cells, const MapGrid& expected, const char* subject) {
    if (!(grid == expected) || cells != expected.size())
        throw input_error(subject,
                          fmt::format("its grid of {} x {} cells of {} m is not the heat flux's of {} x {} cells of {} m",
                                      grid.cols, grid.rows, grid.cell_m, expected.cols, expected.rows, expected.cell_m));
}
template <class T>
void require_grid(const Raster<T>& raster, const MapGrid& expected, const char* subject) {
    require_grid(raster.grid, raster.values.size(), expected, subject);
}

void require_positive(double value, const char* subject) {
    if (!(value > 0.0 && std::isfinite(value))) throw input_error(subject, fmt::format("is {}, must be above 0", value));
}

void check(const FireParameters& p) {
    require_positive(p.flaming_heat_flux_W_m2, "fire.flaming_heat_flux_W_m2");
    require_positive(p.volumetric_heat_release_W_m3, "fire.volumetric_heat_release_W_m3");
    require_positive(p.scar.time_constant1_s, "scar.time_constant1_s");
    require_positive(p.scar.time_constant2_s, "scar.time_constant2_s");
    for (const auto& scar : p.scar_of_cover) {
        require_positive(scar.cooling.time_constant1_s, "scar.by_cover: time_constant1_s");
        require_positive(scar.cooling.time_constant2_s, "scar.by_cover: time_constant2_s");
    }
    require_positive(p.air_density_kg_m3, "fire.air_density_kg_m3");
    require_positive(p.air_heat_capacity_J_kg_K, "fire.air_heat_capacity_J_kg_K");
    require_positive(p.air_temperature_K, "fire.air_temperature_K");
    require_positive(p.embers.cooling_time_s, "fire.embers.cooling_time_s");
    require_positive(p.embers.wind_height_m, "fire.embers.wind_height_m");
    if (!(p.front_threshold_W_m2 >= 0.0))
        throw input_error("fire.front_threshold_W_m2", fmt::format("is {}, must not be negative", p.front_threshold_W_m2));
    if (!(p.maximum_tilt_rad >= 0.0 && p.maximum_tilt_rad <= 89.0 * kDegree_rad))
        throw input_error("fire.maximum_tilt",
                          fmt::format("is {} degrees, must lie within 0 and 89", p.maximum_tilt_rad / kDegree_rad));
}

void check(const FireState* previous, const FrameInputs& frame) {
    const MapGrid& grid = frame.heat_flux_W_m2.grid;
    require_grid(frame.heat_flux_W_m2, grid, "heat flux");
    require_grid(frame.wind_east_m_s, grid, "wind east");
    require_grid(frame.wind_north_m_s, grid, "wind north");
    if (frame.arrival_time_s) require_grid(*frame.arrival_time_s, grid, "arrival time");
    if (!frame.scar_class.values.empty()) require_grid(frame.scar_class, grid, "scar class");
    if (!std::isfinite(frame.time_s)) throw input_error("frame time", fmt::format("is {}, must be a number", frame.time_s));
    if (previous == nullptr) return;
    require_grid(previous->cell_class, grid, "previous state");
    for (const auto* raster : {&previous->arrival_time_s, &previous->last_burning_time_s})
        require_grid(raster->grid, raster->grid.size(), grid, "previous state");
    if (previous->predicted_arrival_time_s) require_grid(*previous->predicted_arrival_time_s, grid, "previous state");
    if (!(frame.time_s > previous->time_s))
        throw input_error("frame time", fmt::format("{} s does not come after the previous frame at {} s", frame.time_s,
                                                    previous->time_s));
}

FireState blank_state(const FireState* previous, const FrameInputs& frame, double ambient_K) {
    const MapGrid& grid = frame.heat_flux_W_m2.grid;
    FireState state;
    state.time_s = frame.time_s;
    state.cell_class = Raster<std::uint8_t>(grid, "class", "1");
    state.arrival_time_s = SparseRaster<float>(grid, "arrival_time", "s", kNaN);
    state.last_burning_time_s = SparseRaster<float>(grid, "last_burning_time", "s", kNaN);
    state.surface_temperature_K = SparseRaster<float>(grid, "surface_temperature", "K", static_cast<float>(ambient_K));
    state.front_fraction = SparseRaster<float>(grid, "front_fraction", "1");
    state.flame_height_m = SparseRaster<float>(grid, "flame_height", "m");
    state.ember_height_m = SparseRaster<float>(grid, "ember_height", "m");
    state.flame_tilt_rad = SparseRaster<float>(grid, "flame_tilt", "rad");
    state.flame_azimuth_rad = SparseRaster<float>(grid, "flame_azimuth", "rad");
    if (frame.arrival_time_s) {
        state.predicted_arrival_time_s = frame.arrival_time_s;
    } else if (previous != nullptr) {
        state.predicted_arrival_time_s = previous->predicted_arrival_time_s;
    }
    state.scar_class = frame.scar_class;
    if (previous != nullptr) state.height_statistics = previous->height_statistics;
    return state;
}

/// Later of two times of which one or both may be unknown (NaN).
float later(float a_s, float b_s) noexcept { return std::fmax(a_s, b_s); }

CellClass label(bool is_front, bool has_history, bool has_flux) noexcept {
    if (is_front) return CellClass::Front;
    if (has_history) return CellClass::Scar;
    return has_flux ? CellClass::Unburned : CellClass::NoData;
}

/// Class, arrival and scar clock of every cell.
void label_cells(FireState& state, const FireState* previous, const FrameInputs& frame, double threshold_W_m2) {
    const Raster<float>* const predicted = state.predicted_arrival_time_s.get();
    const auto now_s = static_cast<float>(frame.time_s);
    for (std::size_t i = 0; i < state.cell_class.values.size(); ++i) {
        const float flux = frame.heat_flux_W_m2.values[i];
        const bool has_flux = std::isfinite(flux);
        const bool is_front = has_flux && flux >= kZeroFlux_W_m2 && flux > threshold_W_m2;
        const float given_s = predicted != nullptr ? predicted->values[i] : kNaN;
        const float reached_s = static_cast<double>(given_s) <= frame.time_s ? given_s : kNaN;
        const float earlier_s = previous != nullptr ? previous->arrival_time_s[i] : kNaN;
        const float clock_s = later(previous != nullptr ? previous->last_burning_time_s[i] : kNaN, reached_s);
        const bool has_history = !std::isnan(reached_s) || !std::isnan(earlier_s);
        const bool burns_again =
            is_front && previous != nullptr && previous->cell_class.values[i] == static_cast<std::uint8_t>(CellClass::Scar);

        state.cell_class.values[i] = static_cast<std::uint8_t>(label(is_front, has_history, has_flux));
        state.last_burning_time_s.set(i, is_front ? now_s : clock_s);
        const float seen_s = (std::isnan(earlier_s) && is_front) || burns_again ? now_s : earlier_s;
        state.arrival_time_s.set(i, std::isnan(reached_s) ? seen_s : reached_s);
    }
}

void set_temperatures(FireState& state, const FireParameters& p) {
    for (std::size_t i = 0; i < state.cell_class.values.size(); ++i) {
        double T_K = p.ambient_temperature_K;
        switch (static_cast<CellClass>(state.cell_class.values[i])) {
            case CellClass::Front:
                T_K = p.front_temperature_K;
                break;
            case CellClass::Scar:
                T_K = scar_or_ambient_K(p, scar_of_cell(state, p, i), state.time_s - scar_clock_s(state, p.physics, i));
                break;
            case CellClass::Unburned:
                break;
            case CellClass::NoData:
                T_K = std::numeric_limits<double>::quiet_NaN();
                break;
        }
        state.surface_temperature_K.set(i, static_cast<float>(T_K));
    }
}

double heat_release_W(const FrameInputs& frame) {
    double sum = 0.0;
    for (const float flux : frame.heat_flux_W_m2.values)
        if (flux > 0.0F && std::isfinite(flux)) sum += flux;
    return sum * frame.heat_flux_W_m2.grid.cell_area_m2();
}

}  // namespace

float scar_clock_s(const FireState& state, Physics physics, std::size_t cell) noexcept {
    return physics == Physics::Thesis ? state.last_burning_time_s[cell] : state.arrival_time_s[cell];
}

FireState advance(const FireState* previous, const FrameInputs& frame, const FireParameters& parameters) {
    check(parameters);
    check(previous, frame);
    FireState state = blank_state(previous, frame, parameters.ambient_temperature_K);
    label_cells(state, previous, frame, parameters.front_threshold_W_m2);
    set_temperatures(state, parameters);
    set_flames(state, frame, parameters);
    release_embers(state, previous, frame, parameters);
    state.heat_release_W = heat_release_W(frame);
    return state;
}

}  // namespace pyroscene::fire
