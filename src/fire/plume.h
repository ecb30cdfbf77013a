#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/raster.h"
#include "base/vec3.h"
#include "fire/flame_field.h"
#include "fire/state.h"

namespace pyroscene::fire {

/// Horizontally uniform smoke or haze.
struct SmokeLayer {
    double bottom_m = 0.0, top_m = 0.0;  ///< heights of the scene frame (the terrain's datum)
    double concentration_g_m3 = 0.0, temperature_K = 300.0;
};

/// Hot gas and smoke above the flames. Sources of the numbers: docs/physics-fire.md.
struct PlumeParameters {
    std::array<double, 3> voxel_m{20.0, 20.0, 20.0};
    double top_m = 1500.0;          ///< nothing higher above the fire's ground
    double duration_s = 600.0;      ///< how long the fire has fed the plume
    double minimum_excess_K = 1.0;  ///< voxels with less excess temperature are air
    double entrainment = 0.6;       ///< growth of the radius with height (Briggs: bent-over plumes)
    double merge_m = 200.0;         ///< burning cells within this distance rise as one plume
    double wind_height_m = 6.1, wind_exponent = 0.143;
    double air_temperature_K = 300.0, air_density_kg_m3 = 1.18, air_heat_capacity_J_kg_K = 1005.0;
    double emission_factor_g_kg = 10.0;         ///< particles per fuel burnt
    double heat_of_combustion_J_kg = 17.433e6;  ///< heat back to fuel, for its smoke: what fire models count with
    std::optional<double> temperature_K;        ///< of every voxel, instead of the computed one (thesis: 795 K)
    bool uniform = false;                       ///< every voxel has fill 1 (absorption given per metre of plume)
    std::vector<SmokeLayer> layers;  ///< added to the voxels by exact overlap, as far as the plume's lattice reaches
};

/// Excess over the air of a bent-over plume and where it is; the parts of a trajectory.
struct PlumePoint {
    double time_s = 0.0, downwind_m = 0.0, height_m = 0.0, rise_m_s = 0.0;
};

/// Axis of a plume in a crosswind, integrated in time:
///   d(u R^2 w)/dt = F,   dz/dt = w,   R = R0 + beta z,   F = g Q / (pi rho c_p T)       (Morton, Taylor, Turner; Briggs)
/// In a uniform wind from a point it is Briggs' 2/3 law z = (3 / (2 beta^2))^(1/3) F^(1/3) x^(2/3) / u.
/// Stops at top_m or duration_s. The wind grows with height; below 1 m/s it counts as 1 m/s.
/// \param heat_W > 0  \param radius_m of the source  \param step_m  length of a step along the axis
std::vector<PlumePoint> plume_axis(double heat_W, double radius_m, double wind_m_s, double step_m,
                                   const PlumeParameters& parameters);

/// Plume of all burning cells of a frame: each cell's heat travels along the axis of the fire around it (merge_m) and
/// spreads over cubes of the plume's cross-section. Heat and smoke are conserved where the plume is on the map and below
/// top_m. Fill is smoke particle mass [g m-3] (or 1), temperature the air's plus heat / (rho c_p), at most 800 K above it.
/// \param scene_origin  map coordinates of the scene frame's origin
FlameField rising_plume(const FrameInputs& frame, const Raster<float>& terrain_m, const PlumeParameters& parameters,
                        Vec3 scene_origin);

/// Layers without a plume: voxels of voxel_m[2] height and 100 km width around the map, from its lowest ground up, so that
/// slanted rays and the sun cross the layers outside the map too.
FlameField layers_alone(const Raster<float>& terrain_m, const PlumeParameters& parameters, Vec3 scene_origin);

/// Excess temperature from buoyancy b [m s-2]:  dT = b T_air / g.
double excess_of_buoyancy_K(double buoyancy_m_s2, double air_K) noexcept;

/// Plume from a three-dimensional field: excess temperatures [K] on the map grid at ascending heights above the terrain,
/// linear between them, the lowest down to the ground, none above the highest. Not a number = air. Throws an input error
/// when levels and heights do not fit together.
FlameField plume_of_levels(std::span<const Raster<float>> excess_K, std::span<const double> levels_m,
                           const Raster<float>& terrain_m, const PlumeParameters& parameters, Vec3 scene_origin);

}  // namespace pyroscene::fire
