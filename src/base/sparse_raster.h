#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/map_grid.h"

namespace pyroscene {

/// A quantity that few cells of a large map have: the others hold `fill`. Memory follows the cells that were set (in runs of
/// kRun cells along the rows), so that a small fire on a large map costs little. Reading is safe for several threads at once.
template <class T>
class SparseRaster {
public:
    static constexpr std::size_t kRun = 64;

    MapGrid grid;
    std::string name, unit;

    SparseRaster() = default;
    SparseRaster(MapGrid g, std::string quantity, std::string unit_symbol, T fill = T{})
        : grid(std::move(g)),
          name(std::move(quantity)),
          unit(std::move(unit_symbol)),
          fill_(fill),
          run_of_cells_((grid.size() + kRun - 1) / kRun, -1) {}

    [[nodiscard]] T operator[](std::size_t cell) const noexcept {
        const std::int32_t run = run_of_cells_[cell / kRun];
        return run < 0 ? fill_ : values_[static_cast<std::size_t>(run) * kRun + cell % kRun];
    }
    [[nodiscard]] T at(int row, int col) const noexcept { return (*this)[grid.index(row, col)]; }

    /// Without a grid.
    [[nodiscard]] bool empty() const noexcept { return run_of_cells_.empty(); }
    /// Cells that memory is spent on.
    [[nodiscard]] std::size_t cells_held() const noexcept { return values_.size(); }
    /// The cells from `first` on, as many as `out` has.
    void copy(std::size_t first, std::span<T> out) const noexcept {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = (*this)[first + i];
    }

    /// Setting what a cell already holds costs no memory.
    void set(std::size_t cell, T value) {
        std::int32_t& run = run_of_cells_[cell / kRun];
        if (run < 0) {
            const auto nothing = [](T v) { return std::isnan(static_cast<double>(v)); };
            if (value == fill_ || (nothing(value) && nothing(fill_))) return;
            run = static_cast<std::int32_t>(values_.size() / kRun);
            values_.resize(values_.size() + kRun, fill_);
        }
        values_[static_cast<std::size_t>(run) * kRun + cell % kRun] = value;
    }

private:
    T fill_{};
    std::vector<std::int32_t> run_of_cells_;  ///< place of each run of cells in values_, -1 = not held
    std::vector<T> values_;
};

}  // namespace pyroscene
