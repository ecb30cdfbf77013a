#include "analysis/ortho.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::analysis {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

/// Ground point in units of cells: column and row such that cell centres are integers, and the height.
struct Node {
    double col = 0.0, row = 0.0, z = 0.0;
};
Node operator+(Node a, Node b) { return {a.col + b.col, a.row + b.row, a.z + b.z}; }
Node operator-(Node a, Node b) { return {a.col - b.col, a.row - b.row, a.z - b.z}; }
Node operator*(double s, Node a) { return {s * a.col, s * a.row, s * a.z}; }

double cross(Node a, Node b) { return a.col * b.row - a.row * b.col; }

/// Pixel centres with a frame of extrapolated points on the image border: node (0, 0) is the image corner, node (i, j) the
/// centre of pixel (i - 1, j - 1), the last node the opposite corner.
class NodeGrid {
public:
    NodeGrid(const MapGrid& grid, int samples, int lines, std::span<const double> x_m, std::span<const double> y_m,
             std::span<const double> z_m)
        : cols_(samples + 2),
          rows_(lines + 2),
          samples_(samples),
          lines_(lines),
          nodes_(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_)) {
        for (int line = 0; line < lines; ++line) {
            for (int sample = 0; sample < samples; ++sample) {
                const auto i =
                    static_cast<std::size_t>(line) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
                at(sample + 1, line + 1) = {grid.col_at(x_m[i]) - 0.5, grid.row_at(y_m[i]) - 0.5, z_m[i]};
            }
            at(0, line + 1) = half_step_out(at(1, line + 1), at(2, line + 1));
            at(cols_ - 1, line + 1) = half_step_out(at(cols_ - 2, line + 1), at(cols_ - 3, line + 1));
        }
        for (int i = 0; i < cols_; ++i) {
            at(i, 0) = half_step_out(at(i, 1), at(i, 2));
            at(i, rows_ - 1) = half_step_out(at(i, rows_ - 2), at(i, rows_ - 3));
        }
    }

    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] const Node& at(int i, int j) const { return nodes_[index(i, j)]; }
    /// Image position of a node along each axis, corners at integers.
    [[nodiscard]] double sample_of(int i) const { return std::clamp(i - 0.5, 0.0, static_cast<double>(samples_)); }
    [[nodiscard]] double line_of(int j) const { return std::clamp(j - 0.5, 0.0, static_cast<double>(lines_)); }

private:
    static Node half_step_out(Node rim, Node inner) { return rim + 0.5 * (rim - inner); }
    [[nodiscard]] std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(i);
    }
    Node& at(int i, int j) { return nodes_[index(i, j)]; }

    int cols_, rows_, samples_, lines_;
    std::vector<Node> nodes_;
};

/// Bilinear patch  a + u e + v f + u v g  over 0 <= u, v <= 1 and its inverse.
class Quad {
public:
    Quad(Node corner, Node right, Node below, Node opposite)
        : a_(corner), e_(right - corner), f_(below - corner), g_((corner - right) + (opposite - below)) {}

    struct Position {
        double u = 0.0, v = 0.0, z = 0.0;
    };

    /// Parameters of a map position; of the two that a folded quad may have, the higher ground. False when outside.
    bool find(double col, double row, Position& found) const {
        // Eliminating u from p - a = u e + v f + u v g leaves  k2 v^2 + k1 v + k0 = 0  (2-D cross products).
        const Node h{col - a_.col, row - a_.row, 0.0};
        const double k2 = cross(g_, f_), k1 = cross(e_, f_) + cross(h, g_), k0 = cross(h, e_);
        const double discriminant = k1 * k1 - 4.0 * k2 * k0;
        if (!(discriminant >= 0.0)) return false;
        const double q = -0.5 * (k1 + std::copysign(std::sqrt(discriminant), k1));
        bool inside = accept(h, q != 0.0 ? k0 / q : 2.0, false, found);
        if (k2 != 0.0) inside = accept(h, q / k2, inside, found);
        return inside;
    }

private:
    bool accept(Node h, double v, bool have_one, Position& found) const {
        constexpr double kRim = 1e-9;  // a cell on the edge of two quads belongs to both, never to none
        if (!(v >= -kRim && v <= 1.0 + kRim)) return have_one;
        const Node across = e_ + v * g_, rest = h - v * f_;
        const double u = std::abs(across.col) > std::abs(across.row) ? rest.col / across.col : rest.row / across.row;
        if (!(u >= -kRim && u <= 1.0 + kRim)) return have_one;
        const double z = a_.z + u * e_.z + v * f_.z + u * v * g_.z;
        if (have_one && !(z > found.z)) return true;
        found = {std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0), z};
        return true;
    }

    Node a_, e_, f_, g_;
};

