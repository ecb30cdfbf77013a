#include "spread/ring.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace pyroscene::spread {
namespace {

/// Cuts the ray at the edges of cells.
Move make_move(Offset from) {
    Move move{.from = from};
    std::vector<double> cuts{0.0, 1.0};
    const auto cut = [&](int steps) {
        for (int k = 0; k < std::abs(steps); ++k) cuts.push_back((k + 0.5) / std::abs(steps));
    };
    cut(from.col);
    cut(from.row);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double share = cuts[i + 1] - cuts[i], middle = 0.5 * (cuts[i] + cuts[i + 1]);
        const auto cell = [&](double at) {
            return Offset{static_cast<int>(std::lround(at * from.col)), static_cast<int>(std::lround(at * from.row))};
        };
        if (share > 1e-9) {
            move.piece[static_cast<std::size_t>(move.pieces++)] = {cell(middle), share};
            continue;
        }
        const Offset before = cell(middle - 1e-6), after = cell(middle + 1e-6);
        move.corner = true;
        move.beside = {Offset{before.col, after.row}, Offset{after.col, before.row}};
    }
    return move;
}

}  // namespace

const std::array<Move, kDirections>& ring() {
    static const auto moves = [] {
        constexpr std::array<Offset, 8> kQuarter{{{1, 0}, {3, 1}, {2, 1}, {3, 2}, {1, 1}, {2, 3}, {1, 2}, {1, 3}}};
        std::array<Move, kDirections> out;
        for (std::size_t i = 0; i < kDirections; ++i) {
            Offset o = kQuarter[i % kQuarter.size()];
            for (std::size_t turn = 0; turn < i / kQuarter.size(); ++turn) o = {-o.row, o.col};
            out[i] = make_move(o);
        }
        return out;
    }();
    return moves;
}

}  // namespace pyroscene::spread
