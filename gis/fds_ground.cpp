#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/fds_index.h"
#include "gis/fire_model_files.h"

namespace pyroscene::gis {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kEven = 1e-3;  ///< of a cell: spacing may differ by so much

/// The files of the first label that the run has.
std::vector<FdsFile> files_of(const FdsIndex& index, const std::vector<std::string>& labels, const std::string& smv) {
    std::set<std::string> found;
    for (const auto& file : index.files) found.insert(file.label);
    for (const auto& label : labels) {
        std::vector<FdsFile> files;
        std::copy_if(index.files.begin(), index.files.end(), std::back_inserter(files),
                     [&](const FdsFile& f) { return f.label == label; });
        if (!files.empty()) return files;
    }
    throw input_error(smv, fmt::format("has no output of '{}'; it has {}", fmt::join(labels, "', '"),
                                       found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "))));
}

double spacing(const std::vector<double>& nodes, const std::string& subject) {
    const double step = (nodes.back() - nodes.front()) / static_cast<double>(nodes.size() - 1);
    for (std::size_t i = 1; i < nodes.size(); ++i)
        if (!(std::abs(nodes[i] - nodes[i - 1] - step) <= kEven * std::abs(step)))
            throw input_error(subject, fmt::format("has cells of unequal size ({:g} m beside {:g} m); expected one spacing",
                                                   nodes[i] - nodes[i - 1], step));
    return step;
}

/// The lattice of nodes of all meshes: one spacing, one origin.
struct Lattice {
    double west_m = std::numeric_limits<double>::infinity(), south_m = west_m, east_m = -west_m, north_m = -west_m;
    double dx_m = 0.0, dy_m = 0.0;

    void add(const FdsMesh& mesh, const std::string& subject) {
        if (mesh.x_m.empty() || mesh.y_m.empty()) throw input_error(subject, "has a mesh without PDIM or TRNX, TRNY");
        const double dx = spacing(mesh.x_m, subject), dy = spacing(mesh.y_m, subject);
        if (dx_m > 0.0 && (std::abs(dx - dx_m) > kEven * dx_m || std::abs(dy - dy_m) > kEven * dy_m))
            throw input_error(subject,
                              fmt::format("has meshes with cells of {:g} m and {:g} m; expected one size", dx_m, dx));
        dx_m = dx, dy_m = dy;
        west_m = std::min(west_m, mesh.x_m.front()), east_m = std::max(east_m, mesh.x_m.back());
        south_m = std::min(south_m, mesh.y_m.front()), north_m = std::max(north_m, mesh.y_m.back());
    }
    [[nodiscard]] int cols() const { return static_cast<int>(std::lround((east_m - west_m) / dx_m)) + 1; }
    [[nodiscard]] int rows() const { return static_cast<int>(std::lround((north_m - south_m) / dy_m)) + 1; }
};

/// Puts a patch where it belongs. Values of cells are stored with the node to their east and north; the first is of none.
void lay(const FdsPatch& patch, const FdsFile& file, const FdsMesh& mesh, const Lattice& lattice, MemoryRaster& out) {
    const int first = file.cell_centred ? 1 : 0;
    for (int j = patch.j_first + first; j <= patch.j_last; ++j)
        for (int i = patch.i_first + first; i <= patch.i_last; ++i) {
            if (i < 0 || j < 0 || i >= static_cast<int>(mesh.x_m.size()) || j >= static_cast<int>(mesh.y_m.size()))
                throw input_error(file.file.string(), fmt::format("has a node {}, {} beyond its mesh", i, j));
            const int col =
                static_cast<int>(std::lround((mesh.x_m[static_cast<std::size_t>(i)] - lattice.west_m) / lattice.dx_m));
            const int row =
                out.rows - 1 -
                static_cast<int>(std::lround((mesh.y_m[static_cast<std::size_t>(j)] - lattice.south_m) / lattice.dy_m));
            const auto from =
                static_cast<std::size_t>(j - patch.j_first) * static_cast<std::size_t>(patch.i_last - patch.i_first + 1) +
                static_cast<std::size_t>(i - patch.i_first);
            float& value = out.bands[0][static_cast<std::size_t>(row) * static_cast<std::size_t>(out.cols) +
                                        static_cast<std::size_t>(col)];
            value = std::fmin(value, patch.values[from]);
        }
}

}  // namespace

std::filesystem::path fds_ground_quantity(const std::filesystem::path& smv, const std::vector<std::string>& labels,
                                          const std::string& unit, const LocalPlacement& place) {
    constexpr float kNotReached = 9e5F;
    const auto subject = smv.string();
    const FdsIndex index = read_fds_index(smv);
    const auto files = files_of(index, labels, subject);
    Lattice lattice;
    for (const auto& mesh : index.meshes) lattice.add(mesh, subject);
    const bool cells = files.front().cell_centred;
    const double shift = cells ? 1.0 : 0.5;  // from the node that a value is stored with to the corner of its pixel
    MemoryRaster out{lattice.cols(),
                     lattice.rows(),
                     north_up(place.west_m + lattice.west_m - shift * lattice.dx_m,
                              place.south_m + lattice.north_m + (1.0 - shift) * lattice.dy_m, lattice.dx_m, lattice.dy_m),
                     parse_map_crs(place.crs, "crs of the FDS run").wkt,
                     unit,
                     {}};
    out.bands.emplace_back(static_cast<std::size_t>(out.cols) * static_cast<std::size_t>(out.rows), kNaN);
    bool any = false;
    for (const auto& file : files) {
        if (file.unit != unit)
            throw input_error(subject, fmt::format("'{}' is in '{}', expected '{}'", file.label, file.unit, unit));
        if (file.cell_centred != cells)
            throw input_error(subject,
                              fmt::format("'{}' is given at nodes and at cells; expected one of the two", file.label));
        for (const auto& patch : read_fds_patches(file)) {
            any = true;
            lay(patch, file, index.meshes[file.mesh], lattice, out);
        }
    }
    if (!any)
        throw input_error(subject,
                          fmt::format("'{}' has no horizontal slice and no surface that faces up", files.front().label));
    for (float& value : out.bands[0])
        if (value > kNotReached) value = kNaN;
    return keep_in_memory(
        "fds", fmt::format("{}|{}|{}|{}|{}", subject, files.front().label, place.crs, place.west_m, place.south_m), "ground",
        out);
}

}  // namespace pyroscene::gis
