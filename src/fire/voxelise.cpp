#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "fire/bricks.h"
#include "fire/flame_field.h"
#include "fire/sampling.h"

namespace pyroscene::fire {
namespace {

constexpr double kMaximumTilt_rad = 89.0 * kDegree_rad;
/// Contributions that a run may hold at once; 16 bytes each.
constexpr double kMaximumContributions = 1e8;
/// Overlaps below this part of the column's edge are rounding at a voxel face, not flame.
constexpr double kSliver = 1e-9;

/// Voxels from the zero of the scene frame, so that the lattices of different frames coincide.
struct Lattice {
    double dx_m, dy_m, dz_m;
    std::int64_t i0 = 0, j0 = 0, k0 = 0;
};

/// Horizontal place of a column's square at one height.
struct Square {
    double west_m, south_m, width_m;
};

/// A column with what its cuts need.
struct Prism {
    const FlameColumn& column;
    double low_m, high_m;     ///< z of its ends, scene frame
    double shift_x, shift_y;  ///< horizontal shift per metre of height

    explicit Prism(const FlameColumn& c)
        : column(c),
          low_m(c.z_m + c.bottom_m),
          high_m(c.z_m + c.top_m),
          shift_x(std::tan(c.tilt_rad) * std::sin(c.azimuth_rad)),
          shift_y(std::tan(c.tilt_rad) * std::cos(c.azimuth_rad)) {}

    [[nodiscard]] Square square_at(double z_m) const noexcept {
        const double above_base_m = z_m - column.z_m;
        return {column.x_m + shift_x * above_base_m - 0.5 * column.width_m,
                column.y_m + shift_y * above_base_m - 0.5 * column.width_m, column.width_m};
    }
    [[nodiscard]] bool is_empty() const noexcept {
        return !(high_m > low_m && column.width_m > 0.0 && column.area_fraction > 0.0);
    }
};

void check(const FlameColumn& c) {
    const bool finite = std::isfinite(c.x_m) && std::isfinite(c.y_m) && std::isfinite(c.z_m) && std::isfinite(c.top_m);
    if (!finite || !(c.tilt_rad >= 0.0 && c.tilt_rad <= kMaximumTilt_rad))
        throw input_error("flame column",
                          fmt::format("at x {} y {} z {} m with top {} m and tilt {} rad cannot be cut into voxels", c.x_m,
                                      c.y_m, c.z_m, c.top_m, c.tilt_rad));
}

std::int64_t cell_of(double place_m, double size_m) noexcept {
    return static_cast<std::int64_t>(std::floor(place_m / size_m));
}

/// Parts of [from, from + width] that lie in each lattice interval, as lengths; the first interval is `first`.
struct Overlaps {
    std::int64_t first = 0;
    std::vector<double> length_m;

    void cut(double from_m, double width_m, double size_m) {
        const double to_m = from_m + width_m;
        first = cell_of(from_m, size_m);
        const std::int64_t last = std::max(first, cell_of(to_m, size_m));
        length_m.clear();
        for (std::int64_t i = first; i <= last; ++i) {
            const double from_i = std::max(from_m, static_cast<double>(i) * size_m);
            const double to_i = std::min(to_m, static_cast<double>(i + 1) * size_m);
            length_m.push_back(to_i - from_i > kSliver * width_m ? to_i - from_i : 0.0);
        }
    }
};

/// Box of lattice indices, both ends included.
struct Extent {
    std::int64_t i_low = std::numeric_limits<std::int64_t>::max(), i_high = std::numeric_limits<std::int64_t>::min();
    std::int64_t j_low = i_low, j_high = i_high, k_low = i_low, k_high = i_high;

