#include "fire/plume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/constants.h"
#include "base/error.h"
#include "fire/sampling.h"

namespace pyroscene::fire {
namespace {

constexpr double kLeastWind_m_s = 1.0;
constexpr double kLargestExcess_K = 800.0;  ///< hotter gas is flame
constexpr double kMaximumVoxels = 2e7;
constexpr int kMaximumSteps = 2000;

/// Dense lattice over the map; heat per air heat capacity, hence excess temperature, accumulates in it.
class Lattice {
public:
    Lattice(const MapGrid& map, const Raster<float>& terrain_m, const PlumeParameters& p, Vec3 origin) {
        double lowest_m = std::numeric_limits<double>::max(), highest_m = -lowest_m;
        for (const float height_m : terrain_m.values) {
            if (std::isnan(height_m)) continue;
            lowest_m = std::min(lowest_m, static_cast<double>(height_m));
            highest_m = std::max(highest_m, static_cast<double>(height_m));
        }
        const auto [dx_m, dy_m, dz_m] = p.voxel_m;
        // Voxel faces lie at multiples of the edges in the scene frame, as those of the flame do.
        const auto first = [](double place_m, double edge_m) { return std::floor(place_m / edge_m); };
        const double i0 = first(map.west_m - origin.x, dx_m), j0 = first(map.south_m() - origin.y, dy_m);
        const double k0 = first(lowest_m, dz_m);
        grid = {.corner_m = {i0 * dx_m, j0 * dy_m, k0 * dz_m},
                .nx = static_cast<int>(first(map.east_m() - origin.x - 1e-6, dx_m) - i0) + 1,
                .ny = static_cast<int>(first(map.north_m - origin.y - 1e-6, dy_m) - j0) + 1,
                .dx_m = dx_m,
                .dy_m = dy_m,
                .dz_m = dz_m};
        nz = static_cast<int>(std::ceil((highest_m + p.top_m - grid.corner_m.z) / dz_m));
        const double voxels = static_cast<double>(grid.nx) * grid.ny * nz;
        if (!(voxels <= kMaximumVoxels))
            throw input_error("plume.voxel_m",
                              fmt::format("{} x {} x {} m make {:.2g} voxels, {:.0e} are possible; use larger "
                                          "voxels or a lower plume.top_m",
                                          dx_m, dy_m, dz_m, voxels, kMaximumVoxels));
        excess_K.assign(static_cast<std::size_t>(voxels), 0.0);
    }

    [[nodiscard]] std::size_t index(int i, int j, int k) const noexcept {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.ny) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(grid.nx) +
               static_cast<std::size_t>(i);
    }

    /// Spreads heat [K m3] evenly over a cube by exact overlap; what lies outside the lattice is lost, except that the part
    /// of a cube below the ground at its middle is above it.
    void add_cube(Vec3 centre_m, double edge_m, double ground_m, double heat_K_m3) {
        const double bottom_m = std::max(centre_m.z - 0.5 * edge_m, ground_m);
        const Span x = span(centre_m.x - 0.5 * edge_m - grid.corner_m.x, edge_m, grid.dx_m, grid.nx);
        const Span y = span(centre_m.y - 0.5 * edge_m - grid.corner_m.y, edge_m, grid.dy_m, grid.ny);
        const Span z = span(bottom_m - grid.corner_m.z, edge_m, grid.dz_m, nz);
        const double per_m3 = heat_K_m3 / (edge_m * edge_m * edge_m) / (grid.dx_m * grid.dy_m * grid.dz_m);
        for (int k = z.first; k < z.end; ++k) {
            const double z_K = per_m3 * z.overlap_m(k);
            for (int j = y.first; j < y.end; ++j) {
                const double yz_K = z_K * y.overlap_m(j);
                double* row = &excess_K[index(0, j, k)];
                for (int i = x.first; i < x.end; ++i) row[i] += yz_K * x.overlap_m(i);
            }
        }
    }

