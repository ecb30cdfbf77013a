#include "analysis/fire_lines.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace pyroscene::analysis {
namespace {

/// Cells that hang together within a distance, as a list of indices; `seen` marks what is in it.
std::vector<std::size_t> group_of(std::size_t first, std::span<const Heat> heat, int cols, int rows, int reach,
                                  std::vector<bool>& seen) {
    std::vector<std::size_t> group{first};
    seen[first] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
        const int row = static_cast<int>(group[k] / static_cast<std::size_t>(cols)),
                  col = static_cast<int>(group[k] % static_cast<std::size_t>(cols));
        for (int r = std::max(row - reach, 0); r <= std::min(row + reach, rows - 1); ++r)
            for (int c = std::max(col - reach, 0); c <= std::min(col + reach, cols - 1); ++c) {
                const auto i = static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
                if (heat[i] == Heat::None || seen[i]) continue;
                seen[i] = true;
                group.push_back(i);
            }
    }
    return group;
}

using Vertex = std::array<int, 2>;  ///< column, row of a cell corner

/// An edge between a front cell and an unburned one.
struct Edge {
    std::array<Vertex, 2> ends;
    std::size_t cell = 0;
    std::array<int, 2> next{-1, -1};  ///< the edge that goes on at each end

    [[nodiscard]] std::array<double, 2> middle() const {
        return {0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])};
    }
};

std::vector<Edge> edges_of(std::span<const std::uint8_t> front, std::span<const std::uint8_t> unburned, int cols, int rows) {
    const auto at = [&](int c, int r) {
        return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
    };
    struct Side {
        int dc, dr;
        Vertex from, to;  ///< relative to the cell's north-west corner
    };
    constexpr std::array<Side, 4> kSides{
        {{0, -1, {0, 0}, {1, 0}}, {1, 0, {1, 0}, {1, 1}}, {0, 1, {1, 1}, {0, 1}}, {-1, 0, {0, 1}, {0, 0}}}};
    std::vector<Edge> edges;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < cols; ++c) {
            if (front[at(c, r)] == 0) continue;
            for (const Side& s : kSides) {
                const int nc = c + s.dc, nr = r + s.dr;
                if (nc < 0 || nr < 0 || nc >= cols || nr >= rows || unburned[at(nc, nr)] == 0) continue;
                edges.push_back(
                    {{Vertex{c + s.from[0], r + s.from[1]}, Vertex{c + s.to[0], r + s.to[1]}}, at(c, r), {-1, -1}});
            }
        }
    return edges;
}

/// Edges run with the front cell on one side, so at every corner the end of one meets the beginning of another. Where two pairs
/// meet, an edge goes on along its own cell.
void join(std::vector<Edge>& edges) {
    std::map<Vertex, std::vector<int>> begins;
    for (std::size_t e = 0; e < edges.size(); ++e) begins[edges[e].ends[0]].push_back(static_cast<int>(e));
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto here = begins.find(edges[e].ends[1]);
        if (here == begins.end()) continue;
        const auto& others = here->second;
        const auto same = std::find_if(others.begin(), others.end(),
                                       [&](int o) { return edges[static_cast<std::size_t>(o)].cell == edges[e].cell; });
        const int next = same != others.end() ? *same : others.front();
        Edge& following = edges[static_cast<std::size_t>(next)];
        if (following.next[0] >= 0) continue;
        edges[e].next[1] = next;
        following.next[0] = static_cast<int>(e);
    }
}

FireLine follow(const std::vector<Edge>& edges, std::size_t first, std::vector<bool>& used) {
    FireLine line;
    line.cell = edges[first].cell;
    const bool closed_start = edges[first].next[0] >= 0;
    if (!closed_start) {
        const Vertex v = edges[first].ends[0];
        line.points.push_back({static_cast<double>(v[0]), static_cast<double>(v[1])});
    }
    std::size_t e = first;
    while (true) {
        used[e] = true;
        line.points.push_back(edges[e].middle());
        const int next = edges[e].next[1];
        if (next < 0) {
            const Vertex v = edges[e].ends[1];
            line.points.push_back({static_cast<double>(v[0]), static_cast<double>(v[1])});
            return line;
        }
        e = static_cast<std::size_t>(next);
        if (used[e]) {
            line.points.push_back(edges[e].middle());
            return line;
        }
    }
}

}  // namespace

std::vector<HeatClass> heat_classes(std::span<const Heat> heat, int cols, int rows, int join_cells, int isolated_cells) {
    std::vector<HeatClass> out(heat.size(), HeatClass::None);
    std::vector<bool> seen(heat.size(), false);
    for (std::size_t i = 0; i < heat.size(); ++i) {
        if (heat[i] == Heat::None || seen[i]) continue;
        const auto group = group_of(i, heat, cols, rows, join_cells, seen);
        const bool isolated = static_cast<int>(group.size()) <= isolated_cells;
        for (const std::size_t cell : group)
            out[cell] = isolated                      ? HeatClass::Isolated
                        : heat[cell] == Heat::Flaming ? HeatClass::Intense
                                                      : HeatClass::Scattered;
    }
    return out;
}

std::vector<FireLine> fire_lines(std::span<const std::uint8_t> front, std::span<const std::uint8_t> unburned, int cols,
                                 int rows) {
    auto edges = edges_of(front, unburned, cols, rows);
    join(edges);
    std::vector<bool> used(edges.size(), false);
    std::vector<FireLine> lines;
    // Open lines from their beginning, then what is left: closed ones.
    for (const bool open : {true, false})
        for (std::size_t e = 0; e < edges.size(); ++e)
            if (!used[e] && (!open || edges[e].next[0] < 0)) lines.push_back(follow(edges, e, used));
    return lines;
}

}  // namespace pyroscene::analysis
