#pragma once

#include <cstdint>
#include <vector>

#include "fire/state.h"

namespace pyroscene::fire {

/// The ground at one moment on a grid `refinement` times finer than the map: what burns where inside a cell.
/// Flaming area, hence radiant power, of every map cell is conserved for any refinement. Fine cells are kept in blocks of one map
/// cell each; map cells that are all alike (vegetation at ambient temperature, no data) share one block, so that memory follows
/// the fire and not the map.
struct SurfaceField {
    MapGrid grid;                              ///< the fine grid, same corner and CRS as the map
    int refinement = 1;                        ///< fine cells per map cell and axis
    SparseRaster<std::int32_t> block_of_cell;  ///< on the map; empty = every map cell has a block of its own, in their order
    std::vector<float> base_temperature_K;  ///< [block][row][col] ground that does not flame: scar or ambient; NaN = no data
    std::vector<float> front_fraction;      ///< [block][row][col] part of the fine cell at front_temperature_K
    std::vector<std::uint8_t> burned;       ///< [block][row][col] 1 = burnt or burning (char), 0 = vegetation
    double front_temperature_K = 0.0;
    double ambient_temperature_K = 0.0;

    /// Where the arrays hold a fine cell of the grid.
    [[nodiscard]] std::size_t index(int row, int col) const noexcept {
        const int n = refinement;
        return place(block(row / n, col / n), row % n, col % n);
    }
    /// Block of a map cell.
    [[nodiscard]] std::size_t block(int map_row, int map_col) const noexcept {
        const auto cell = static_cast<std::size_t>(map_row) * static_cast<std::size_t>(grid.cols / refinement) +
                          static_cast<std::size_t>(map_col);
        return block_of_cell.empty() ? cell : static_cast<std::size_t>(block_of_cell[cell]);
    }
    /// Calls f(row, col, index) for the fine cells of map cells with a block of their own (those that burn or have burnt are among
    /// them), row by row of the fine grid.
    template <class F>
    void for_each_own_cell(const F& f) const {
        const int n = refinement;
        for (int row = 0; row < grid.rows; ++row)
            for (int cell = 0; cell < grid.cols / n; ++cell) {
                const std::size_t own = block(row / n, cell);
                if (!block_of_cell.empty() && own < kSharedBlocks) continue;
                for (int k = 0; k < n; ++k) f(row, cell * n + k, place(own, row % n, k));
            }
    }
    static constexpr std::size_t kSharedBlocks = 2;  ///< where block_of_cell is given: plain vegetation, no data

private:
    [[nodiscard]] std::size_t place(std::size_t own, int row, int col) const noexcept {
        const auto n = static_cast<std::size_t>(refinement);
        return (own * n + static_cast<std::size_t>(row)) * n + static_cast<std::size_t>(col);
    }
};

/// The ground at `time_s`, which may lie after the state: scars have cooled to that very time, cells keep their class.
///  - Front: the flaming area of the cell (front_fraction x refinement^2 fine cells) goes to the fine cells that the
///    bilinearly interpolated arrival time reached last, then to those it will reach next: a strip. The rest is scar by its
///    own arrival or still vegetation. Without an arrival time, and in cells that the front passed longer ago than the scar's
///    first time constant, the flaming fine cells are drawn at random (reproducibly). Without one the rest is vegetation in
///    the first frame of the cell's fire, then scar since its first burning. Physics::Thesis: every fine cell carries the
///    fraction of the cell.
///  - Scar: the clock of a fine cell is its own interpolated arrival, else scar_clock_s of the cell. Fine cells that the
///    interpolated arrival has not reached are still vegetation.
///  - Unburned stays so whatever the arrival time says.
/// \param refinement fine cells per map cell and axis, >= 1
/// Throws an input error for refinement < 1 or a time before the state's.
SurfaceField surface_at(const FireState& state, double time_s, const FireParameters& parameters, int refinement);

}  // namespace pyroscene::fire
