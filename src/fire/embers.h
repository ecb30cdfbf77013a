#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.h"

namespace pyroscene::fire {

struct FireState;
struct FireParameters;
struct FlameColumn;
struct FlameParameters;
struct FrameInputs;
struct TiltInputs;

/// How flame that has torn off moves and dies. Thesis 4.1, 4.6.1: bursts separate from the flame, propagate downwind,
/// "quickly cool down and turn black". The numbers are ours (docs/physics-fire.md).
struct EmberParameters {
    bool drift = true;             ///< false: detached flame stays above its cell at the temperature of the flame
    double cooling_time_s = 2.0;   ///< e-folding of the excess over the air temperature
    double lifetime_s = 6.0;       ///< older pockets are forgotten (3 cooling times: 5 % of the excess is left)
    double wind_height_m = 6.1;    ///< height above ground of the wind input (20 ft)
    double wind_exponent = 0.143;  ///< wind grows as height^exponent (1/7: neutral surface layer)
};

/// A pocket of flame gas that has left its flame: what it was when it left. Where it is later is a closed form of that, so
/// that stopping and resuming changes no bit.
struct Ember {
    double release_s = 0.0;                     ///< since ignition
    double x_m = 0.0, y_m = 0.0;                ///< map coordinates of its centre at release
    double ground_x_m = 0.0, ground_y_m = 0.0;  ///< of the flame it came from: heights count from the terrain there
    double bottom_m = 0.0;                      ///< height above that terrain at release
    double edge_m = 0.0;                        ///< of the cube that it fills; volume is kept
    double east_m_s = 0.0, north_m_s = 0.0;     ///< drift
    double rise_m_s = 0.0;                      ///< initial upward speed

    friend bool operator==(const Ember&, const Ember&) = default;
};

/// Place and temperature of an ember at a time.
struct EmberNow {
    double x_m = 0.0, y_m = 0.0, bottom_m = 0.0, temperature_K = 0.0;
};
/// Drifts with the wind, rises by its buoyancy and cools; age a = time - release:
///   T = T_air + (T_flame - T_air) exp(-a/tau),  w = w_b exp(-a/(2 tau))  (terminal speed ~ root of the excess)
///   x = x_0 + u a,  z = z_0 + 2 tau w_b (1 - exp(-a/(2 tau)))
EmberNow ember_at(const Ember& ember, double time_s, const EmberParameters& parameters, double flame_K,
                  double air_K) noexcept;

/// Wind speed factor from the height of the wind input to a height above ground: (z / z_ref)^exponent, z at least 1 m.
double wind_factor(double height_m, const EmberParameters& parameters) noexcept;

/// Adds what tears off in this frame (ember_height_m of every front cell, four pockets each) to the embers of `previous` that
/// live on. Place in the cell, and moment up to one cooling time before the frame: counter-based generator, keyed by seed,
/// frame time and cell.
void release_embers(FireState& state, const FireState* previous, const FrameInputs& frame, const FireParameters& parameters);

}  // namespace pyroscene::fire
