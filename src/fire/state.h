#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/raster.h"
#include "base/sparse_raster.h"
#include "fire/embers.h"
#include "fire/flame_relations.h"

namespace pyroscene::fire {

/// Which formulas are used: the physically right ones or the thesis's own (docs/physics-fire.md says where they differ).
enum class Physics { Default, Thesis };

/// Label of a map cell (thesis 6.2). Values are those of the class band in the state file.
enum class CellClass : std::uint8_t { Unburned = 0, Front = 1, Scar = 2, NoData = 255 };

/// Coefficients of the scar cooling curve T(t) = T1 exp(-t/tau1) + T2 exp(-t/tau2) + Ta (thesis eq 4.17), defaults eq 4.18.
/// Amplitudes are temperature differences [K]; the floor is an absolute temperature [K]. One exponential: amplitude2_K = 0.
struct ScarCooling {
    double amplitude1_K = 578.97, time_constant1_s = 74.88;
    double amplitude2_K = 197.50, time_constant2_s = 247.72;
    double floor_K = 273.15 + 33.19;
};

/// Cooling curve of one class of ground cover.
struct CoverScar {
    int code = 0;  ///< as the cover raster has it
    ScarCooling cooling;
};

/// All numbers of the fire model a scenario can set. Defaults: thesis values where usable, else docs/physics-fire.md.
struct FireParameters {
    Physics physics = Physics::Default;
    double front_threshold_W_m2 = 1000.0;          ///< heat flux above which a cell is front (thesis 6.2)
    double front_temperature_K = 273.15 + 800.0;   ///< ground under the flames (thesis 6.2)
    double ambient_temperature_K = 273.15 + 34.0;  ///< unburned ground (thesis 6.2)
    double flaming_heat_flux_W_m2 =
        5.0e5;         ///< heat flux inside the flaming zone; cell mean / this = area fraction that flames
    ScarCooling scar;  ///< of all ground that scar_of_cover does not name
    std::vector<CoverScar> scar_of_cover;         ///< FrameInputs::scar_class says where
    double height_alpha = 1.0;                    ///< scale of flame-height method 1 (eq 4.22), dimensionless
    double volumetric_heat_release_W_m3 = 2.0e6;  ///< chemical heat release per flame volume (thesis: 2000 kW m-3)
    bool one_sigma_rule = true;                   ///< limit heights by the statistics of all earlier frames (thesis 4.6.1)
    double air_density_kg_m3 = 1.18, air_heat_capacity_J_kg_K = 1005.0, air_temperature_K = 300.0;
    double maximum_tilt_rad = 1.4835298641951802;  ///< 85 degrees; at most 89 (a flat flame has no shear)
    EmberParameters embers;
    double jitter_m = 0.0;  ///< half width of the uniform shift of flame columns (thesis 4.6.4)
    std::uint64_t seed = 1;
    FlameRelations flames;  ///< which relations for height, tilt, intensity and depth
};

/// Running count, mean and sum of squared deviations (Welford) of front-cell flame heights [m] of all earlier frames.
struct RunningStatistics {
    std::int64_t count = 0;
    double mean_m = 0.0, m2_m2 = 0.0;

