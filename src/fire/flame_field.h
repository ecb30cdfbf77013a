#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/raster.h"
#include "base/vec3.h"
#include "fire/surface_field.h"
#include "fire/temperature_profile.h"

namespace pyroscene::fire {

/// Regular voxel lattice in the scene frame (map coordinates minus the scene origin): x east, y north, z up.
struct VoxelGrid {
    Vec3 corner_m;       ///< south-west-bottom corner
    int nx = 0, ny = 0;  ///< columns to the east, rows to the NORTH (j = 0 is the southern row)
    double dx_m = 0.0, dy_m = 0.0, dz_m = 0.0;
};

/// One emitting voxel before bricking. `fill` is emissive volume / voxel volume (>= 0; it may exceed 1 where columns
/// overlap) and scales the absorption coefficient, so that emissive volume is conserved when the voxel size changes.
struct FlameVoxel {
    int i = 0, j = 0, k = 0;
    float fill = 0.0F, temperature_K = 0.0F;
};

/// Sparse flame: bricks of 8 x 8 x 8 voxels, grouped by vertical columns of bricks. No wavelengths here.
struct FlameField {
    static constexpr int kBrickEdge = 8;
    static constexpr int kBrickVoxels = kBrickEdge * kBrickEdge * kBrickEdge;

    /// Voxel (i, j, k) within a brick sits at index (k * 8 + j) * 8 + i. fill == 0 marks an empty voxel.
    struct Brick {
        std::array<float, kBrickVoxels> fill, temperature_K;
    };
    /// Bricks of one brick column are contiguous from z_begin (in bricks above corner_m.z) upwards; brick_count 0 = empty.
    /// Bricks between the lowest and highest occupied one are all present.
    struct BrickColumn {
        std::int32_t first_brick = 0, z_begin = 0, brick_count = 0;
    };

    VoxelGrid grid;
    int brick_cols = 0, brick_rows = 0;
    std::vector<BrickColumn> columns;  ///< [brick_row j][brick_col i]
    std::vector<Brick> bricks;

    [[nodiscard]] bool empty() const noexcept { return bricks.empty(); }
    /// Sum of fill x voxel volume [m3].
    [[nodiscard]] double emissive_volume_m3() const noexcept;
    /// Lowest and highest z of any brick [m]; {0, 0} when empty.
    [[nodiscard]] std::array<double, 2> z_range_m() const noexcept;
    /// {lowest, highest} temperature of occupied voxels [K]; {0, 0} when empty.
    [[nodiscard]] std::array<double, 2> temperature_range_K() const noexcept;
    /// Mean temperature of occupied voxels, weighted by fill and T^4 [K]; 0 when empty.
    [[nodiscard]] double emission_mean_temperature_K() const noexcept;
};

/// Builds the bricks; voxels of the same (i, j, k) are merged: fills add, T^5 averages by fill (TemperatureProfile says why). Order of the input
/// does not matter to the bit. Throws an input error for k < 0 or i, j outside the grid, a negative or infinite fill, and a
/// grid without voxels.
FlameField make_flame_field(const VoxelGrid& grid, std::span<const FlameVoxel> voxels);

/// What is in voxel (i, j, k); fill 0 where there is no flame or no brick. Meant for export and tests, not for ray marching.
FlameVoxel voxel_at(const FlameField& field, int i, int j, int k) noexcept;

/// A leaning prism of flame over a horizontal rectangle on the terrain.
struct FlameColumn {
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;  ///< centre of the base, scene frame
    double width_m = 0.0;                    ///< edge of the square base
    double area_fraction = 1.0;              ///< part of the base that flames
    double bottom_m = 0.0, top_m = 0.0;      ///< heights above the base between which it emits (embers: bottom > 0)
    double tilt_rad = 0.0, azimuth_rad = 0.0;
    double temperature_K = 0.0;  ///< at the base where a profile runs, else everywhere
    double flame_m = 0.0;        ///< height over which the temperature profile runs, from the base; 0 = one temperature
};

/// Flame temperature and voxel size as the scenario gives them.
struct FlameParameters {
    double temperature_K = 1100.0;
    std::array<double, 3> voxel_m{5.0, 5.0, 1.0};
    double ember_gap_m = 0.5;  ///< air between a flame and its detached part
    TemperatureProfile profile;
};

/// Columns of all burning fine cells: their height is flame_height / front_fraction of the map cell over the flaming area,
/// which conserves the volume of eq 4.21; jittered by the counter-based generator. Embers that drift follow, at `time_s` (not
/// before the state's); where they do not, detached flame (ember_height) is a second column above the gap. Fine cells whose terrain height is unknown have no flame. Throws an input error when the terrain or
/// the surface is not on the state's grid. \param scene_origin  map coordinates (x, y) of the scene frame's origin; z of the
/// scene frame is terrain height itself \param terrain_m     on the map grid; base height of a column is bilinear in it
std::vector<FlameColumn> make_columns(const FireState& state, const SurfaceField& surface, const Raster<float>& terrain_m,
                                      const FireParameters& fire, const FlameParameters& flame, Vec3 scene_origin,
                                      double time_s);

/// The same at the time of the state.
std::vector<FlameColumn> make_columns(const FireState& state, const SurfaceField& surface, const Raster<float>& terrain_m,
                                      const FireParameters& fire, const FlameParameters& flame, Vec3 scene_origin);

/// The ground that flames stand on, whose bilinear surface is what lines of sight end at.
struct FlameGround {
    const Raster<float>& terrain_m;
    Vec3 scene_origin;  ///< as for make_columns()
};

/// Cuts the columns into voxels; each column's emissive volume goes to voxels by exact overlap, sheared by its tilt (slabs
/// that shift by at most half a voxel). The lattice starts at the zero of the scene frame, so lattices of different frames
/// coincide; heights are vertical, so shear conserves volume. Columns in any order give the same bits. Throws an input error
/// for voxels too small for the memory and for a tilt beyond 89 degrees.
/// \param ground  flame in voxels that the ground cuts goes up into the lowest voxel that stands clear of it, or part of it would
/// be hidden: half of what is lower than a voxel, on a slope or on level ground between two voxel faces. Null = no ground
FlameField voxelise(std::span<const FlameColumn> columns, const FlameParameters& flame, const FlameGround* ground = nullptr);

}  // namespace pyroscene::fire
