#pragma once

#include <cstdint>
#include <vector>

#include "base/raster.h"

namespace pyroscene::fire {

/// How the fuel of a place burns once the front is there: two shares of its load, each decaying exponentially with the time
/// since arrival. WRF-SFIRE has one share only.
struct BurnOut {
    double fine_time_s = 8.2;    ///< e-folding time of the fine fuel, > 0
    double coarse_share = 0.0;   ///< of the load that burns more slowly, 0..1
    double coarse_time_s = 1.0;  ///< its e-folding time, > 0
};

/// One share with the time constant weight / 0.85 s (WRF-SFIRE, module_fr_sfire_phys.F; weights of its fuel categories in
/// data/fuel/sfire_heat_defaults.csv). \param weight_s  > 0
BurnOut sfire_burn_out(double weight_s) noexcept;

/// Fine and live fuel burns 90 % while the flames stand (e-folding time = residence time / ln 10), coarse fuel over
/// `coarse_time_s`. \param residence_time_s  > 0 (fire/residence_time.h)
BurnOut residence_burn_out(double residence_time_s, double coarse_share, double coarse_time_s) noexcept;

/// Share of the load that is left `age_s` after arrival; 1 before it.
double remaining_share(const BurnOut& burn, double age_s) noexcept;

/// Arrival times spread evenly from first to last: a straight front that crosses a piece of ground.
struct ArrivalSpan {
    double first_s = 0.0, last_s = 0.0;
};
/// The mean of the above over such a piece, exact.
double remaining_share(const BurnOut& burn, const ArrivalSpan& arrival, double time_s) noexcept;

/// Heat that a kilogram of fuel (its water included, as SFIRE counts) gives off [J kg-1]; `moisture` = water / dry mass, >= 0.
/// Sensible: 17.433e6 (1 - b); latent: 2.5e6 (b + 0.56 (1 - b)), b = moisture / (1 + moisture) (module_fr_sfire_phys.F 1415-1417).
double sensible_heat_J_kg(double moisture) noexcept;
double latent_heat_J_kg(double moisture) noexcept;

/// What burns where and when. All rasters on one grid.
struct BurningGround {
    Raster<float> arrival_time_s;  ///< at the centres of cells, seconds of any clock; NaN = no fire comes
    Raster<float> heat_J_m2;       ///< released until all is burnt; not finite = 0
    Raster<std::uint8_t> kind;     ///< position in `burn_out`
    std::vector<BurnOut> burn_out;
};

/// Mean heat flux from t0_s to t1_s over each cell [W m-2], 0 where nothing burns. A cell is cut into 4 x 4 pieces with arrival
/// times interpolated bilinearly among the burnt cells around it, and a front of its own gradient crosses each. The flux is the
/// difference of what is left at both times, so that the sum over consecutive intervals of any length is the heat released.
/// Throws an input error when t1_s <= t0_s or the grids differ.
Raster<float> mean_heat_flux_W_m2(const BurningGround& ground, double t0_s, double t1_s);

/// Share of the load that is left at a time, mean over each cell, 1 where no fire came.
Raster<float> remaining_share(const BurningGround& ground, double time_s);

/// The rows [first, last) of both, for callers that spread them over threads. `flux_W_m2` (0) and `left` (1) are on the grid of the ground.
void fill_mean_heat_flux(const BurningGround& ground, double t0_s, double t1_s, int first_row, int last_row,
                         Raster<float>& flux_W_m2);
void fill_remaining_share(const BurningGround& ground, double time_s, int first_row, int last_row, Raster<float>& left);

}  // namespace pyroscene::fire