/// Cell indices whose centres may lie between the smallest and the largest of four coordinates.
struct CellRange {
    int first = 0, last = -1;
};
CellRange cells_between(std::array<double, 4> at, int count) {
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    constexpr double kRim = 1e-6;
    if (!(*high >= 0.0) || !(*low <= count - 1)) return {};
    return {static_cast<int>(std::max(0.0, std::ceil(*low - kRim))),
            static_cast<int>(std::min(count - 1.0, std::floor(*high + kRim)))};
}

/// Gives the cells under one quad their image position.
void fill_quad(const NodeGrid& nodes, int first_line, int i, int j, OrthoLookup& lookup) {
    const Node &a = nodes.at(i, j), &b = nodes.at(i + 1, j), &c = nodes.at(i, j + 1), &d = nodes.at(i + 1, j + 1);
    if (!std::isfinite(a.col + a.row + a.z + b.col + b.row + b.z + c.col + c.row + c.z + d.col + d.row + d.z)) return;
    const CellRange cols = cells_between({a.col, b.col, c.col, d.col}, lookup.grid.cols);
    const CellRange rows = cells_between({a.row, b.row, c.row, d.row}, lookup.grid.rows);
    if (cols.first > cols.last || rows.first > rows.last) return;
    const Quad quad(a, b, c, d);
    const double sample = nodes.sample_of(i), line = first_line + nodes.line_of(j);
    const double width = nodes.sample_of(i + 1) - sample, height = first_line + nodes.line_of(j + 1) - line;
    Quad::Position p;
    for (int row = rows.first; row <= rows.last; ++row)
        for (int col = cols.first; col <= cols.last; ++col) {
            const std::size_t cell = lookup.grid.index(row, col);
            if (!quad.find(col, row, p) || static_cast<float>(p.z) <= lookup.ground_z_m[cell]) continue;
            lookup.sample[cell] = static_cast<float>(sample + p.u * width);
            lookup.line[cell] = static_cast<float>(line + p.v * height);
            lookup.ground_z_m[cell] = static_cast<float>(p.z);
        }
}

void check_lengths(int samples, int lines, std::initializer_list<std::size_t> lengths) {
    const auto pixels = static_cast<std::size_t>(std::max(samples, 0)) * static_cast<std::size_t>(std::max(lines, 0));
    for (const std::size_t length : lengths)
        if (length != pixels)
            throw input_error("ortho",
                              fmt::format("an image of {} x {} pixels, but an array of {}", samples, lines, length));
}

float bilinear(std::span<const float> plane, int samples, int lines, double sample, double line) {
    const double x = sample - 0.5, y = line - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    double sum = 0.0, weights = 0.0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const double w = std::abs(1 - i - (x - x0)) * std::abs(1 - j - (y - y0));
            const int column = std::clamp(x0 + i, 0, samples - 1), row = std::clamp(y0 + j, 0, lines - 1);
            const float value =
                plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(column)];
            if (std::isnan(value) || w == 0.0) continue;
            sum += w * value;
            weights += w;
        }
    return weights > 0.0 ? static_cast<float>(sum / weights) : kNoData;
}

float nearest_pixel(std::span<const float> plane, int samples, int lines, double sample, double line) {
    const int column = std::clamp(static_cast<int>(std::floor(sample)), 0, samples - 1);
    const int row = std::clamp(static_cast<int>(std::floor(line)), 0, lines - 1);
    return plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(column)];
}

}  // namespace

