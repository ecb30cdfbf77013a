#include "gis/fds_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

constexpr std::size_t kLabelLength = 30;

std::size_t nodes_along(const std::array<int, 6>& box, std::size_t axis) {
    return static_cast<std::size_t>(box[2 * axis + 1] - box[2 * axis] + 1);
}

/// Height that a node stands for, or the cell below it: the trapezoidal rule, the cell's own height.
double height_m(const std::vector<double>& z_m, int k, int first, int last, bool cell_centred) {
    const auto at = [&](int n) { return z_m.at(static_cast<std::size_t>(n)); };
    if (cell_centred) return k > first ? at(k) - at(k - 1) : 0.0;
    return 0.5 * (at(std::min(k + 1, last)) - at(std::max(k - 1, first)));
}

}  // namespace

FdsReader::FdsReader(const FdsFile& file, const FdsMesh& mesh, bool volume)
    : mesh_(mesh), records_(file.file), cell_centred_(file.cell_centred) {
    constexpr int kUp = 3;
    geometry_ = file.kind == FdsFile::Kind::Geometry;
    if (geometry_) {
        for (int i = 0; i < 2; ++i) (void)records_.integers(1);  // byte order, version
        read_faces(file);
        return;
    }
    for (int i = 0; i < 3; ++i) (void)records_.text(kLabelLength);
    const auto add = [&](const std::vector<std::int32_t>& numbers, bool wanted) {
        Block block{{}, wanted};
        std::copy_n(numbers.begin(), block.box.size(), block.box.begin());
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (block.box[2 * axis] < 0 || block.box[2 * axis + 1] < block.box[2 * axis] ||
                block.box[2 * axis + 1] >= static_cast<int>((axis == 0   ? mesh.x_m
                                                             : axis == 1 ? mesh.y_m
                                                                         : mesh.z_m)
                                                                .size()))
                throw input_error(file.file.string(), fmt::format("has nodes {} to {} beyond its mesh", block.box[2 * axis],
                                                                  block.box[2 * axis + 1]));
        blocks_.push_back(block);
    };
    if (file.kind == FdsFile::Kind::Slice) {
        const auto box = records_.integers(6);
        add(box, (box[4] != box[5]) == volume && box[0] != box[1] && box[2] != box[3]);
        return;
    }
    const int count = records_.integers(1)[0];
    for (int i = 0; i < count; ++i) {
        const auto numbers = records_.integers(9);  // box, orientation, obstacle, mesh
        add(numbers, numbers[6] == kUp);
    }
}

bool FdsReader::on_ground() const noexcept {
    return !faces_.empty() || std::any_of(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.wanted; });
}

/// Vertices and triangles of cut cells (.gbf, since FDS 6.10 .gcf): byte order, version, 3 numbers, a time, counts, x y z, corners.
void FdsReader::read_faces(const FdsFile& file) {
    FortranRecords records(file.geometry);
    for (int i = 0; i < 2; ++i) (void)records.integers(1);
    (void)records.integers(3);
    (void)records.floats(1);
    const auto counts = records.integers(3);
    if (counts[0] <= 0 || counts[1] <= 0) return;
    const auto xyz = records.floats(3 * static_cast<std::size_t>(counts[0]));
    const auto corners = records.integers(3 * static_cast<std::size_t>(counts[1]));
    for (std::size_t f = 0; f < corners.size(); f += 3) {
        FdsFace face;
        std::array<double, 3> z_m{};
        for (std::size_t c = 0; c < 3; ++c) {
            const int vertex = corners[f + c] - 1;
            if (vertex < 0 || vertex >= counts[0])
                throw input_error(file.geometry.string(),
                                  fmt::format("has a triangle with corner {}, but {} vertices", vertex + 1, counts[0]));
            const auto v = 3 * static_cast<std::size_t>(vertex);
            face.x_m[c] = xyz[v], face.y_m[c] = xyz[v + 1], z_m[c] = xyz[v + 2];
        }
        const double ax = face.x_m[1] - face.x_m[0], ay = face.y_m[1] - face.y_m[0], az = z_m[1] - z_m[0],
                     bx = face.x_m[2] - face.x_m[0], by = face.y_m[2] - face.y_m[0], bz = z_m[2] - z_m[0];
        const double up = std::abs(ax * by - ay * bx), area = std::hypot(ay * bz - az * by, az * bx - ax * bz, up);
        face.seen_from_above = area > 0.0 ? up / area : 0.0;
        faces_.push_back(face);
    }
}

bool FdsReader::next() {
    if (records_.at_end()) return false;
    time_s_ = records_.floats(1)[0];
    if (geometry_) {
        const auto counts = records_.integers(4);
        if (static_cast<std::size_t>(std::max(0, counts[3])) != faces_.size())
            throw input_error(records_.path(),
                              fmt::format("has {} values, but its geometry {} triangles", counts[3], faces_.size()));
        if (!faces_.empty()) face_values_ = records_.floats(faces_.size());
        return true;
    }
    patches_.clear();
    for (const auto& block : blocks_) {
        auto values = records_.floats(nodes_along(block.box, 0) * nodes_along(block.box, 1) * nodes_along(block.box, 2));
        if (block.wanted) patches_.push_back(patch_of(block, std::move(values)));
    }
    return true;
}

FdsPatch FdsReader::patch_of(const Block& block, std::vector<float> values) const {
    const auto& b = block.box;
    FdsPatch patch{b[0], b[1], b[2], b[3], {}};
    if (b[4] == b[5]) {
        patch.values = std::move(values);
        return patch;
    }
    const std::size_t layer = nodes_along(b, 0) * nodes_along(b, 1);
    patch.values.assign(layer, 0.0F);
    for (int k = b[4]; k <= b[5]; ++k) {
        const double dz_m = height_m(mesh_.z_m, k, b[4], b[5], cell_centred_);
        const std::size_t start = static_cast<std::size_t>(k - b[4]) * layer;
        for (std::size_t i = 0; i < layer; ++i) patch.values[i] += static_cast<float>(dz_m * values[start + i]);
    }
    return patch;
}

}  // namespace pyroscene::gis
