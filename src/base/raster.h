#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/map_grid.h"

namespace pyroscene {

/// One named quantity with its unit on a map grid, row-major, row 0 = north. NaN is "no data" for floating types.
template <class T>
struct Raster {
    MapGrid grid;
    std::string name, unit;
    std::vector<T> values;

    Raster() = default;
    Raster(MapGrid g, std::string quantity, std::string unit_symbol, T fill = T{})
        : grid(std::move(g)), name(std::move(quantity)), unit(std::move(unit_symbol)), values(grid.size(), fill) {}

    [[nodiscard]] T& at(int row, int col) noexcept { return values[grid.index(row, col)]; }
    [[nodiscard]] const T& at(int row, int col) const noexcept { return values[grid.index(row, col)]; }
};

/// A raster that many hold and nobody changes; null = there is none.
template <class T>
using SharedRaster = std::shared_ptr<const Raster<T>>;

template <class T>
SharedRaster<T> share(Raster<T> raster) {
    return std::make_shared<const Raster<T>>(std::move(raster));
}

}  // namespace pyroscene