OrthoLookup ortho_lookup(const MapGrid& grid, int samples, int lines, std::span<const double> x_m,
                         std::span<const double> y_m, std::span<const double> z_m, const ScanLines& scans) {
    if (samples < 2 || lines < 2)
        throw input_error(
            "ortho", fmt::format("an image of {} x {} pixels has no neighbours to interpolate between", samples, lines));
    check_lengths(samples, lines, {x_m.size(), y_m.size(), z_m.size()});
    // Heights start at -infinity, so that the first ground found always wins; it becomes NaN where nothing came.
    constexpr float kNothing = -std::numeric_limits<float>::infinity();
    OrthoLookup lookup{grid, std::vector<float>(grid.size(), kNoData), std::vector<float>(grid.size(), kNoData),
                       std::vector<float>(grid.size(), kNothing)};
    for (int first = 0, end = 0; first < lines; first = end) {
        end = scans.end_of_scan(first, lines);
        if (end - first < 2) continue;  // a single line of a cut sweep has no neighbour
        const auto from = static_cast<std::size_t>(first) * static_cast<std::size_t>(samples);
        const auto count = static_cast<std::size_t>(end - first) * static_cast<std::size_t>(samples);
        const NodeGrid nodes(grid, samples, end - first, x_m.subspan(from, count), y_m.subspan(from, count),
                             z_m.subspan(from, count));
        for (int j = 0; j + 1 < nodes.rows(); ++j)
            for (int i = 0; i + 1 < nodes.cols(); ++i) fill_quad(nodes, first, i, j, lookup);
    }
    std::replace(lookup.ground_z_m.begin(), lookup.ground_z_m.end(), kNothing, kNoData);
    return lookup;
}

std::int64_t hide_unseen(OrthoLookup& lookup, std::span<const float> terrain_z_m, double tolerance_m) {
    if (terrain_z_m.size() != lookup.grid.size())
        throw input_error("ortho",
                          fmt::format("a grid of {} cells, but {} terrain heights", lookup.grid.size(), terrain_z_m.size()));
    std::int64_t removed = 0;
    for (std::size_t i = 0; i < terrain_z_m.size(); ++i) {
        if (!(std::abs(lookup.ground_z_m[i] - terrain_z_m[i]) > tolerance_m)) continue;
        lookup.sample[i] = lookup.line[i] = lookup.ground_z_m[i] = kNoData;
        ++removed;
    }
    return removed;
}

std::vector<float> heights_on(const MapGrid& grid, const Raster<float>& terrain_m) {
    const MapGrid& from = terrain_m.grid;
    std::vector<float> out(grid.size(), kNoData);
    for (int row = 0; row < grid.rows; ++row) {
        const double y = from.row_at(grid.y_centre_m(row));
        if (!(y >= 0.0 && y <= from.rows)) continue;
        for (int col = 0; col < grid.cols; ++col) {
            const double x = from.col_at(grid.x_centre_m(col));
            if (!(x >= 0.0 && x <= from.cols)) continue;
            out[grid.index(row, col)] = bilinear(terrain_m.values, from.cols, from.rows, x, y);
        }
    }
    return out;
}

std::vector<float> ortho_resample(const OrthoLookup& lookup, int samples, int lines, std::span<const float> plane,
                                  bool nearest) {
    check_lengths(samples, lines, {plane.size()});
    std::vector<float> out(lookup.grid.size(), kNoData);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double sample = lookup.sample[i], line = lookup.line[i];
        if (std::isnan(sample) || std::isnan(line)) continue;
        out[i] =
            nearest ? nearest_pixel(plane, samples, lines, sample, line) : bilinear(plane, samples, lines, sample, line);
    }
    return out;
}

MapGrid ortho_grid(const MapGrid& like, double cell_m, std::span<const double> x_m, std::span<const double> y_m) {
    if (!(cell_m > 0.0)) throw input_error("ortho", fmt::format("cell of {} m, expected more than 0", cell_m));
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double west = kInfinity, east = -kInfinity, south = kInfinity, north = -kInfinity;
    for (std::size_t i = 0; i < std::min(x_m.size(), y_m.size()); ++i) {
        if (!std::isfinite(x_m[i]) || !std::isfinite(y_m[i])) continue;
        west = std::min(west, x_m[i]);
        east = std::max(east, x_m[i]);
        south = std::min(south, y_m[i]);
        north = std::max(north, y_m[i]);
    }
    if (!(west <= east)) throw input_error("ortho", "no pixel of the image meets the ground");
    const double first_col = std::floor(west / cell_m), last_row = std::ceil(north / cell_m);
    const double cols = std::max(1.0, std::ceil(east / cell_m) - first_col),
                 rows = std::max(1.0, last_row - std::floor(south / cell_m));
    if (cols * rows > static_cast<double>(std::numeric_limits<int>::max()))
        throw input_error(
            "ortho", fmt::format("a cell of {} m would need {:.0f} x {:.0f} cells; take a larger cell", cell_m, cols, rows));
    return {static_cast<int>(cols), static_cast<int>(rows), first_col * cell_m, last_row * cell_m, cell_m, like.crs_wkt};
}

}  // namespace pyroscene::analysis