    void include(const Square& s, const Lattice& lattice) noexcept {
        i_low = std::min(i_low, cell_of(s.west_m, lattice.dx_m));
        i_high = std::max(i_high, cell_of(s.west_m + s.width_m, lattice.dx_m));
        j_low = std::min(j_low, cell_of(s.south_m, lattice.dy_m));
        j_high = std::max(j_high, cell_of(s.south_m + s.width_m, lattice.dy_m));
    }
};

/// Extent of all columns and, by way of check, an upper estimate of the work.
Extent extent_of(std::span<const FlameColumn> columns, const Lattice& lattice) {
    Extent all;
    double contributions = 0.0;
    for (const FlameColumn& c : columns) {
        check(c);
        const Prism prism(c);
        if (prism.is_empty()) continue;
        all.include(prism.square_at(prism.low_m), lattice);
        all.include(prism.square_at(prism.high_m), lattice);
        all.k_low = std::min(all.k_low, cell_of(prism.low_m, lattice.dz_m));
        all.k_high = std::max(all.k_high, cell_of(prism.high_m, lattice.dz_m));
        const double layers = std::ceil((prism.high_m - prism.low_m) / lattice.dz_m);
        const double layer_m = std::min(lattice.dz_m, prism.high_m - prism.low_m);
        contributions += layers * ((c.width_m + std::abs(prism.shift_x) * layer_m) / lattice.dx_m + 1.0) *
                         ((c.width_m + std::abs(prism.shift_y) * layer_m) / lattice.dy_m + 1.0);
    }
    if (contributions > kMaximumContributions)
        throw input_error("flame.voxel_m",
                          fmt::format("{} x {} x {} m cut the flames into {:.2g} pieces, {:.0e} are possible; use "
                                      "larger voxels",
                                      lattice.dx_m, lattice.dy_m, lattice.dz_m, contributions, kMaximumContributions));
    return all;
}

/// The lowest layer of each column of voxels that stands clear of the ground.
class ClearLayers {
public:
    ClearLayers(const Lattice& lattice, const FlameGround& ground) : lattice_(lattice), ground_(ground) {}

    std::int64_t lowest(std::int64_t i, std::int64_t j) {
        const auto key = (static_cast<std::uint64_t>(i) << 32U) ^ static_cast<std::uint32_t>(j);
        const auto [place, is_new] = known_.try_emplace(key, 0);
        if (is_new) place->second = find(i, j);
        return place->second;
    }

private:
    /// Judged at the corners of the column and in steps of at most half of it and half a cell between them.
    [[nodiscard]] std::int64_t find(std::int64_t i, std::int64_t j) const {
        constexpr double kBuried = 0.02;  // of a voxel's height
        const MapGrid& grid = ground_.terrain_m.grid;
        const double largest_m = std::max(lattice_.dx_m, lattice_.dy_m);
        const int steps = std::max(2, static_cast<int>(std::ceil(2.0 * largest_m / grid.cell_m)));
        double highest_m = -std::numeric_limits<double>::infinity();
        for (int b = 0; b <= steps; ++b)
            for (int a = 0; a <= steps; ++a) {
                const double x_m = (static_cast<double>(i) + static_cast<double>(a) / steps) * lattice_.dx_m,
                             y_m = (static_cast<double>(j) + static_cast<double>(b) / steps) * lattice_.dy_m;
                const double z_m = bilinear_or_own(ground_.terrain_m, grid.col_at(x_m + ground_.scene_origin.x),
                                                   grid.row_at(y_m + ground_.scene_origin.y));
                if (z_m > highest_m) highest_m = z_m;
            }
        if (!std::isfinite(highest_m)) return std::numeric_limits<std::int64_t>::min();
        return static_cast<std::int64_t>(std::ceil(highest_m / lattice_.dz_m - kBuried));
    }

    Lattice lattice_;
    FlameGround ground_;
    std::unordered_map<std::uint64_t, std::int64_t> known_;
};

/// Cuts columns layer by layer into contributions of whole voxels.
class Cutter {
public:
    Cutter(const Lattice& lattice, const VoxelGrid& grid, const TemperatureProfile& profile, const FlameGround* ground)
        : lattice_(lattice), grid_(grid), profile_(profile) {
        if (ground != nullptr) clear_.emplace(lattice, *ground);
    }

    void add(const FlameColumn& c) {
        const Prism prism(c);
        if (prism.is_empty()) return;
        const std::int64_t last = cell_of(prism.high_m, lattice_.dz_m);
        for (std::int64_t k = cell_of(prism.low_m, lattice_.dz_m); k <= last; ++k) {
            const double low_m = std::max(prism.low_m, static_cast<double>(k) * lattice_.dz_m);
            const double high_m = std::min(prism.high_m, static_cast<double>(k + 1) * lattice_.dz_m);
            if (high_m - low_m > kSliver * (prism.high_m - prism.low_m)) add_layer(prism, low_m, high_m, k);
        }
    }

