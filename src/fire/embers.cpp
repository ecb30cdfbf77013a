#include "fire/embers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "fire/flame_tilt.h"
#include "fire/sampling.h"
#include "fire/state.h"

namespace pyroscene::fire {
namespace {

/// Pockets per cell and frame; places tried for each, of which the one nearest to the arriving front is taken.
constexpr std::uint64_t kPockets = 4;
constexpr std::uint32_t kPlaces = 8;
constexpr double kLeastHeight_m = 1.0;

struct Place {
    double x_m, y_m;
};

/// A place in a cell: where the fire arrived, or will arrive, nearest to now; without arrival times anywhere.
Place place_in_cell(const FireState& state, int row, int col, const RandomKey& key, std::uint64_t pocket) {
    const MapGrid& grid = state.cell_class.grid;
    const bool has_arrival = state.predicted_arrival_time_s != nullptr;
    Place best{grid.x_centre_m(col), grid.y_centre_m(row)};
    double nearest_s = std::numeric_limits<double>::infinity();
    for (std::uint32_t n = 0; n < (has_arrival ? kPlaces : 1); ++n) {
        const double u = col + uniform01(key, pocket, 2 * n), v = row + uniform01(key, pocket, 2 * n + 1);
        const double arrival_s = has_arrival ? bilinear_or_own(*state.predicted_arrival_time_s, u, v) : state.time_s;
        const double from_now_s =
            std::isnan(arrival_s) ? std::numeric_limits<double>::max() : std::abs(arrival_s - state.time_s);
        if (from_now_s >= nearest_s) continue;
        nearest_s = from_now_s;
        best = {grid.west_m + u * grid.cell_m, grid.north_m - v * grid.cell_m};
    }
    return best;
}

/// The pockets that one front cell sheds.
void shed(FireState& state, int row, int col, const FrameInputs& frame, const FireParameters& p, const RandomKey& key) {
    const MapGrid& grid = state.cell_class.grid;
    const std::size_t cell = grid.index(row, col);
    const double volume_m3 = static_cast<double>(state.ember_height_m[cell]) * grid.cell_area_m2();
    const double tip_m = static_cast<double>(state.flame_height_m[cell]) / state.front_fraction[cell];
    const double lean_m = tip_m * std::tan(static_cast<double>(state.flame_tilt_rad[cell]));
    const double azimuth_rad = state.flame_azimuth_rad[cell];
    Ember ember;
    ember.edge_m = std::cbrt(volume_m3 / static_cast<double>(kPockets));
    ember.bottom_m = tip_m;
    const double factor = wind_factor(tip_m + 0.5 * ember.edge_m, p.embers);
    const float east_m_s = frame.wind_east_m_s.values[cell], north_m_s = frame.wind_north_m_s.values[cell];
    if (std::isfinite(east_m_s) && std::isfinite(north_m_s)) {
        ember.east_m_s = factor * east_m_s;
        ember.north_m_s = factor * north_m_s;
    }
    ember.rise_m_s =
        buoyant_velocity_m_s({.fireline_intensity_W_m = static_cast<double>(frame.heat_flux_W_m2.values[cell]) * grid.cell_m,
                              .air_density_kg_m3 = p.air_density_kg_m3,
                              .air_heat_capacity_J_kg_K = p.air_heat_capacity_J_kg_K,
                              .air_temperature_K = p.air_temperature_K});
    for (std::uint64_t n = 0; n < kPockets; ++n) {
        const std::uint64_t pocket = cell * kPockets + n;
        const Place place = place_in_cell(state, row, col, key, pocket);
        ember.ground_x_m = place.x_m;
        ember.ground_y_m = place.y_m;
        ember.x_m = place.x_m + lean_m * std::sin(azimuth_rad);
        ember.y_m = place.y_m + lean_m * std::cos(azimuth_rad);
        ember.release_s = state.time_s - p.embers.cooling_time_s * uniform01(key, pocket, 2 * kPlaces);
        state.embers.push_back(ember);
    }
}

}  // namespace

EmberNow ember_at(const Ember& ember, double time_s, const EmberParameters& parameters, double flame_K,
                  double air_K) noexcept {
    const double age_s = std::max(0.0, time_s - ember.release_s), tau_s = parameters.cooling_time_s;
    return {.x_m = ember.x_m + ember.east_m_s * age_s,
            .y_m = ember.y_m + ember.north_m_s * age_s,
            .bottom_m = ember.bottom_m + 2.0 * tau_s * ember.rise_m_s * -std::expm1(-0.5 * age_s / tau_s),
            .temperature_K = air_K + (flame_K - air_K) * std::exp(-age_s / tau_s)};
}

double wind_factor(double height_m, const EmberParameters& parameters) noexcept {
    return std::pow(std::max(height_m, kLeastHeight_m) / parameters.wind_height_m, parameters.wind_exponent);
}

void release_embers(FireState& state, const FireState* previous, const FrameInputs& frame,
                    const FireParameters& parameters) {
    if (!parameters.embers.drift) return;
    if (previous != nullptr) {
        for (const Ember& ember : previous->embers)
            if (state.time_s - ember.release_s < parameters.embers.lifetime_s) state.embers.push_back(ember);
    }
    const MapGrid& grid = state.cell_class.grid;
    const RandomKey key{parameters.seed, stream_id("embers"), random_frame(state.time_s)};
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t cell = grid.index(row, col);
            if (state.ember_height_m[cell] > 0.0F && state.front_fraction[cell] > 0.0F)
                shed(state, row, col, frame, parameters, key);
        }
    }
}

}  // namespace pyroscene::fire
