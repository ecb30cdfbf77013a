#include "gis/fds_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kSame = 1e-3;  ///< of a cell: nearer than this is the same place

double smallest_step(const std::vector<double>& nodes_m) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < nodes_m.size(); ++i) least = std::min(least, nodes_m[i] - nodes_m[i - 1]);
    return least;
}

/// Start, step and number of cells of a line over all meshes, on the nodes of the finest.
struct Line {
    double start_m = 0.0, step_m = 0.0;
    int cells = 0;
};
Line line_over(const std::vector<FdsMesh>& meshes, std::vector<double> FdsMesh::*axis, const std::string& subject) {
    Line line{0.0, std::numeric_limits<double>::infinity(), 0};
    double first = line.step_m, last = -line.step_m, finest = 0.0;
    for (const auto& mesh : meshes) {
        const auto& nodes_m = mesh.*axis;
        if (nodes_m.size() < 2) throw input_error(subject, "has a mesh without PDIM or TRNX, TRNY");
        const double step = smallest_step(nodes_m);
        if (!(step > 0.0)) throw input_error(subject, "has a mesh whose nodes do not ascend");
        if (step < line.step_m * (1.0 - kSame)) line.step_m = step, finest = nodes_m.front();
        first = std::min(first, nodes_m.front()), last = std::max(last, nodes_m.back());
    }
    constexpr double kMost = 30000.0;
    if (!((last - first) / line.step_m < kMost))
        throw input_error(subject, fmt::format("spans {:g} m with cells of {:g} m; expected less than {:g} of them",
                                               last - first, line.step_m, kMost));
    line.start_m = finest - line.step_m * std::ceil((finest - first) / line.step_m - kSame);
    line.cells = static_cast<int>(std::ceil((last - line.start_m) / line.step_m - kSame));
    return line;
}

