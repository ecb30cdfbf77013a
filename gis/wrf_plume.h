#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gis/wrf_sfire.h"

namespace pyroscene::gis {

/// Variables that wrf_plume needs.
std::vector<std::string> wrf_plume_variables();

/// Power that the tendencies of a record give the air [W], whose density is taken as 1.1 kg m-3: within some 20 % of the sum of GRNHFX.
double wrf_heating_W(const WrfSfire& wrf, const WrfMoment& moment);

/// Name of a raster in memory, on the atmosphere's grid, with the excess temperature [K] of the air over a fire at heights above the ground [m,
/// ascending], a band each, from the tendency RTHFRTEN of a record. WRF multiplies it by the dry air c1 (MU + MUB) + c2 [Pa] before it writes
/// it and calls the unit K/s all the same (fire_tendency in phys/module_fr_sfire_atm.F and module_fr_fire_atm.F); heating [K s-1] is without it. Steady balance of a layer: heating is carried off by the wind,
/// and what rises brings the excess of the layer below,
///
///     e_k (|u| / dx + |v| / dy + w+ / dz) = heating + w+_below e_(k-1) / dz,      w+ = max(w, 0)
///
/// with u, v, w at the layer's centre (the fields are staggered), dz from geopotential (PH + PHB) / 9.81, and no layer aired by less than
/// 0.5 m/s upwards. Air that flows in sideways is unheated and none mixes: excess on one cell of the atmosphere is a mean over it.
/// Heights between centres of layers are interpolated, those below the lowest take its value, those above the highest 0.
/// Input errors: a missing variable (named), a tendency in another unit than K/s.
std::filesystem::path wrf_plume(const WrfSfire& wrf, const WrfMoment& moment, std::span<const double> levels_m);

}  // namespace pyroscene::gis
