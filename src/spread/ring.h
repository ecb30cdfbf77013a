#pragma once

#include <array>

namespace pyroscene::spread {

struct Offset {
    int col = 0, row = 0;  ///< row counts southwards
};

/// The ray from the centre of a neighbour on the ring to that of a cell.
struct Move {
    Offset from;  ///< the neighbour, seen from the cell
    struct Piece {
        Offset cell;
        double share = 0.0;  ///< of the ray
    };
    int pieces = 0;
    std::array<Piece, 6> piece{};  ///< the cells it crosses, its own first
    bool corner = false;           ///< it passes through the corner between these two
    std::array<Offset, 2> beside{};
};

/// A ring of neighbours in order of direction, 7 to 19 degrees apart, at most 3 cells away.
inline constexpr std::size_t kDirections = 32;
const std::array<Move, kDirections>& ring();

}  // namespace pyroscene::spread