    VoxelGrid grid;
    int nz = 0;
    std::vector<double> excess_K;

private:
    struct Span {
        double from_m, to_m, size_m;
        int first, end;
        [[nodiscard]] double overlap_m(int i) const noexcept {
            return std::min(to_m, (i + 1) * size_m) - std::max(from_m, i * size_m);
        }
    };
    static Span span(double from_m, double width_m, double size_m, int count) noexcept {
        const double to_m = from_m + width_m;
        return {from_m, to_m, size_m, std::clamp(static_cast<int>(std::floor(from_m / size_m)), 0, count),
                std::clamp(static_cast<int>(std::ceil(to_m / size_m)), 0, count)};
    }
};

/// Smoke of a layer in the voxels of index k.
float overlap_g_m3(const SmokeLayer& layer, const VoxelGrid& grid, int k) {
    const double bottom_m = grid.corner_m.z + k * grid.dz_m;
    const double inside_m = std::min(layer.top_m, bottom_m + grid.dz_m) - std::max(layer.bottom_m, bottom_m);
    return static_cast<float>(layer.concentration_g_m3 * std::max(inside_m, 0.0) / grid.dz_m);
}

/// Voxels above the threshold, as gas and smoke, and those of layers.
FlameField voxels_of(const Lattice& lattice, const PlumeParameters& p) {
    const double smoke_g_per_K_m3 =
        p.air_density_kg_m3 * p.air_heat_capacity_J_kg_K * p.emission_factor_g_kg / p.heat_of_combustion_J_kg;
    std::vector<FlameVoxel> voxels;
    for (int k = 0; k < lattice.nz; ++k)
        for (int j = 0; j < lattice.grid.ny; ++j)
            for (int i = 0; i < lattice.grid.nx; ++i) {
                const double excess_K = lattice.excess_K[lattice.index(i, j, k)];
                if (!(excess_K >= p.minimum_excess_K) || !(excess_K > 0.0)) continue;
                const double T_K = p.temperature_K.value_or(p.air_temperature_K + std::min(excess_K, kLargestExcess_K));
                voxels.push_back(
                    {i, j, k, p.uniform ? 1.0F : static_cast<float>(smoke_g_per_K_m3 * excess_K), static_cast<float>(T_K)});
            }
    for (const SmokeLayer& layer : p.layers)
        for (int k = 0; k < lattice.nz; ++k) {
            const float fill = overlap_g_m3(layer, lattice.grid, k);
            for (int j = 0; fill > 0.0F && j < lattice.grid.ny; ++j)
                for (int i = 0; i < lattice.grid.nx; ++i)
                    voxels.push_back({i, j, k, fill, static_cast<float>(layer.temperature_K)});
        }
    if (voxels.empty()) return {};
    return make_flame_field(lattice.grid, voxels);
}

void check(const PlumeParameters& p) {
    const bool positive = p.voxel_m[0] > 0.0 && p.voxel_m[1] > 0.0 && p.voxel_m[2] > 0.0 && p.top_m > 0.0 &&
                          p.duration_s > 0.0 && p.entrainment > 0.0 && p.merge_m >= 0.0 && p.wind_height_m > 0.0 &&
                          p.air_density_kg_m3 > 0.0 && p.air_heat_capacity_J_kg_K > 0.0 && p.air_temperature_K > 0.0 &&
                          p.heat_of_combustion_J_kg > 0.0;
    if (!positive) throw input_error("plume", "voxel_m, top_m, duration_s, entrainment and the air must be above 0");
}

double wind_at(double wind_m_s, double height_m, const PlumeParameters& p) noexcept {
    const double factor = std::pow(std::max(height_m, 1.0) / p.wind_height_m, p.wind_exponent);
    return std::max(wind_m_s * factor, kLeastWind_m_s);
}

/// Sum of a raster over squares of cells around each cell: sums of columns, then of rows.
std::vector<double> sums_around(const MapGrid& grid, const std::vector<double>& values, int reach) {
    const auto slide = [](const double* in, double* out, int count, std::ptrdiff_t stride, int r) {
        std::vector<double> before(static_cast<std::size_t>(count) + 1, 0.0);
        for (int i = 0; i < count; ++i)
            before[static_cast<std::size_t>(i) + 1] = before[static_cast<std::size_t>(i)] + in[i * stride];
        for (int i = 0; i < count; ++i)
            out[i * stride] = before[static_cast<std::size_t>(std::min(i + r + 1, count))] -
                              before[static_cast<std::size_t>(std::max(i - r, 0))];
    };
    std::vector<double> rows(values.size()), both(values.size());
    for (int row = 0; row < grid.rows; ++row)
        slide(&values[grid.index(row, 0)], &rows[grid.index(row, 0)], grid.cols, 1, reach);
    for (int col = 0; col < grid.cols; ++col)
        slide(&rows[static_cast<std::size_t>(col)], &both[static_cast<std::size_t>(col)], grid.rows, grid.cols, reach);
    return both;
}

}  // namespace