double twice_area(double ax, double ay, double bx, double by, double cx, double cy) {
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

bool holds(const FdsFace& f, double x, double y) {
    const double a = twice_area(f.x_m[0], f.y_m[0], f.x_m[1], f.y_m[1], x, y),
                 b = twice_area(f.x_m[1], f.y_m[1], f.x_m[2], f.y_m[2], x, y),
                 c = twice_area(f.x_m[2], f.y_m[2], f.x_m[0], f.y_m[0], x, y);
    return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

}  // namespace

FdsLattice::FdsLattice(const std::vector<FdsMesh>& meshes, bool cells, const std::string& subject) : cells_(cells) {
    const auto x = line_over(meshes, &FdsMesh::x_m, subject), y = line_over(meshes, &FdsMesh::y_m, subject);
    cols_ = x.cells + (cells ? 0 : 1), rows_ = y.cells + (cells ? 0 : 1);
    west_m_ = x.start_m, south_m_ = y.start_m, dx_m_ = x.step_m, dy_m_ = y.step_m;
}

FdsLattice::Moment FdsLattice::moment() const {
    return {std::vector<float>(size(), kNaN), std::vector<float>(size(), std::numeric_limits<float>::infinity())};
}

void FdsLattice::lay(const FdsReader& reader, const FdsFile& file, const FdsMesh& mesh, Rule rule, float most,
                     Moment& into) const {
    for (const auto& patch : reader.patches()) lay_patch(patch, file, mesh, rule, most, into);
    if (!reader.faces().empty()) lay_faces(reader, mesh, rule, most, into);
}

void FdsLattice::put(float value, double cell_m2, std::size_t pixel, Rule rule, Moment& into) const {
    float &known = into.values[pixel], &known_m2 = into.cell_m2[pixel];
    const auto own_m2 = static_cast<float>(cell_m2);
    if (own_m2 > known_m2 * (1.0F + static_cast<float>(kSame))) return;
    if (own_m2 < known_m2 * (1.0F - static_cast<float>(kSame)) || std::isnan(known))
        known = value;
    else if (!std::isnan(value))
        known = rule == Rule::Smallest ? std::min(known, value) : std::max(known, value);
    known_m2 = own_m2;
}

std::vector<FdsLattice::Spot> FdsLattice::spots(const std::vector<double>& nodes_m, int first, int last, double start_m,
                                                double step_m, int count) const {
    std::vector<Spot> out(static_cast<std::size_t>(count));
    const auto node = [&](int i) { return nodes_m[static_cast<std::size_t>(i)]; };
    const double slack = kSame * step_m;
    for (int c = 0; c < count; ++c) {
        const double at = start_m + (c + (cells_ ? 0.5 : 0.0)) * step_m;
        if (at < node(first) - slack || at > node(last) + slack) continue;
        int i = first;
        while (i + 2 <= last && node(i + 1) <= at + slack) ++i;
        const double share = (at - node(i)) / (node(i + 1) - node(i));
        out[static_cast<std::size_t>(c)] = {i, share < kSame ? 0.0 : share > 1.0 - kSame ? 1.0 : share};
    }
    return out;
}

void FdsLattice::lay_patch(const FdsPatch& patch, const FdsFile& file, const FdsMesh& mesh, Rule rule, float most,
                           Moment& into) const {
    if (patch.i_first == patch.i_last || patch.j_first == patch.j_last) return;
    const auto columns = spots(mesh.x_m, patch.i_first, patch.i_last, west_m_, dx_m_, cols_),
               lines = spots(mesh.y_m, patch.j_first, patch.j_last, south_m_, dy_m_, rows_);
    const auto width = static_cast<std::size_t>(patch.i_last - patch.i_first + 1);
    const auto value = [&](int i, int j) {
        const float v =
            patch.values[static_cast<std::size_t>(j - patch.j_first) * width + static_cast<std::size_t>(i - patch.i_first)];
        return v > most ? kNaN : v;
    };
    const double cell_m2 = smallest_step(mesh.x_m) * smallest_step(mesh.y_m);
    // A slice stores a cell with the node to its east and north, a boundary file with the one to its west and south.
    const int cell = file.kind == FdsFile::Kind::Slice ? 1 : 0;
    for (int row = 0; row < rows_; ++row) {
        const Spot& y = lines[static_cast<std::size_t>(row)];
        if (y.node < 0) continue;
        for (int col = 0; col < cols_; ++col) {
            const Spot& x = columns[static_cast<std::size_t>(col)];
            if (x.node < 0) continue;
            float found = kNaN;
            if (cells_) {
                found = value(x.node + cell, y.node + cell);
            } else if (!std::isnan(value(x.node + (x.share > 0.5 ? 1 : 0), y.node + (y.share > 0.5 ? 1 : 0)))) {
                double sum = 0.0, weights = 0.0;  // neighbours without a value drop out
                for (const int di : {0, 1})
                    for (const int dj : {0, 1}) {
                        const double w = (di == 1 ? x.share : 1.0 - x.share) * (dj == 1 ? y.share : 1.0 - y.share);
                        const float v = w > 0.0 ? value(x.node + di, y.node + dj) : kNaN;
                        if (!std::isnan(v)) sum += w * v, weights += w;
                    }
                found = static_cast<float>(sum / weights);
            }
            const auto pixel =
                static_cast<std::size_t>(rows_ - 1 - row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col);
            put(found, cell_m2, pixel, rule, into);
        }
    }
}

void FdsLattice::lay_faces(const FdsReader& reader, const FdsMesh& mesh, Rule rule, float most, Moment& into) const {
    constexpr int kFine = 3;  // places along the side of a pixel
    constexpr double kUpright = 1e-3;
    std::vector<double> sum(size(), 0.0);
    std::vector<int> places(size(), 0);
    const double west = west_m(), south = north_m() - rows_ * dy_m_;
    for (std::size_t f = 0; f < reader.faces().size(); ++f) {
        const auto& face = reader.faces()[f];
        const float stored = reader.face_values()[f];
        if (face.seen_from_above < kUpright || stored > most || std::isnan(stored)) continue;
        const double value = rule == Rule::Largest ? stored / face.seen_from_above : stored;
        const auto [x0, x1] = std::minmax_element(face.x_m.begin(), face.x_m.end());
        const auto [y0, y1] = std::minmax_element(face.y_m.begin(), face.y_m.end());
        const int first_col = std::max(0, static_cast<int>(std::floor((*x0 - west) / dx_m_))),
                  last_col = std::min(cols_ - 1, static_cast<int>(std::floor((*x1 - west) / dx_m_))),
                  first_row = std::max(0, static_cast<int>(std::floor((*y0 - south) / dy_m_))),
                  last_row = std::min(rows_ - 1, static_cast<int>(std::floor((*y1 - south) / dy_m_)));
        for (int row = first_row; row <= last_row; ++row)
            for (int col = first_col; col <= last_col; ++col)
                for (int k = 0; k < kFine * kFine; ++k) {
                    const double x = west + (col + (k % kFine + 0.5) / kFine) * dx_m_,
                                 y = south + (row + (k / kFine + 0.5) / kFine) * dy_m_;
                    if (!holds(face, x, y)) continue;
                    const auto pixel = static_cast<std::size_t>(rows_ - 1 - row) * static_cast<std::size_t>(cols_) +
                                       static_cast<std::size_t>(col);
                    sum[pixel] += value;
                    ++places[pixel];
                }
    }
    const double own_m2 = smallest_step(mesh.x_m) * smallest_step(mesh.y_m);
    for (std::size_t i = 0; i < size(); ++i)
        if (places[i] > 0) put(static_cast<float>(sum[i] / places[i]), own_m2, i, rule, into);
}

}  // namespace pyroscene::gis
