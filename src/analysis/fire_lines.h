#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pyroscene::analysis {

/// What an infrared interpreter would draw (classes of the NWCG's infrared products).
enum class HeatClass : std::uint8_t {
    None = 0,
    Intense = 1,    ///< flaming front
    Scattered = 2,  ///< hot ground without a front
    Isolated = 3    ///< a few hot cells apart from all others
};

/// Heat of a map cell.
enum class Heat : std::uint8_t { None = 0, Hot = 1, Flaming = 2 };

/// Groups hot cells that lie within `join_cells` of each other (larger of the steps along rows and columns). Groups of at most
/// `isolated_cells` cells are isolated heat; in the others flaming cells are intense and the rest is scattered heat.
std::vector<HeatClass> heat_classes(std::span<const Heat> heat, int cols, int rows, int join_cells, int isolated_cells);

/// A piece of the active edge of a fire.
struct FireLine {
    std::vector<std::array<double, 2>> points;  ///< continuous column and row, cell corners at integers
    std::size_t cell = 0;                       ///< a front cell beside it
};

/// The edges between front cells and unburned cells as lines through the middles of the edges, which cuts the corners of the
/// cells; open ends reach to the end of their edge.
std::vector<FireLine> fire_lines(std::span<const std::uint8_t> front, std::span<const std::uint8_t> unburned, int cols,
                                 int rows);

}  // namespace pyroscene::analysis
