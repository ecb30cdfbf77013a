#include "fire/burn_out.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::fire {
namespace {

constexpr double kSensible_J_kg = 17.433e6;
constexpr double kVaporisation_J_kg = 2.5e6;
constexpr double kWaterOfCombustion = 0.56;  ///< kg per kg of dry fuel

constexpr int kPieces = 4;  ///< per axis of a cell; even, so that none lies on both sides of a centre

/// Arrival times at the centres of the four cells around a quarter of a cell: its own, beside, above or below, across.
struct Corners {
    double own = 0.0, beside = 0.0, along = 0.0, across = 0.0;
};

/// The arrival time of a neighbour. Where there is none the front is continued, outwards only: with the step from the opposite
/// neighbour when it came from there, else as it is.
double continued(double own, float neighbour, float opposite) noexcept {
    if (std::isfinite(neighbour)) return neighbour;
    return std::isfinite(opposite) ? own + std::max(0.0, own - opposite) : own;
}

/// Calls `with` for each piece of a burnt cell with the span of its arrival times: that of a front with the gradient of the
/// bilinear surface. Evenly spread over the root sum of squares of both gradients, the times have the right mean and variance.
template <class With>
void for_each_piece(const Raster<float>& arrival_s, int row, int col, const With& with) {
    const auto at = [&](int r, int c) { return arrival_s.grid.contains(r, c) ? arrival_s.at(r, c) : std::nanf(""); };
    const double own = at(row, col);
    for (const int down : {-1, 1})
        for (const int right : {-1, 1}) {
            const double beside = continued(own, at(row, col + right), at(row, col - right));
            const double along = continued(own, at(row + down, col), at(row - down, col));
            const float diagonal = at(row + down, col + right);
            const double across = std::isfinite(diagonal) ? diagonal : beside + along - own;
            const double twist = across - beside - along + own;
            for (int j = 0; j < kPieces / 2; ++j)
                for (int i = 0; i < kPieces / 2; ++i) {
                    const double x = (i + 0.5) / kPieces, y = (j + 0.5) / kPieces;
                    const double slope_x = beside - own + twist * y, slope_y = along - own + twist * x;
                    const double middle = own + slope_x * x + (along - own) * y;
                    const double half = 0.5 * std::hypot(slope_x, slope_y) / kPieces;
                    with(ArrivalSpan{middle - half, middle + half});
                }
        }
}

/// Mean of exp(-age / tau) over ages from `from_s` on, `span_s` wide.
double mean_decay(double from_s, double span_s, double tau_s) noexcept {
    const double x = span_s / tau_s;
    return std::exp(-from_s / tau_s) * (x > 1e-12 ? -std::expm1(-x) / x : 1.0);
}

/// Mean of the remaining share over a cell.
double remaining_in_cell(const Raster<float>& arrival_s, int row, int col, const BurnOut& burn, double time_s) {
    double sum = 0.0;
    for_each_piece(arrival_s, row, col, [&](const ArrivalSpan& span) { sum += remaining_share(burn, span, time_s); });
    return sum / (kPieces * kPieces);
}

/// Earliest and latest arrival time among a burnt cell and its neighbours, and the cell's own continued outwards.
ArrivalSpan bounds(const Raster<float>& arrival_s, int row, int col) noexcept {
    const double own = arrival_s.at(row, col);
    ArrivalSpan span{own, own};
    for (int r = std::max(0, row - 1); r <= std::min(arrival_s.grid.rows - 1, row + 1); ++r)
        for (int c = std::max(0, col - 1); c <= std::min(arrival_s.grid.cols - 1, col + 1); ++c)
            if (const double t = arrival_s.at(r, c); std::isfinite(t)) {
                span.first_s = std::min(span.first_s, t);
                span.last_s = std::max(span.last_s, t);
            }
    const double reach = span.last_s - span.first_s;
    return {span.first_s - reach, span.last_s + 2.0 * reach};
}

void check_grids(const BurningGround& ground) {
    if (!(ground.heat_J_m2.grid == ground.arrival_time_s.grid) || !(ground.kind.grid == ground.arrival_time_s.grid))
        throw input_error("burning ground", "arrival time, heat and kind of fuel are not on one grid");
}

const BurnOut& burn_out_of(const BurningGround& ground, std::size_t cell) {
    const std::size_t kind = ground.kind.values[cell];
    if (kind >= ground.burn_out.size())
        throw input_error("burning ground",
                          fmt::format("kind {} of fuel, but only {} are known", kind, ground.burn_out.size()));
    return ground.burn_out[kind];
}

}  // namespace

