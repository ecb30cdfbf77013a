#pragma once

#include <cstdint>
#include <vector>

#include "fire/flame_field.h"

/// How voxels become bricks; shared by make_flame_field() and voxelise(), not for other modules.
namespace pyroscene::fire {

/// Part of the flame in one voxel. The key orders voxels by brick column, brick height and place in the brick.
struct Contribution {
    std::uint64_t key = 0;
    float fill = 0.0F, temperature_K = 0.0F;
};

/// Bricks across a number of voxels.
inline int bricks_across(int voxels) noexcept { return (voxels - 1) / FlameField::kBrickEdge + 1; }

/// Key of a voxel that lies in the grid. Throws an input error when the lattice is too large for the keys.
std::uint64_t contribution_key(const VoxelGrid& grid, int i, int j, int k);

/// Throws an input error unless the grid has voxels of positive size and a number of brick columns that memory can hold.
void check_grid(const VoxelGrid& grid);

/// Sorts and merges the contributions. Their order does not matter to the bit: equal voxels are summed in the order of
/// value.
FlameField merge_into_bricks(const VoxelGrid& grid, std::vector<Contribution> contributions);

}  // namespace pyroscene::fire