std::vector<PlumePoint> plume_axis(double heat_W, double radius_m, double wind_m_s, double step_m,
                                   const PlumeParameters& p) {
    const double F =
        kGravity_m_s2 * heat_W / (kPi * p.air_density_kg_m3 * p.air_heat_capacity_J_kg_K * p.air_temperature_K);  // m4 s-3
    std::vector<PlumePoint> axis{{}};
    double momentum = 0.0;  // u R^2 w
    while (static_cast<int>(axis.size()) < kMaximumSteps) {
        const PlumePoint at = axis.back();
        const double u = wind_at(wind_m_s, at.height_m, p), R = radius_m + p.entrainment * at.height_m;
        const double dt_s = std::max(step_m, 0.25 * R) / std::hypot(u, at.rise_m_s);
        // dz = w dt and R = R0 + beta z make R^2 w dt = d(R^3) / (3 beta): exact in R for a wind that is constant in the step.
        const double R_after = std::cbrt(R * R * R + 3.0 * p.entrainment * (momentum + 0.5 * F * dt_s) / u * dt_s);
        momentum += F * dt_s;
        PlumePoint next{at.time_s + dt_s, at.downwind_m + u * dt_s, (R_after - radius_m) / p.entrainment,
                        momentum / (u * R_after * R_after)};
        if (next.height_m > p.top_m || next.time_s > p.duration_s) break;
        axis.push_back(next);
    }
    return axis;
}

FlameField rising_plume(const FrameInputs& frame, const Raster<float>& terrain_m, const PlumeParameters& p,
                        Vec3 scene_origin) {
    check(p);
    const MapGrid& map = frame.heat_flux_W_m2.grid;
    if (!(terrain_m.grid == map)) throw input_error("terrain", "its grid is not the heat flux's");
    std::vector<double> heat_W(map.size(), 0.0), burning(map.size(), 0.0);
    for (std::size_t i = 0; i < heat_W.size(); ++i) {
        const float flux = frame.heat_flux_W_m2.values[i];
        if (!(flux > 0.0F) || !std::isfinite(flux)) continue;
        heat_W[i] = static_cast<double>(flux) * map.cell_area_m2();
        burning[i] = 1.0;
    }
    const int reach = static_cast<int>(std::floor(p.merge_m / map.cell_m));
    const auto heat_around_W = sums_around(map, heat_W, reach), cells_around = sums_around(map, burning, reach);
    Lattice lattice(map, terrain_m, p, scene_origin);
    const double cell_radius_m = map.cell_m / std::sqrt(kPi);
    for (int row = 0; row < map.rows; ++row) {
        for (int col = 0; col < map.cols; ++col) {
            const std::size_t cell = map.index(row, col);
            const double ground_m = terrain_m.values[cell];
            if (!(heat_W[cell] > 0.0) || std::isnan(ground_m)) continue;
            const double east = frame.wind_east_m_s.values[cell], north = frame.wind_north_m_s.values[cell];
            const bool windy = std::isfinite(east) && std::isfinite(north) && std::hypot(east, north) > 0.0;
            const double wind_m_s = windy ? std::hypot(east, north) : 0.0;
            const double dir_x = windy ? east / wind_m_s : 0.0, dir_y = windy ? north / wind_m_s : 0.0;
            const auto axis = plume_axis(heat_around_W[cell], cell_radius_m * std::sqrt(cells_around[cell]), wind_m_s,
                                         0.5 * map.cell_m, p);
            for (std::size_t n = 0; n + 1 < axis.size(); ++n) {
                const double height_m = 0.5 * (axis[n].height_m + axis[n + 1].height_m);
                const double downwind_m = 0.5 * (axis[n].downwind_m + axis[n + 1].downwind_m);
                const double edge_m = std::sqrt(kPi) * (cell_radius_m + p.entrainment * height_m);
                const double heat_K_m3 = heat_W[cell] * (axis[n + 1].time_s - axis[n].time_s) /
                                         (p.air_density_kg_m3 * p.air_heat_capacity_J_kg_K);
                const Vec3 centre{map.x_centre_m(col) - scene_origin.x + dir_x * downwind_m,
                                  map.y_centre_m(row) - scene_origin.y + dir_y * downwind_m, ground_m + height_m};
                lattice.add_cube(centre, edge_m, ground_m, heat_K_m3);
            }
        }
    }
    return voxels_of(lattice, p);
}