    void add(double value_m) noexcept;
    /// Sample standard deviation (n - 1); 0 while fewer than two values are known.
    [[nodiscard]] double standard_deviation_m() const noexcept;
};

/// What is known of the front beside the rasters of a frame, on the same grid: values that hold when the front passes a cell.
/// Not finite = unknown there.
struct FrontInputs {
    std::optional<Raster<float>> spread_rate_m_s;          ///< as given, or from arrival times (gradients.h)
    std::optional<Raster<float>> fuel_load_kg_m2;          ///< before the fire
    std::optional<Raster<float>> fireline_intensity_W_m;   ///< as given
    std::optional<Raster<float>> flame_length_m;           ///< as given; along the leaning axis
    std::optional<Raster<float>> residence_time_s;         ///< of flames at one place
    std::optional<Raster<float>> midflame_wind;            ///< wind at flames / wind of the frame; none = the same
    std::optional<Raster<float>> slope_east, slope_north;  ///< of the ground, rise over run; both or none
};

/// Rasters of one moment, all on one map grid.
struct FrameInputs {
    double time_s = 0.0;                          ///< since ignition
    Raster<float> heat_flux_W_m2;                 ///< surface fire sensible heat flux, cell mean; not finite = no data
    Raster<float> wind_east_m_s, wind_north_m_s;  ///< along the grid's axes; not finite = calm
    SharedRaster<float> arrival_time_s;           ///< seconds since ignition, NaN = never reached; null = not given
    Raster<std::uint8_t> scar_class;              ///< 0 = FireParameters::scar, n = scar_of_cover[n - 1]; no values = all 0
    const FrontInputs* front = nullptr;           ///< not owned; null = nothing but the flux is known
};

/// Front cells of one frame whose flames needed a way out; for the run report.
struct FlameCounts {
    std::int64_t without_height = 0;          ///< the method gave none: Heskestad's is negative, a raster has no value
    std::int64_t intensity_by_heat_flux = 0;  ///< load or spread rate unknown
    std::int64_t depth_by_heat_flux = 0;      ///< spread rate or residence time unknown, or the front has passed
};

/// What the fire has done up to one frame: a pure function of the previous state and this frame's inputs. Its size does not
/// depend on the number of frames; but for a class per cell and the arrival raster it follows the burnt area, not the map.
///
/// To continue from a stored state, advance() needs, to the bit: time_s, cell_class, arrival_time_s, last_burning_time_s,
/// height_statistics, embers and, when frames come without an arrival raster of their own, predicted_arrival_time_s.
/// To see a stored state, surface_at() and make_columns() need in addition cell_class, front_fraction, flame_height_m,
/// ember_height_m, flame_tilt_rad and flame_azimuth_rad. surface_temperature_K is for people: nothing reads it.
struct FireState {
    double time_s = 0.0;
    Raster<std::uint8_t> cell_class;     ///< CellClass
    SparseRaster<float> arrival_time_s;  ///< first time the cell burned (from the arrival raster when given), NaN = not yet
    SharedRaster<float>
        predicted_arrival_time_s;               ///< the arrival raster as given, later times too; null when none was given
    SparseRaster<float> last_burning_time_s;    ///< last time the cell is known to have burned, NaN = never
    SparseRaster<float> surface_temperature_K;  ///< at time_s: front, scar curve or ambient
    Raster<std::uint8_t> scar_class;            ///< as given with the frames; no values when none was given
    SparseRaster<float> front_fraction;         ///< area fraction of the cell that flames, 0 outside the front
    SparseRaster<float> flame_height_m;         ///< eq 4.22 mean over the cell, after the one-sigma rule [m]
    SparseRaster<float> ember_height_m;         ///< part of the height beyond one sigma, detached above the flame
    SparseRaster<float> flame_tilt_rad;         ///< from the vertical, 0 = upright
    SparseRaster<float> flame_azimuth_rad;      ///< direction the flame leans to, clockwise from grid north
    RunningStatistics height_statistics;        ///< of all frames up to and including this one
    std::vector<Ember> embers;    ///< detached flame still hot, oldest frame first; empty when embers do not drift
    double heat_release_W = 0.0;  ///< sum of positive heat flux x cell area over the whole map
    FlameCounts flame_counts;     ///< of this frame alone; not kept in files
};

/// Zero of a scar cell's cooling curve [s]. Default physics: the arrival of the fire, because the part that still flamed later
/// is front_fraction's business and the rest has cooled since. Thesis physics: the last time it burned, because the whole
/// cell is held at the front temperature until then.
float scar_clock_s(const FireState& state, Physics physics, std::size_t cell) noexcept;

/// The next state (thesis 6.2, 4.6). `previous` is null for the first frame.
///  - Front: heat flux above the threshold. A front cell that burned before burns again and its scar clock starts anew.
///  - Scar: no front, but it burned in an earlier frame or its arrival time lies at or before this frame, whatever its flux.
///  - Unburned: everything else, also cells with a flux below the threshold (pre-heat, numerical diffusion).
///  - NoData: flux not finite in a cell without history.
/// Fluxes below 1e-3 W m-2 count as zero. Throws an input error when grids differ, time does not advance or a parameter
/// makes the formulas meaningless.
FireState advance(const FireState* previous, const FrameInputs& frame, const FireParameters& parameters);

}  // namespace pyroscene::fire
