#include "fire/surface_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/random.h"
#include "fire/sampling.h"
#include "fire/scar.h"

namespace pyroscene::fire {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::int32_t kPlain = 0, kNoData = 1;  // blocks that cells share

/// One fine cell of the map cell at hand.
struct FineCell {
    std::size_t number = 0;  ///< in the fine grid
    std::size_t index = 0;   ///< in the arrays
    float arrival_s = kNaN;  ///< interpolated arrival, NaN without arrival data
    bool reached = true;     ///< the fire has been here
    double order = 0.0;      ///< among reached, then among others, those with the smallest order flame first
};

/// What all cells of one call share.
struct Context {
    const FireState& state;
    const FireParameters& parameters;
    double time_s;
    bool has_arrival;  ///< an arrival raster shapes the inside of cells
    RandomKey patches;
};

float scar_K(const Context& c, std::size_t cell, double clock_s) noexcept {
    const auto& cooling = scar_of_cell(c.state, c.parameters, cell);
    return static_cast<float>(scar_or_ambient_K(c.parameters, cooling, c.time_s - clock_s));
}

/// Fills `fine` with the fine cells of a map cell and their own arrival times.
void list_fine_cells(const Context& c, const SurfaceField& out, int row, int col, std::vector<FineCell>& fine) {
    const int n = out.refinement;
    // Without its own arrival time a cell has no shape inside, whatever its neighbours say.
    const bool shaped = c.has_arrival && !std::isnan(c.state.predicted_arrival_time_s->at(row, col));
    fine.clear();
    for (int r = row * n; r < (row + 1) * n; ++r) {
        for (int k = col * n; k < (col + 1) * n; ++k) {
            FineCell cell{.number = out.grid.index(r, k), .index = out.index(r, k)};
            if (shaped) {
                cell.arrival_s = bilinear_or_own(*c.state.predicted_arrival_time_s, (k + 0.5) / n, (r + 0.5) / n);
                cell.reached = cell.arrival_s <= c.time_s;
            }
            fine.push_back(cell);
        }
    }
}

/// Scar temperature of every fine cell, by its own arrival or the cell's clock. Where the fire reached the middle of the cell
/// but not all of it, the rest is still vegetation.
void fill_scar(const Context& c, SurfaceField& out, std::size_t cell, const std::vector<FineCell>& fine) {
    const float clock_s = scar_clock_s(c.state, c.parameters.physics, cell);
    const bool partly_reached = c.has_arrival && c.state.predicted_arrival_time_s->values[cell] <= c.time_s;
    for (const FineCell& f : fine) {
        if (partly_reached && !f.reached) continue;
        const bool own = !std::isnan(f.arrival_s) && f.reached;
        out.base_temperature_K[f.index] = scar_K(c, cell, own ? f.arrival_s : clock_s);
        out.burned[f.index] = 1;
    }
}

/// Sorts the fine cells of a front cell as they flame: reached last ... reached first, next to be reached ... last to be.
/// Without arrival data, and where the front has passed and only slow fuel burns on, the order is random: patches.
void sort_by_flaming(const Context& c, std::size_t cell, std::vector<FineCell>& fine) {
    const double fast_s = scar_of_cell(c.state, c.parameters, cell).time_constant1_s;
    const bool passed = std::all_of(fine.begin(), fine.end(),
                                    [&](const FineCell& f) { return f.reached && c.time_s - f.arrival_s > fast_s; });
    for (FineCell& f : fine) {
        const bool strip = !std::isnan(f.arrival_s) && !passed;
        f.order = strip ? std::abs(c.time_s - f.arrival_s) : uniform01(c.patches, f.number);
    }
    std::sort(fine.begin(), fine.end(), [](const FineCell& a, const FineCell& b) {
        if (a.reached != b.reached) return a.reached;
        return a.order != b.order ? a.order < b.order : a.number < b.number;
    });
}

/// Puts the flaming area of a front cell into its fine cells, whole ones first, so that their sum is the cell's area.
void distribute_flames(const Context& c, SurfaceField& out, std::size_t cell, double fraction, std::vector<FineCell>& fine) {
    sort_by_flaming(c, cell, fine);
    double left = fraction * static_cast<double>(fine.size());
    for (const FineCell& f : fine) {
        if (!(left > 0.0)) break;
        out.front_fraction[f.index] = static_cast<float>(std::min(1.0, left));
        out.burned[f.index] = 1;
        left -= 1.0;
    }
}

/// Ground of a front cell: flames, the part they have left behind and the part they have not reached. Without arrival data
/// the part that does not flame is vegetation in the first frame that shows the cell burning, and scar from then on.
void fill_front(const Context& c, SurfaceField& out, std::size_t cell, std::vector<FineCell>& fine) {
    const float fraction = c.state.front_fraction[cell];
    const float first_burning_s = c.state.arrival_time_s[cell];
    const bool fresh = first_burning_s >= c.state.time_s;
    for (const FineCell& f : fine) {
        if (!f.reached || (std::isnan(f.arrival_s) && fresh)) continue;
        out.base_temperature_K[f.index] = scar_K(c, cell, std::isnan(f.arrival_s) ? first_burning_s : f.arrival_s);
        out.burned[f.index] = 1;
    }
    if (c.parameters.physics == Physics::Thesis) {
        for (const FineCell& f : fine) out.front_fraction[f.index] = fraction;
        return;
    }
    distribute_flames(c, out, cell, fraction, fine);
}

SurfaceField blank_field(const FireState& state, const FireParameters& parameters, int refinement) {
    SurfaceField out;
    out.grid = state.cell_class.grid;
    out.grid.cols *= refinement;
    out.grid.rows *= refinement;
    out.grid.cell_m /= refinement;
    out.refinement = refinement;
    out.front_temperature_K = parameters.front_temperature_K;
    out.ambient_temperature_K = parameters.ambient_temperature_K;
    // Blocks that many cells share first, then one for each cell that burns or has burnt.
    const auto& classes = state.cell_class.values;
    out.block_of_cell = SparseRaster<std::int32_t>(state.cell_class.grid, "block", "1", kPlain);
    std::int32_t next = static_cast<std::int32_t>(SurfaceField::kSharedBlocks);
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const auto c = static_cast<CellClass>(classes[i]);
        if (c == CellClass::NoData) out.block_of_cell.set(i, kNoData);
        if (c == CellClass::Front || c == CellClass::Scar) out.block_of_cell.set(i, next++);
    }
    const auto block_size = static_cast<std::size_t>(refinement) * static_cast<std::size_t>(refinement);
    const std::size_t size = static_cast<std::size_t>(next) * block_size;
    out.base_temperature_K.assign(size, static_cast<float>(parameters.ambient_temperature_K));
    out.front_fraction.assign(size, 0.0F);
    out.burned.assign(size, 0);
    std::fill_n(out.base_temperature_K.begin() + static_cast<std::ptrdiff_t>(kNoData * block_size), block_size, kNaN);
    return out;
}

}  // namespace

