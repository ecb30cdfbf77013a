#pragma once

#include "spread/fuel_model.h"

namespace pyroscene::spread {

/// Share of live herbs that counts as dead fuel when it cures.
enum class Curing {
    BehavePlus,  ///< 1.333 - 1.11 m for moistures m of 0.30 to 1.20 (where 0.001 is left), as BEHAVE computes
    Linear       ///< (1.20 - m) / 0.90, as published (Scott and Burgan 2005)
};

/// Water / dry mass of each size class; herbs that have cured take that of 1-h fuel.
using Moistures = PerFuelClass;

/// What Rothermel's surface fire model says of a fuel bed without wind and slope. Rothermel (1972, INT-115) in the form of Albini
/// (1976, INT-30), as Andrews (2018, RMRS-GTR-371) writes it. A bed too wet to burn has rate and heat 0.
struct FuelBed {
    double rate_m_s = 0.0;  ///< no wind, no slope
    double reaction_intensity_W_m2 = 0.0;
    double residence_time_s = 0.0;              ///< 384 min / sigma (Anderson 1969)
    double heat_J_m2 = 0.0;                     ///< given off in the front = reaction intensity x residence time
    double surface_to_volume_per_m = 0.0;       ///< sigma, characteristic
    double relative_packing = 0.0;              ///< packing ratio / its optimum
    double slope_factor = 0.0;                  ///< phi_s = this x tan^2(slope)
    double wind_scale = 0.0, wind_power = 1.0;  ///< phi_w = scale x (midflame wind [m/s]) ^ power
};
FuelBed fuel_bed(const FuelModel& model, const Moistures& moisture, Curing curing = Curing::BehavePlus) noexcept;

/// The fastest spread over a slope.
struct HeadFire {
    double rate_m_s = 0.0;            ///< along the slope
    double from_upslope_rad = 0.0;    ///< direction, clockwise from straight up the slope, in its plane
    double effective_wind_m_s = 0.0;  ///< the midflame wind that would do the same on level ground
    bool limited = false;             ///< by the wind-speed limit
};
/// \param midflame_m_s        wind speed, >= 0
/// \param wind_from_upslope_rad direction the wind blows to, clockwise from straight up the slope
/// \param slope_tangent       rise over run, >= 0
/// \param wind_limit          no effective wind above 0.9 x reaction intensity (ft/min, Btu/ft2/min; Rothermel 1972)
HeadFire head_fire(const FuelBed& bed, double midflame_m_s, double wind_from_upslope_rad, double slope_tangent,
                   bool wind_limit = false) noexcept;

/// Trees above the fuel, which shelter it.
struct Canopy {
    double cover = 0.0;  ///< 0..1
    double height_m = 0.0;
    double crown_ratio = 0.0;  ///< share of the height that is crown, 0..1
};
/// Whether they shelter the fuel: crowns fill at least 5 % of the space (cover x crown ratio / 3) and stand 6 ft high.
bool shelters(const Canopy& canopy) noexcept;
/// Midflame wind / wind 6.1 m (20 ft) above the vegetation, Albini and Baughman (1979, INT-221) as in Andrews (2012,
/// RMRS-GTR-266): below trees that shelter it, else over the fuel bed.
double wind_adjustment(double fuel_depth_m, const Canopy& canopy) noexcept;
/// Wind at 10 m / wind at 6.1 m (20 ft), the usual factor.
inline constexpr double kTenMetresToTwentyFeet = 1.15;

/// Length / width of the ellipse that a fire in a steady wind grows into (Anderson 1983, as in FARSITE), at most 8.
double length_to_width(double effective_wind_m_s) noexcept;

/// 0.0775 I^0.46 (Byram 1959) [m], I in kW/m; the coefficient follows exactly from 0.45 in ft and Btu/ft/s.
double flame_length_m(double fireline_intensity_W_m) noexcept;

}  // namespace pyroscene::spread
