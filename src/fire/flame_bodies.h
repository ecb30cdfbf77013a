#pragma once

#include <vector>

#include "fire/flame_field.h"

namespace pyroscene::fire {

/// A brick of flame as one body, to estimate its light as a whole: a convex body of volume V and surface A has the mean chord
/// 4 V / A and, seen from a random direction, the area A / 4 (Cauchy).
struct FlameBody {
    Vec3 middle_m;           ///< weighted with fill T^4
    double filled_m3 = 0.0;  ///< sum of fill times voxel volume
    /// Its share by volume of the faces (of horizontal ones the filled part: flame stands in columns, fronts are strips) towards air of the brick and the bricks around it, so that flame cut into bricks keeps
    /// its chord and its whole surface; at least that of the sphere that holds the same gas.
    double area_m2 = 0.0;
    double T_K = 0.0;  ///< weighted with fill T^4
    [[nodiscard]] double chord_m() const noexcept { return 4.0 * filled_m3 / area_m2; }
};

/// One body per brick with flame, in the order of the bricks.
std::vector<FlameBody> flame_bodies(const FlameField& flame);

}  // namespace pyroscene::fire