    std::vector<Contribution> take() { return std::move(contributions_); }

private:
    /// One layer of one column. Slabs thin enough to shift by at most half a voxel follow the shear.
    void add_layer(const Prism& prism, double low_m, double high_m, std::int64_t k) {
        const double dz_m = high_m - low_m;
        const double halves =
            std::max(std::abs(prism.shift_x) / lattice_.dx_m, std::abs(prism.shift_y) / lattice_.dy_m) * 2.0 * dz_m;
        const int slabs = std::max(1, static_cast<int>(std::ceil(halves)));
        Extent window;
        window.include(prism.square_at(low_m), lattice_);
        window.include(prism.square_at(high_m), lattice_);
        const auto cols = static_cast<std::size_t>(window.i_high - window.i_low + 1);
        const auto rows = static_cast<std::size_t>(window.j_high - window.j_low + 1);
        layer_m3_.assign(cols * rows, 0.0);
        const double slab_m = dz_m / slabs;
        for (int s = 0; s < slabs; ++s) {
            const Square square = prism.square_at(low_m + (s + 0.5) * slab_m);
            x_.cut(square.west_m, square.width_m, lattice_.dx_m);
            y_.cut(square.south_m, square.width_m, lattice_.dy_m);
            for (std::size_t j = 0; j < y_.length_m.size(); ++j) {
                double* line = &layer_m3_[(static_cast<std::size_t>(y_.first - window.j_low) + j) * cols +
                                          static_cast<std::size_t>(x_.first - window.i_low)];
                for (std::size_t i = 0; i < x_.length_m.size(); ++i) line[i] += x_.length_m[i] * y_.length_m[j] * slab_m;
            }
        }
        emit(prism.column, window, k, temperature_K(prism, low_m, high_m));
    }

    /// One temperature for the layer that emits like the profile within it.
    [[nodiscard]] float temperature_K(const Prism& prism, double low_m, double high_m) const noexcept {
        const FlameColumn& c = prism.column;
        if (!(c.flame_m > 0.0)) return static_cast<float>(c.temperature_K);
        return static_cast<float>(
            profile_.emission_mean_K(c.temperature_K, (low_m - c.z_m) / c.flame_m, (high_m - c.z_m) / c.flame_m));
    }

    void emit(const FlameColumn& column, const Extent& window, std::int64_t k, float T_K) {
        const double per_m3 = column.area_fraction / (lattice_.dx_m * lattice_.dy_m * lattice_.dz_m);
        std::size_t n = 0;
        for (std::int64_t j = window.j_low; j <= window.j_high; ++j) {
            for (std::int64_t i = window.i_low; i <= window.i_high; ++i, ++n) {
                const auto fill = static_cast<float>(layer_m3_[n] * per_m3);
                if (!(fill > 0.0F)) continue;
                const std::int64_t layer = clear_ ? std::max(k, clear_->lowest(i, j)) : k;
                const auto key = contribution_key(grid_, static_cast<int>(i - lattice_.i0),
                                                  static_cast<int>(j - lattice_.j0), static_cast<int>(layer - lattice_.k0));
                contributions_.push_back({key, fill, T_K});
            }
        }
    }

    Lattice lattice_;
    VoxelGrid grid_;
    TemperatureProfile profile_;
    std::optional<ClearLayers> clear_;
    Overlaps x_, y_;
    std::vector<double> layer_m3_;
    std::vector<Contribution> contributions_;
};

}  // namespace

FlameField voxelise(std::span<const FlameColumn> columns, const FlameParameters& flame, const FlameGround* ground) {
    const auto [dx_m, dy_m, dz_m] = flame.voxel_m;
    if (!(dx_m > 0.0 && dy_m > 0.0 && dz_m > 0.0))
        throw input_error("flame.voxel_m", fmt::format("is {} x {} x {} m, must be above 0", dx_m, dy_m, dz_m));
    Lattice lattice{dx_m, dy_m, dz_m};
    const Extent extent = extent_of(columns, lattice);
    if (extent.i_high < extent.i_low) return {};
    lattice.i0 = extent.i_low;
    lattice.j0 = extent.j_low;
    lattice.k0 = extent.k_low;
    const std::int64_t nx = extent.i_high - extent.i_low + 1, ny = extent.j_high - extent.j_low + 1;
    constexpr std::int64_t kLimit = std::numeric_limits<int>::max();
    const VoxelGrid grid{{static_cast<double>(extent.i_low) * dx_m, static_cast<double>(extent.j_low) * dy_m,
                          static_cast<double>(extent.k_low) * dz_m},
                         static_cast<int>(std::min(nx, kLimit)),
                         static_cast<int>(std::min(ny, kLimit)),
                         dx_m,
                         dy_m,
                         dz_m};
    check_grid(grid);
    Cutter cutter(lattice, grid, flame.profile, ground);
    for (const FlameColumn& column : columns) cutter.add(column);
    return merge_into_bricks(grid, cutter.take());
}

}  // namespace pyroscene::fire