SurfaceField surface_at(const FireState& state, double time_s, const FireParameters& parameters, int refinement) {
    if (refinement < 1) throw input_error("ground refinement", fmt::format("is {}, must be at least 1", refinement));
    if (!(time_s >= state.time_s))
        throw input_error("acquisition time", fmt::format("{} s lies before the fire state at {} s", time_s, state.time_s));
    SurfaceField out = blank_field(state, parameters, refinement);
    const bool has_arrival = parameters.physics == Physics::Default && state.predicted_arrival_time_s != nullptr;
    const Context context{
        state, parameters, time_s, has_arrival, {parameters.seed, stream_id("flaming patches"), random_frame(state.time_s)}};
    std::vector<FineCell> fine;
    fine.reserve(static_cast<std::size_t>(refinement) * static_cast<std::size_t>(refinement));
    for (int row = 0; row < state.cell_class.grid.rows; ++row) {
        for (int col = 0; col < state.cell_class.grid.cols; ++col) {
            const std::size_t cell = state.cell_class.grid.index(row, col);
            const auto cell_class = static_cast<CellClass>(state.cell_class.values[cell]);
            if (cell_class != CellClass::Front && cell_class != CellClass::Scar) continue;
            list_fine_cells(context, out, row, col, fine);
            if (cell_class == CellClass::Front)
                fill_front(context, out, cell, fine);
            else
                fill_scar(context, out, cell, fine);
        }
    }
    return out;
}

}  // namespace pyroscene::fire
