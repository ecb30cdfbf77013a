#include "fire/flame_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "fire/bricks.h"

namespace pyroscene::fire {
namespace {

constexpr int kEdge = FlameField::kBrickEdge;
constexpr double kMaximumBrickColumns = 5e7;  ///< 600 MB of look-up table

// Bits of a key: brick column above, then the height of the brick, then the voxel in the brick.
constexpr int kVoxelBits = 9, kHeightBits = 22;
static_assert(FlameField::kBrickVoxels == 1 << kVoxelBits);

std::size_t voxel_of(std::uint64_t key) noexcept { return key & ((std::uint64_t{1} << kVoxelBits) - 1); }
int height_of(std::uint64_t key) noexcept {
    return static_cast<int>((key >> kVoxelBits) & ((std::uint64_t{1} << kHeightBits) - 1));
}
std::size_t column_of(std::uint64_t key) noexcept { return key >> (kVoxelBits + kHeightBits); }

bool comes_before(const Contribution& a, const Contribution& b) noexcept {
    if (a.key != b.key) return a.key < b.key;
    return a.fill != b.fill ? a.fill < b.fill : a.temperature_K < b.temperature_K;
}

/// Lays out the brick columns: one pass over sorted contributions, so that the bricks can be allocated at once.
std::size_t lay_out_columns(FlameField& field, const std::vector<Contribution>& sorted) {
    std::size_t bricks = 0;
    for (std::size_t n = 0; n < sorted.size();) {
        const std::size_t column = column_of(sorted[n].key);
        std::size_t end = n;
        while (end < sorted.size() && column_of(sorted[end].key) == column) ++end;
        const int lowest = height_of(sorted[n].key), highest = height_of(sorted[end - 1].key);
        field.columns[column] = {static_cast<std::int32_t>(bricks), lowest, highest - lowest + 1};
        bricks += static_cast<std::size_t>(highest - lowest + 1);
        n = end;
    }
    if (bricks > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
        throw input_error("flame.voxel_m", fmt::format("makes {} bricks of flame; use larger voxels", bricks));
    return bricks;
}

template <class Visitor>
void for_each_occupied(const FlameField& field, Visitor&& visit) {
    for (const auto& brick : field.bricks)
        for (std::size_t v = 0; v < brick.fill.size(); ++v)
            if (brick.fill[v] > 0.0F) visit(brick.fill[v], brick.temperature_K[v]);
}

}  // namespace

void check_grid(const VoxelGrid& grid) {
    const bool sized = grid.dx_m > 0.0 && grid.dy_m > 0.0 && grid.dz_m > 0.0 && grid.nx > 0 && grid.ny > 0;
    if (!sized)
        throw input_error("flame.voxel_m", fmt::format("{} x {} voxels of {} x {} x {} m, all must be above 0", grid.nx,
                                                       grid.ny, grid.dx_m, grid.dy_m, grid.dz_m));
    if (static_cast<double>(bricks_across(grid.nx)) * bricks_across(grid.ny) > kMaximumBrickColumns)
        throw input_error("flame.voxel_m", fmt::format("{} x {} voxels of {} x {} m cover the flames; use larger voxels",
                                                       grid.nx, grid.ny, grid.dx_m, grid.dy_m));
}

std::uint64_t contribution_key(const VoxelGrid& grid, int i, int j, int k) {
    const auto column = static_cast<std::uint64_t>(j / kEdge) * static_cast<std::uint64_t>(bricks_across(grid.nx)) +
                        static_cast<std::uint64_t>(i / kEdge);
    const auto height = static_cast<std::uint64_t>(k / kEdge);
    if (height >> kHeightBits != 0)
        throw input_error("flame.voxel_m", fmt::format("height {} m makes too many layers; use larger voxels", grid.dz_m));
    const auto voxel = static_cast<std::uint64_t>(((k % kEdge) * kEdge + j % kEdge) * kEdge + i % kEdge);
    return (column << (kVoxelBits + kHeightBits)) | (height << kVoxelBits) | voxel;
}

FlameField merge_into_bricks(const VoxelGrid& grid, std::vector<Contribution> contributions) {
    std::sort(contributions.begin(), contributions.end(), comes_before);
    FlameField field;
    field.grid = grid;
    field.brick_cols = bricks_across(grid.nx);
    field.brick_rows = bricks_across(grid.ny);
    field.columns.resize(static_cast<std::size_t>(field.brick_cols) * static_cast<std::size_t>(field.brick_rows));
    field.bricks.resize(lay_out_columns(field, contributions), FlameField::Brick{});
    for (std::size_t n = 0; n < contributions.size();) {
        const std::uint64_t key = contributions[n].key;
        double fill = 0.0, fill_T5 = 0.0;
        const float first_K = contributions[n].temperature_K;
        bool isothermal = true;
        for (; n < contributions.size() && contributions[n].key == key; ++n) {
            const double T_K = contributions[n].temperature_K, T2 = T_K * T_K;
            fill += contributions[n].fill;
            fill_T5 += static_cast<double>(contributions[n].fill) * T2 * T2 * T_K;
            isothermal = isothermal && contributions[n].temperature_K == first_K;
        }
        const auto& column = field.columns[column_of(key)];
        auto& brick = field.bricks[static_cast<std::size_t>(column.first_brick + height_of(key) - column.z_begin)];
        brick.fill[voxel_of(key)] = static_cast<float>(fill);
        brick.temperature_K[voxel_of(key)] = isothermal ? first_K : static_cast<float>(std::pow(fill_T5 / fill, 0.2));
    }
    return field;
}

FlameField make_flame_field(const VoxelGrid& grid, std::span<const FlameVoxel> voxels) {
    check_grid(grid);
    std::vector<Contribution> contributions;
    contributions.reserve(voxels.size());
    for (const FlameVoxel& v : voxels) {
        if (v.i < 0 || v.i >= grid.nx || v.j < 0 || v.j >= grid.ny || v.k < 0)
            throw input_error("flame voxel", fmt::format("({}, {}, {}) lies outside the {} x {} columns of the grid", v.i,
                                                         v.j, v.k, grid.nx, grid.ny));
        if (!(v.fill >= 0.0F) || !std::isfinite(v.fill) || !std::isfinite(v.temperature_K))
            throw input_error("flame voxel",
                              fmt::format("({}, {}, {}) has fill {} and {} K", v.i, v.j, v.k, v.fill, v.temperature_K));
        if (v.fill > 0.0F) contributions.push_back({contribution_key(grid, v.i, v.j, v.k), v.fill, v.temperature_K});
    }
    return merge_into_bricks(grid, std::move(contributions));
}

FlameVoxel voxel_at(const FlameField& field, int i, int j, int k) noexcept {
    FlameVoxel out{i, j, k, 0.0F, 0.0F};
    if (i < 0 || j < 0 || k < 0 || i >= field.grid.nx || j >= field.grid.ny || field.columns.empty()) return out;
    const auto& column = field.columns[static_cast<std::size_t>(j / kEdge) * static_cast<std::size_t>(field.brick_cols) +
                                       static_cast<std::size_t>(i / kEdge)];
    const int brick = k / kEdge - column.z_begin;
    if (brick < 0 || brick >= column.brick_count) return out;
    const auto& b = field.bricks[static_cast<std::size_t>(column.first_brick + brick)];
    const auto voxel = static_cast<std::size_t>(((k % kEdge) * kEdge + j % kEdge) * kEdge + i % kEdge);
    out.fill = b.fill[voxel];
    out.temperature_K = b.temperature_K[voxel];
    return out;
}

double FlameField::emissive_volume_m3() const noexcept {
    double fill = 0.0;
    for_each_occupied(*this, [&](float f, float) { fill += f; });
    return fill * grid.dx_m * grid.dy_m * grid.dz_m;
}

std::array<double, 2> FlameField::z_range_m() const noexcept {
    if (empty()) return {0.0, 0.0};
    int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
    for (const auto& column : columns) {
        if (column.brick_count == 0) continue;
        lowest = std::min(lowest, column.z_begin);
        highest = std::max(highest, column.z_begin + column.brick_count);
    }
    return {grid.corner_m.z + lowest * kBrickEdge * grid.dz_m, grid.corner_m.z + highest * kBrickEdge * grid.dz_m};
}

std::array<double, 2> FlameField::temperature_range_K() const noexcept {
    if (empty()) return {0.0, 0.0};
    double lowest = std::numeric_limits<double>::max(), highest = 0.0;
    for_each_occupied(*this, [&](float, float T_K) {
        lowest = std::min(lowest, static_cast<double>(T_K));
        highest = std::max(highest, static_cast<double>(T_K));
    });
    return {lowest, highest};
}

double FlameField::emission_mean_temperature_K() const noexcept {
    double weight = 0.0, sum_K = 0.0;
    for_each_occupied(*this, [&](float fill, float T_K) {
        const double emission = static_cast<double>(fill) * T_K * T_K * T_K * T_K;
        weight += emission;
        sum_K += emission * static_cast<double>(T_K);
    });
    return weight > 0.0 ? sum_K / weight : 0.0;
}

}  // namespace pyroscene::fire