BurnOut sfire_burn_out(double weight_s) noexcept { return {.fine_time_s = weight_s / 0.85}; }

BurnOut residence_burn_out(double residence_time_s, double coarse_share, double coarse_time_s) noexcept {
    return {residence_time_s / std::numbers::ln10, coarse_share, coarse_time_s};
}

double remaining_share(const BurnOut& burn, double age_s) noexcept { return remaining_share(burn, ArrivalSpan{}, age_s); }

double remaining_share(const BurnOut& burn, const ArrivalSpan& arrival, double time_s) noexcept {
    const double youngest = time_s - arrival.last_s, oldest = time_s - arrival.first_s;
    if (oldest <= 0.0) return 1.0;
    const double from = std::max(0.0, youngest), span = oldest - from;
    const double on_fire = oldest > youngest ? span / (oldest - youngest) : 1.0;
    const double fine = mean_decay(from, span, burn.fine_time_s);
    const double coarse = burn.coarse_share > 0.0 ? mean_decay(from, span, burn.coarse_time_s) : 0.0;
    return 1.0 - on_fire + on_fire * std::lerp(fine, coarse, burn.coarse_share);
}

double sensible_heat_J_kg(double moisture) noexcept { return kSensible_J_kg / (1.0 + moisture); }

double latent_heat_J_kg(double moisture) noexcept {
    return kVaporisation_J_kg * (moisture + kWaterOfCombustion) / (1.0 + moisture);
}

void fill_mean_heat_flux(const BurningGround& ground, double t0_s, double t1_s, int first_row, int last_row,
                         Raster<float>& flux_W_m2) {
    check_grids(ground);
    if (!(t1_s > t0_s))
        throw input_error("heat flux", fmt::format("from {} s to {} s: expected a time that passes", t0_s, t1_s));
    constexpr double kBurntOut = 40.0;  ///< e-folding times after which less than a rounding error is left
    const MapGrid& grid = ground.arrival_time_s.grid;
    for (int row = first_row; row < last_row; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t cell = grid.index(row, col);
            const double heat = ground.heat_J_m2.values[cell];
            if (!std::isfinite(ground.arrival_time_s.values[cell]) || !std::isfinite(heat)) continue;
            const BurnOut& burn = burn_out_of(ground, cell);
            const ArrivalSpan span = bounds(ground.arrival_time_s, row, col);
            const double slowest =
                burn.coarse_share > 0.0 ? std::max(burn.fine_time_s, burn.coarse_time_s) : burn.fine_time_s;
            if (span.first_s >= t1_s || span.last_s + kBurntOut * slowest < t0_s) continue;
            const double burnt = remaining_in_cell(ground.arrival_time_s, row, col, burn, t0_s) -
                                 remaining_in_cell(ground.arrival_time_s, row, col, burn, t1_s);
            flux_W_m2.values[cell] = static_cast<float>(heat * burnt / (t1_s - t0_s));
        }
}

void fill_remaining_share(const BurningGround& ground, double time_s, int first_row, int last_row, Raster<float>& left) {
    check_grids(ground);
    const MapGrid& grid = ground.arrival_time_s.grid;
    for (int row = first_row; row < last_row; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t cell = grid.index(row, col);
            if (!std::isfinite(ground.arrival_time_s.values[cell])) continue;
            left.values[cell] =
                static_cast<float>(remaining_in_cell(ground.arrival_time_s, row, col, burn_out_of(ground, cell), time_s));
        }
}

Raster<float> mean_heat_flux_W_m2(const BurningGround& ground, double t0_s, double t1_s) {
    const MapGrid& grid = ground.arrival_time_s.grid;
    Raster<float> flux(grid, "heat_flux", "W m-2", 0.0F);
    fill_mean_heat_flux(ground, t0_s, t1_s, 0, grid.rows, flux);
    return flux;
}

Raster<float> remaining_share(const BurningGround& ground, double time_s) {
    const MapGrid& grid = ground.arrival_time_s.grid;
    Raster<float> left(grid, "remaining_share", "1", 1.0F);
    fill_remaining_share(ground, time_s, 0, grid.rows, left);
    return left;
}

}  // namespace pyroscene::fire