FlameField layers_alone(const Raster<float>& terrain_m, const PlumeParameters& p, Vec3 scene_origin) {
    check(p);
    constexpr double kWidth_m = 1e5;
    const MapGrid& map = terrain_m.grid;
    double lowest_m = std::numeric_limits<double>::max(), top_m = -lowest_m;
    for (const float height_m : terrain_m.values)
        if (!std::isnan(height_m)) lowest_m = std::min(lowest_m, static_cast<double>(height_m));
    for (const SmokeLayer& layer : p.layers) top_m = std::max(top_m, layer.top_m);
    const double dz_m = p.voxel_m[2], bottom_m = std::floor(lowest_m / dz_m) * dz_m;
    const double west_m = 0.5 * (map.west_m + map.east_m() - kWidth_m) - scene_origin.x,
                 south_m = 0.5 * (map.south_m() + map.north_m - kWidth_m) - scene_origin.y;
    const VoxelGrid grid{
        .corner_m = {west_m, south_m, bottom_m}, .nx = 1, .ny = 1, .dx_m = kWidth_m, .dy_m = kWidth_m, .dz_m = dz_m};
    std::vector<FlameVoxel> voxels;
    for (int k = 0; bottom_m + k * dz_m < top_m; ++k)
        for (const SmokeLayer& layer : p.layers) {
            const float fill = overlap_g_m3(layer, grid, k);
            if (fill > 0.0F) voxels.push_back({0, 0, k, fill, static_cast<float>(layer.temperature_K)});
        }
    if (voxels.empty()) return {};
    return make_flame_field(grid, voxels);
}

double excess_of_buoyancy_K(double buoyancy_m_s2, double air_K) noexcept { return buoyancy_m_s2 * air_K / kGravity_m_s2; }

FlameField plume_of_levels(std::span<const Raster<float>> excess_K, std::span<const double> levels_m,
                           const Raster<float>& terrain_m, const PlumeParameters& p, Vec3 scene_origin) {
    check(p);
    if (excess_K.empty() || excess_K.size() != levels_m.size())
        throw input_error("inputs.plume.levels_m",
                          fmt::format("{} heights for {} levels; each needs one", levels_m.size(), excess_K.size()));
    const MapGrid& map = terrain_m.grid;
    for (const auto& level : excess_K)
        if (!(level.grid == map)) throw input_error("inputs.plume", "a level is not on the map grid");
    Lattice lattice(map, terrain_m, p, scene_origin);
    const VoxelGrid& g = lattice.grid;
    for (int j = 0; j < g.ny; ++j) {
        for (int i = 0; i < g.nx; ++i) {
            const double col = map.col_at(g.corner_m.x + (i + 0.5) * g.dx_m + scene_origin.x);
            const double row = map.row_at(g.corner_m.y + (j + 0.5) * g.dy_m + scene_origin.y);
            if (!map.contains(static_cast<int>(std::floor(row)), static_cast<int>(std::floor(col)))) continue;
            const double ground_m = bilinear_or_own(terrain_m, col, row);
            if (std::isnan(ground_m)) continue;
            for (int k = 0; k < lattice.nz; ++k) {
                const double height_m = g.corner_m.z + (k + 0.5) * g.dz_m - ground_m;
                if (height_m < 0.0 || height_m > std::min(levels_m.back(), p.top_m)) continue;
                const auto above = static_cast<std::size_t>(std::lower_bound(levels_m.begin(), levels_m.end(), height_m) -
                                                            levels_m.begin());
                const std::size_t below = above == 0 ? 0 : above - 1;
                const double span_m = levels_m[above] - levels_m[below];
                const double part = span_m > 0.0 ? (height_m - levels_m[below]) / span_m : 0.0;
                const double low_K = bilinear_or_own(excess_K[below], col, row),
                             high_K = bilinear_or_own(excess_K[above], col, row);
                const double value_K = part > 0.0 ? (1.0 - part) * low_K + part * high_K : low_K;
                if (value_K > 0.0) lattice.excess_K[lattice.index(i, j, k)] = value_K;
            }
        }
    }
    return voxels_of(lattice, p);
}

}  // namespace pyroscene::fire
